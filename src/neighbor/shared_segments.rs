//! The segments that all indices with the same shelf share, by the logarithmic method of Bentley and Saxe.
//!
//! Which configurations such a segment holds depends on nothing but the number of configurations. Written in
//! binary, the number of whole runs of [`SHORTEST`] configurations has a one for every segment, and a carry
//! into a digit merges shorter segments into one of that digit's length.

use super::build::Source;
use super::tree::Tree;
use crate::shelf::{self, BlockName, Claim, Shelf};
use std::ops::Range;
use std::sync::Arc;

/// Number of configurations in the shortest shared segment.
const SHORTEST: u32 = if cfg!(test) { 1 << 5 } else { 1 << 10 };

/// Which configurations a shared segment holds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SharedSegment {
    /// The digit that it stands for: it holds `SHORTEST << level` configurations.
    level: u32,
    /// How many segments of this length would fit before it.
    number: u32,
}

impl SharedSegment {
    /// The segments over the first `configs` configurations, longest first. They leave out the last ones, fewer
    /// than [`SHORTEST`].
    fn all(configs: u32) -> impl Iterator<Item = SharedSegment> {
        let count = configs / SHORTEST;
        let levels = (0..u32::BITS).rev().filter(move |level| count >> level & 1 == 1);
        levels.map(move |level| SharedSegment { level, number: (count >> level) - 1 })
    }

    /// Number of configurations.
    fn len(self) -> u32 {
        SHORTEST << self.level
    }

    /// The ids of its configurations.
    fn range(self) -> Range<u32> {
        self.number * self.len()..(self.number + 1) * self.len()
    }

    /// The name of its block on the shelf.
    fn name(self) -> BlockName {
        BlockName::Segment { level: self.level, number: self.number }
    }

    /// The shorter shared segments over the same configurations, which it supersedes.
    fn superseded(self) -> impl Iterator<Item = SharedSegment> {
        (0..self.level).flat_map(move |level| {
            let first = self.number << (self.level - level);
            let count = 1 << (self.level - level);
            (first..first + count).map(move |number| SharedSegment { level, number })
        })
    }
}

/// The trees of the shared segments over the source's configurations, each taken from `old`, found on the shelf, or
/// built. Where a segment is not there and another process holds the claim to build, the shorter segments of
/// `old` stand in for it and for all that follow, so the trees may end early.
pub(super) fn update(old: &[Arc<Tree>], shelf: &dyn Shelf, source: &Source) -> Vec<Arc<Tree>> {
    let mut trees: Vec<Arc<Tree>> = Vec::new();
    let mut claim = None;
    for segment in SharedSegment::all(source.configs) {
        let ids = segment.range();
        let first = ids.start;
        let known = old.iter().find(|tree| (tree.first()..tree.end()) == ids).cloned();
        match known.or_else(|| find_or_build(segment, shelf, source, &mut claim).map(Arc::new)) {
            Some(tree) => trees.push(tree),
            None => {
                trees.extend(old.iter().filter(|tree| tree.first() >= first).cloned());
                break;
            }
        }
    }
    trees
}

/// The tree of a shared segment, found on the shelf or built. `None` where it is not there and another process
/// holds the claim to build.
fn find_or_build(
    segment: SharedSegment,
    shelf: &dyn Shelf,
    source: &Source,
    claim: &mut Option<Claim>,
) -> Option<Tree> {
    let range = segment.range();
    let find =
        || Tree::found(source.embedding, range.clone(), |bytes| shelf.find(segment.name(), bytes));
    let tree = find().or_else(|| {
        if claim.is_none() {
            *claim = Some(shelf.claim()?);
        }
        // The last holder of the claim may have built the segment since we first looked.
        Some(find().unwrap_or_else(|| {
            let put = |bytes, fill: &mut dyn FnMut(&mut [u8])| {
                let kept = shelf.put(segment.name(), bytes, fill);
                kept.unwrap_or_else(|| shelf::private(bytes, fill))
            };
            Tree::new(source, range.clone(), put)
        }))
    })?;
    // Whoever has built a segment may have died before it discarded those that are superseded, so all who come
    // to use it do that.
    segment.superseded().for_each(|shorter| shelf.discard(shorter.name()));
    Some(tree)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_follow_one_another_and_contain_those_they_supersede() {
        for count in 0..200u32 {
            let configs = count * SHORTEST + count % SHORTEST;
            let segments: Vec<SharedSegment> = SharedSegment::all(configs).collect();
            let mut end = 0;
            for segment in &segments {
                let own = segment.range();
                assert_eq!(own.start, end);
                end = own.end;
                let shorter: Vec<_> = segment.superseded().map(SharedSegment::range).collect();
                assert!(shorter.iter().all(|ids| own.start <= ids.start && ids.end <= own.end));
                let covered: usize = shorter.iter().map(ExactSizeIterator::len).sum();
                assert_eq!(covered, segment.level as usize * own.len());
            }
            assert_eq!(end, count * SHORTEST);
            assert!(segments.windows(2).all(|pair| pair[0].level > pair[1].level));
        }
    }
}
