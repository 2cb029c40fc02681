//! What motions of a deformable robot cost: how hard they are expected to be deformed.

use crate::model::{Cost, Directed};
use crate::space::Space;

/// What a motion as long as the largest distance in the space costs for its length alone: so little that it decides between motions
/// of equal weight only.
const LENGTH_SHARE: f64 = 1e-6;

/// The cost of the motion from `a` to `b`, whose ends have these weights: their sum (§4.1 and §4.2 of the paper), and a share of the
/// length. It is the same in either direction. `peak` is the largest weight on the way.
pub(super) fn cost(space: &Space, a: &[f64], b: &[f64], ends: [f64; 2], peak: f64) -> Cost {
    let diameter = space.diameter();
    let share = if diameter > 0.0 { space.distance(a, b) / diameter } else { 0.0 };
    let weight = ends[0] + ends[1] + LENGTH_SHARE * share;
    Cost::Directed(Directed { forward: weight, backward: weight, peak })
}

/// The two ends of a motion, first the one that is less in lexicographic order, so that both directions are looked at alike.
pub(super) fn in_order<'q>(a: &'q [f64], b: &'q [f64]) -> (&'q [f64], &'q [f64]) {
    if b < a { (b, a) } else { (a, b) }
}
