//! A conformation in single precision, by blocks of eight residues, to see quickly which pairs double precision has to look
//! at.
//!
//! Coordinates are taken from where the CA in the middle of the chain is, or was, the differences being formed in double precision. Of every
//! point half its square is kept, s = |a|²/2, so that half the square of a distance is s_a + s_b − a·b: three products.
//!
//! Rounding never makes two points seem apart that are not. With ε = 2⁻²⁴, and all points within M of the origin: a
//! coordinate is off by ε M at most, so that half the square of a distance d is off by 2 ε M d + 2 ε² M²; either s is off by
//! 3 ε M²/2 at most; the sum of products, each partial sum of which is below 3 M²/2, by 5 ε M². So [`Screen::margin`], 64 ε (M² + M d + 1), is more than all of it. Products and sums may be fused, which rounds
//! less often.

use super::known::Known;
use super::list::{List, Tiles};
use crate::lanes::Lanes;
use crate::model::protein::placed::{Placed, Row, SITES, Site};
use crate::structure::Point;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f64x4};

/// The sum of half the squares of all points of a conformation that is looked at in single precision, Å².
const LARGEST: f32 = 1e20;

/// Residues in a block: as many as there are lanes.
pub(super) const BLOCK: usize = 8;

/// Half the square of what is not there: farther than all else, and yet no sum of it overflows.
pub(super) const FAR: f32 = 1e30;

/// How many of the sites of a residue are backbone atoms: N, CA, C, O and CB.
pub(super) const BACKBONE: usize = 5;

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

/// The sites of a residue, in the order of [`Site`]: the first [`BACKBONE`] are its backbone atoms.
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
    /// Where the origin is, in the source's frame.
    pub(super) origin: Point,
    /// Of all blocks up to each, by the sites of a residue: the greatest square of a distance from the middle, the greatest half
    /// of a square, and the sum of these.
    pub(super) totals: Vec<[[f32; SITES]; 3]>,
    /// Pairs of blocks whose middles may be close, and of those whose side chains may be.
    pub(super) near_blocks: [List; 2],
    /// Pairs of residues i < j whose backbones may be close.
    pub(super) tiles: Tiles,
    /// The conformation that was valid last.
    pub(super) known: Option<Known>,
    /// Whether the last conformation was taken.
    pub(super) is_taken: bool,
    /// Pairs of residues that double precision looked at.
    pub(super) suspects: Vec<(u32, u32)>,
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
            origin: Point::zeros(),
            totals: Vec::new(),
            near_blocks: Default::default(),
            tiles: Tiles::default(),
            known: None,
            is_taken: false,
            suspects: Vec::new(),
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

/// Eight numbers from an origin.
#[inline(always)]
fn eight<S: Simd>(simd: S, from: &[f64; SITES], origin: f64x4<S>) -> f32x8<S> {
    let (low, high) = (f64x4::from_slice(simd, &from[..4]), f64x4::from_slice(simd, &from[4..]));
    (low - origin).narrow(high - origin)
}

