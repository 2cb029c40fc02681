//! Lists that grow by the set bits of eight, without a branch for each.

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
