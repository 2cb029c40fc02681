//! Whether a whole motion is free, in one recursion over two trees and time.
//!
//! Over a chord of the motion a point leaves the straight line by at most an eighth of the chord's time,
//! squared, times a bound on its second derivative. So the extents of a moving box along an axis that
//! stands still, and of a box that stands still along an axis that moves with the body, are linear up to
//! that error, and every axis clips the times at which the two can meet. Where nothing is left, all that
//! the boxes hold is apart during the whole chord. `docs/validity.md` says it in full.

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
use crate::lanes::with_lanes;
use crate::model::bodies::robot::Rates;
use search::Sweep;
use span::{Samples, Span};

/// A chord is halved while its points leave it by more than this share of the larger box.
const BEND: f64 = 0.01;

#[cfg(test)]
mod tests;

/// Nodes of the tree that stands still, each with the time in which it may be met.
type Open = Vec<(u32, Span)>;

/// Memory for the recursion.
#[derive(Clone, Debug, Default)]
pub(super) struct Stacks {
    /// To be tested against the next box.
    open: Open,
    /// Not told apart from it.
    near: Open,
    /// To be tested against the same box over shorter chords.
    halves: Open,
    /// To be tested against the children of the box.
    children: Open,
    /// Not told apart from one of these, the first, the second, …
    found: Vec<(u32, u32, Span)>,
    pub pairs: Vec<(u32, u32)>,
    /// Of the bounds on the motion of a link: the links on the way down to it.
    pub descent: Vec<usize>,
    /// Of the bounds: nodes, and when they are to be looked at.
    inside: Vec<(u32, Samples)>,
    /// A bit for each of the last searches, set where something was in the way.
    blocked: u32,
    pub work: Work,
}

impl Stacks {
    /// Rubbish, see [`Scratch::poison`](crate::model::bodies::validity::Scratch::poison).
    pub fn poison(&mut self, rubbish: u64) {
        let span = Span { from: 0.0, to: rubbish as f32 };
        let entry = (u32::MAX, span);
        self.open = vec![entry; rubbish as usize % 3];
        self.near = vec![entry; rubbish as usize % 7];
        self.halves = vec![entry; rubbish as usize % 5];
        self.children = vec![entry; rubbish as usize % 2];
        self.found = vec![(7, u32::MAX, span); rubbish as usize % 4];
        self.pairs = vec![(u32::MAX, 7); rubbish as usize % 3];
        self.descent = vec![usize::MAX; rubbish as usize % 4];
        self.inside = vec![(u32::MAX, Samples { from: 7, to: rubbish }); rubbish as usize % 6];
        self.blocked = rubbish as u32;
    }
}

/// What is asked of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asks {
    /// That at every sample, the ends among them, every two surfaces are farther apart than half a
    /// step moves the points of the one: they are then apart at all times.
    AllTimes,
    /// That no surfaces meet at the samples between the ends.
    Samples,
}

impl Asks {
    /// Whether it is about any time within a span.
    #[inline(always)]
    fn about(self, span: Span, last: u64) -> bool {
        self == Asks::AllTimes || span.holds_any(last)
    }
}

/// What is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Finds {
    /// It is as asked.
    Free,
    /// Some surfaces come too near.
    Near,
    /// Surfaces meet at a sample between the ends.
    Meets,
}

/// What is found of two groups during a motion.
pub(super) fn find<'a>(
    meeting: Meeting<'a>,
    rates: Rates,
    asks: Asks,
    clock: &mut Clock<'a>,
    stacks: &mut Stacks,
) -> Finds {
    with_lanes!(meeting.lanes, simd => Sweep::new(simd, meeting, rates, asks, clock, stacks).finds())
}
