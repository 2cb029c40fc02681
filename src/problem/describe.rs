use super::Problem;
use crate::robot::{JointKind, Limits};
use crate::scene::{Body, Shape};
use crate::schedule::Adaptive;
use crate::space::Motion;
use crate::validity::{BoundsMeaning, Edges, TOLERANCE};
use std::fmt::Write;

pub(super) fn describe(problem: &Problem) -> String {
    let mut text = String::new();
    write_all(problem, &mut text).expect("writing to memory cannot fail");
    text
}

fn write_all(problem: &Problem, out: &mut String) -> std::fmt::Result {
    let bounds = &problem.bounds;
    let space = problem.space();
    let names: Vec<_> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
    writeln!(out, "problem          {} (seed {})", problem.name, problem.seed)?;
    writeln!(out, "configuration    {}", names.join(" "))?;
    let base = match problem.robot.motion {
        Motion::Fixed => "the base stands still",
        Motion::Translation2d => "x y: the base's place in the plane z = 0",
        Motion::Rigid2d => {
            "x y theta: the base's pose in the plane; theta in radians, in [-pi, pi)"
        }
        Motion::Translation3d => "x y z: the base's place",
        Motion::Rigid3d => "x y z qw qx qy qz: the base's pose; a unit quaternion, w first",
    };
    writeln!(out, "                 {base}, its frame in the world's")?;
    for joint in problem.robot.links.iter().filter_map(|link| link.joint.as_ref()) {
        let name = &joint.name;
        match joint.kind {
            JointKind::Fixed => {}
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
    let pairs = problem.robot.self_pairs().count();
    if problem.robot.links.len() > 1 {
        let links = problem.robot.links.len();
        writeln!(out, "                 {links} links, {pairs} pairs of which must not touch")?;
    }
    writeln!(out, "                 lengths in the unit of the file")?;
    let axes = problem.robot.motion.bounded_axes();
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
    let promise = match problem.edges {
        Edges::Swept => format!("motions are free at all times, to a {TOLERANCE}th of it"),
        Edges::Sampled => "no robot point moves farther between two checks".to_owned(),
    };
    writeln!(out, "resolution       {}: {promise}", problem.resolution)?;
    if problem.robot.motion.rotates() {
        writeln!(
            out,
            "rotation_length  {}: what a radian counts for in the metric",
            problem.rotation_length
        )?;
    }
    let robot: Vec<Body> = problem.robot.bodies().cloned().collect();
    for (what, bodies) in [("robot", &robot), ("obstacles", &problem.obstacles)] {
        let triangles: usize = bodies
            .iter()
            .map(|body| if let Shape::Mesh(mesh) = &body.shape { mesh.triangles.len() } else { 0 })
            .sum();
        let mut shapes: Vec<(&str, usize)> = Vec::new();
        for body in bodies {
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
    if let Some(query) = &problem.query {
        writeln!(out, "start            {:?}", query.start)?;
        writeln!(out, "goal             {:?}", query.goal)?;
    }
    for strategy in &problem.strategies {
        writeln!(
            out,
            "strategy         {}: {} nodes per set, {:?}, within {:?}, among {:?}",
            strategy.label, strategy.nodes, strategy.sampler, strategy.within, strategy.among
        )?;
    }
    let labels: Vec<_> = problem
        .schedule
        .iter()
        .map(|index| problem.strategies[*index as usize].label.as_str())
        .collect();
    writeln!(
        out,
        "schedule         {}, {}; {} sets per round",
        labels.join(" "),
        match problem.adaptive {
            None => "over and over".to_owned(),
            Some(Adaptive { rounds }) =>
                format!("by what they united for their cost in the last {rounds} rounds"),
        },
        problem.sets_per_round
    )?;
    for evaluator in &problem.evaluators {
        writeln!(out, "until            {evaluator:?}")?;
    }
    let sets = match problem.limits.sets {
        u64::MAX => "any number of".to_owned(),
        sets => sets.to_string(),
    };
    write!(out, "limits           {} nodes, {sets} sets", problem.limits.nodes)?;
    match problem.limits.seconds {
        Some(seconds) => writeln!(out, ", {seconds} s")?,
        None => writeln!(out, ", any time")?,
    }
    for note in &problem.notes {
        writeln!(out, "chosen           {note}")?;
    }
    writeln!(out, "problem digest   {}", problem.digest())
}
