//! Obstacles that are smaller or larger.

use super::scaling::Scaling;
use crate::model::relaxation::{CannotRelax, ScaleObstacles, between};
use crate::scene::Body;

/// The obstacles, of which those that are asked for are scaled, each about its own centroid, or all about one point.
///
/// # Errors
/// There is no obstacle of such a number, or a shape cannot be scaled along some axes only.
pub(super) fn scaled(
    obstacles: &[Body],
    asked: &ScaleObstacles,
    level: f64,
) -> Result<Vec<Body>, CannotRelax> {
    let count = obstacles.len();
    if count == 0 {
        return Err(CannotRelax::new("", "scale-obstacles found, but there are no obstacles"));
    }
    if asked.obstacles.as_ref().is_some_and(Vec::is_empty) {
        return Err(CannotRelax::new("obstacles", "[] found; at least one number expected"));
    }
    if let Some(number) = asked.obstacles.iter().flatten().find(|number| **number >= count) {
        let message = format!("{number} found; numbers from 0 to {} expected", count - 1);
        return Err(CannotRelax::new("obstacles", message));
    }
    let factor = between(asked.factor, 1.0, level);
    let is_asked =
        |number: &usize| asked.obstacles.as_ref().is_none_or(|asked| asked.contains(number));
    let scaled = |(number, body): (usize, &Body)| {
        if !is_asked(&number) {
            return Ok(body.clone());
        }
        let bodies = std::slice::from_ref(body);
        let scaling = Scaling::new(bodies, asked.centre, asked.axes.each(), factor);
        scaling
            .of(body)
            .map_err(|why| CannotRelax::new("axes", format!("of obstacle {number} {why}")))
    };
    obstacles.iter().enumerate().map(scaled).collect()
}
