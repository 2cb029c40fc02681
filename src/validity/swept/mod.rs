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

pub(super) use clip::misses;
pub(super) use clock::{Clock, Timeline};
pub(super) use room::{Walls, stays_inside};

use super::frame::Frame;
use super::meet::Meeting;
use super::tree::Tree;
use super::work::Work;
use crate::robot::Rates;
use clip::{Span, SweptBall, SweptBox};

/// A chord is halved while its points leave it by more than this share of the larger box.
const BEND: f64 = 0.01;
/// After so many tests of boxes without an answer the whole robot is looked at where it stands at one sample,
/// and each time after so many times more.
const PATIENCE: u32 = 32;
/// Where of the last 32 searches so many found something in the way, the first look comes after so many tests.
const OFTEN: (u32, u32) = (14, 2);

#[cfg(test)]
mod tests;

/// Nodes of the tree that stands still, each with the samples at which it may be met.
type Open = Vec<(u32, Span)>;

/// Memory for the recursion.
#[derive(Clone, Debug, Default)]
pub(super) struct Stacks {
    /// To be tested against the box at hand.
    open: Open,
    /// To be tested against the same box over shorter chords.
    halves: Open,
    /// To be tested against the children of the box.
    children: Open,
    pub pairs: Vec<(u32, u32)>,
    /// A bit for each of the last searches, set where something was in the way.
    blocked: u32,
    pub work: Work,
}

