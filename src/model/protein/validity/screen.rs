//! A conformation in single precision, by blocks of eight residues, to see quickly which pairs double precision has to look
//! at.
//!
//! Coordinates are taken from the CA in the middle of the chain, the differences being formed in double precision. Of every
//! point half its square is kept, s = |a|²/2, so that half the square of a distance is s_a + s_b − a·b: three products.
//!
//! Rounding never makes two points seem apart that are not. With ε = 2⁻²⁴, and all points within M of the origin: a
//! coordinate is off by ε M at most, so that half the square of a distance d is off by 2 ε M d + 2 ε² M²; either s is off by
//! 3 ε M²/2 at most; the sum of products, each partial sum of which is below 3 M²/2, by 5 ε M². So [`Screen::margin`], 64 ε (M² + M d + 1), is more than all of it. Products and sums may be fused, which rounds
//! less often.

use super::list::List;
use crate::lanes::Lanes;
use crate::model::protein::placed::{Coordinates, Placed};
use crate::structure::Point;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f64x4};

/// The sum of half the squares of all points of a conformation that is looked at in single precision, Å².
const LARGEST: f32 = 1e20;

/// Residues in a block: as many as there are lanes.
pub(super) const BLOCK: usize = 8;

/// Half the square of what is not there: farther than all else, and yet no sum of it overflows.
const FAR: f32 = 1e30;

/// Where the middle of a residue is on the way from its CA to its C: about as far from N and CB as from O, so that all
/// backbone atoms lie within 1.9 Å of it.
const MIDDLE: f32 = 0.42;

/// Coordinates of eight points and half their squares.
pub(super) type Points = [[f32; BLOCK]; 4];

/// Eight residues that follow one another.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Block {
    /// Points between CA and C: near them are all backbone atoms of the residue.
    pub middles: Points,
    /// The centroids of side chains.
    pub sides: Points,
}

/// The backbone atoms of a residue, N, CA, C, O and four times CB.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Atoms(pub Points);

/// A conformation in single precision, and the memory that a check needs. What is in it never changes a verdict.
#[derive(Clone, Debug)]
pub struct Screen {
    pub(super) lanes: Lanes,
    pub(super) blocks: Vec<Block>,
    pub(super) atoms: Vec<Atoms>,
    /// Of eight blocks: centres of balls, by coordinate; their radii around the middles of residues; those around side chains.
    pub(super) balls: Vec<[[f32; BLOCK]; 5]>,
    /// No backbone atom is farther than this from the middle of its residue, Å.
    pub(super) reach: f32,
    /// No CA is farther than this from the middle of its residue, Å.
    pub(super) alpha_reach: f32,
    /// No point is farther than this from the origin, Å.
    pub(super) extent: f32,
    /// Pairs of blocks whose middles may be close, and of those whose side chains may be.
    pub(super) near_blocks: [List; 2],
    /// Blocks, and residues before them or in them that may be close to one of theirs.
    pub(super) rows: List,
    /// Pairs of residues i < j whose backbones may be close.
    pub(super) near: List,
}

impl Default for Screen {
    fn default() -> Screen {
        Screen {
            lanes: Lanes::widest(),
            blocks: Vec::new(),
            atoms: Vec::new(),
            balls: Vec::new(),
            reach: 0.0,
            alpha_reach: 0.0,
            extent: 0.0,
            near_blocks: Default::default(),
            rows: List::default(),
            near: List::default(),
        }
    }
}

/// Eight points in single precision, and half their squares.
#[derive(Clone, Copy)]
struct Eight<S: Simd> {
    x: f32x8<S>,
    y: f32x8<S>,
    z: f32x8<S>,
    half: f32x8<S>,
}

