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
/// number. The motion the other way has the two costs exchanged, to the bit. `between` is working memory.
pub(super) fn cost(
    space: &Space,
    (a, b): (&[f64], &[f64]),
    steps: usize,
    highest: f64,
    between: &mut Between,
    mut energy: impl FnMut(&[f64]) -> f64,
) -> Option<Directed> {
    // From the end that is less in lexicographic order, so that both directions are looked at alike.
    let is_backward = b < a;
    let (from, to) = if is_backward { (b, a) } else { (a, b) };
    let Between { q, energies } = between;
    q.clear();
    q.resize(space.len(), 0.0);
    energies.clear();
    energies.resize(steps + 1, 0.0);
    let way = space.way(from, to);
    let allowed = |energy: f64| energy.is_finite() && energy <= highest;
    (energies[0], energies[steps]) = (energy(from), energy(to));
    if !(allowed(energies[0]) && allowed(energies[steps])) {
        return None;
    }
    // The middle first, then the middles of both halves, and so on: most motions that are not valid are found out soon.
    let mut stride = steps.next_power_of_two() / 2;
    while stride > 0 {
        for step in (stride..steps).step_by(2 * stride) {
            way.at(step as f64 / steps as f64, q);
            energies[step] = energy(q);
            if !allowed(energies[step]) {
                return None;
            }
        }
        stride /= 2;
    }
    let (mut up, mut down, mut peak) = (0.0, 0.0, energies[0]);
    for pair in energies.windows(2) {
        up += (pair[1] - pair[0]).max(0.0) / KT;
        down += (pair[0] - pair[1]).max(0.0) / KT;
        peak = pair[1].max(peak);
    }
    let (forward, backward) = if is_backward { (down, up) } else { (up, down) };
    Some(Directed { forward, backward, peak })
}

/// Working memory of [`cost`].
#[derive(Debug, Default)]
pub(super) struct Between {
    /// A configuration.
    pub q: Vec<f64>,
    /// The energies after each step.
    pub energies: Vec<f64>,
}

/// In how many steps a motion is looked at on which no atom moves farther than `way`, so that none moves farther than `step` in one.
pub(super) fn steps(way: f64, step: f64) -> usize {
    (way / step).ceil().clamp(1.0, STEPS_MAX) as usize
}
