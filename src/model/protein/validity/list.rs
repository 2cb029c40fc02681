//! Lists that grow without a branch for each entry: which entries there are is hard to predict.

use fearless_simd::prelude::*;
use fearless_simd::u32x8;

/// For eight bits: the numbers of those that are set, in order.
static SET_BITS: [[u32; 8]; 256] = {
    let mut numbers = [[0; 8]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut bit, mut count) = (0, 0);
        while bit < 8 {
            if (bits >> bit) & 1 == 1 {
                numbers[bits][count] = bit as u32;
                count += 1;
            }
            bit += 1;
        }
        bits += 1;
    }
    numbers
};

/// Pairs of numbers below 2¹⁶ in one memory: the first · 2¹⁶ + the second.
#[derive(Clone, Debug, Default)]
pub(super) struct List {
    memory: Vec<u32>,
    len: usize,
}

impl List {
    /// What two numbers are in the list.
    #[inline(always)]
    pub fn pair(first: usize, second: usize) -> u32 {
        ((first << 16) | second) as u32
    }

    /// Takes everything out.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends `base` plus the number of every bit that is set, in order.
    #[inline(always)]
    pub fn push<S: Simd>(&mut self, simd: S, base: u32, bits: u8) {
        if self.memory.len() < self.len + 8 {
            self.memory.resize(2 * self.len + 256, 0);
        }
        // Eight are written whatever the bits; what is too many is written over by what comes next.
        let to = &mut self.memory[self.len..self.len + 8];
        let numbers = u32x8::load_array_ref(simd, &SET_BITS[usize::from(bits)]);
        (numbers + u32x8::splat(simd, base)).store_slice(to);
        self.len += bits.count_ones() as usize;
    }

    /// The pairs, in the order in which they were appended.
    #[inline(always)]
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.memory[..self.len].iter().map(|pair| ((pair >> 16) as usize, (pair & 0xFFFF) as usize))
    }

    /// Fills the memory with what could mislead.
    pub fn poison(&mut self) {
        self.memory.fill(u32::MAX);
    }
}

/// Pairs of residues, those of two blocks in a tile: a bit for each of 8 · 8.
#[derive(Clone, Debug, Default)]
pub(super) struct Tiles {
    memory: Vec<(u64, u32)>,
    /// How many tiles, and how many pairs in them.
    len: usize,
    count: usize,
}

impl Tiles {
    /// Takes everything out.
    pub fn clear(&mut self) {
        (self.len, self.count) = (0, 0);
    }

    /// Appends the pairs of two blocks: bit 8 i + j stands for residue i of the first and residue j of the second.
    #[inline(always)]
    pub fn push(&mut self, first: usize, second: usize, bits: u64) {
        // One more than needed, since reading looks one ahead.
        if self.memory.len() < self.len + 2 {
            self.memory.resize(2 * self.len + 64, (0, 0));
        }
        // A tile without a pair is written over by what comes next.
        self.memory[self.len] = (bits, List::pair(first, second));
        self.len += usize::from(bits != 0);
        self.count += bits.count_ones() as usize;
    }

    /// The pairs, tile by tile.
    #[inline(always)]
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let (mut next, mut bits, mut blocks) = (0, 0u64, 0);
        (0..self.count).map(move |_| {
            let (new_bits, new_blocks) = self.memory[next];
            let is_new = bits == 0;
            next += usize::from(is_new);
            (bits, blocks) = if is_new { (new_bits, new_blocks) } else { (bits, blocks) };
            let bit = bits.trailing_zeros();
            bits &= bits - 1;
            let [first, second] = [blocks >> 16, blocks & 0xFFFF].map(|block| 8 * block);
            ((first + bit / 8) as usize, (second + bit % 8) as usize)
        })
    }

    /// Fills the memory with what could mislead.
    pub fn poison(&mut self) {
        self.memory.fill((u64::MAX, u32::MAX));
    }
}
