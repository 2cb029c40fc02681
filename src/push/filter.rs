//! Which of the configurations that pushes have found are worth keeping (O. B. Bayazit 2003, chapter IV E 3).

use super::{Pushed, Search};
use crate::model::Validity;
use crate::space::{FactorKind, Space};

/// Those that are [held](is_held): pushes that look in one direction also leave the passage.
pub(super) fn held(found: Vec<Pushed>, search: &mut Search) -> Vec<Pushed> {
    found.into_iter().filter(|pushed| is_held(&pushed.q, search)).collect()
}

/// Whether a valid configuration lies in a passage: along one of the axes of the space (translations along the world's axes, turns about those of the
/// robot, joints) collisions result within the reach when it is moved either way. Being out of bounds is no collision.
pub fn is_held(q: &[f64], search: &mut Search) -> bool {
    let axes = search.cx.space().cube_dimensions();
    let weights = weights(search.cx.space());
    (0..axes).any(|axis| {
        weights[axis] > 0.0
            && [-1.0, 1.0].into_iter().all(|sign| collides_along(q, axis, sign, &weights, search))
    })
}

/// Whether a collision results within the reach when a configuration is moved along an axis.
fn collides_along(q: &[f64], axis: usize, sign: f64, weights: &[f64], search: &mut Search) -> bool {
    let (mut by, mut moved) = (vec![0.0; weights.len()], q.to_vec());
    for step in 1..=search.steps() {
        by[axis] = sign * f64::from(step) * search.step / weights[axis];
        search.cx.space.moved(q, &by, &mut moved);
        match search.cx.model.validity(&moved, search.scratch) {
            Validity::Valid => {}
            Validity::Invalid => return true,
            Validity::OutOfBounds => return false,
        }
    }
    false
}

/// The weights in the metric of the numbers by which [`Space::moved`] moves a configuration.
pub(super) fn weights(space: &Space) -> Vec<f64> {
    let of = |factor: &crate::space::Factor| {
        let numbers = if factor.kind == FactorKind::Rotation { 3 } else { 1 };
        std::iter::repeat_n(factor.weight, numbers)
    };
    space.factors().iter().flat_map(of).collect()
}

/// Of configurations closer to one another than `closest`, in the space's metric, the first.
pub fn thinned(space: &Space, found: Vec<Pushed>, closest: f64) -> Vec<Pushed> {
    let mut kept: Vec<Pushed> = Vec::new();
    for pushed in found {
        let is_apart = |other: &Pushed| space.distance(&pushed.q, &other.q) >= closest;
        if kept.iter().all(is_apart) {
            kept.push(pushed);
        }
    }
    kept
}
