//! What `check` says of bodies.

use super::Bodies;
use super::padding::spec_of_padding;
use super::robot::{JointKind, Limits, Mimic};
use super::spec::PaddingSpec;
use super::validity::{BoundsMeaning, MotionChecking, TOLERANCE};
use crate::internal::plain::plain;
use crate::model::Description;
use crate::scene::{Body, Shape};
use crate::space::BaseJoint;
use std::fmt::Write;

/// The names by which the values of moving joints are known, which tell joints of one name apart; in the order of the links.
fn joint_names(bodies: &Bodies) -> Vec<String> {
    let space = bodies.space();
    let joints = bodies.robot.links.iter().filter_map(|link| link.joint.as_ref());
    let values = joints.map(|joint| joint.kind.values());
    let values: Vec<usize> = values.filter(|values| *values > 0).collect();
    let mut at = space.len() - values.iter().sum::<usize>();
    let mut names = Vec::new();
    for count in values {
        let name = &space.dofs()[at].name;
        names.push(if count == 4 { name.replace("-qw", "") } else { name.clone() });
        at += count;
    }
    names
}

pub(super) fn describe(bodies: &Bodies, out: &mut String) -> std::fmt::Result {
    let bounds = &bodies.bounds;
    let base = match bodies.robot.motion {
        BaseJoint::Fixed => "the base stands still",
        BaseJoint::Translation2d => "x y: the base's place in the plane z = 0",
        BaseJoint::Rigid2d => {
            "x y theta: the base's pose in the plane; theta in radians, in [-pi, pi)"
        }
        BaseJoint::Translation3d => "x y z: the base's place",
        BaseJoint::Rigid3d => "x y z qw qx qy qz: the base's pose; a unit quaternion, w first",
    };
    writeln!(out, "                 {base}, its frame in the world's")?;
    let given = joint_names(bodies);
    let mut names = given.iter();
    // The names of values, by their indices.
    let mut of_values: Vec<&str> = Vec::new();
    for joint in bodies.robot.links.iter().filter_map(|link| link.joint.as_ref()) {
        if joint.kind.values() > 0 {
            let name = names.next().map_or("", String::as_str);
            of_values.extend(std::iter::repeat_n(name, joint.kind.values()));
        }
    }
    let mut names = given.iter();
    let mut locked = Vec::new();
    for joint in bodies.robot.links.iter().filter_map(|link| link.joint.as_ref()) {
        let name = match joint.kind.values() {
            0 => plain(&joint.name).into_owned(),
            _ => plain(names.next().map_or("", String::as_str)).into_owned(),
        };
        match joint.kind {
            JointKind::Fixed => {}
            JointKind::Locked => locked.push(name),
            JointKind::RevoluteMimic { mimic, .. } | JointKind::PrismaticMimic { mimic, .. } => {
                let other = plain(of_values[mimic.value as usize]);
                let Mimic { multiplier, offset, .. } = mimic;
                writeln!(
                    out,
                    "                 {name} has no value: it follows {other}, times {multiplier}, plus \
                     {offset}"
                )?;
            }
            JointKind::Revolute { limits: None, .. } => {
                writeln!(out, "                 {name}: turns on and on; radians, in [-pi, pi)")?;
            }
            JointKind::Revolute { limits: Some(Limits { min, max }), .. } => {
                writeln!(out, "                 {name}: turns from {min} to {max} radians")?;
            }
            JointKind::Spherical => {
                writeln!(out, "                 {name}: turns in every way; a unit quaternion")?;
            }
            JointKind::Prismatic { limits: Limits { min, max }, .. } => {
                writeln!(out, "                 {name}: slides from {min} to {max}")?;
            }
        }
    }
    if !locked.is_empty() {
        writeln!(out, "                 locked: {}", locked.join(", "))?;
    }
    let pairs = bodies.robot.self_pairs().count();
    if bodies.robot.links.len() > 1 {
        let links = bodies.robot.links.len();
        writeln!(out, "                 {links} links, {pairs} pairs of which must not touch")?;
    }
    match spec_of_padding(&bodies.robot) {
        None => {}
        Some(PaddingSpec::Same(length)) => {
            writeln!(
                out,
                "                 obstacles stay {length} away from every link (padding)"
            )?;
        }
        Some(PaddingSpec::ByLink(by_link)) => {
            let entry = |(link, length)| format!("{length} from {link}");
            let entries: Vec<String> = by_link.iter().map(entry).collect();
            let entries = entries.join(", ");
            writeln!(out, "                 obstacles stay away (padding): {entries}")?;
        }
    }
    writeln!(out, "                 lengths in the unit of the file")?;
    let axes = bodies.robot.motion.bounded_axes();
    let meaning = match bounds.meaning {
        BoundsMeaning::Body => "hold every robot point and the reference point",
        BoundsMeaning::Reference => "hold the reference point, the origin of the robot's frame",
    };
    writeln!(
        out,
        "bounds           {:?} to {:?}, {meaning}",
        &bounds.min[..axes],
        &bounds.max[..axes]
    )?;
    let promise = match bodies.edges {
        MotionChecking::Swept => format!("motions are free at all times, to a {TOLERANCE}th of it"),
        MotionChecking::Sampled => "no robot point moves farther between two checks".to_owned(),
        MotionChecking::Penetrating { depth } => format!(
            "no robot point moves farther between two checks, and what a motion of length {depth} frees is valid"
        ),
    };
    writeln!(out, "resolution       {}: {promise}", bodies.resolution)?;
    if bodies.robot.motion.rotates() {
        writeln!(
            out,
            "rotation_length  {}: what a radian counts for in the metric",
            bodies.rotation_length
        )?;
    }
    let robot: Vec<Body> = bodies.robot.bodies().cloned().collect();
    for (what, shown) in [("robot", &robot), ("obstacles", &bodies.obstacles)] {
        let triangles: usize = shown
            .iter()
            .map(|body| if let Shape::Mesh(mesh) = &body.shape { mesh.triangles.len() } else { 0 })
            .sum();
        let mut shapes: Vec<(&str, usize)> = Vec::new();
        for body in shown {
            match shapes.iter_mut().find(|(name, _)| *name == body.shape.name()) {
                Some((_, count)) => *count += 1,
                None => shapes.push((body.shape.name(), 1)),
            }
        }
        let shapes: Vec<_> = shapes.iter().map(|(name, count)| format!("{count} {name}")).collect();
        let shapes = if shapes.is_empty() { "none".to_owned() } else { shapes.join(", ") };
        match triangles {
            0 => writeln!(out, "{what:<16} {shapes}")?,
            _ => writeln!(out, "{what:<16} {shapes} ({triangles} triangles)")?,
        }
    }
    Ok(())
}
