//! The ways of points during a part of a motion, as a segment's frame sees them.
//!
//! Over a part of length h each way is a cubic, by positions and velocities at both ends, and what it may leave that
//! cubic by: h⁴/384 · max |x⁗| (Hermite interpolation; J. Stoer, R. Bulirsch, *Introduction to Numerical Analysis*, §2.1.5).
//! `docs/protein-motions.md` derives the bound on the fourth derivative.

use super::chain::{Chain, Pairs, Segment};
use super::cubic::Cubic;
use super::points::{self, Four, Points, dot, minus, plus, times};
use super::sample::{Frame, Sample};
use super::straight::Straight;
use crate::lanes::{Lanes, with_lanes};
use fearless_simd::f64x4;
use fearless_simd::prelude::*;
use std::ops::Range;

/// A part of a motion: the times of its ends, and the chain there.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub length: f64,
    pub from: &'a Sample,
    pub to: &'a Sample,
}

/// The ways of a chain's points, a place for each.
#[derive(Clone, Debug, Default)]
pub(super) struct Ways {
    /// The cubics' control points, Å.
    controls: [Points; 4],
    /// The middles between the cubics' ends.
    pub centres: Points,
    /// How far the ways come from these, at most, Å.
    pub radii: Vec<f64>,
    /// How far the farther end is from the frame's origin, Å.
    ends: Vec<f64>,
    /// Bounds on the ways' fourth derivatives by the time of the whole motion, Å.
    fourths: Vec<f64>,
}

impl Ways {
    /// Makes room for a chain's points.
    pub fn resize(&mut self, count: usize) {
        self.controls.iter_mut().for_each(|points| points.resize(count));
        self.centres.resize(count);
        [&mut self.radii, &mut self.ends, &mut self.fourths]
            .into_iter()
            .for_each(|numbers| points::resize(numbers, count));
    }

    /// The cubic of a point.
    pub fn cubic(&self, point: usize) -> Cubic {
        [0, 1, 2, 3].map(|control| self.controls[control].at(point))
    }

    /// The bound on the fourth derivative of a point's way.
    pub fn fourth(&self, point: usize) -> f64 {
        self.fourths[point]
    }

    /// Fills all with a number.
    pub fn poison(&mut self, rubbish: f64) {
        self.controls.iter_mut().for_each(|points| points.fill(rubbish));
        self.centres.fill(rubbish);
        [&mut self.radii, &mut self.ends, &mut self.fourths]
            .into_iter()
            .for_each(|numbers| numbers.fill(rubbish));
    }

    /// The cubics of some points over a part, and of up to three behind them.
    #[inline(always)]
    fn cubics<S: Simd>(&mut self, simd: S, part: &Part, frames: [&Frame; 2], which: Range<usize>) {
        let [from, to] = [frames[0].in_lanes(simd), frames[1].in_lanes(simd)];
        let third = f64x4::splat(simd, part.length / 3.0);
        let half = f64x4::splat(simd, 0.5);
        for point in which.step_by(points::LANES) {
            let [first, leaving] = from
                .see(&part.from.points.load(simd, point), &part.from.velocities.load(simd, point));
            let [last, arriving] =
                to.see(&part.to.points.load(simd, point), &part.to.velocities.load(simd, point));
            let second = plus(&first, &times(&leaving, third));
            let next = minus(&last, &times(&arriving, third));
            let centre = times(&plus(&first, &last), half);
            let reach = square_distance(&last, &centre)
                .max(square_distance(&second, &centre))
                .max(square_distance(&next, &centre))
                .sqrt();
            let ends = dot(&first, &first).max(dot(&last, &last)).sqrt();
            self.controls[0].store(point, &first);
            self.controls[1].store(point, &second);
            self.controls[2].store(point, &next);
            self.controls[3].store(point, &last);
            self.centres.store(point, &centre);
            points::store(&mut self.radii, point, reach);
            points::store(&mut self.ends, point, ends);
        }
    }

    /// The same of a single point: its cubic.
    pub fn cubic_of(
        &mut self,
        lanes: Lanes,
        part: &Part,
        frames: [&Frame; 2],
        point: usize,
    ) -> Cubic {
        with_lanes!(lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.cubics(simd, part, frames, point..point + 1),
        ));
        self.cubic(point)
    }
}

/// By how much a way with this bound leaves its cubic, at most, over a part of this length, Å.
pub(super) fn leaves_cubic(fourth: f64, length: f64) -> f64 {
    let square = length * length;
    fourth * (square * square / 384.0)
}

