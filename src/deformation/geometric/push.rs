//! In which direction a region is pushed, and how far.

use super::directions::{across, unit};
use super::trial::Trial;
use parry3d_f64::math::Vector;

/// By how much longer a push away from the robot's middle counts than one toward it, as a share of its length. Without it the
/// choice between two directions that are as good would be left to rounding.
const PREFERENCE: f64 = 0.1;
/// How often the longest push is halved for the first length that is tried.
const RUNGS: i32 = 6;
/// How often a length is bisected.
const BISECTIONS: u32 = 8;
/// By which share of its length a push must be shorter to be taken instead of one before.
const SHORTER: f64 = 0.02;
/// By which angles, as tangents, a direction is turned to see whether the push gets shorter.
const TURNS: [f64; 4] = [0.3, 0.15, 0.075, 0.0375];

/// The shortest push, no longer than `longest`, that frees the region; vertices of the region take part in it by their weights.
/// `None` where no direction frees it.
///
/// Lengths are compared after those of pushes that do not lead to `middle`, the robot's middle, were raised by up to a tenth. Once
/// the shortest is found, its direction is turned by ever smaller angles as long as that makes it shorter. So
/// the direction follows the pose continuously, until another one of those given becomes better.
pub(super) fn push(
    trial: &mut Trial,
    directions: &[Vector],
    longest: f64,
    middle: Vector,
) -> Option<Vector> {
    if !trial.region.has_rest {
        return None;
    }
    let corners = trial.surface.corners_of(&trial.region.colliding);
    let sum = corners.iter().fold(Vector::ZERO, |sum, corner| sum + trial.shape[*corner as usize]);
    let inward = unit(middle - sum / corners.len() as f64);
    let factor = |direction: Vector| {
        let turned_away = inward.map_or(0.0, |inward| (1.0 - direction.dot(inward)) / 2.0);
        1.0 + PREFERENCE * turned_away
    };
    let mut best: Option<(Vector, f64)> = None;
    for direction in directions {
        best = shorter(trial, *direction, best, longest, &factor).or(best);
    }
    let (mut direction, mut length) = best?;
    for turn in TURNS {
        let [u, v] = across(direction);
        for aside in [u, -u, v, -v] {
            let Some(turned) = unit(direction + turn * aside) else { continue };
            let found = shorter(trial, turned, Some((direction, length)), longest, &factor);
            (direction, length) = found.unwrap_or((direction, length));
        }
    }
    Some(direction * length)
}

/// The shortest push in a direction, if that is better than the best so far.
fn shorter(
    trial: &mut Trial,
    direction: Vector,
    best: Option<(Vector, f64)>,
    longest: f64,
    factor: &impl Fn(Vector) -> f64,
) -> Option<(Vector, f64)> {
    let mut is_free = |length: f64| {
        let region = trial.region;
        let shape = trial.shape;
        let place =
            |(vertex, weight): &(u32, f64)| shape[*vertex as usize] + direction * (length * weight);
        trial.is_free(region.vertices.iter().map(place))
    };
    let (mut colliding, mut free) = match best {
        Some((other, length)) => {
            let most = length * factor(other) / factor(direction) * (1.0 - SHORTER);
            (0.0, (most <= longest && is_free(most)).then_some(most)?)
        }
        None => {
            let mut rungs = (0..=RUNGS).rev().map(|rung| longest / f64::from(1u32 << rung));
            let free = rungs.find(|length| is_free(*length))?;
            (if free > longest / f64::from(1u32 << RUNGS) { free / 2.0 } else { 0.0 }, free)
        }
    };
    for _ in 0..BISECTIONS {
        let middle = (colliding + free) / 2.0;
        *(if is_free(middle) { &mut free } else { &mut colliding }) = middle;
    }
    Some((direction, free))
}
