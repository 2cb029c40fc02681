//! Who may be too close: pairs of residues, found in single precision.

use super::known::Window;
use super::list::List;
use super::pairs::Flow;
use super::rules::Limits;
use super::screen::{BACKBONE, BLOCK, FAR, Points, Screen};
use fearless_simd::f32x8;
use fearless_simd::prelude::*;

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

/// What of residues is looked at: the number of a list in `Screen::near_blocks`.
#[derive(Clone, Copy)]
enum Part {
    Middles,
    Sides,
}

/// Of the pairs of two blocks, in the order of `Screen::tile`, those whose second residue is at least so much after the first:
/// for one block and itself, for a block and the next one, and for blocks that are farther apart.
const fn at_least(apart: usize) -> [u64; 3] {
    let mut bits = [0, 0, u64::MAX];
    let mut pair = 0;
    while pair < BLOCK * BLOCK {
        let (one, other) = (pair / BLOCK, pair % BLOCK);
        bits[0] |= ((other >= one + apart) as u64) << pair;
        bits[1] |= ((BLOCK + other >= one + apart) as u64) << pair;
        pair += 1;
    }
    bits
}

/// The pairs that the rules of side chains are about.
const SIDES: [u64; 3] = at_least(1);

/// The pairs that the rules of backbones are about.
const BACKBONES: [u64; 3] = at_least(3);

impl Screen {
    /// Calls `backbones` for pairs of residues i < j, among them all |i − j| ≥ 3 whose backbones are closer than the limits,
    /// and `sides` for pairs among which are all whose side chains are; both for pairs of a window.
    #[inline(always)]
    pub(super) fn suspects<S: Simd>(
        &mut self,
        simd: S,
        limits: &Limits,
        window: Window,
        backbones: &mut impl FnMut((usize, usize)) -> Flow,
        sides: &mut impl FnMut((usize, usize)) -> Flow,
    ) -> Flow {
        let least = limits.nitrogen_oxygen.max(limits.backbone) as f32;
        let alpha_carbons = limits.alpha_carbons as f32;
        let side_chains = limits.side_chains as f32 * 1.000_01;
        // How far apart the middles of two residues are at most of which two atoms are as close as a rule forbids; 0: no rule.
        let middles = |least: f32, reach: f32| {
            if least > 0.0 { (least + 2.0 * reach) * 1.000_01 } else { 0.0 }
        };
        let middles = middles(least, self.reach).max(middles(alpha_carbons, self.alpha_reach));
        self.list_blocks(simd, window, middles, side_chains);
        if side_chains > 0.0 {
            self.pairs_of_sides(simd, side_chains, sides)?;
        }
        if middles > 0.0 {
            self.list_pairs(simd, middles);
            self.pairs_of_atoms(simd, limits, backbones)?;
        }
        Flow::Continue(())
    }

    /// What rounding can do to distances from centres of balls, relative to coordinates, Å.
    fn slack(&self) -> f32 {
        1e-3 + self.extent / (1 << 18) as f32
    }

    /// Lists the pairs of blocks that may be near: whose middles may be as close as `middles`, and whose side chains as
    /// `side_chains`; 0: nobody asks.
    #[inline(always)]
    fn list_blocks<S: Simd>(&mut self, simd: S, window: Window, middles: f32, side_chains: f32) {
        let slack = self.slack();
        let count = self.blocks.len();
        // Lists of its own keep their lengths in registers.
        let [mut near_middles, mut near_sides] = std::mem::take(&mut self.near_blocks);
        near_middles.clear();
        near_sides.clear();
        for first in 0..count.min(window.last.saturating_add(1)) {
            let ball = &self.balls[first / BLOCK];
            let of = |row: usize| f32x8::splat(simd, ball[row][first % BLOCK]);
            let (x, y, z) = (of(0), of(1), of(2));
            let from = first.max(window.first);
            let reach = of(3) + f32x8::splat(simd, middles + slack);
            let side_reach = of(4) + f32x8::splat(simd, side_chains + slack);
            for (eight, ball) in self.balls.iter().enumerate().skip(from / BLOCK) {
                let [bx, by, bz, radius, side_radius] = ball;
                let dx = f32x8::load_array_ref(simd, bx) - x;
                let dy = f32x8::load_array_ref(simd, by) - y;
                let dz = f32x8::load_array_ref(simd, bz) - z;
                let square = dz.mul_add(dz, dy.mul_add(dy, dx * dx));
                let reach = reach + f32x8::load_array_ref(simd, radius);
                let side_reach = side_reach + f32x8::load_array_ref(simd, side_radius);
                let close = square.simd_lt(reach * reach).to_bitmask() as u32;
                let side_close = square.simd_lt(side_reach * side_reach).to_bitmask() as u32;
                // From the first block on, or where the window begins, up to the last one.
                let begin = from.saturating_sub(eight * BLOCK);
                let end = (count - eight * BLOCK).min(BLOCK);
                let there = (0xFF << begin) & (0xFF >> (BLOCK - end));
                let base = List::pair(first, eight * BLOCK);
                near_middles.push(simd, base, (close & there) as u8);
                near_sides.push(simd, base, (side_close & there) as u8);
            }
        }
        self.near_blocks = [near_middles, near_sides];
    }