/// The largest turn, of all torsions on one side of a frame during a part, for which ways are bounded, in radians.
pub(super) const TURN_MAX: f64 = 1.25;

/// The larger of what the torsions on either side of a segment's frame turn by, in radians.
pub(super) fn turn(chain: &Chain, segment: &Segment, motion: &Straight) -> f64 {
    let sum = |residue: usize, which: usize| motion.sums[chain.links[residue].before[which]];
    let (first, last) = (segment.residues.start, segment.residues.end - 1);
    let middle = sum(segment.frame, 0);
    (middle - sum(first, 0)).max(sum(last, 2) - middle)
}

/// Finds the ways of all points of a segment. What stands for other points is anything.
///
/// No side of the segment's frame may turn by more than [`TURN_MAX`] during the part.
pub(super) fn find(
    lanes: Lanes,
    chain: &Chain,
    segment: &Segment,
    motion: &Straight,
    part: &Part,
    ways: &mut Ways,
) {
    let frames = [part.from, part.to].map(|sample| sample.frame(segment.frame));
    let residues = &segment.residues;
    with_lanes!(lanes, simd => simd.vectorize(
        #[inline(always)]
        || {
            ways.cubics(simd, part, frames, residues.clone());
            ways.cubics(simd, part, frames, chain.side_chains_of(residues));
        },
    ));
    bound(chain, segment, motion, part.length, ways);
}

#[inline(always)]
fn square_distance<S: Simd>(a: &Four<S>, b: &Four<S>) -> f64x4<S> {
    let between = minus(a, b);
    dot(&between, &between)
}

/// Bounds the fourth derivatives, and so how far ways come.
fn bound(chain: &Chain, segment: &Segment, motion: &Straight, length: f64, ways: &mut Ways) {
    let middle = motion.sums[chain.links[segment.frame].before[0]];
    let mut side = Side { chain, motion, length, middle, ways };
    // Of a residue, the torsions that come first are nearer to the frame.
    side.bound(segment.frame..segment.residues.end, [0, 1, 2]);
    if segment.pairs != Pairs::Obstacles {
        side.bound((segment.residues.start..segment.frame).rev(), [2, 1, 0]);
    }
}

/// What is on one side of a frame.
struct Side<'a> {
    chain: &'a Chain,
    motion: &'a Straight,
    length: f64,
    /// The sum of turns at the frame.
    middle: f64,
    ways: &'a mut Ways,
}

impl Side<'_> {
    /// Bounds the ways of the points of residues, the frame's neighbour first; `order` is that in which the places between
    /// torsions are passed.
    #[inline(always)]
    fn bound(&mut self, residues: impl Iterator<Item = usize>, order: [usize; 3]) {
        // Sums over the torsions that were passed: how far the Cα on the axis is from the origin at most, times by how much
        // the second (fourth) power of the turn grew with the torsion.
        let (mut second, mut fourth) = (0.0, 0.0);
        for residue in residues {
            let before = &self.chain.links[residue].before;
            let square = |place: usize| {
                let turn = self.motion.sums[before[order[place]]] - self.middle;
                turn * turn
            };
            let (s0, s1, s2) = (square(0), square(1), square(2));
            let distance = self.put(residue, s0, second, fourth);
            second += distance * (s1 - s0);
            fourth += distance * (s1 * s1 - s0 * s0);
            if let Some(point) = self.chain.side_chain(residue) {
                self.put(point, s1, second, fourth);
            }
            second += distance * (s2 - s1);
            fourth += distance * (s2 * s2 - s1 * s1);
        }
    }

    /// Bounds the way of one point, where the turn between it and the frame has this square. Returns a bound on its distance
    /// from the origin.
    #[inline(always)]
    fn put(&mut self, point: usize, square: f64, second: f64, fourth: f64) -> f64 {
        let eighth = self.length * self.length / 8.0;
        // The point leaves its chord by h²/8 times its second derivative, whose levers are at most the point's distance
        // from the origin and the axis' added. 1/(1 − x) is at most 1 + 1.25 x for x up to 0.2, and x is.
        let distance = (self.ways.ends[point] + eighth * second) * (1.0 + 1.25 * (eighth * square));
        let fourth = distance * (square * square) + fourth;
        self.ways.fourths[point] = fourth;
        self.ways.radii[point] += leaves_cubic(fourth, self.length) + self.chain.rounding;
        distance
    }
}
