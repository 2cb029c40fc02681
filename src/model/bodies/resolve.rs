//! From what a problem asks for to a checked description.

use super::Bodies;
use super::linkage::robot_of;
use super::robot::Robot;
use super::shapes::{bodies, check_bodies};
use super::sound::depth_complaint;
use super::spec::{BodiesSpec, SpaceSpec};
use super::validity::{Bounds, BoundsMeaning};
use crate::scene::{Body, LENGTH_MAX};
use crate::source::Step::Key;
use crate::source::{ProblemError, Source};
use crate::space::BaseJoint;

/// The finest resolution, as a fraction of the diagonal of the bounds.
pub(in crate::model) const FINEST: f64 = 1e-7;
/// The farthest robot point, as a multiple of the same: with it a motion has at most 10¹⁵ steps.
const RADIUS_MAX: f64 = 1e6;

/// Checks a robot and obstacles and makes what they ask for.
pub(super) fn resolve(
    spec: &BodiesSpec,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Bodies, ProblemError> {
    let robot = robot_of(source, &spec.robot, spec.space.motion, notes)?;
    let bounds = bounds_of(source, &spec.space, &robot, notes)?;
    let obstacles = bodies(source, &[Key("obstacles")], &spec.obstacles, notes)?;
    check_bodies(source, &robot, &obstacles)?;
    let resolution = resolution_of(source, &spec.space, &bounds, &robot, notes)?;
    let rotation_length = rotation_length_of(source, &spec.space, &robot, notes)?;
    let edges = spec.space.edges;
    if let Some(message) = depth_complaint(edges) {
        return Err(source.error(&[Key("space"), Key("edges")], message));
    }
    Ok(Bodies { bounds, resolution, edges, rotation_length, robot, obstacles })
}

fn bounds_of(
    source: &Source,
    space: &SpaceSpec,
    robot: &Robot,
    notes: &mut Vec<String>,
) -> Result<Bounds, ProblemError> {
    let axes = robot.motion.bounded_axes();
    let SpaceSpec { min, max, bounds, .. } = space;
    if robot.motion == BaseJoint::Fixed && min.is_none() && max.is_none() && bounds.is_none() {
        let (bounds, note) =
            bounds_of_reach(robot).map_err(|message| source.error(&[Key("robot")], message))?;
        if bounds.min[0] >= bounds.max[0] {
            let message = "a robot without extent found; min, max and bounds expected".to_owned();
            return Err(source.error(&[Key("space")], message));
        }
        notes.push(note);
        return Ok(bounds);
    }
    let lacks = |key: &str, expected: &str| {
        let message = match robot.motion {
            BaseJoint::Fixed => {
                format!("no {key} found; {expected} expected, or none of min, max and bounds")
            }
            _ => format!("no {key} found; {expected} expected, as the base moves"),
        };
        Err(source.error(&[Key("space")], message))
    };
    let (Some(min), Some(max)) = (min, max) else {
        let key = if min.is_none() { "min" } else { "max" };
        return lacks(key, &format!("{axes} lengths"));
    };
    let Some(meaning) = *bounds else {
        return lacks("bounds", "\"body\" or \"reference\"");
    };
    let mut box_of = [[0.0; 3]; 2];
    for (corner, (key, values)) in box_of.iter_mut().zip([("min", min), ("max", max)]) {
        let place = [Key("space"), Key(key)];
        if values.len() != axes {
            let message = format!("{} values found; {axes} expected", values.len());
            return Err(source.error(&place, message));
        }
        for (axis, value) in values.iter().enumerate() {
            if value.abs() > LENGTH_MAX || value.is_nan() {
                let message = format!("{value} found; a length within ±{LENGTH_MAX:e} expected");
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
    Ok(Bounds { min, max, meaning })
}

/// The box about the base's origin that is as large as a robot can reach, and a note about it.
///
/// # Errors
/// What is wrong with the reach.
pub(super) fn bounds_of_reach(robot: &Robot) -> Result<(Bounds, String), String> {
    let reach = robot.reach();
    if reach.is_nan() || reach > LENGTH_MAX {
        return Err(format!("a reach of {reach:e} found; at most {LENGTH_MAX:e} expected"));
    }
    let at = match robot.motion {
        BaseJoint::Fixed => robot.base.translation,
        _ => [0.0; 3],
    };
    let (min, max) = (at.map(|x| x - reach), at.map(|x| x + reach));
    let note = format!("the bounds reach as far as the robot, {reach}");
    Ok((Bounds { min, max, meaning: BoundsMeaning::Reference }, note))
}

fn resolution_of(
    source: &Source,
    space: &SpaceSpec,
    bounds: &Bounds,
    robot: &Robot,
    notes: &mut Vec<String>,
) -> Result<f64, ProblemError> {
    let diagonal = diagonal_of(bounds, robot.motion);
    if let Some(message) = too_far(robot, diagonal) {
        return Err(source.error(&[Key("robot")], message));
    }
    if let Some(resolution) = space.resolution {
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
pub(in crate::model) fn diagonal_of(bounds: &Bounds, motion: BaseJoint) -> f64 {
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
    space: &SpaceSpec,
    robot: &Robot,
    notes: &mut Vec<String>,
) -> Result<f64, ProblemError> {
    let place = [Key("space"), Key("rotation_length")];
    match space.rotation_length {
        Some(length) if length.is_finite() && length >= 0.0 => Ok(length),
        Some(length) => {
            Err(source.error(&place, format!("{length} found; a length of at least 0 expected")))
        }
        None => Ok(default_rotation_length(robot, notes)),
    }
}
