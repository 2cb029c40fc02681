//! What makes a description of bodies sound. A problem file is checked while it is read, with the line of whatever is
//! wrong; here the same is asked of a description that came as bytes, from a ledger or another process.

use super::Bodies;
use super::resolve::{FINEST, diagonal_of, too_far};
use super::robot::{JointKind, LINKS_MAX, Limits, Link, Robot, TURN_MAX, mimic_complaint};
use super::shapes::bodies_complaint;
use super::validity::{Bounds, MotionChecking};
use crate::scene::{Body, LENGTH_MAX, Mesh, Pose, Shape};
use crate::source::place_of;

/// The largest coordinate. Importers centre meshes and compose frames, which leads beyond what files may hold.
const FAR: f64 = 4.0 * LENGTH_MAX;
/// By how much, relative to them, rounding may have moved numbers that were computed from what a file holds.
const ROUNDING: f64 = 1e-9;
/// By how much rotations and axes may differ from unit length.
const UNIT: f64 = 1e-6;

/// The first thing that is wrong with a description: where, what was found and what is expected.
pub(super) fn sound(bodies: &Bodies) -> Result<(), String> {
    let Bodies { bounds, resolution, edges, rotation_length, robot, obstacles } = bodies;
    bounds_sound(bounds, robot)?;
    robot_sound(robot)?;
    for (index, body) in obstacles.iter().enumerate() {
        body_sound(body).map_err(|why| format!("obstacles[{index}]{why}"))?;
    }
    if let Some((place, message)) = bodies_complaint(robot, obstacles) {
        return Err(format!("{}: {message}", place_of(&place)));
    }
    let diagonal = diagonal_of(bounds, robot.motion);
    if let Some(message) = too_far(robot, diagonal) {
        return Err(format!("robot: {message}"));
    }
    let finest = FINEST * diagonal;
    if !(resolution.is_finite() && *resolution >= finest * (1.0 - ROUNDING)) {
        let expected = format!("a length of at least {finest:e} expected");
        return Err(format!("space.resolution: {resolution} found; {expected}"));
    }
    if let Some(message) = depth_complaint(*edges) {
        return Err(format!("space.edges: {message}"));
    }
    if !(rotation_length.is_finite() && *rotation_length >= 0.0) {
        let expected = "a length of at least 0 expected";
        return Err(format!("space.rotation_length: {rotation_length} found; {expected}"));
    }
    Ok(())
}

/// What is wrong with the depth by which bodies may overlap, if anything is.
pub(super) fn depth_complaint(edges: MotionChecking) -> Option<String> {
    let MotionChecking::Penetrating { depth } = edges else { return None };
    // Written so that NaN fails it.
    let fits = depth > 0.0 && depth <= LENGTH_MAX;
    (!fits).then(|| {
        format!("depth = {depth} found; a length above 0, at most {LENGTH_MAX:e}, expected")
    })
}

/// Written so that NaN fails it.
fn is_near(values: &[f64]) -> bool {
    values.iter().all(|value| value.abs() <= FAR)
}

fn is_unit(values: &[f64]) -> bool {
    let square: f64 = values.iter().map(|value| value * value).sum();
    (square - 1.0).abs() <= UNIT
}

fn bounds_sound(Bounds { min, max, meaning: _ }: &Bounds, robot: &Robot) -> Result<(), String> {
    if !(is_near(min) && is_near(max)) {
        return Err(format!("space: bounds {min:?} to {max:?} found; finite lengths expected"));
    }
    let bounded = 0..robot.motion.bounded_axes();
    match bounded.into_iter().find(|axis| min[*axis] >= max[*axis]) {
        None => Ok(()),
        Some(axis) => {
            let (name, low, high) = (["x", "y", "z"][axis], min[axis], max[axis]);
            let expected = format!("more than min = {low} expected");
            Err(format!("space.max: in {name} max = {high} found; {expected}"))
        }
    }
}

fn robot_sound(robot: &Robot) -> Result<(), String> {
    let Robot { motion, base, links, may_touch, padding } = robot;
    pose_sound(base).map_err(|why| format!("robot.base: {why}"))?;
    if !(1..=LINKS_MAX).contains(&links.len()) {
        return Err(format!("robot: {} links found; 1 to {LINKS_MAX} expected", links.len()));
    }
    for (index, link) in links.iter().enumerate() {
        link_sound(link, index).map_err(|why| format!("robot: link {index}{why}"))?;
    }
    let joints = links.iter().filter_map(|link| link.joint.as_ref());
    if motion.values() + joints.map(|joint| joint.kind.values()).sum::<usize>() == 0 {
        return Err("robot: nothing moves; a moving base or a moving joint expected".to_owned());
    }
    if let Some((index, message)) = mimic_complaint(links) {
        return Err(format!("robot: link {index}.joint: {message}"));
    }
    if !(padding.is_empty() || padding.len() == links.len()) {
        let (found, expected) = (padding.len(), links.len());
        return Err(format!("robot.padding: {found} lengths found; none or {expected} expected"));
    }
    // Written so that NaN fails it.
    if let Some(length) = padding.iter().find(|length| !(**length >= 0.0 && **length <= FAR)) {
        return Err(format!("robot.padding: {length} found; a length of at least 0 expected"));
    }
    let listed = |link: &u32| (*link as usize) < links.len();
    match may_touch.iter().find(|(one, other)| !(listed(one) && listed(other))) {
        None => Ok(()),
        Some(pair) => Err(format!("robot.may_touch: {pair:?} found; indices of links expected")),
    }
}

