//! The ways of points during a part of a motion, as a segment's frame sees them.
//!
//! Over a part of length h each way is a cubic, by positions and velocities at both ends, and what it may leave that
//! cubic by: h⁴/384 · max |x⁗| (Hermite interpolation; J. Stoer, R. Bulirsch, *Introduction to Numerical Analysis*, §2.1.5).
//! `docs/protein-motions.md` derives the bound on the fourth derivative.

use super::chain::{Chain, Pairs, Segment};
use super::cubic::{Cubic, hermite};
use super::sample::{Frame, Sample};
use super::straight::Straight;

/// A part of a motion: the times of its ends, and the chain there.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub length: f64,
    pub from: &'a Sample,
    pub to: &'a Sample,
}

/// The way of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub cubic: Cubic,
    /// A bound on its fourth derivative by the time of the whole motion, Å.
    pub fourth: f64,
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

/// The cubic of one point over a part.
pub(super) fn cubic(part: &Part, [from, to]: [&Frame; 2], point: usize) -> Cubic {
    let (from, to) = (from.sees(&part.from.points[point]), to.sees(&part.to.points[point]));
    hermite(from.at, from.velocity * part.length, to.at, to.velocity * part.length)
}

/// Finds the ways of all points of a segment; `ways` has a place for every point of the chain.
///
/// No side of the segment's frame may turn by more than [`TURN_MAX`] during the part.
pub(super) fn find(
    chain: &Chain,
    segment: &Segment,
    motion: &Straight,
    part: &Part,
    ways: &mut [Way],
) {
    let frames = [part.from, part.to].map(|sample| sample.frame(segment.frame));
    let middle = motion.sums[chain.links[segment.frame].before[0]];
    let eighth = part.length * part.length / 8.0;
    // One side of the frame after the other. Of a residue, the torsions that come first are nearer to the frame.
    let mut side = |residues: &mut dyn Iterator<Item = usize>, order: [usize; 3]| {
        // Sums over the torsions that were passed: how far the Cα on the axis is from the origin at most, times by how much
        // the second (fourth) power of the turn grew with the torsion.
        let (mut second, mut fourth) = (0.0, 0.0);
        let mut put = |point: usize, turn: f64, second: f64, fourth: f64| {
            let cubic = cubic(part, frames, point);
            let square = turn * turn;
            let ends = cubic[0].norm_squared().max(cubic[3].norm_squared()).sqrt();
            // The point leaves its chord by h²/8 times its second derivative, whose levers are at most the point's
            // distance from the origin and the axis' added.
            let distance = (ends + eighth * second) / (1.0 - eighth * square);
            ways[point] = Way { cubic, fourth: distance * (square * square) + fourth };
            distance
        };
        for residue in residues {
            let turns =
                order.map(|which| (motion.sums[chain.links[residue].before[which]] - middle).abs());
            let [s0, s1, s2] = turns.map(|turn| turn * turn);
            let distance = put(residue, turns[0], second, fourth);
            second += distance * (s1 - s0);
            fourth += distance * (s1 * s1 - s0 * s0);
            if let Some(point) = chain.side_chain(residue) {
                put(point, turns[1], second, fourth);
            }
            second += distance * (s2 - s1);
            fourth += distance * (s2 * s2 - s1 * s1);
        }
    };
    side(&mut (segment.frame..segment.residues.end), [0, 1, 2]);
    if segment.pairs != Pairs::Obstacles {
        side(&mut (segment.residues.start..segment.frame).rev(), [2, 1, 0]);
    }
}
