//! From the file as written to a checked problem.

use super::bodies::{bodies, check_bodies};
use super::building::{adaptive_of, evaluators_of, limits_of, strategies_of};
use super::error::ProblemError;
use super::file::{File, QueryTable};
use super::linkage::{fits, fitting, robot_of};
use super::source::Source;
use super::source::Step::{Index, Key};
use super::{DEFAULT_SEED, Problem};
use crate::context::Ends;
use crate::robot::Robot;
use crate::scene::{Body, LENGTH_MAX};
use crate::space::Motion;
use crate::validity::Bounds;
use std::path::Path;

/// The finest resolution, as a fraction of the diagonal of the bounds.
const FINEST: f64 = 1e-7;
/// The farthest robot point, as a multiple of the same: with it a motion has at most 10¹⁵ steps.
const RADIUS_MAX: f64 = 1e6;

pub(super) fn resolve(path: &Path, text: &str) -> Result<Problem, ProblemError> {
    let source = Source::new(path, text)?;
    let file = source.file()?;
    let mut notes = Vec::new();

    let name = name_of(&source, &file)?;
    let bounds = bounds_of(&source, &file)?;
    let robot = robot_of(&source, &file.robot, file.space.motion, &mut notes)?;
    let obstacles = bodies(&source, &[Key("obstacles")], &file.obstacles, &mut notes)?;
    check_bodies(&source, &robot, &obstacles)?;
    let resolution = resolution_of(&source, &file, &bounds, &robot, &mut notes)?;
    let rotation_length = rotation_length_of(&source, &file, &robot, &mut notes)?;
    let (strategies, schedule, sets_per_round) = strategies_of(&source, &file)?;
    let adaptive = adaptive_of(&source, &file)?;
    let limits = limits_of(&source, &file)?;
    let evaluators = evaluators_of(&source, &file)?;
    let seed = file.seed.unwrap_or(DEFAULT_SEED);

    let problem = Problem {
        name,
        seed,
        bounds,
        resolution,
        edges: file.space.edges,
        rotation_length,
        robot,
        obstacles,
        query: None,
        strategies,
        schedule,
        adaptive,
        sets_per_round,
        evaluators,
        limits,
        notes,
        sources: Vec::new(),
        earlier: Vec::new(),
    };
    let problem = settled(&source, problem, file.query)?;
    Ok(Problem { sources: source.files.into_inner(), ..problem })
}

fn name_of(source: &Source, file: &File) -> Result<String, ProblemError> {
    let name = match &file.name {
        Some(name) => name.clone(),
        None => {
            source.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into())
        }
    };
    if !fits(&name) || name.starts_with('.') || name.len() > 100 {
        let expected = "letters, digits, `-`, `_` and `.` expected, at most 100, not led by `.`";
        return Err(source.error(&[Key("name")], format!("`{name}` found; {expected}")));
    }
    Ok(name)
}

/// A name for a problem, which becomes that of a folder, as near to the given one as may be.
pub(super) fn fitting_name(name: &str) -> String {
    let fitting = fitting(name);
    let mut end = fitting.len().min(100);
    while !fitting.is_char_boundary(end) {
        end -= 1;
    }
    let fitting = fitting[..end].trim_start_matches('.');
    if fitting.is_empty() { "scene".to_owned() } else { fitting.to_owned() }
}

fn bounds_of(source: &Source, file: &File) -> Result<Bounds, ProblemError> {
    let axes = file.space.motion.bounded_axes();
    let mut box_of = [[0.0; 3]; 2];
    for (corner, (key, values)) in
        box_of.iter_mut().zip([("min", &file.space.min), ("max", &file.space.max)])
    {
        let place = [Key("space"), Key(key)];
        if values.len() != axes {
            let message = format!("{} values found; {axes} expected", values.len());
            return Err(source.error(&place, message));
        }
        for (axis, value) in values.iter().enumerate() {
            if value.abs() > LENGTH_MAX || value.is_nan() {
                let message = format!("{value} found; a finite number expected");
                return Err(source.error(&place, message));
            }
            corner[axis] = *value;
        }
    }
    let [min, max] = box_of;
    for axis in 0..axes {
        if min[axis] >= max[axis] {
            let (name, low, high) = (["x", "y", "z"][axis], min[axis], max[axis]);
            let message = format!("in {name} max = {high} found; more than min = {low} expected");
            return Err(source.error(&[Key("space"), Key("max")], message));
        }
    }
    Ok(Bounds { min, max, meaning: file.space.bounds })
}

