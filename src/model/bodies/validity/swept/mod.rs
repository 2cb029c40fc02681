//! Continuous collision detection: whether a whole motion is free, in one recursion over two trees of oriented
//! bounding boxes (OBBs) and over time.
//!
//! A chord is a stretch [t₀, t₁] of the motion in which every point is thought to go straight from its position at
//! t₀ to that at t₁. In truth it leaves that line by at most (t₁ − t₀)²/8 times a bound on its second derivative. So
//! the extent of a moving box along a standing axis, and that of a standing box along an axis that moves with the
//! body, are linear in time up to that error, and each such separating axis excludes the times at which its gap
//! is positive. Where no time is left, all that the two boxes hold is apart during the whole chord.
//! `docs/validity.md` says it in full.

mod ball;
mod chord;
mod clip;
mod clock;
mod contact;
mod room;
mod search;
mod span;

pub(super) use clock::{Clock, Timeline};
pub(super) use room::{Walls, stays_inside};

use super::meet::Meeting;
use super::work::Work;
use crate::lanes::with_widest_lanes;
use crate::model::bodies::robot::{Drive, Rates};
use parry3d_f64::math::Vector;
use search::Sweep;
use span::{SampleRange, Span};

/// A chord is halved while its points may leave their straight lines by more than this share of the radius of the
/// larger of the two boxes.
const BEND: f64 = 0.01;

#[cfg(test)]
mod tests;

/// Nodes of the standing tree, each with the stretch of time in which the moving box at hand may meet it.
type Open = Vec<(u32, Span)>;

/// A node of the standing tree that a child of the moving box at hand may meet, and when.
#[derive(Clone, Copy, Debug)]
struct NearChild {
    /// Which of the children, from 0.
    child: u32,
    /// The node of the standing tree.
    still: u32,
    span: Span,
}

/// Memory for the recursion. The lists are stacks: each level works above what the levels before it left.
#[derive(Clone, Debug, Default)]
pub(super) struct Stacks {
    /// Nodes that are still to be tested against the next moving box.
    open: Open,
    /// Nodes that no axis separates from the moving box during their whole time.
    near: Open,
    /// Nodes that are to be tested against the same box over shorter chords.
    halves: Open,
    /// Nodes that are to be tested against the children of the box.
    children: Open,
    /// Nodes that no axis separates from a child of the box.
    found: Vec<NearChild>,
    /// Pairs of nodes, for tests at a single sample.
    pub pairs: Vec<(u32, u32)>,
    /// Of the bounds on the motion of a link: the links on the way down to it.
    pub descent: Vec<usize>,
    /// What the joints between the two links of a pair add to velocities; of links whose velocities are not constant.
    pub drives: Vec<Drive>,
    /// For the test of the bounds: nodes of the moving tree, and the samples between which they are to be tested.
    inside: Vec<(u32, SampleRange)>,
    /// A bit for each of the last 32 searches, set where the motion was blocked.
    blocked: u32,
    pub work: Work,
}

impl Stacks {
    /// Fills the memory with rubbish, see [`ModelScratch::poison`](crate::model::ModelScratch::poison).
    pub fn poison(&mut self, rubbish: u64) {
        let span = Span { from: 0.0, to: rubbish as f32 };
        let entry = (u32::MAX, span);
        self.open = vec![entry; rubbish as usize % 3];
        self.near = vec![entry; rubbish as usize % 7];
        self.halves = vec![entry; rubbish as usize % 5];
        self.children = vec![entry; rubbish as usize % 2];
        self.found = vec![NearChild { child: 7, still: u32::MAX, span }; rubbish as usize % 4];
        self.pairs = vec![(u32::MAX, 7); rubbish as usize % 3];
        self.descent = vec![usize::MAX; rubbish as usize % 4];
        let drive =
            Drive { parent: Some(7), origin: Vector::ONE, turn: Vector::ONE, slide: Vector::ONE };
        self.drives = vec![drive; rubbish as usize % 3];
        self.inside = vec![(u32::MAX, SampleRange { from: 7, to: rubbish }); rubbish as usize % 6];
        self.blocked = rubbish as u32;
    }
}

/// What a search is to prove of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asks {
    /// That at every sample, both ends included, the surfaces of the two groups are farther apart than half a step
    /// can move a point of the moving one. They are then apart at all times.
    AllTimes,
    /// That no surfaces meet at the samples between the ends.
    SampleRange,
}

impl Asks {
    /// Whether any time within a span matters to the question.
    #[inline(always)]
    fn about(self, span: Span, last: u64) -> bool {
        self == Asks::AllTimes || span.holds_any(last)
    }
}

/// What a search has found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Finds {
    /// The motion is as [`Asks`] demands.
    Free,
    /// Some surfaces come too near each other.
    Near,
    /// Surfaces meet at a sample between the ends.
    Meets,
}

/// Searches a motion for contacts between two groups of bodies.
pub(super) fn find<'a>(
    meeting: Meeting<'a>,
    rates: Rates,
    asks: Asks,
    clock: &mut Clock<'a>,
    stacks: &mut Stacks,
) -> Finds {
    with_widest_lanes!(meeting.lanes, simd => Sweep::new(simd, meeting, rates, asks, clock, stacks).finds())
}