/// Eight numbers of a slice from an origin; behind its end the last one.
#[inline(always)]
fn eight<S: Simd>(simd: S, from: &[f64], block: usize, origin: f64) -> f32x8<S> {
    let origin = f64x4::splat(simd, origin);
    let rest;
    let eight = if let Some(whole) = from.as_chunks::<BLOCK>().0.get(block) {
        whole
    } else {
        let last = from.len() - 1;
        rest = std::array::from_fn(|lane| from[(block * BLOCK + lane).min(last)]);
        &rest
    };
    let (low, high) = (f64x4::from_slice(simd, &eight[..4]), f64x4::from_slice(simd, &eight[4..]));
    (low - origin).narrow(high - origin)
}

impl<S: Simd> Eight<S> {
    #[inline(always)]
    fn load(simd: S, from: &Coordinates, block: usize, origin: &Point) -> Eight<S> {
        let x = eight(simd, &from.x, block, origin.x);
        let y = eight(simd, &from.y, block, origin.y);
        let z = eight(simd, &from.z, block, origin.z);
        Eight::new(simd, x, y, z)
    }

    #[inline(always)]
    fn new(simd: S, x: f32x8<S>, y: f32x8<S>, z: f32x8<S>) -> Eight<S> {
        let half = z.mul_add(z, y.mul_add(y, x * x)) * f32x8::splat(simd, 0.5);
        Eight { x, y, z, half }
    }

    /// The squares of the distances to others.
    #[inline(always)]
    fn squares(&self, [x, y, z]: [f32x8<S>; 3]) -> f32x8<S> {
        let (x, y, z) = (self.x - x, self.y - y, self.z - z);
        z.mul_add(z, y.mul_add(y, x * x))
    }

    #[inline(always)]
    fn store(&self, to: &mut Points) {
        let [x, y, z, half] = to;
        self.x.store_array(x);
        self.y.store_array(y);
        self.z.store_array(z);
        self.half.store_array(half);
    }
}

/// Columns of four numbers become rows.
#[inline(always)]
fn rows<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> [f32x4<S>; 4] {
    let (odd, even) = (a.zip_low(c), b.zip_low(d));
    let (first, second) = (odd.zip_low(even), odd.zip_high(even));
    let (odd, even) = (a.zip_high(c), b.zip_high(d));
    [first, second, odd.zip_low(even), odd.zip_high(even)]
}

/// Gives each of eight residues one coordinate of its atoms, N, CA, C, O and CB.
#[inline(always)]
fn deal<S: Simd>(simd: S, atoms: &mut [Atoms], axis: usize, kinds: [f32x8<S>; 5]) {
    let [n, ca, c, o, cb] = kinds;
    let ((n, n2), (ca, ca2), (c, c2), (o, o2)) = (n.split(), ca.split(), c.split(), o.split());
    let (low, high) = (rows([n, ca, c, o]), rows([n2, ca2, c2, o2]));
    let cb = cb.to_array();
    for (lane, atoms) in atoms.iter_mut().take(BLOCK).enumerate() {
        let four = if lane < 4 { low[lane % 4] } else { high[lane % 4] };
        let to = &mut atoms.0[axis];
        four.store_slice(&mut to[..4]);
        f32x4::splat(simd, cb[lane]).store_slice(&mut to[4..]);
    }
}

impl Screen {
    /// What rounding can do to half the square of a distance of at most this, Å².
    pub(super) fn margin(&self, distance: f32) -> f32 {
        let far = self.extent;
        (far * far + far * distance.max(1.0) + 1.0) * (64.0 / (1u32 << 24) as f32)
    }

    /// Fills it with what could mislead.
    pub(in crate::model::protein) fn poison(&mut self) {
        let nonsense = Block { middles: [[0.0; BLOCK]; 4], sides: [[f32::NAN; BLOCK]; 4] };
        self.blocks.fill(nonsense);
        self.atoms.fill(Atoms([[0.0; BLOCK]; 4]));
        self.balls.fill([[f32::NAN; BLOCK]; 5]);
        (self.reach, self.alpha_reach, self.extent) = (f32::NAN, f32::NAN, f32::NAN);
        let [middles, sides] = &mut self.near_blocks;
        for list in [middles, sides, &mut self.rows, &mut self.near] {
            list.poison();
        }
    }

