//! The energy along a motion of the ligand, and what the motion costs by it.
//!
//! The energies are taken at equal times, so many that no atom moves farther than the step between two of them. A step from the energy E
//! to E′ costs (E′ − E)/kT if that is positive, else nothing: −ln of its probability (N. M. Amato, G. Song, *Using motion planning to
//! study protein folding pathways*, J. Comput. Biol. 9, 2002). Bayazit (2003, chapter V E) looks at the energy along an
//! edge, too, but does not say at which steps.

use crate::model::Directed;
use crate::model::cost::KT;
use crate::space::Space;

/// More steps are not taken, whatever the resolution.
const STEPS_MAX: f64 = 1_048_576.0;

/// What the motion from `a` to `b` costs, looked at in so many steps; `None` where an energy on it is higher than `highest`, or no finite
/// number. The motion the other way has the two costs exchanged, to the bit. `q` is working memory.
pub(super) fn cost(
    space: &Space,
    (a, b): (&[f64], &[f64]),
    steps: usize,
    highest: f64,
    q: &mut Vec<f64>,
    mut energy: impl FnMut(&[f64]) -> f64,
) -> Option<Directed> {
    // From the end that is less in lexicographic order, so that both directions are looked at alike.
    let is_backward = b < a;
    let (from, to) = if is_backward { (b, a) } else { (a, b) };
    let allowed = |energy: f64| energy.is_finite() && energy <= highest;
    let (first, last) = (energy(from), energy(to));
    if !(allowed(first) && allowed(last)) {
        return None;
    }
    let way = space.way(from, to);
    q.resize(space.len(), 0.0);
    let (mut up, mut down, mut peak, mut before) = (0.0, 0.0, first, first);
    for step in 1..=steps {
        let next = if step == steps {
            last
        } else {
            way.at(step as f64 / steps as f64, q);
            energy(q)
        };
        if !allowed(next) {
            return None;
        }
        up += (next - before).max(0.0) / KT;
        down += (before - next).max(0.0) / KT;
        peak = next.max(peak);
        before = next;
    }
    let (forward, backward) = if is_backward { (down, up) } else { (up, down) };
    Some(Directed { forward, backward, peak })
}

/// In how many steps a motion is looked at on which no atom moves farther than `way`, so that none moves farther than `step` in one.
pub(super) fn steps(way: f64, step: f64) -> usize {
    (way / step).ceil().clamp(1.0, STEPS_MAX) as usize
}
