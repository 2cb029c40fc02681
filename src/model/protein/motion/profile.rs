//! The energy along a motion, and what the motion costs by it.
//!
//! The energies are taken at equal steps from end to end. A step from energy E to E′ has the probability
//! exp(−(E′ − E)/kT) if E′ > E, else 1, and a motion costs the sum of −ln of its steps' probabilities (N. M. Amato,
//! G. Song, *Using motion planning to study protein folding pathways*, J. Comput. Biol. 9, 2002): the sum of its climbs,
//! in units of kT.

use super::straight;
use crate::math;

/// The energies along a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// The sum of the climbs on the way from the first configuration to the second, in units of kT.
    pub forward: f64,
    /// The same on the way back.
    pub backward: f64,
    /// The highest energy that was seen, in the unit of the energies.
    pub peak: f64,
}

/// More steps are not taken, whatever the resolution.
const STEPS_MAX: f64 = 1_048_576.0;

/// In how many steps a motion is looked at: so many that no step is longer than `resolution`, in radians of the Euclidean
/// length of all turns together. At least one. The same both ways.
pub fn steps(a: &[f64], b: &[f64], resolution: f64) -> usize {
    let turns = a.iter().zip(b).map(|(a, b)| math::wrap_angle(b - a));
    let length = turns.map(|turn| turn * turn).sum::<f64>().sqrt();
    (length / resolution).ceil().clamp(1.0, STEPS_MAX) as usize
}

/// The profile of the motion from `a` to `b` in [`steps`]; `kt` is kT in the unit of the energies, `energy` gives the
/// energy of a configuration, `between` is working memory. The other way round, the two sums are exchanged, to the bit.
/// `None` where an energy is no finite number.
pub fn profile(
    (a, b): (&[f64], &[f64]),
    resolution: f64,
    kt: f64,
    between: &mut Vec<f64>,
    mut energy: impl FnMut(&[f64]) -> f64,
) -> Option<Profile> {
    let is_backward = straight::is_backward(a, b);
    let (from, to) = if is_backward { (b, a) } else { (a, b) };
    let count = steps(from, to, resolution);
    let mut last = energy(from);
    if !last.is_finite() {
        return None;
    }
    let (mut up, mut down, mut peak) = (0.0, 0.0, last);
    for step in 1..=count {
        let next = if step == count {
            energy(to)
        } else {
            let time = step as f64 / count as f64;
            let torsion = |(from, to): (&f64, &f64)| {
                math::wrap_angle(from + time * math::wrap_angle(to - from))
            };
            between.clear();
            between.extend(from.iter().zip(to).map(torsion));
            energy(between)
        };
        up += (next - last).max(0.0) / kt;
        down += (last - next).max(0.0) / kt;
        peak = next.max(peak);
        // A sum that is no number stays none; `max` would hide it.
        if !next.is_finite() {
            return None;
        }
        last = next;
    }
    let (forward, backward) = if is_backward { (down, up) } else { (up, down) };
    (forward.is_finite() && backward.is_finite() && peak.is_finite()).then_some(Profile {
        forward,
        backward,
        peak,
    })
}
