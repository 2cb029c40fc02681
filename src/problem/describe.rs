use super::Problem;
use crate::scene::{Body, Shape};
use crate::validity::BoundsMeaning;
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
    let turns = match names.last() {
        Some(&"theta") => "; theta in radians, in [-pi, pi)",
        Some(&"qz") => "; qw qx qy qz a unit quaternion, w first",
        _ => "",
    };
    writeln!(out, "                 the pose of the robot's frame in the world's{turns}")?;
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
    writeln!(
        out,
        "resolution       {}: no robot point moves farther between two checks",
        problem.resolution
    )?;
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
        "schedule         {}, over and over; {} sets per round",
        labels.join(" "),
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