    /// Takes a conformation; false if it is none, or too large for single precision.
    #[inline(always)]
    pub(super) fn take<S: Simd>(&mut self, simd: S, placed: &Placed) -> bool {
        let len = placed.len();
        let count = len.div_ceil(BLOCK);
        if len == 0 || len > usize::from(u16::MAX) {
            return false;
        }
        let nothing = [[0.0; BLOCK]; 4];
        self.blocks.resize(count, Block { middles: nothing, sides: nothing });
        self.atoms.resize(count * BLOCK, Atoms(nothing));
        self.balls.resize(count.div_ceil(BLOCK), [[0.0; BLOCK]; 5]);
        let origin = placed.ca.at(len / 2);
        let zero = f32x8::splat(simd, 0.0);
        let (mut reach, mut alpha_reach, mut extent, mut sum) = (zero, zero, zero, zero);
        for number in 0..count {
            let n = Eight::load(simd, &placed.n, number, &origin);
            let ca = Eight::load(simd, &placed.ca, number, &origin);
            let c = Eight::load(simd, &placed.c, number, &origin);
            let o = Eight::load(simd, &placed.o, number, &origin);
            let cb = Eight::load(simd, &placed.cb, number, &origin);
            let side = Eight::load(simd, &placed.centroid, number, &origin);
            let part = f32x8::splat(simd, MIDDLE);
            let middle = Eight::new(
                simd,
                (c.x - ca.x).mul_add(part, ca.x),
                (c.y - ca.y).mul_add(part, ca.y),
                (c.z - ca.z).mul_add(part, ca.z),
            );

            let at = [middle.x, middle.y, middle.z];
            let alphas = ca.squares(at);
            alpha_reach = alpha_reach.max(alphas);
            reach = reach.max(n.squares(at)).max(alphas).max(c.squares(at));
            reach = reach.max(o.squares(at)).max(cb.squares(at));
            extent = extent.max(n.half).max(ca.half).max(c.half);
            extent = extent.max(o.half).max(cb.half).max(side.half);
            // A maximum may pass over what is no number; a sum does not.
            sum += (n.half + ca.half) + (c.half + o.half) + (cb.half + side.half);

            let atoms = &mut self.atoms[number * BLOCK..][..BLOCK];
            deal(simd, atoms, 0, [n.x, ca.x, c.x, o.x, cb.x]);
            deal(simd, atoms, 1, [n.y, ca.y, c.y, o.y, cb.y]);
            deal(simd, atoms, 2, [n.z, ca.z, c.z, o.z, cb.z]);
            deal(simd, atoms, 3, [n.half, ca.half, c.half, o.half, cb.half]);

            let block = &mut self.blocks[number];
            middle.store(&mut block.middles);
            side.store(&mut block.sides);
            let centre = |axis: usize| 0.5 * (block.middles[axis][1] + block.middles[axis][6]);
            let centre = [centre(0), centre(1), centre(2)];
            let [x, y, z] = centre;
            let at = [f32x8::splat(simd, x), f32x8::splat(simd, y), f32x8::splat(simd, z)];
            let radii = [middle.squares(at).reduce_max(), side.squares(at).reduce_max()];
            let ball = &mut self.balls[number / BLOCK];
            let lane = number % BLOCK;
            (ball[0][lane], ball[1][lane], ball[2][lane]) = (x, y, z);
            (ball[3][lane], ball[4][lane]) = (radii[0].sqrt(), radii[1].sqrt());

            for lane in 0..BLOCK {
                let residue = number * BLOCK + lane;
                if residue >= len {
                    block.middles[3][lane] = FAR;
                }
                if !placed.has_centroid.get(residue).is_some_and(|has| *has) {
                    block.sides[3][lane] = FAR;
                }
            }
        }
        self.reach = reach.reduce_max().sqrt();
        self.alpha_reach = alpha_reach.reduce_max().sqrt();
        self.extent = (2.0 * extent.reduce_max()).sqrt();
        sum.reduce_sum() < LARGEST
    }
}
