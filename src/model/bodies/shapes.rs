//! The robot's bodies and the obstacles.

use super::robot::Robot;
use super::spec::{BodySpec, FrameSpec, ShapeSpec, Solid};
use crate::digest::SourceFile;
use crate::math;
use crate::scene::{Body, LENGTH_MAX, MeshOptions, Pose, ReadMesh, Shape, Weld, read_mesh_with};
use crate::source::Step::{self, Index, Key};
use crate::source::{ProblemError, Source};
use crate::space::{canonical, stored_form};

/// The largest share of a mesh's size that its vertices may be apart and be one.
const WELD_MAX: f64 = 0.01;

/// Makes the bodies that are asked for at `place`.
pub(super) fn bodies(
    source: &Source,
    place: &[Step],
    specs: &[BodySpec],
    notes: &mut Vec<String>,
) -> Result<Vec<Body>, ProblemError> {
    let mut bodies = Vec::new();
    for (index, spec) in specs.iter().enumerate() {
        let at = |key| [place, &[Index(index), Key(key)]].concat();
        let pose =
            pose_of(&spec.frame()).map_err(|(key, message)| source.error(&at(key), message))?;
        let what = if place.len() == 1 { "obstacle" } else { "robot body" };
        let what = format!("{what} {index}");
        let (shape, pairs) = shape_of(source, &spec.shape, &what, notes)
            .map_err(|message| source.error(&at("shape"), message))?;
        let solid = match (&shape, spec.solid) {
            (Shape::Mesh(mesh), Solid::Yes) if !mesh.is_closed() => {
                let message = format!(
                    "true found, but the mesh is not closed ({} edges belong to an odd number of \
                     triangles); false or \"auto\" expected",
                    mesh.odd_edges()
                );
                return Err(source.error(&at("solid"), message));
            }
            (Shape::Mesh(mesh), Solid::Auto) => {
                let closed = mesh.is_closed();
                notes.push(format!(
                    "{what}: solid = {closed}, as {}",
                    found(mesh.odd_edges(), pairs)
                ));
                closed
            }
            (Shape::Mesh(_), Solid::Yes) => true,
            (Shape::Mesh(_), Solid::No) => false,
            (_, Solid::No) => {
                let message = format!("false found; a {} is always solid", shape.name());
                return Err(source.error(&at("solid"), message));
            }
            _ => true,
        };
        bodies.push(Body { shape, pose, solid });
    }
    Ok(bodies)
}

/// The pose of a frame, or which key is wrong and how.
pub(super) fn pose_of(frame: &FrameSpec) -> Result<Pose, (&'static str, String)> {
    let FrameSpec { position, orientation, turn } = frame;
    // Written so that NaN fails it.
    if !position.iter().all(|value| value.abs() <= LENGTH_MAX) {
        let message = format!("{position:?} found; lengths within ±{LENGTH_MAX:e} expected");
        return Err(("position", message));
    }
    let rotation = match (orientation, turn) {
        (Some(_), Some(_)) => {
            return Err(("turn", "given beside orientation; one of the two expected".to_owned()));
        }
        (Some(quaternion), None) => stored_form(*quaternion).ok_or_else(|| {
            let expected = "a finite quaternion w x y z other than zero expected";
            ("orientation", format!("{quaternion:?} found; {expected}"))
        })?,
        (None, Some(turn)) => {
            let axis = unit(turn.axis).filter(|_| turn.degrees.is_finite());
            let axis = axis.ok_or_else(|| {
                let expected = "an axis other than zero and finite degrees expected";
                ("turn", format!("axis {:?} by {}° found; {expected}", turn.axis, turn.degrees))
            })?;
            rotation_about(axis, turn.degrees)
        }
        (None, None) => Pose::IDENTITY.rotation,
    };
    Ok(Pose { translation: *position, rotation })
}