impl Stacks {
    /// Rubbish, see [`Scratch::poison`](crate::validity::Scratch::poison).
    pub fn poison(&mut self, rubbish: u64) {
        let entry = (u32::MAX, Span { from: 0, to: rubbish });
        self.open = vec![entry; rubbish as usize % 3];
        self.halves = vec![entry; rubbish as usize % 5];
        self.children = vec![entry; rubbish as usize % 2];
        self.pairs = vec![(u32::MAX, 7); rubbish as usize % 3];
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

/// Two groups during a motion.
pub(super) struct Sweep<'a, 'c> {
    meeting: Meeting<'a>,
    rates: Rates,
    asks: Asks,
    clock: &'c mut Clock<'a>,
    stacks: &'c mut Stacks,
    /// The time in which the tolerance is used up: that of half a step, or none.
    spare: f64,
    /// Surfaces were found to meet at a sample between the ends.
    meets: bool,
    /// Tests of boxes until a sample is looked at.
    patience: u32,
    /// The samples looked at so far, halving the gaps between them.
    looks: u64,
}

impl<'a, 'c> Sweep<'a, 'c> {
    pub fn new(
        meeting: Meeting<'a>,
        rates: Rates,
        asks: Asks,
        clock: &'c mut Clock<'a>,
        stacks: &'c mut Stacks,
    ) -> Sweep<'a, 'c> {
        let half_step = 0.5 / clock.samples as f64;
        let spare = if asks == Asks::Samples { 0.0 } else { half_step };
        let (often, few) = OFTEN;
        let patience = if stacks.blocked.count_ones() >= often { few } else { PATIENCE };
        Sweep { meeting, rates, asks, clock, stacks, spare, meets: false, patience, looks: 0 }
    }

    /// Whether it is as asked.
    pub fn finds(&mut self) -> Finds {
        let samples = self.clock.samples;
        let asked = match self.asks {
            Asks::AllTimes => Span { from: 0, to: samples },
            _ if samples < 2 => return Finds::Free,
            _ => Span { from: 1, to: samples - 1 },
        };
        self.stacks.halves.clear();
        self.stacks.children.clear();
        let Some(mut chord) = self.near_the_ball(asked) else { return Finds::Free };
        if 2 * chord.length() > samples {
            chord = Span { from: 0, to: samples };
        }
        let swept = self.swept(0, chord);
        let blocked = self.blocked(&swept, 0);
        self.stacks.blocked = self.stacks.blocked << 1 | u32::from(blocked);
        match (blocked, self.meets) {
            (false, _) => Finds::Free,
            (true, false) => Finds::Near,
            (true, true) => Finds::Meets,
        }
    }

    /// Opens the nodes, no larger than the ball around what moves, that the ball may meet, and says which
    /// samples they span.
    fn near_the_ball(&mut self, asked: Span) -> Option<Span> {
        let Meeting { mover, still, slack, grain, .. } = self.meeting;
        let frames = [self.frame(0), self.frame(self.clock.samples)];
        let space = &mover.tree.nodes[0].space;
        let ball = SweptBall::new(space, &frames, &self.rates, (self.spare, slack, grain));
        let Tree { nodes, boxes, .. } = &still.tree;
        let Stacks { open, pairs: todo, work, .. } = &mut *self.stacks;
        open.clear();
        todo.clear();
        todo.push((0, 0));
        let mut whole: Option<Span> = None;
        while let Some((at, _)) = todo.pop() {
            let node = &nodes[at as usize];
            work.count(|work| work.balls += 1);
            let Some(clip) = ball.meets(&boxes[at as usize]) else { continue };
            if node.space.radius > space.radius && !node.is_leaf() {
                todo.push((node.left, 0));
                todo.push((node.left + 1, 0));
            } else if let Some(span) = clip.samples(Span { from: 0, to: self.clock.samples }, asked)
            {
                open.push((at, span));
                let Span { from, to } = whole.unwrap_or(span);
                whole = Some(Span { from: from.min(span.from), to: to.max(span.to) });
            }
        }
        whole
    }

    fn step(&self) -> f64 {
        1.0 / self.clock.samples as f64
    }

    fn frame(&mut self, sample: u64) -> Frame {
        let Meeting { mover_link, still_link, .. } = self.meeting;
        self.clock.at(sample).seen(mover_link, still_link)
    }

    fn swept(&mut self, node: u32, chord: Span) -> SweptBox {
        self.stacks.work.count(|work| work.placed += 1);
        let frames = [self.frame(chord.from), self.frame(chord.to)];
        let Tree { nodes, boxes, .. } = &self.meeting.mover.tree;
        let of = (node, &nodes[node as usize].space, &boxes[node as usize]);
        let time = chord.length() as f64 * self.step();
        let tolerances = (self.spare, self.meeting.slack, self.meeting.grain);
        SweptBox::new(of, (chord, time), [&frames[0], &frames[1]], &self.rates, tolerances)
    }

    /// Whether anything in the swept box comes near anything below the nodes that are open from `base`
    /// on, at a sample of theirs.
    fn blocked(&mut self, swept: &SweptBox, base: usize) -> bool {
        let Meeting { mover, still: other, .. } = self.meeting;
        let moving = &mover.tree.nodes[swept.node as usize];
        let (halves, children) = (self.stacks.halves.len(), self.stacks.children.len());
        while self.stacks.open.len() > base {
            let (still, span) = self.stacks.open.pop().expect("more than the base");
            self.patience -= 1;
            if self.patience == 0 && self.meets_at_a_sample() {
                return true;
            }
            self.stacks.work.count(|work| work.boxes += 1);
            let Some(span) = swept.meets(&other.tree.boxes[still as usize], span) else { continue };
            self.stacks.work.count(|work| work.near += 1);
            let node = &other.tree.nodes[still as usize];
            if moving.is_leaf() && node.is_leaf() {
                if self.touches(moving, node, span) {
                    return true;
                }
                continue;
            }
            let larger = moving.space.radius.max(node.space.radius);
            if swept.chord.length() > 1 && swept.bend > BEND * larger {
                self.stacks.halves.push((still, span));
            } else if !moving.is_leaf()
                && (node.is_leaf() || moving.space.radius > node.space.radius)
            {
                self.stacks.children.push((still, span));
            } else {
                self.stacks.open.push((node.left + 1, span));
                self.stacks.open.push((node.left, span));
            }
        }
        if self.stacks.halves.len() > halves && self.halves_blocked(swept, halves) {
            return true;
        }
        if self.stacks.children.len() > children {
            for child in [moving.left, moving.left + 1] {
                let swept = self.swept(child, swept.chord);
                let Stacks { open, children: list, .. } = &mut *self.stacks;
                open.extend_from_slice(&list[children..]);
                if self.blocked(&swept, base) {
                    return true;
                }
            }
            self.stacks.children.truncate(children);
        }
        false
    }

    /// [`Sweep::blocked`] over shorter chords, of the nodes in the list of halves from `list` on.
    fn halves_blocked(&mut self, swept: &SweptBox, list: usize) -> bool {
        let chord = swept.chord;
        let spans = self.stacks.halves[list..].iter().map(|(_, span)| *span);
        let whole = spans
            .reduce(|all, span| Span { from: all.from.min(span.from), to: all.to.max(span.to) });
        let whole = whole.unwrap_or(chord);
        let middle = chord.from + chord.length() / 2;
        // What is left, if that is less than half; else one half after the other.
        let (parts, count) = if 2 * whole.length() <= chord.length() {
            ([(whole, whole), (whole, whole)], 1)
        } else {
            let (first, second) = (Span { to: middle, ..chord }, Span { from: middle, ..chord });
            ([(first, first), (second, Span { from: middle + 1, ..chord })], 2)
        };
        for (chord, asked) in &parts[..count] {
            let base = self.stacks.open.len();
            let Stacks { open, halves, .. } = &mut *self.stacks;
            open.extend(halves[list..].iter().filter_map(|(still, span)| {
                let span = Span { from: span.from.max(asked.from), to: span.to.min(asked.to) };
                (span.from <= span.to).then_some((*still, span))
            }));
            if open.len() > base {
                let swept = self.swept(swept.node, *chord);
                if self.blocked(&swept, base) {
                    return true;
                }
            }
        }
        self.stacks.halves.truncate(list);
        false
    }

    /// Whether surfaces meet at one sample, the next of those that halve the gaps between the ones before.
    fn meets_at_a_sample(&mut self) -> bool {
        self.looks += 1;
        // 1/2, 1/4, 3/4, 1/8, …: what is in the way is often so half way.
        let pieces = (self.looks + 1).next_power_of_two();
        let odd = 2 * (self.looks - pieces / 2) + 1;
        self.patience = PATIENCE << self.looks.min(16);
        if pieces >= self.clock.samples {
            return false;
        }
        let sample = self.clock.samples / pieces * odd;
        self.stacks.work.count(|work| work.looks += 1);
        self.meets = self.meeting.surfaces_meet(self.clock.at(sample), &mut self.stacks.pairs);
        self.meets
    }
}
