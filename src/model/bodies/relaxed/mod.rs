//! Bodies whose constraints are relaxed. One file per kind of relaxation.
//!
//! What comes of it is another description of bodies, plain data as any: a scaled mesh is a mesh. The box that bounds the robot, the
//! resolution and the rotation length stay what they are, so that distances of configurations are the same at all levels.

mod extra_joint;
mod obstacles;
mod penetration;
mod robot;
mod scaling;
mod thin;

pub(super) use penetration::BodiesWithPenetration;
pub(in crate::model) use scaling::{Scaling, centroid};

use super::{Bodies, sound};
use crate::model::relaxation::{CannotRelax, Relaxation, RelaxedModel};
use crate::model::{Description, ModelKind};

/// What bodies can be relaxed by.
const KNOWN: &str =
    "scale-robot, thin-robot, scale-obstacles, penetration or, of a linkage, extra-joint expected";

/// The bodies at a level, below 1, of a relaxation.
///
/// # Errors
/// By which setting they cannot be relaxed.
pub(super) fn relaxed(
    bodies: &Bodies,
    relaxation: &Relaxation,
    level: f64,
) -> Result<RelaxedModel, CannotRelax> {
    let mut made = bodies.clone();
    let mut extra_value = None;
    match relaxation {
        Relaxation::ScaleRobot(asked) => made.robot = robot::scaled(&bodies.robot, asked, level)?,
        Relaxation::ScaleObstacles(asked) => {
            made.obstacles = obstacles::scaled(&bodies.obstacles, asked, level)?;
        }
        Relaxation::ThinRobot(asked) => made.robot = thin::thinned(&bodies.robot, asked, level)?,
        Relaxation::Penetration(asked) => {
            made.edges = penetration::allowed(asked, level, &bodies.space())?;
        }
        Relaxation::ExtraJoint(asked) => {
            let (robot, at) = extra_joint::with_joint(&bodies.robot, asked, level)?;
            (made.robot, extra_value) = (robot, Some(at));
        }
        Relaxation::Energy(_) => {
            return Err(CannotRelax::unknown(relaxation, "a model of bodies", KNOWN));
        }
    }
    // Scaling may lead beyond what a description may hold.
    sound::sound(&made).map_err(|why| CannotRelax::new("", format!("at level {level} {why}")))?;
    Ok(RelaxedModel { model: ModelKind::Bodies(made), extra_value })
}

#[cfg(test)]
mod tests;
