//! Who may be too close: pairs of residues, found in single precision.

use super::pairs::Flow;
use super::rules::Limits;
use super::screen::{BLOCK, Points, Screen};
use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// For eight bits: the numbers of those that are set, in order.
const SET_BITS: [[u8; 8]; 256] = {
    let mut numbers = [[0; 8]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut bit, mut count) = (0, 0);
        while bit < 8 {
            if (bits >> bit) & 1 == 1 {
                numbers[bits][count] = bit as u8;
                count += 1;
            }
            bit += 1;
        }
        bits += 1;
    }
    numbers
};

/// Eight points in lanes.
#[derive(Clone, Copy)]
struct Lanes8<S: Simd> {
    x: f32x8<S>,
    y: f32x8<S>,
    z: f32x8<S>,
    half: f32x8<S>,
}

impl<S: Simd> Lanes8<S> {
    #[inline(always)]
    fn load(simd: S, [x, y, z, half]: &Points) -> Lanes8<S> {
        Lanes8 {
            x: f32x8::load_array_ref(simd, x),
            y: f32x8::load_array_ref(simd, y),
            z: f32x8::load_array_ref(simd, z),
            half: f32x8::load_array_ref(simd, half),
        }
    }

    /// Half the squares of the distances to one of eight points, negative.
    #[inline(always)]
    fn closeness(&self, simd: S, [x, y, z, half]: &Points, lane: usize) -> f32x8<S> {
        let along = f32x8::splat(simd, z[lane]).mul_sub(self.z, self.half);
        let along = f32x8::splat(simd, y[lane]).mul_add(self.y, along);
        let along = f32x8::splat(simd, x[lane]).mul_add(self.x, along);
        along - f32x8::splat(simd, half[lane])
    }
}

impl Screen {
    /// Calls `backbones` for pairs of residues i < j, among them all |i − j| ≥ 3 whose backbones are closer than the limits,
    /// and `sides` for pairs among which are all whose side chains are.
    #[inline(always)]
    pub(super) fn suspects<S: Simd>(
        &mut self,
        simd: S,
        limits: &Limits,
        backbones: &mut impl FnMut((usize, usize)) -> Flow,
        sides: &mut impl FnMut((usize, usize)) -> Flow,
    ) -> Flow {
        let least = limits.nitrogen_oxygen.max(limits.backbone) as f32;
        let alpha_carbons = limits.alpha_carbons as f32;
        let widest = least.max(alpha_carbons) * 1.000_01;
        let side_chains = limits.side_chains as f32 * 1.000_01;
        let (look, look_at_sides) = (widest > 0.0, side_chains > 0.0);
        if look || look_at_sides {
            self.pairs_of_blocks(simd, widest, side_chains, sides)?;
        }
        if look {
            self.pairs_of_atoms(simd, least, alpha_carbons, backbones)
        } else {
            Flow::Continue(())
        }
    }

    /// Goes through pairs of blocks that are near: lists pairs of residues with backbones that may be this close, and calls
    /// `sides` where side chains may be.
    #[inline(always)]
    fn pairs_of_blocks<S: Simd>(
        &mut self,
        simd: S,
        backbones: f32,
        side_chains: f32,
        sides: &mut impl FnMut((usize, usize)) -> Flow,
    ) -> Flow {
        let middles = backbones + 2.0 * self.reach * 1.000_01;
        let threshold = -0.5 * middles * middles - self.margin(middles);
        let side_threshold = -0.5 * side_chains * side_chains - self.margin(side_chains);
        // Rounding of what is computed with balls, relative to coordinates.
        let slack = 1e-3 + self.extent / (1 << 18) as f32;
        let (near, far) = (f32x8::splat(simd, threshold), f32x8::splat(simd, side_threshold));
        let mut len = 0;
        for first in 0..self.blocks.len() {
            let ball = &self.balls[first / BLOCK];
            let of = |row: usize| f32x8::splat(simd, ball[row][first % BLOCK]);
            let (x, y, z) = (of(0), of(1), of(2));
            let reach = of(3) + f32x8::splat(simd, middles + slack);
            let side_reach = of(4) + f32x8::splat(simd, side_chains + slack);
            for eight in first / BLOCK..self.balls.len() {
                let [bx, by, bz, radius, side_radius] = &self.balls[eight];
                let dx = f32x8::load_array_ref(simd, bx) - x;
                let dy = f32x8::load_array_ref(simd, by) - y;
                let dz = f32x8::load_array_ref(simd, bz) - z;
                let square = dz.mul_add(dz, dy.mul_add(dy, dx * dx));
                let reach = reach + f32x8::load_array_ref(simd, radius);
                let side_reach = side_reach + f32x8::load_array_ref(simd, side_radius);
                let mut close = square.simd_lt(reach * reach).to_bitmask();
                let mut side_close = square.simd_lt(side_reach * side_reach).to_bitmask();
                // From the first block on, up to the last one.
                let begin = first.saturating_sub(eight * BLOCK);
                let end = (self.blocks.len() - eight * BLOCK).min(BLOCK);
                let there = (0xFF << begin) & (0xFF >> (BLOCK - end));
                close &= if backbones > 0.0 { there } else { 0 };
                side_close &= if side_chains > 0.0 { there } else { 0 };
                while close != 0 {
                    let second = eight * BLOCK + close.trailing_zeros() as usize;
                    close &= close - 1;
                    len = self.list(simd, (first, second), near, len);
                }
                while side_close != 0 {
                    let second = eight * BLOCK + side_close.trailing_zeros() as usize;
                    side_close &= side_close - 1;
                    if self.sides_may_be_close(simd, (first, second), far) {
                        pairs_of(first, second, sides)?;
                    }
                }
            }
        }
        self.near.truncate(len);
        Flow::Continue(())
    }

