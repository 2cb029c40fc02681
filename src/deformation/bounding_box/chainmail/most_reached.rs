//! The points first that most searches came to: the revised algorithm of Bayazit's dissertation (2003), chapter VI D, which says:
//! "Breadth-first-search (BFS) is used to propagate vertex movements. To reject infeasible deformations quickly, vertices are
//! processed in reverse order of the number of BFS trees in which they participate (since vertices contained in the largest number of
//! BFS trees have higher failure rates)."
//!
//! What the dissertation leaves open is decided as follows. The tree of a point of which something is demanded has the points
//! that it alone would move. A point's interval is passed on as soon as no point that waits is in more trees; among equals the
//! one with the lowest index comes first.

use super::super::lattice::Lattice;
use super::{Counts, Empty, Interval, Limits, pass_on};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

/// See [`narrow`](super::narrow).
pub(super) fn narrow(
    lattice: &Lattice,
    limits: &Limits,
    demanded: &[usize],
    intervals: &mut [Interval],
    counts: &mut Counts,
) -> Result<(), Empty> {
    let trees = trees(lattice, limits, demanded, intervals, counts);
    let mut heap: BinaryHeap<(u32, Reverse<usize>)> =
        demanded.iter().map(|point| (trees[*point], Reverse(*point))).collect();
    let mut waits = vec![false; intervals.len()];
    demanded.iter().for_each(|point| waits[*point] = true);
    while let Some((_, Reverse(point))) = heap.pop() {
        waits[point] = false;
        pass_on(lattice, limits, point, intervals, counts, |neighbour| {
            if !std::mem::replace(&mut waits[neighbour], true) {
                heap.push((trees[neighbour], Reverse(neighbour)));
            }
        })?;
    }
    Ok(())
}

/// In how many trees each point is.
fn trees(
    lattice: &Lattice,
    limits: &Limits,
    demanded: &[usize],
    intervals: &[Interval],
    counts: &mut Counts,
) -> Vec<u32> {
    let mut trees = vec![0; intervals.len()];
    // By which search a point was reached last, counted from 1.
    let mut reached = vec![0; intervals.len()];
    let mut queue: VecDeque<(usize, Interval)> = VecDeque::new();
    for (search, root) in (1u32..).zip(demanded) {
        reached[*root] = search;
        trees[*root] += 1;
        queue.push_back((*root, intervals[*root]));
        while let Some((point, interval)) = queue.pop_front() {
            for (axis, next, neighbour) in lattice.neighbours(point) {
                if reached[neighbour] == search {
                    continue;
                }
                reached[neighbour] = search;
                counts.searched += 1;
                let allowed = interval.of_neighbour(limits, axis, next);
                if allowed.nearest([0.0; 3]) != [0.0; 3] {
                    trees[neighbour] += 1;
                    queue.push_back((neighbour, allowed));
                }
            }
        }
    }
    trees
}
