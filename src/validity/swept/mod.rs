//! Whether a whole motion is free, in one recursion over two trees and time.
//!
//! Over a chord of the motion a point leaves the straight line by at most an eighth of the chord's time,
//! squared, times a bound on its second derivative. So the extents of a moving box along an axis that
//! stands still, and of a box that stands still along an axis that moves with the body, are linear up to
//! that error, and every axis clips the times at which the two can meet. Where nothing is left, all that
//! the boxes hold is apart during the whole chord. `docs/validity.md` says it in full.

mod clip;
mod clock;
mod contact;
mod room;
mod two;

pub(super) use clock::{Clock, Timeline};
pub(super) use room::{Walls, stays_inside};

use super::frame::Frame;
use super::meet::Meeting;
use crate::robot::Rates;
use clip::{Span, SweptBox};

/// A chord is halved while its points leave it by more than this share of the larger box.
const BEND: f64 = 0.02;

#[cfg(test)]
mod tests;

/// Memory for the recursion.
#[derive(Clone, Debug, Default)]
pub(super) struct Stacks {
    open: Vec<(u32, Span)>,
    pub pairs: Vec<(u32, u32)>,
}

/// Two groups during a motion.
pub(super) struct Sweep<'a, 'c> {
    pub meeting: Meeting<'a>,
    pub rates: Rates,
    pub clock: &'c mut Clock<'a>,
    pub stacks: &'c mut Stacks,
}

impl Sweep<'_, '_> {
    /// Whether at every sample, the ends among them, every two surfaces are farther apart than half a
    /// step moves the points of the one. They are then apart at all times.
    pub fn is_free(&mut self) -> bool {
        let whole = Span { from: 0, to: self.clock.samples };
        let swept = self.swept(0, whole);
        if swept.meets(&self.meeting.still.tree.nodes[0].space, whole).is_none() {
            return true;
        }
        // What is in the way is often so half way.
        let stance = self.clock.at(whole.to / 2);
        if self.meeting.surfaces_meet(stance, &mut self.stacks.pairs) {
            return false;
        }
        self.stacks.open.clear();
        !self.blocked(&swept, 0, whole)
    }

    fn step(&self) -> f64 {
        1.0 / self.clock.samples as f64
    }

    fn frame(&mut self, sample: u64) -> Frame {
        let Meeting { mover_link, still_link, .. } = self.meeting;
        self.clock.at(sample).seen(mover_link, still_link)
    }

    fn swept(&mut self, node: u32, chord: Span) -> SweptBox {
        let frames = [self.frame(chord.from), self.frame(chord.to)];
        let space = &self.meeting.mover.tree.nodes[node as usize].space;
        let (step, slack) = (self.step(), self.meeting.slack);
        SweptBox::new((node, space), chord, [&frames[0], &frames[1]], &self.rates, step, slack)
    }

    /// Whether anything in the swept box comes near anything below a node of the other tree at a sample
    /// of the span.
    fn blocked(&mut self, swept: &SweptBox, still: u32, span: Span) -> bool {
        let Meeting { mover, still: other, .. } = self.meeting;
        let moving = &mover.tree.nodes[swept.node as usize];
        let base = self.stacks.open.len();
        self.stacks.open.push((still, span));
        while self.stacks.open.len() > base {
            let (still, span) = self.stacks.open.pop().expect("more than the base");
            let node = &other.tree.nodes[still as usize];
            let Some(span) = swept.meets(&node.space, span) else { continue };
            if moving.is_leaf() && node.is_leaf() {
                if self.touches(moving, node, span) {
                    return true;
                }
                continue;
            }
            let larger = moving.space.radius.max(node.space.radius);
            if swept.chord.length() > 1 && swept.bend > BEND * larger {
                if self.halves_blocked(swept, still, span) {
                    return true;
                }
            } else if !moving.is_leaf()
                && (node.is_leaf() || moving.space.radius > node.space.radius)
            {
                for child in [moving.left, moving.left + 1] {
                    let swept = self.swept(child, swept.chord);
                    if self.blocked(&swept, still, span) {
                        return true;
                    }
                }
            } else {
                self.stacks.open.push((node.left + 1, span));
                self.stacks.open.push((node.left, span));
            }
        }
        false
    }

    /// [`Sweep::blocked`] over shorter chords.
    fn halves_blocked(&mut self, swept: &SweptBox, still: u32, span: Span) -> bool {
        let chord = swept.chord;
        if 2 * span.length() <= chord.length() {
            let swept = self.swept(swept.node, span);
            return self.blocked(&swept, still, span);
        }
        let middle = chord.from + chord.length() / 2;
        if span.from <= middle {
            let swept = self.swept(swept.node, Span { to: middle, ..chord });
            if self.blocked(&swept, still, Span { to: span.to.min(middle), ..span }) {
                return true;
            }
        }
        span.to > middle && {
            let swept = self.swept(swept.node, Span { from: middle, ..chord });
            self.blocked(&swept, still, Span { from: span.from.max(middle + 1), ..span })
        }
    }
}
