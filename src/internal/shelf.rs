//! Where parts of a roadmap that never change any more are kept, once for all who have the same roadmap.

use bytes::Bytes;
use std::any::Any;
use std::fmt;

/// Bytes that never change. They begin at a multiple of [`ALIGNMENT`], so that numbers can be read in
/// place; copies share them.
pub type Block = Bytes;

/// Where blocks begin, in bytes: at a cache line.
pub const ALIGNMENT: usize = 64;

/// What a block is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BlockName {
    /// Configurations: so many whole blocks are before it.
    Configs(u32),
    /// Edges: so many whole blocks are before it.
    Edges(u32),
    /// A segment of the index over all nodes: so many of its length are before it.
    Segment {
        /// Segments of a level are twice as long as those of the one before.
        level: u32,
        /// Its number within the level.
        number: u32,
    },
    /// The numbers of a model's grid of energies.
    Energies,
}

impl fmt::Display for BlockName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BlockName::Configs(number) => write!(f, "configs-{number}"),
            BlockName::Edges(number) => write!(f, "edges-{number}"),
            BlockName::Segment { level, number } => write!(f, "segment-{level}-{number}"),
            BlockName::Energies => f.write_str("energies"),
        }
    }
}

/// Held by whoever makes what is dear to make; others can claim it once this is dropped.
pub type Claim = Box<dyn Any>;

/// Where replicas of one roadmap, which all go through the same states, keep what never changes.
///
/// A shelf may lose or refuse what it likes: then a replica makes its own. What two replicas make under one name
/// need not be the same bytes, but each serves all of them.
pub trait Shelf: fmt::Debug + Send + Sync {
    /// The block of that name and length, if it is there.
    fn find(&self, name: BlockName, bytes: usize) -> Option<Block>;

    /// Has a block filled, which is all zeros, and keeps it; the block of that name that there is then, made by
    /// whomever. `None` where there is no room.
    fn put(&self, name: BlockName, bytes: usize, fill: &mut dyn FnMut(&mut [u8])) -> Option<Block>;

    /// The right to make what is dear; `None` while another has it.
    fn claim(&self) -> Option<Claim>;

    /// Forgets a block, if there is one. Those who have it keep it.
    fn discard(&self, name: BlockName);
}

/// A block that is on no shelf.
pub fn private(bytes: usize, fill: &mut dyn FnMut(&mut [u8])) -> Block {
    struct Words(Vec<u64>);
    impl AsRef<[u8]> for Words {
        fn as_ref(&self) -> &[u8] {
            bytemuck::cast_slice(&self.0)
        }
    }
    let mut words = Words(vec![0; (bytes + ALIGNMENT).div_ceil(size_of::<u64>())]);
    let first = words.as_ref().as_ptr().align_offset(ALIGNMENT);
    fill(&mut bytemuck::cast_slice_mut(&mut words.0)[first..first + bytes]);
    Bytes::from_owner(words).slice(first..first + bytes)
}

/// The block of that name, from the shelf or made for it, or where it has no room, made beside it.
pub(crate) fn kept(
    shelf: &dyn Shelf,
    name: BlockName,
    bytes: usize,
    fill: &mut dyn FnMut(&mut [u8]),
) -> Block {
    let found = shelf.find(name, bytes).or_else(|| shelf.put(name, bytes, fill));
    found.unwrap_or_else(|| private(bytes, fill))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::numbers::Ordinal;
    use crate::seed::{Purpose, Seed, Stream};
    use std::collections::BTreeMap;
    use std::sync::Mutex;

    /// A shelf that, so often of once, loses a block, has no room, or says that another has the claim.
    #[derive(Debug)]
    pub(crate) struct Flaky {
        often: f64,
        state: Mutex<State>,
    }

    #[derive(Debug)]
    struct State {
        blocks: BTreeMap<BlockName, Block>,
        stream: Stream,
        made: usize,
    }

    impl Flaky {
        pub(crate) fn new(often: f64, ordinal: u64) -> Flaky {
            let stream = Seed::of_set(1, "shelf", Ordinal(ordinal)).stream(Purpose::Sampling);
            let state = State { blocks: BTreeMap::new(), stream, made: 0 };
            Flaky { often, state: Mutex::new(state) }
        }

        /// How many blocks were ever put here.
        pub(crate) fn made(&self) -> usize {
            self.state.lock().unwrap().made
        }

        /// The names of the blocks that are here.
        pub(crate) fn names(&self) -> Vec<BlockName> {
            self.state.lock().unwrap().blocks.keys().copied().collect()
        }

        fn fails(&self) -> bool {
            self.state.lock().unwrap().stream.unit() < self.often
        }
    }

    impl Shelf for Flaky {
        fn find(&self, name: BlockName, bytes: usize) -> Option<Block> {
            let fails = self.fails();
            let mut state = self.state.lock().unwrap();
            if fails {
                state.blocks.remove(&name);
            }
            state.blocks.get(&name).filter(|block| block.len() == bytes).cloned()
        }

        fn put(
            &self,
            name: BlockName,
            bytes: usize,
            fill: &mut dyn FnMut(&mut [u8]),
        ) -> Option<Block> {
            if self.fails() {
                return None;
            }
            let block = private(bytes, fill);
            let mut state = self.state.lock().unwrap();
            state.made += 1;
            Some(state.blocks.entry(name).or_insert(block).clone())
        }

        fn claim(&self) -> Option<Claim> {
            (!self.fails()).then(|| Box::new(()) as Claim)
        }

        fn discard(&self, name: BlockName) {
            self.state.lock().unwrap().blocks.remove(&name);
        }
    }

    #[test]
    fn blocks_begin_at_cache_lines() {
        for bytes in (0..300).step_by(7) {
            let block = private(bytes, &mut |block| {
                assert!(block.iter().all(|byte| *byte == 0));
                block.fill(bytes as u8);
            });
            assert_eq!(block.as_ptr().align_offset(ALIGNMENT), 0);
            assert_eq!(block, vec![bytes as u8; bytes]);
        }
    }
}