fn resolution_of(
    source: &Source,
    file: &File,
    bounds: &Bounds,
    robot: &Robot,
    notes: &mut Vec<String>,
) -> Result<f64, ProblemError> {
    let diagonal = diagonal_of(bounds, robot.motion);
    if let Some(message) = too_far(robot, diagonal) {
        return Err(source.error(&[Key("robot")], message));
    }
    if let Some(resolution) = file.space.resolution {
        if !(resolution.is_finite() && resolution >= FINEST * diagonal) {
            let expected = format!("a length of at least {:e} expected", FINEST * diagonal);
            let message = format!("{resolution} found; {expected}");
            return Err(source.error(&[Key("space"), Key("resolution")], message));
        }
        return Ok(resolution);
    }
    Ok(default_resolution(diagonal, robot, notes))
}

/// Complains of a robot whose motions would have too many steps.
pub(super) fn too_far(robot: &Robot, diagonal: f64) -> Option<String> {
    let radius = robot.reach();
    (radius > RADIUS_MAX * diagonal).then(|| {
        format!(
            "robot points {radius} away from its reference point found; at most {RADIUS_MAX:e} times \
             the diagonal of the bounds expected"
        )
    })
}

/// Fine enough for the scene as a whole and for the thinnest part of the robot.
pub(super) fn default_resolution(diagonal: f64, robot: &Robot, notes: &mut Vec<String>) -> f64 {
    let thinnest = robot.bodies().map(thickness).fold(f64::INFINITY, f64::min);
    let mut resolution = diagonal / 200.0;
    let mut reason = "a 200th of the diagonal of the bounds";
    if thinnest > 0.0 && thinnest / 2.0 < resolution {
        resolution = (thinnest / 2.0).max(FINEST * diagonal);
        reason = "half the robot's thinnest extent";
    }
    notes.push(format!("resolution = {resolution}, {reason}"));
    resolution
}

/// Length of the diagonal of the bounds.
pub(super) fn diagonal_of(bounds: &Bounds, motion: Motion) -> f64 {
    let square = |axis: usize| {
        let edge = bounds.max[axis] - bounds.min[axis];
        edge * edge
    };
    (0..motion.bounded_axes()).map(square).sum::<f64>().sqrt()
}

/// A radian of the base's rotation counts for the way of the farthest point.
pub(super) fn default_rotation_length(robot: &Robot, notes: &mut Vec<String>) -> f64 {
    let reach = robot.reach();
    if robot.motion.rotates() {
        let what = "the farthest robot point from the reference point";
        notes.push(format!("rotation_length = {reach}, {what}"));
    }
    reach
}

/// The least extent of a body along the axes of its own frame; 0 for a point.
fn thickness(body: &Body) -> f64 {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let along = axes.map(|axis| body.shape.extent(axis) + body.shape.extent(axis.map(|x| -x)));
    along.into_iter().fold(f64::INFINITY, f64::min)
}

fn rotation_length_of(
    source: &Source,
    file: &File,
    robot: &Robot,
    notes: &mut Vec<String>,
) -> Result<f64, ProblemError> {
    let place = [Key("space"), Key("rotation_length")];
    match file.space.rotation_length {
        Some(length) if length.is_finite() && length >= 0.0 => Ok(length),
        Some(length) => {
            Err(source.error(&place, format!("{length} found; a length of at least 0 expected")))
        }
        None => Ok(default_rotation_length(robot, notes)),
    }
}

/// Checks what needs the whole problem: configurations.
fn settled(
    source: &Source,
    mut problem: Problem,
    query: Option<QueryTable>,
) -> Result<Problem, ProblemError> {
    let cx = problem.context();
    if let Some(mut query) = query {
        for (key, q) in [("start", &mut query.start), ("goal", &mut query.goal)] {
            cx.settle(q).map_err(|message| source.error(&[Key("query"), Key(key)], message))?;
        }
        problem.query = Some(Ends { start: query.start, goal: query.goal });
    }
    for (index, strategy) in problem.strategies.iter().enumerate() {
        let place = [Key("strategies"), Index(index), Key("sampler")];
        strategy.sampler.method().suits(&cx).map_err(|message| source.error(&place, message))?;
    }
    for (index, evaluator) in problem.evaluators.iter_mut().enumerate() {
        let settled = evaluator.method_mut().settle(&cx);
        settled.map_err(|message| source.error(&[Key("evaluators"), Index(index)], message))?;
    }
    Ok(problem)
}
