//! The fixed places at which segments lie that several indices have in common.

use super::build::Source;
use super::tree::Tree;
use crate::shelf::{self, BlockName, Claim, Shelf};
use std::sync::Arc;

/// Length of the shortest of these segments.
const SHORTEST: u32 = if cfg!(test) { 1 << 5 } else { 1 << 10 };

/// A place: so many segments of its length are before it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spot {
    level: u32,
    number: u32,
}

impl Spot {
    /// Those of the segments over the first configurations: the powers of two of which their number is made, as
    /// far as it is a multiple of [`SHORTEST`], longest first.
    fn all(configs: u32) -> impl Iterator<Item = Spot> {
        let count = configs / SHORTEST;
        let levels = (0..u32::BITS).rev().filter(move |level| count >> level & 1 == 1);
        levels.map(move |level| Spot { level, number: (count >> level) - 1 })
    }

    fn len(self) -> u32 {
        SHORTEST << self.level
    }

    fn range(self) -> (u32, u32) {
        (self.number * self.len(), self.len())
    }

    fn name(self) -> BlockName {
        BlockName::Segment { level: self.level, number: self.number }
    }

    /// The shorter ones at the same place.
    fn within(self) -> impl Iterator<Item = Spot> {
        (0..self.level).flat_map(move |level| {
            let first = self.number << (self.level - level);
            let count = 1 << (self.level - level);
            (first..first + count).map(move |number| Spot { level, number })
        })
    }
}

/// The segments at fixed places for as many configurations as the source's time, given those before. Where
/// another is making one of them the row ends with shorter ones, or early.
pub(super) fn settled(old: &[Arc<Tree>], shelf: &dyn Shelf, source: &Source) -> Vec<Arc<Tree>> {
    let mut segments: Vec<Arc<Tree>> = Vec::new();
    let mut claim = None;
    for spot in Spot::all(source.time) {
        let (first, len) = spot.range();
        let known = old.iter().find(|tree| (tree.first(), tree.len()) == (first, len)).cloned();
        match known.or_else(|| obtain(spot, shelf, source, &mut claim).map(Arc::new)) {
            Some(tree) => segments.push(tree),
            None => {
                segments.extend(old.iter().filter(|tree| tree.first() >= first).cloned());
                break;
            }
        }
    }
    segments
}

/// The segment at a place, found or made; `None` where another has the claim to make it.
fn obtain(
    spot: Spot,
    shelf: &dyn Shelf,
    source: &Source,
    claim: &mut Option<Claim>,
) -> Option<Tree> {
    let find =
        || Tree::found(source.embedding, spot.range(), |bytes| shelf.find(spot.name(), bytes));
    let tree = find().or_else(|| {
        if claim.is_none() {
            *claim = Some(shelf.claim()?);
        }
        // Whoever had the claim may have made it meanwhile.
        Some(find().unwrap_or_else(|| {
            let put = |bytes, fill: &mut dyn FnMut(&mut [u8])| {
                let kept = shelf.put(spot.name(), bytes, fill);
                kept.unwrap_or_else(|| shelf::private(bytes, fill))
            };
            Tree::new(source, spot.range(), put)
        }))
    })?;
    // Also those that others have made and died with.
    spot.within().for_each(|shorter| shelf.discard(shorter.name()));
    Some(tree)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_follow_one_another_and_contain_the_shorter_ones() {
        for count in 0..200u32 {
            let spots: Vec<Spot> = Spot::all(count * SHORTEST + count % SHORTEST).collect();
            let mut end = 0;
            for spot in &spots {
                let (first, len) = spot.range();
                assert_eq!(first, end);
                end += len;
                let inner: Vec<_> = spot.within().map(Spot::range).collect();
                assert!(inner.iter().all(|(at, len)| first <= *at && at + len <= end));
                assert_eq!(inner.iter().map(|(_, len)| len).sum::<u32>(), spot.level * len);
            }
            assert_eq!(end, count * SHORTEST);
            assert!(spots.windows(2).all(|pair| pair[0].level > pair[1].level));
        }
    }
}