    /// Lists the pairs of residues of two blocks whose middles are near, behind the first `len` of the list.
    #[inline(always)]
    fn list<S: Simd>(
        &mut self,
        simd: S,
        (first, second): (usize, usize),
        threshold: f32x8<S>,
        mut len: usize,
    ) -> usize {
        if self.near.len() < len + BLOCK * BLOCK {
            self.near.resize(2 * len + 16 * BLOCK * BLOCK, 0);
        }
        let near = &mut self.near[..len + BLOCK * BLOCK];
        let ones = &self.blocks[first].middles;
        let others = Lanes8::load(simd, &self.blocks[second].middles);
        // The first residues of the second block that are at least three after the one of the first.
        let apart = (second - first) * BLOCK;
        for lane in 0..BLOCK {
            let close = others.closeness(simd, ones, lane).simd_gt(threshold).to_bitmask();
            let allowed = 0xFF << (lane + 3).saturating_sub(apart).min(BLOCK);
            let close = (close & allowed & 0xFF) as u8;
            let base = (((first * BLOCK + lane) << 16) | (second * BLOCK)) as u32;
            let to = &mut near[len..len + BLOCK];
            let bits = &SET_BITS[usize::from(close)];
            for number in 0..BLOCK {
                to[number] = base + u32::from(bits[number]);
            }
            len += close.count_ones() as usize;
        }
        len
    }

    /// Whether two side chains of two blocks may be close.
    #[inline(always)]
    fn sides_may_be_close<S: Simd>(
        &self,
        simd: S,
        (first, second): (usize, usize),
        threshold: f32x8<S>,
    ) -> bool {
        let ones = &self.blocks[first].sides;
        let others = Lanes8::load(simd, &self.blocks[second].sides);
        if first == second {
            let mut close = 0;
            for lane in 0..BLOCK {
                let near = others.closeness(simd, ones, lane).simd_gt(threshold).to_bitmask();
                close |= near & (0xFF << (lane + 1));
            }
            return close & 0xFF != 0;
        }
        let mut closest = others.closeness(simd, ones, 0);
        for lane in 1..BLOCK {
            closest = closest.max(others.closeness(simd, ones, lane));
        }
        closest.simd_gt(threshold).any_true()
    }

    /// Calls `backbones` for the listed pairs of residues of which two atoms may be close.
    #[inline(always)]
    fn pairs_of_atoms<S: Simd>(
        &self,
        simd: S,
        least: f32,
        alpha_carbons: f32,
        backbones: &mut impl FnMut((usize, usize)) -> Flow,
    ) -> Flow {
        let margin = self.margin(least.max(alpha_carbons));
        let threshold = f32x8::splat(simd, -0.5 * least * least - margin);
        // Two CA are to be farther apart than others; by so much they seem closer. CA is the second atom.
        let mut closer = [0.0; BLOCK];
        closer[1] = (0.5 * (alpha_carbons * alpha_carbons - least * least) * 1.000_01).max(0.0);
        let closer = f32x8::load_array(simd, closer);
        for pair in &self.near {
            let (i, j) = ((pair >> 16) as usize, (pair & 0xFFFF) as usize);
            let ones = &self.atoms[i].0;
            let others = Lanes8::load(simd, &self.atoms[j].0);
            let closest = others.closeness(simd, ones, 0).max(others.closeness(simd, ones, 2));
            let closest = closest.max(others.closeness(simd, ones, 3));
            let closest = closest.max(others.closeness(simd, ones, 4));
            let closest = closest.max(others.closeness(simd, ones, 1) + closer);
            if closest.simd_gt(threshold).any_true() {
                backbones((i, j))?;
            }
        }
        Flow::Continue(())
    }
}

/// Calls `of` for all pairs of residues i < j of two blocks, in order.
fn pairs_of(first: usize, second: usize, of: &mut impl FnMut((usize, usize)) -> Flow) -> Flow {
    for i in first * BLOCK..(first + 1) * BLOCK {
        for j in (second * BLOCK).max(i + 1)..(second + 1) * BLOCK {
            of((i, j))?;
        }
    }
    Flow::Continue(())
}
