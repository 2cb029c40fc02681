//! Elastic relaxation: points move to where their neighbours would have them (Gibson 1997).

use super::chainmail::Interval;
use super::lattice::Lattice;

/// Some sweeps. In each, every point is put where its interval is nearest to the mean of its neighbours' displacements, as they
/// were after the sweep before; a neighbour that is missing at the surface counts as displaced like the point itself.
///
/// All limits are still kept. The means of two points that are neighbours differ by a mean of differences of neighbours of the same
/// kind, or of none, so that the means keep the limits, and with them the nearest places in intervals do, by the same argument as in
/// [`chainmail`](super::chainmail).
pub(super) fn relax(
    lattice: &Lattice,
    intervals: &[Interval],
    sweeps: u32,
    displacements: &mut Vec<[f64; 3]>,
) {
    let strides = lattice.strides();
    let mut next = vec![[0.0; 3]; displacements.len()];
    for _ in 0..sweeps {
        for (index, new) in next.iter_mut().enumerate() {
            let place = lattice.place(index);
            let mut sum = [0.0; 3];
            for axis in 0..3 {
                let before = if place[axis] > 0 { index - strides[axis] } else { index };
                let is_last = place[axis] + 1 == lattice.counts[axis];
                let after = if is_last { index } else { index + strides[axis] };
                for neighbour in [before, after] {
                    for k in 0..3 {
                        sum[k] += displacements[neighbour][k];
                    }
                }
            }
            let [x, y, z] = sum;
            *new = intervals[index].nearest([x / 6.0, y / 6.0, z / 6.0]);
        }
        std::mem::swap(displacements, &mut next);
    }
}
