//! ChainMail: movements of some points passed on to the others, so that neighbours keep within limits of one another (S. F. F.
//! Gibson, *3D ChainMail: a fast algorithm for deforming volumetric objects*, 1997).
//!
//! Gibson's limits are for each axis alone: neighbours along an axis keep their difference along it between a least and a greatest
//! length, and along each of the other two axes within a length of their own, the shear. So in displacements `u` from where
//! points rest, the limits of two neighbours `p` and `q` are, along each coordinate, `low ≤ u(q) − u(p) ≤ high` with
//! `low ≤ 0 ≤ high`: constraints of differences, which separate by coordinate.
//!
//! Every point has an interval for each coordinate. At first the intervals are what is demanded of points: one that is pushed is
//! displaced by so much *at least*, one that is held not at all, all others anyhow. Then intervals are narrowed from neighbour to
//! neighbour: `q`'s to within `[low + least(p), high + greatest(p)]`, and so on from `q`, until nothing changes or an interval
//! is empty. Last, every point takes the place in its intervals that is nearest to where it rests.
//!
//! - *It ends.* A bound of an interval is always a sum along a path from a point of which something is demanded. A sum does not fall
//!   along a path, since `high ≥ 0` and rounding is monotone, so that going round in a circle never narrows anything: there are only
//!   finitely many sums that can become bounds, and each bound only ever gets narrower.
//! - *It does not depend on the order.* In the end no bound is wider than the least sum over all paths, by induction along the path,
//!   and each is the sum of some path. So it *is* the least sum of all paths, in rounded arithmetic, too, whichever points are
//!   looked at first: intervals have the same bits for every order.
//! - *All limits are kept.* In the end `least(q) ≤ least(p) + high` and `greatest(q) ≤ greatest(p) + high`, and `0 ≤ 0 + high`. A
//!   point is put at the median of 0 and its two bounds, and the median is monotone, so that `u(q) ≤ u(p) + high`; the lower limit
//!   likewise. Both hold up to the rounding of one addition.
//! - *It is refused exactly where nothing fits.* If an interval is empty, the two paths that its bounds came along demand what
//!   contradicts itself. If none is, the medians are an answer.

mod most_reached;
mod queue;
#[cfg(test)]
mod tests;

use super::lattice::Lattice;
use crate::model::deformable::{BoundingBoxSettings, ChainMailOrder};

/// How far a neighbour may be displaced against a point, along each coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// By axis along which the points are neighbours, by coordinate: the least and the greatest difference of the displacements of
    /// the next point and of the one before it.
    pub of: [[[f64; 2]; 3]; 3],
}

impl Limits {
    /// The limits of a material. Settings are checked.
    pub fn new(settings: &BoundingBoxSettings, spacing: [f64; 3]) -> Limits {
        let of = [0, 1, 2].map(|axis| {
            let rest = spacing[axis];
            let along =
                [(settings.least[axis] - 1.0) * rest, (settings.greatest[axis] - 1.0) * rest];
            let across = [-settings.shear * rest, settings.shear * rest];
            [0, 1, 2].map(|coordinate| if coordinate == axis { along } else { across })
        });
        Limits { of }
    }
}

/// Where a point may be: its least and greatest displacement along each coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    /// The least displacements.
    pub least: [f64; 3],
    /// The greatest.
    pub greatest: [f64; 3],
}

impl Interval {
    /// Anywhere.
    pub const ALL: Interval =
        Interval { least: [f64::NEG_INFINITY; 3], greatest: [f64::INFINITY; 3] };

    /// Where it rests.
    pub const HELD: Interval = Interval { least: [0.0; 3], greatest: [0.0; 3] };

    /// Displaced by a vector, or farther along each coordinate.
    pub fn pushed(by: [f64; 3]) -> Interval {
        let bound = |from: f64, open: f64, is_open: bool| if is_open { open } else { from };
        Interval {
            least: by.map(|b| bound(b, f64::NEG_INFINITY, b <= 0.0)),
            greatest: by.map(|b| bound(b, f64::INFINITY, b >= 0.0)),
        }
    }

    fn is_empty(&self) -> bool {
        (0..3).any(|k| self.least[k] > self.greatest[k])
    }

    /// The displacement within the interval that is nearest to another.
    #[inline]
    pub fn nearest(&self, mut to: [f64; 3]) -> [f64; 3] {
        // A loop, since `map` of arrays is not always compiled in place, and relaxation asks this ten times for every point.
        for (k, to) in to.iter_mut().enumerate() {
            if *to < self.least[k] {
                *to = self.least[k];
            } else if *to > self.greatest[k] {
                *to = self.greatest[k];
            }
        }
        to
    }

    /// Where the neighbour of a point with this interval may be, the next one along `axis` or the one before.
    #[inline]
    fn of_neighbour(&self, limits: &Limits, axis: usize, next: bool) -> Interval {
        let [mut least, mut greatest] = [self.least, self.greatest];
        for k in 0..3 {
            let [low, high] = limits.of[axis][k];
            let (low, high) = if next { (low, high) } else { (-high, -low) };
            // Adding 0 makes of −0 a 0, so that equal bounds have equal bits.
            least[k] = least[k] + low + 0.0;
            greatest[k] = greatest[k] + high + 0.0;
        }
        Interval { least, greatest }
    }

    /// Narrows the interval to what it has in common with another. Whether that changed it.
    #[inline]
    fn narrow(&mut self, to: &Interval) -> bool {
        let mut changed = false;
        for k in 0..3 {
            changed |= to.least[k] > self.least[k];
            changed |= to.greatest[k] < self.greatest[k];
        }
        // Most looks at a neighbour change nothing.
        if changed {
            for k in 0..3 {
                if to.least[k] > self.least[k] {
                    self.least[k] = to.least[k];
                }
                if to.greatest[k] < self.greatest[k] {
                    self.greatest[k] = to.greatest[k];
                }
            }
        }
        changed
    }
}

/// Nothing keeps the limits: the interval of a point is empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Empty;

/// How much was done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Counts {
    /// Intervals of neighbours that were looked at, whether or not they were narrowed.
    pub narrowings: u64,
    /// Points that searches came to which only say in which order the others are looked at.
    pub searched: u64,
}

/// Narrows intervals, given what is demanded of points, until all limits can be kept. `demanded` are the points of which something
/// is demanded, in increasing order.
///
/// # Errors
/// An interval is empty; the others are as they were left.
pub(super) fn narrow(
    order: ChainMailOrder,
    lattice: &Lattice,
    limits: &Limits,
    demanded: &[usize],
    intervals: &mut [Interval],
    counts: &mut Counts,
) -> Result<(), Empty> {
    match order {
        ChainMailOrder::Queue => queue::narrow(lattice, limits, demanded, intervals, counts),
        ChainMailOrder::MostReached => {
            most_reached::narrow(lattice, limits, demanded, intervals, counts)
        }
    }
}

/// Narrows the intervals of a point's neighbours and calls `changed` with those that got narrower.
fn pass_on(
    lattice: &Lattice,
    limits: &Limits,
    point: usize,
    intervals: &mut [Interval],
    counts: &mut Counts,
    mut changed: impl FnMut(usize),
) -> Result<(), Empty> {
    let interval = intervals[point];
    for (axis, next, neighbour) in lattice.neighbours(point) {
        counts.narrowings += 1;
        let allowed = interval.of_neighbour(limits, axis, next);
        let own = &mut intervals[neighbour];
        if own.narrow(&allowed) {
            if own.is_empty() {
                return Err(Empty);
            }
            changed(neighbour);
        }
    }
    Ok(())
}
