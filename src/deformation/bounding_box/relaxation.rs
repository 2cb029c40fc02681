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
    let [width, rows, layers] = lattice.counts;
    let mut next = vec![[0.0; 3]; displacements.len()];
    for _ in 0..sweeps {
        for row in 0..rows * layers {
            // The rows beside this one along y and z; this one itself where none is.
            let (y, z) = (row % rows, row / rows);
            let at = |row: usize| &displacements[row * width..][..width];
            let beside = [
                at(if y > 0 { row - 1 } else { row }),
                at(if y + 1 < rows { row + 1 } else { row }),
                at(if z > 0 { row - rows } else { row }),
                at(if z + 1 < layers { row + rows } else { row }),
            ];
            let own = at(row);
            for x in 0..width {
                let mut sum = [0.0; 3];
                for k in 0..3 {
                    let (before, after) = (x.saturating_sub(1), (x + 1).min(width - 1));
                    sum[k] += own[before][k] + own[after][k];
                    for row in beside {
                        sum[k] += row[x][k];
                    }
                }
                sum.iter_mut().for_each(|sum| *sum /= 6.0);
                let index = row * width + x;
                next[index] = intervals[index].nearest(sum);
            }
        }
        std::mem::swap(displacements, &mut next);
    }
}
