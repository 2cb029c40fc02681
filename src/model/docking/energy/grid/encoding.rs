//! What a grid keeps of energies, and how it is turned back.

use super::Lookup;
use crate::structure::Point;

/// The largest energy that is kept as such, in kJ/mol: values beyond would make a cell's other corners count for nothing.
const ENERGY_MAX: f64 = 1e5;
/// What is added to the repulsion before its reciprocal is taken, in kJ/mol, so that the reciprocal ends where the
/// repulsion does.
const REPULSION_SHIFT: f64 = 0.03;
/// The same for the attraction.
const ATTRACTION_SHIFT: f64 = 0.3;
/// The least reciprocal: repulsions of 10⁸ and attractions of 10⁴ kJ/mol. Splines may swing below it.
const RECIPROCAL_MIN: f64 = 1e-4;

/// Writes what is kept of a repulsion and an attraction (kJ/mol, none below 0): the energy, or 1/√ of the repulsion and
/// 1/ of the attraction.
///
/// Where one atom of the protein decides, 1/√R grows as r⁶ and 1/A as r⁶, which bends upwards; between several atoms both
/// have ridges, which bend downwards. On descended poses of three complexes the two errors nearly cancel with these powers:
/// R^(−1/12) and A^(−1/6), which are straight lines beside a single atom, err more, and to one side.
pub(super) fn write(lookup: Lookup, repulsion: f64, attraction: f64, out: &mut [f32]) {
    if lookup.is_plain() {
        out[0] = (repulsion - attraction).min(ENERGY_MAX) as f32;
    } else {
        out[0] = (1.0 / (repulsion + REPULSION_SHIFT).sqrt()) as f32;
        out[1] = (1.0 / (attraction + ATTRACTION_SHIFT)) as f32;
    }
}

/// The energy in kJ/mol of the two reciprocals, and its gradient by theirs.
#[inline(always)]
pub(super) fn energy([u, w]: [f64; 2], [of_u, of_w]: [Point; 2]) -> (f64, Point) {
    let (u, w) = (u.max(RECIPROCAL_MIN), w.max(RECIPROCAL_MIN));
    let square = u * u;
    // One quotient in place of two.
    let both = 1.0 / (square * w);
    let (repulsion, attraction) = (w * both, square * both);
    let energy = (repulsion - REPULSION_SHIFT) - (attraction - ATTRACTION_SHIFT);
    (energy, of_w * (attraction * attraction) - of_u * (2.0 * repulsion / u))
}