impl<S: Simd> Eight<S> {
    #[inline(always)]
    fn of_row(simd: S, Row([x, y, z]): &Row, origin: &[f64x4<S>; 3]) -> Eight<S> {
        let [x0, y0, z0] = *origin;
        Eight::new(simd, eight(simd, x, x0), eight(simd, y, y0), eight(simd, z, z0))
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

/// Of four rows of four, the last two columns.
#[inline(always)]
fn last_two<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> [f32x4<S>; 2] {
    let (odd, even) = (a.zip_high(c), b.zip_high(d));
    [odd.zip_low(even), odd.zip_high(even)]
}

/// Of one coordinate of eight residues: that of their centroids, and that of their middles.
#[inline(always)]
fn ends<S: Simd>(simd: S, [a, b, c, d, e, f, g, h]: [f32x8<S>; BLOCK]) -> [f32x8<S>; 2] {
    let (a, b, c, d) = (a.split().1, b.split().1, c.split().1, d.split().1);
    let (e, f, g, h) = (e.split().1, f.split().1, g.split().1, h.split().1);
    let [centroids, middles] = last_two([a, b, c, d]);
    let [centroids2, middles2] = last_two([e, f, g, h]);
    [simd.combine_f32x4(centroids, centroids2), simd.combine_f32x4(middles, middles2)]
}

/// The last of eight numbers, eight times.
#[inline(always)]
fn last<S: Simd>(simd: S, of: f32x8<S>) -> f32x8<S> {
    let four = of.split().1;
    let two = four.zip_high(four);
    let one = two.zip_high(two);
    simd.combine_f32x4(one, one)
}

impl Screen {
    /// What rounding can do to half the square of a distance of at most this, Å².
    pub(super) fn margin(&self, distance: f32) -> f32 {
        let far = self.extent;
        (far * far + far * distance.max(1.0) + 1.0) * (64.0 / (1u32 << 24) as f32)
    }

    /// Fills it with what could mislead, and forgets what it knows.
    pub(in crate::model::protein) fn poison(&mut self) {
        let nonsense = Block { middles: [[0.0; BLOCK]; 4], sides: [[f32::NAN; BLOCK]; 4] };
        self.blocks.fill(nonsense);
        self.atoms.fill(Atoms([[0.0; BLOCK]; 4]));
        self.balls.fill([[f32::NAN; BLOCK]; 5]);
        (self.reach, self.alpha_reach, self.extent) = (f32::NAN, f32::NAN, f32::NAN);
        self.near_blocks.iter_mut().for_each(List::poison);
        self.tiles.poison();
        self.totals.fill([[f32::NAN; SITES]; 3]);
        self.origin.fill(f64::NAN);
        self.known = None;
        self.suspects.fill((u32::MAX, u32::MAX));
    }

    /// Takes a conformation; false if it is none, or too large for single precision. Residues before `from` are as
    /// when the last one was taken.
    #[inline(always)]
    pub(super) fn take<S: Simd>(&mut self, simd: S, placed: &Placed, from: usize) -> bool {
        let len = placed.len();
        let count = len.div_ceil(BLOCK);
        if len == 0 || len > usize::from(u16::MAX) {
            return false;
        }
        let nothing = [[0.0; BLOCK]; 4];
        self.blocks.resize(count, Block { middles: nothing, sides: nothing });
        self.atoms.resize(count * BLOCK, Atoms(nothing));
        self.balls.resize(count.div_ceil(BLOCK), [[0.0; BLOCK]; 5]);
        self.totals.resize(count, [[0.0; SITES]; 3]);
        let from = from / BLOCK;
        if from == 0 {
            self.origin = placed.at(Site::CA, len / 2);
        }
        let origin = self.origin;
        let number = |axis: f64| f64x4::splat(simd, axis);
        let origin = [number(origin.x), number(origin.y), number(origin.z)];
        let zero = f32x8::splat(simd, 0.0);
        let (mut reach, mut extent, mut sum) = (zero, zero, zero);
        if let Some(before) = from.checked_sub(1) {
            let before = &self.totals[before];
            reach = f32x8::load_array_ref(simd, &before[0]);
            extent = f32x8::load_array_ref(simd, &before[1]);
            sum = f32x8::load_array_ref(simd, &before[2]);
        }
        for number in from..count {
            let atoms = &mut self.atoms[number * BLOCK..][..BLOCK];
            let [mut xs, mut ys, mut zs] = [[zero; BLOCK]; 3];
            for (lane, atoms) in atoms.iter_mut().enumerate() {
                // Behind the end of the chain is the last residue.
                let row = &placed.rows[(number * BLOCK + lane).min(len - 1)];
                let sites = Eight::of_row(simd, row, &origin);
                sites.store(&mut atoms.0);
                let middle = [last(simd, sites.x), last(simd, sites.y), last(simd, sites.z)];
                reach = reach.max(sites.squares(middle));
                extent = extent.max(sites.half);
                // A maximum may pass over what is no number; a sum does not.
                sum += sites.half;
                (xs[lane], ys[lane], zs[lane]) = (sites.x, sites.y, sites.z);
            }
            let totals = &mut self.totals[number];
            reach.store_array(&mut totals[0]);
            extent.store_array(&mut totals[1]);
            sum.store_array(&mut totals[2]);
            let [side_x, middle_x] = ends(simd, xs);
            let [side_y, middle_y] = ends(simd, ys);
            let [side_z, middle_z] = ends(simd, zs);
            let middle = Eight::new(simd, middle_x, middle_y, middle_z);
            let side = Eight::new(simd, side_x, side_y, side_z);

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
        let squares = reach.to_array();
        self.reach =
            squares[..BACKBONE].iter().fold(0.0, |most: f32, square| most.max(*square)).sqrt();
        self.alpha_reach = squares[Site::CA as usize].sqrt();
        self.extent = (2.0 * extent.reduce_max()).sqrt();
        sum.reduce_sum() < LARGEST
    }
}
