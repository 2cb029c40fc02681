//! Search trees over configurations that come over time.

use super::best::{Best, Neighbor};
use crate::space::{Configs, Space};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Configurations after the last multiple of this number are looked at one by one.
const BLOCK: u32 = 64;

/// What a tree is asked for.
pub(super) struct TreeQuery<'a> {
    pub space: &'a Space,
    pub configs: &'a Configs,
    /// Where the neighbours are sought, in stored form.
    pub q: &'a [f64],
    /// How many times farther than the true i-th neighbour the i-th that is given may be, less 1. Only k-d trees know it.
    pub epsilon: f64,
    /// Which ids may be given.
    pub is_eligible: &'a dyn Fn(u32) -> bool,
}

impl TreeQuery<'_> {
    /// Measures a configuration, and keeps it if it is eligible and among the nearest so far.
    pub fn offer(&self, id: u32, best: &mut Best<Neighbor>) {
        if (self.is_eligible)(id) {
            let config = self.configs.get(id as usize);
            let distance = self.space.distance_unless_above(self.q, config, best.bound());
            if let Some(distance) = distance {
                best.offer(Neighbor { distance, id });
            }
        }
    }
}

/// A tree over consecutive ids, a pure function of their configurations.
pub(super) trait SearchTree: Sized + fmt::Debug {
    /// Builds the tree.
    fn new(space: &Space, configs: &Configs, ids: Range<u32>) -> Self;
    /// Offers what may be among the nearest.
    fn search(&self, query: &TreeQuery, best: &mut Best<Neighbor>);
}

#[derive(Debug)]
struct Segment<T> {
    ids: Range<u32>,
    tree: T,
}

/// Trees of one kind over the configurations of ids from 0 on, more of which may come.
///
/// As the segments of [`Index`](super::Index), trees follow the logarithmic method (J. L. Bentley, J. B. Saxe 1980). Unlike there,
/// which ids a tree has follows from the number of configurations alone, by its binary digits, and not from when there were
/// searches: what approximate searches return depends on the trees, and must not depend on who searched before.
#[derive(Debug)]
pub(crate) struct SearchTrees<T> {
    segments: Vec<Arc<Segment<T>>>,
}

impl<T> Default for SearchTrees<T> {
    fn default() -> SearchTrees<T> {
        SearchTrees { segments: Vec::new() }
    }
}

/// Trees never change, so copies share them.
impl<T> Clone for SearchTrees<T> {
    fn clone(&self) -> SearchTrees<T> {
        SearchTrees { segments: self.segments.clone() }
    }
}

/// Which ids each tree has where there are `count` configurations: the longest tree first, each of a length that is
/// [`BLOCK`] times a power of two.
fn segments_of(count: u32) -> impl Iterator<Item = Range<u32>> {
    let blocks = count / BLOCK;
    let mut begin = 0;
    (0..u32::BITS).rev().filter(move |bit| blocks >> bit & 1 == 1).map(move |bit| {
        let ids = begin..begin + (BLOCK << bit);
        begin = ids.end;
        ids
    })
}

impl<T> SearchTrees<T> {
    /// Whether the trees are those of `count` configurations.
    pub fn is_of(&self, count: u32) -> bool {
        segments_of(count).eq(self.segments.iter().map(|segment| segment.ids.clone()))
    }
}

#[allow(private_bounds, reason = "the kinds of trees are named outside, what they are is not")]
impl<T: SearchTree> SearchTrees<T> {
    /// Makes the trees those of the first `count` of `configs`; the ones that stay are not built again.
    pub fn extend(&mut self, space: &Space, configs: &Configs, count: u32) {
        let mut known = std::mem::take(&mut self.segments).into_iter().peekable();
        for ids in segments_of(count) {
            let same = known.next_if(|segment| segment.ids == ids);
            self.segments.push(same.unwrap_or_else(|| {
                let tree = T::new(space, configs, ids.clone());
                Arc::new(Segment { ids, tree })
            }));
        }
    }

    /// Searches the first `count` of the configurations: those without a tree first, then short trees before long ones, which
    /// begin with the bounds that the others gave.
    pub(super) fn k_nearest(&self, query: &TreeQuery, count: u32, k: usize) -> Vec<Neighbor> {
        if k == 0 {
            return Vec::new();
        }
        let mut best = Best::new(k);
        let begin = self.segments.last().map_or(0, |segment| segment.ids.end);
        (begin..count).for_each(|id| query.offer(id, &mut best));
        for segment in self.segments.iter().rev() {
            segment.tree.search(query, &mut best);
        }
        best.into_items()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_are_the_digits_of_the_number_of_blocks() {
        for count in [0, 1, 63, 64, 65, 200, 64 * 13 + 5, 1 << 20] {
            let mut end = 0;
            let mut last = u32::MAX;
            for ids in segments_of(count) {
                assert_eq!(ids.start, end);
                let length = ids.end - ids.start;
                assert!(length < last && (length / BLOCK).is_power_of_two());
                (end, last) = (ids.end, length);
            }
            assert!(count - end < BLOCK);
        }
    }
}
