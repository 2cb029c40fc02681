//! The robot with smaller shapes.

use super::scaling::Scaling;
use crate::model::bodies::robot::Robot;
use crate::model::relaxation::{CannotRelax, ScaleAxes, ScaleRobot, between};

/// The robot whose links have their shapes scaled, each link about its own centre; joints stay where they are. A padding is scaled as
/// the shapes are, where these are scaled along all axes.
///
/// # Errors
/// A shape cannot be scaled along some axes only.
pub(super) fn scaled(robot: &Robot, asked: &ScaleRobot, level: f64) -> Result<Robot, CannotRelax> {
    let factor = between(asked.least, 1.0, level);
    let mut robot = robot.clone();
    for link in &mut robot.links {
        let scaling = Scaling::new(&link.bodies, asked.centre, asked.axes.each(), factor);
        for body in &mut link.bodies {
            *body = scaling.of(body).map_err(|why| {
                CannotRelax::new("axes", format!("of the link `{}` {why}", link.name))
            })?;
        }
    }
    if asked.axes.each() == ScaleAxes::All.each() {
        robot.padding.iter_mut().for_each(|length| *length *= factor);
    }
    Ok(robot)
}