/// The vector at unit length, if it has a direction. One that has unit length to within rounding is
/// taken as it is, so that what is written can be read again.
pub(super) fn unit([x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
    let length = (x * x + y * y + z * z).sqrt();
    if (length - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some([x, y, z]);
    }
    (length.is_finite() && length > 1e-100).then(|| [x / length, y / length, z / length])
}

/// The rotation by `degrees` about a unit axis.
fn rotation_about(axis: [f64; 3], degrees: f64) -> [f64; 4] {
    let half = degrees / 360.0 * std::f64::consts::PI;
    let (sine, cosine) = (math::sin(half), math::cos(half));
    let quaternion = [cosine, axis[0] * sine, axis[1] * sine, axis[2] * sine];
    canonical(quaternion).unwrap_or(Pose::IDENTITY.rotation)
}

/// What decides whether a mesh is solid: its open edges, and pairs of equal triangles that were kept to close it.
pub(super) fn found(odd_edges: usize, pairs: usize) -> String {
    match (odd_edges, pairs) {
        (0, 0) => "the mesh is closed".to_owned(),
        (0, 1) => {
            "the mesh is closed but for a wall within it, 1 pair of equal triangles".to_owned()
        }
        (0, _) => {
            format!("the mesh is closed but for walls within it, {pairs} pairs of equal triangles")
        }
        (odd, _) => format!("the mesh has {odd} open edges"),
    }
}

/// How far apart vertices are that had to be joined to close a mesh.
pub(super) fn closed_by(read: &ReadMesh) -> Option<String> {
    let (length, open) = read.closed_by?;
    Some(format!("vertices at most {length:.3e} apart joined, without which {open} edges are open"))
}

/// Makes a shape, and says of a mesh how many pairs of equal triangles it keeps.
fn shape_of(
    source: &Source,
    spec: &ShapeSpec,
    what: &str,
    notes: &mut Vec<String>,
) -> Result<(Shape, usize), String> {
    let length = |key: &str, value: f64| {
        if value > 0.0 && value <= LENGTH_MAX {
            Ok(value)
        } else if value > LENGTH_MAX {
            Err(format!("{key} = {value:e} found; at most {LENGTH_MAX:e} expected"))
        } else {
            Err(format!("{key} = {value} found; a positive length expected"))
        }
    };
    let mesh_options = |scale: f64, weld: f64| {
        length("scale", scale)?;
        if !(0.0..=WELD_MAX).contains(&weld) {
            let expected = format!("a share of the mesh's size from 0 to {WELD_MAX} expected");
            return Err(format!("weld = {weld} found; {expected}"));
        }
        let weld = Weld::ToClose(weld);
        Ok(MeshOptions { scale: [scale; 3], weld, ..MeshOptions::default() })
    };
    let (read, weld) = match spec {
        ShapeSpec::Point {} => return Ok((Shape::Point, 0)),
        ShapeSpec::Box { size } => {
            for edge in size {
                length("size", *edge)?;
            }
            return Ok((Shape::Box { size: *size }, 0));
        }
        ShapeSpec::Sphere { radius } => {
            return Ok((Shape::Sphere { radius: length("radius", *radius)? }, 0));
        }
        ShapeSpec::Cylinder { radius, height } => {
            let (radius, height) = (length("radius", *radius)?, length("height", *height)?);
            return Ok((Shape::Cylinder { radius, height }, 0));
        }
        ShapeSpec::Capsule { radius, height } => {
            let (radius, height) = (length("radius", *radius)?, length("height", *height)?);
            return Ok((Shape::Capsule { radius, height }, 0));
        }
        ShapeSpec::Mesh { file, scale, weld } => {
            let options = mesh_options(*scale, *weld)?;
            let read = read_mesh_with(&source.folder.join(file), &options);
            let read = read.map_err(|error| error.to_string())?;
            let path = file.to_string_lossy().into_owned();
            source.read(SourceFile { path, digest: read.digest });
            (read, weld)
        }
        ShapeSpec::Triangles { vertices, triangles, scale, weld } => {
            let options = mesh_options(*scale, *weld)?;
            let read = ReadMesh::of_triangles(vertices.clone(), triangles.clone(), &options);
            (read.map_err(|error| error.to_string())?, weld)
        }
    };
    if let Some(joined) = closed_by(&read) {
        notes.push(format!("{what}: {joined} (weld = {weld:e})"));
    }
    Ok((Shape::Mesh(read.mesh), read.pairs))
}

/// Checks the robot and the obstacles against one another.
pub(super) fn check_bodies(
    source: &Source,
    robot: &Robot,
    obstacles: &[Body],
) -> Result<(), ProblemError> {
    bodies_complaint(robot, obstacles)
        .map_or(Ok(()), |(place, message)| Err(source.error(&place, message.to_owned())))
}

/// What is wrong with the robot and the obstacles taken together, if anything: where, what was found and what is
/// expected.
pub(super) fn bodies_complaint(
    robot: &Robot,
    obstacles: &[Body],
) -> Option<(Vec<Step<'static>>, &'static str)> {
    if robot.bodies().next().is_none() {
        let message = "no bodies found; at least one expected";
        return Some((vec![Key("robot"), Key("bodies")], message));
    }
    if let Some(index) = obstacles.iter().position(|body| body.shape == Shape::Point) {
        let message = "a point cannot be an obstacle; a shape with an extent expected";
        return Some((vec![Key("obstacles"), Index(index), Key("shape")], message));
    }
    let pointlike = robot.bodies().any(|body| body.shape == Shape::Point);
    if pointlike && let Some(index) = obstacles.iter().position(|body| !body.solid) {
        let message = "a point robot never touches a surface without inside at the configurations \
                       that are checked; a solid obstacle or a robot with an extent expected";
        return Some((vec![Key("obstacles"), Index(index)], message));
    }
    None
}