    /// Which residues of two blocks may be closer than the threshold says: bit 8 i + j is about number i of the first block and
    /// number j of the second.
    #[inline(always)]
    fn tile<S: Simd>(simd: S, ones: &Points, others: &Lanes8<S>, threshold: f32x8<S>) -> u64 {
        let mut bits = 0;
        for one in 0..BLOCK {
            let close = others.closeness(simd, ones, one).simd_gt(threshold).to_bitmask();
            bits |= (close & 0xFF) << (BLOCK * one);
        }
        bits
    }

    /// Lists the pairs of residues, the second at least three after the first, whose middles may be as close as `middles`.
    #[inline(always)]
    fn list_pairs<S: Simd>(&mut self, simd: S, middles: f32) {
        let threshold = -0.5 * middles * middles - self.margin(middles);
        let threshold = f32x8::splat(simd, threshold);
        let mut tiles = std::mem::take(&mut self.tiles);
        tiles.clear();
        for (first, second) in self.near_blocks[Part::Middles as usize].pairs() {
            let ones = &self.blocks[first].middles;
            let others = Lanes8::load(simd, &self.blocks[second].middles);
            let bits =
                Self::tile(simd, ones, &others, threshold) & BACKBONES[(second - first).min(2)];
            tiles.push(first, second, bits);
        }
        self.tiles = tiles;
    }

    /// Calls `sides` for pairs of residues among which are all whose side chains may be as close as `least`.
    #[inline(always)]
    fn pairs_of_sides<S: Simd>(
        &self,
        simd: S,
        least: f32,
        sides: &mut impl FnMut((usize, usize)) -> Flow,
    ) -> Flow {
        let threshold = f32x8::splat(simd, -0.5 * least * least - self.margin(least));
        for (first, second) in self.near_blocks[Part::Sides as usize].pairs() {
            let ones = &self.blocks[first].sides;
            let others = Lanes8::load(simd, &self.blocks[second].sides);
            if first != second {
                // Nearly always nobody is close, which is seen sooner than who it is.
                let mut closest =
                    [others.closeness(simd, ones, 0), others.closeness(simd, ones, 1)];
                for one in 2..BLOCK {
                    closest[one % 2] = closest[one % 2].max(others.closeness(simd, ones, one));
                }
                if !closest[0].max(closest[1]).simd_gt(threshold).any_true() {
                    continue;
                }
            }
            let mut bits =
                Self::tile(simd, ones, &others, threshold) & SIDES[(second - first).min(2)];
            while bits != 0 {
                let bit = bits.trailing_zeros() as usize;
                sides((first * BLOCK + bit / BLOCK, second * BLOCK + bit % BLOCK))?;
                bits &= bits - 1;
            }
        }
        Flow::Continue(())
    }

    /// Calls `backbones` for the listed pairs of residues of which two atoms may be close.
    #[inline(always)]
    fn pairs_of_atoms<S: Simd>(
        &self,
        simd: S,
        limits: &Limits,
        backbones: &mut impl FnMut((usize, usize)) -> Flow,
    ) -> Flow {
        let least = limits.nitrogen_oxygen.max(limits.backbone) as f32;
        let margin = self.margin(least.max(limits.alpha_carbons as f32));
        let threshold = f32x8::splat(simd, -0.5 * least * least - margin);
        // Pairs with another least distance than `least` seem closer, or farther apart, by what makes up for it.
        let shift = |own: f64| {
            let shift = 0.5 * (own as f32 * own as f32 - least * least);
            shift + 1e-5 * shift.abs()
        };
        let (backbone, nitrogen_oxygen) = (shift(limits.backbone), shift(limits.nitrogen_oxygen));
        let alpha_carbons = shift(limits.alpha_carbons).max(backbone);
        // By the lanes of the atoms: N, CA, C, O and CB; what else there is of a residue is no concern of these rules.
        let mut of_others = [-FAR; BLOCK];
        of_others[..BACKBONE].fill(backbone);
        let [mut of_n, mut of_ca, mut of_o] = [of_others; 3];
        (of_n[3], of_ca[1], of_o[0]) = (nitrogen_oxygen, alpha_carbons, nitrogen_oxygen);
        let load = f32x8::load_array;
        let (of_n, of_ca, of_o) = (load(simd, of_n), load(simd, of_ca), load(simd, of_o));
        let of_others = load(simd, of_others);
        for (i, j) in self.tiles.pairs() {
            let ones = &self.atoms[i].0;
            let others = Lanes8::load(simd, &self.atoms[j].0);
            let closest = others.closeness(simd, ones, 2).max(others.closeness(simd, ones, 4));
            let closest = closest + of_others;
            let closest = closest.max(others.closeness(simd, ones, 0) + of_n);
            let closest = closest.max(others.closeness(simd, ones, 1) + of_ca);
            let closest = closest.max(others.closeness(simd, ones, 3) + of_o);
            if closest.simd_gt(threshold).any_true() {
                backbones((i, j))?;
            }
        }
        Flow::Continue(())
    }
}
