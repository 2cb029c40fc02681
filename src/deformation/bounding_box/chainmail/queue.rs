//! First in, first out: the paper's algorithm.

use super::super::lattice::Lattice;
use super::{Counts, Empty, Interval, Limits, pass_on};
use std::collections::VecDeque;

/// See [`narrow`](super::narrow).
pub(super) fn narrow(
    lattice: &Lattice,
    limits: &Limits,
    demanded: &[usize],
    intervals: &mut [Interval],
    counts: &mut Counts,
) -> Result<(), Empty> {
    let mut queue: VecDeque<usize> = demanded.iter().copied().collect();
    let mut waits = vec![false; intervals.len()];
    demanded.iter().for_each(|point| waits[*point] = true);
    while let Some(point) = queue.pop_front() {
        waits[point] = false;
        pass_on(lattice, limits, point, intervals, counts, |neighbour| {
            if !std::mem::replace(&mut waits[neighbour], true) {
                queue.push_back(neighbour);
            }
        })?;
    }
    Ok(())
}