/// What is wrong begins with `: ` or with the key of a part of the link.
fn link_sound(link: &Link, index: usize) -> Result<(), String> {
    for (number, body) in link.bodies.iter().enumerate() {
        body_sound(body).map_err(|why| format!(".bodies[{number}]{why}"))?;
    }
    let joint = match (&link.joint, index) {
        (None, 0) => return Ok(()),
        (Some(joint), 1..) => joint,
        (Some(_), 0) => return Err(": a joint found; none expected at the base".to_owned()),
        (None, 1..) => return Err(": no joint found; one expected".to_owned()),
    };
    if joint.parent as usize >= index {
        let expected = "the index of a link before this one expected";
        return Err(format!(".joint: parent {} found; {expected}", joint.parent));
    }
    for (key, pose) in [("before", &joint.before), ("after", &joint.after)] {
        pose_sound(pose).map_err(|why| format!(".joint.{key}: {why}"))?;
    }
    let (axis, limits, most) = match joint.kind {
        JointKind::Fixed | JointKind::Spherical | JointKind::Locked => return Ok(()),
        JointKind::RevoluteMimic { axis, .. } | JointKind::PrismaticMimic { axis, .. } => {
            (axis, None, TURN_MAX)
        }
        JointKind::Revolute { axis, limits } => (axis, limits, TURN_MAX),
        JointKind::Prismatic { axis, limits } => (axis, Some(limits), FAR),
    };
    if !is_unit(&axis) {
        return Err(format!(".joint: axis {axis:?} found; one of unit length expected"));
    }
    let most = most * (1.0 + ROUNDING);
    match limits {
        Some(Limits { min, max }) if !(min <= max && -most <= min && max <= most) => {
            let expected = format!("a least and a largest value within ±{most:e} expected");
            Err(format!(".joint: limits {min} to {max} found; {expected}"))
        }
        _ => Ok(()),
    }
}

/// As of [`link_sound`].
pub(crate) fn body_sound(body: &Body) -> Result<(), String> {
    pose_sound(&body.pose).map_err(|why| format!(": {why}"))?;
    let lengths: &[f64] = match &body.shape {
        Shape::Point => &[],
        Shape::Box { size } => size,
        Shape::Sphere { radius } => &[*radius],
        Shape::Cylinder { radius, height } | Shape::Capsule { radius, height } => {
            &[*radius, *height]
        }
        Shape::Mesh(mesh) => return mesh_sound(mesh, body.solid),
    };
    // Written so that NaN fails it.
    match lengths.iter().find(|length| !(**length > 0.0 && **length <= FAR)) {
        None => Ok(()),
        Some(length) => Err(format!(".shape: {length} found; a positive length expected")),
    }
}

fn mesh_sound(mesh: &Mesh, solid: bool) -> Result<(), String> {
    let Mesh { vertices, triangles } = mesh;
    if let Some(vertex) = vertices.iter().find(|vertex| !is_near(&vertex[..])) {
        return Err(format!(".shape: a vertex at {vertex:?} found; finite lengths expected"));
    }
    let listed = |corner: &u32| (*corner as usize) < vertices.len();
    if let Some(corners) = triangles.iter().find(|corners| !corners.iter().all(listed)) {
        let expected = format!("indices of {} vertices expected", vertices.len());
        return Err(format!(".shape: a triangle of {corners:?} found; {expected}"));
    }
    if mesh.faces().next().is_none() {
        return Err(".shape: a mesh without triangles that have an area found".to_owned());
    }
    match mesh.odd_edges() {
        odd if solid && odd > 0 => Err(format!(
            ".solid: true found, but the mesh is not closed ({odd} edges belong to an odd number \
             of triangles)"
        )),
        _ => Ok(()),
    }
}

fn pose_sound(Pose { translation, rotation }: &Pose) -> Result<(), String> {
    if !is_near(translation) {
        return Err(format!("position {translation:?} found; finite lengths expected"));
    }
    if !is_unit(rotation) {
        return Err(format!("orientation {rotation:?} found; a unit quaternion expected"));
    }
    Ok(())
}
