//! Continuous collision detection between two bounding-volume hierarchies: one recursion over both trees and
//! over the time of a motion.

use super::chord::{Chord, Course, SweptBoxes};
use super::clip::{MOMENT, Spans};
use super::clock::Clock;
use super::span::{SampleRange, Span};
use super::{Asks, BEND, Finds, NearChild, Stacks};
use crate::model::bodies::robot::Rates;
use crate::model::bodies::validity::frame::Frame;
use crate::model::bodies::validity::light::Eight;
use crate::model::bodies::validity::meet::Meeting;
use fearless_simd::Simd;

/// A search that has tested this many pairs of boxes without an answer checks one sample of the motion for
/// collisions, since a blocked motion is often refused sooner that way than by searching on. From one such check
/// to the next the number of tests grows by half.
const PATIENCE: f64 = 48.0;
/// When blocked motions are frequent: if at least this many of the last 32 searches ended blocked, the first
/// sample is checked after this many tests of boxes already, and there the whole group is checked instead of
/// the two nodes that the search has come to.
const OFTEN: (u32, f64) = (4, 2.0);

/// Where a search has come to: a node of the moving tree and one of the standing tree, and when the two may meet.
#[derive(Clone, Copy)]
struct NearPair {
    node: u32,
    still: u32,
    span: Span,
}

/// The search for contacts between two groups of bodies during a motion.
pub(super) struct Sweep<'a, 'c, S: Simd> {
    pub(super) simd: S,
    pub(super) meeting: Meeting<'a>,
    pub(super) course: Course,
    pub(super) asks: Asks,
    pub(super) asked: SampleRange,
    pub(super) clock: &'c mut Clock<'a>,
    pub(super) stacks: &'c mut Stacks,
    /// Whether surfaces were found to meet at a sample strictly between the ends of the motion.
    pub(super) meets: bool,
    /// Whether the next check of a sample is of the whole groups.
    whole: bool,
    /// Tests of boxes that are left until a sample is checked.
    patience: f64,
    /// Tests of boxes from that check to the next one.
    rest: f64,
}

impl<'a, 'c, S: Simd> Sweep<'a, 'c, S> {
    pub fn new(
        simd: S,
        meeting: Meeting<'a>,
        rates: Rates,
        asks: Asks,
        clock: &'c mut Clock<'a>,
        stacks: &'c mut Stacks,
    ) -> Sweep<'a, 'c, S> {
        let half_step = 0.5 / clock.samples as f64;
        let spare = if asks == Asks::SampleRange { 0.0 } else { half_step };
        let whole = stacks.blocked.count_ones() >= OFTEN.0;
        let patience = if whole { OFTEN.1 } else { PATIENCE };
        let course = Course::new(rates, spare, &meeting);
        let samples = clock.samples;
        let asked = match asks {
            Asks::AllTimes => SampleRange { from: 0, to: samples },
            Asks::SampleRange => SampleRange { from: 1, to: samples - 1 },
        };
        let (meets, rest) = (false, PATIENCE);
        Sweep { simd, meeting, course, asks, asked, clock, stacks, meets, whole, patience, rest }
    }

    /// Whether the motion is as [`Asks`] demands.
    pub fn finds(&mut self) -> Finds {
        let last = self.clock.samples;
        if self.asked.from > self.asked.to {
            return Finds::Free;
        }
        self.stacks.near.clear();
        self.stacks.halves.clear();
        self.stacks.children.clear();
        self.stacks.found.clear();
        let Some(span) = self.near_the_ball() else { return Finds::Free };
        let part = SampleRange::around(span, last);
        let all = 2 * part.length() > last;
        let samples = if all { SampleRange { from: 0, to: last } } else { part };
        let blocked = self.blocked(0, samples);
        self.stacks.blocked = self.stacks.blocked << 1 | u32::from(blocked);
        match (blocked, self.meets) {
            (false, _) => Finds::Free,
            (true, false) => Finds::Near,
            (true, true) => Finds::Meets,
        }
    }

    fn step(&self) -> f64 {
        1.0 / self.clock.samples as f64
    }

    pub(super) fn frame(&mut self, sample: u64) -> Frame {
        let Meeting { mover_link, still_link, .. } = self.meeting;
        self.clock.at(sample).seen(mover_link, still_link)
    }

    /// The frame of the moving tree's origin as seen from the standing tree's origin, at a sample.
    fn between_origins(&mut self, sample: u64) -> Frame {
        let frame = self.frame(sample);
        self.meeting.between_origins(&frame)
    }

    /// Whether anything in the box of the moving `node` comes near anything below the open nodes of the other
    /// tree, at a sample within the chord and within the time span of that open node.
    fn blocked(&mut self, node: u32, samples: SampleRange) -> bool {
        let simd = self.simd;
        let frames = [self.between_origins(samples.from), self.between_origins(samples.to)];
        let grain = self.meeting.grain([frames[0].shift, frames[1].shift]);
        let step = self.step();
        simd.vectorize(
            #[inline(always)]
            || {
                let frames = [&frames[0], &frames[1]];
                let chord = Chord::new(simd, &self.course, samples, step, frames, grain);
                self.stacks.work.count(|work| work.placed += 1);
                let own = Eight::same(simd, &self.meeting.mover.tree.boxes[node as usize]);
                let swept = SweptBoxes::new(simd, &self.course, &chord, &own);
                let base = self.stacks.near.len();
                self.find_near(node, &chord, &swept)
                    || self.comes_near(node, &chord, &swept, None, base)
            },
        )
    }

    /// Tests one moving box, which stands in every lane, against the open nodes, eight at a time; those that it
    /// may meet go to the list `near`. Returns whether a check of a sample on the way found that surfaces meet.
    #[inline(always)]
    fn find_near(&mut self, node: u32, chord: &Chord<S>, swept: &SweptBoxes<S>) -> bool {
        let simd = self.simd;
        let (asks, last) = (self.asks, self.clock.samples);
        let tree = &self.meeting.still.tree;
        let Stacks { open, near, work, .. } = &mut *self.stacks;
        let tests = open.len();
        for batch in open.chunks(8) {
            let end = batch.len() - 1;
            let [a, b, c, d] = [batch[0], batch[1.min(end)], batch[2.min(end)], batch[3.min(end)]];
            let [e, f, g, h] =
                [batch[4.min(end)], batch[5.min(end)], batch[6.min(end)], batch[7.min(end)]];
            let nodes = [a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0];
            let spans = Spans::new(simd, [a.1, b.1, c.1, d.1, e.1, f.1, g.1, h.1]);
            let met =
                swept.meets(simd, &Eight::new(simd, tree.gathered(&nodes)), chord.span, &spans);
            work.count(|work| work.tested(batch.len()));
            for (lane, span) in met.spans(batch.len()) {
                if asks.about(span, last) {
                    near.push((batch[lane].0, span));
                }
            }
        }
        let (still, span) = open.first().map_or((0, Span::ALL), |first| *first);
        open.clear();
        self.tires(tests, NearPair { node, still, span })
    }

    /// [`Sweep::blocked`] for the nodes of the list `near` from `base` on: nodes that the box of `node` may meet.
    /// `lane` says which of the eight boxes of `swept` it is, or that it stands in every lane.
    #[inline(always)]
    fn comes_near(
        &mut self,
        node: u32,
        chord: &Chord<S>,
        swept: &SweptBoxes<S>,
        lane: Option<usize>,
        base: usize,
    ) -> bool {
        let simd = self.simd;
        let (asks, last) = (self.asks, self.clock.samples);
        let Meeting { mover, still: other, .. } = self.meeting;
        let (own, other) = (&mover.tree, &other.tree);
        let (leaf, radius) = (own.is_leaf(node), own.boxes[node as usize].radius());
        let bend = swept.bend(lane.unwrap_or(0));
        let mut alone = None;
        let (halves, children) = (self.stacks.halves.len(), self.stacks.children.len());
        while self.stacks.near.len() > base {
            let (still, span) = self.stacks.near.pop().expect("more than the base");
            let (end, size) = (other.is_leaf(still), other.boxes[still as usize].radius());
            if leaf && end {
                if self.touches(node, still, span) {
                    return true;
                }
            } else if chord.samples.length() > 1 && bend > BEND as f32 * radius.max(size) {
                self.stacks.halves.push((still, span));
            } else if !leaf && (end || radius > size) {
                self.stacks.children.push((still, span));
            } else {
                let (nodes, boxes) = other.children(still);
                let boxes = Eight::load(simd, boxes);
                let swept = match (lane, &alone) {
                    (None, _) => swept,
                    (_, Some(alone)) => alone,
                    (Some(lane), None) => alone.insert(swept.only(simd, lane)),
                };
                let met = swept.meets(simd, &boxes, chord.span, &Spans::same(simd, span));
                let Stacks { near, work, .. } = &mut *self.stacks;
                work.count(|work| work.tested(nodes.len()));
                for (lane, span) in met.spans(nodes.len()) {
                    if asks.about(span, last) {
                        near.push((nodes[lane], span));
                    }
                }
                if self.tires(nodes.len(), NearPair { node, still, span }) {
                    return true;
                }
            }
        }
        if self.stacks.halves.len() > halves && self.halves_blocked(node, chord, halves) {
            return true;
        }
        self.stacks.children.len() > children && self.children_blocked(node, chord, children)
    }

    /// [`Sweep::blocked`] over shorter chords, for the nodes of the list `halves` from `list` on.
    #[inline(never)]
    fn halves_blocked(&mut self, node: u32, chord: &Chord<S>, list: usize) -> bool {
        let spans = self.stacks.halves[list..].iter().map(|(_, span)| *span);
        let whole = spans.reduce(Span::with).unwrap_or(chord.span);
        let last = self.clock.samples;
        let SampleRange { from, to } = chord.samples;
        let middle = from + (to - from) / 2;
        let part = SampleRange::around(whole, last);
        let part = SampleRange { from: part.from.max(from), to: part.to.min(to) };
        // One chord over the time that is left, where that is less than half; else one half after the other.
        let (parts, count) = if 2 * part.length() <= to - from {
            ([(part, whole); 2], 1)
        } else {
            let half = (middle as f64 / last as f64) as f32;
            let first = Span { to: half + MOMENT, ..chord.span };
            let second = Span { from: half - MOMENT, ..chord.span };
            let (first, second) = (
                (SampleRange { from, to: middle }, first),
                (SampleRange { from: middle, to }, second),
            );
            ([first, second], 2)
        };
        for (chord, asked) in &parts[..count] {
            let Stacks { open, halves, .. } = &mut *self.stacks;
            open.extend(halves[list..].iter().filter_map(|(still, span)| {
                let span = Span { from: span.from.max(asked.from), to: span.to.min(asked.to) };
                (span.from <= span.to).then_some((*still, span))
            }));
            if !open.is_empty() && self.blocked(node, *chord) {
                return true;
            }
        }
        self.stacks.halves.truncate(list);
        false
    }

    /// [`Sweep::blocked`] for the children of the moving `node`, with the nodes of the list `children` from
    /// `list` on.
    #[inline(always)]
    fn children_blocked(&mut self, node: u32, chord: &Chord<S>, list: usize) -> bool {
        let simd = self.simd;
        let (asks, last) = (self.asks, self.clock.samples);
        let Meeting { mover, still: other, .. } = self.meeting;
        let tree = &mover.tree;
        let (nodes, boxes) = tree.children(node);
        let own = Eight::load(simd, boxes);
        let swept = SweptBoxes::new(simd, &self.course, chord, &own);
        self.stacks.work.count(|work| work.placed += nodes.len() as u64);
        let Stacks { children, found, work, .. } = &mut *self.stacks;
        let first = found.len();
        let mut met_by = 0;
        for (still, span) in &children[list..] {
            let boxes = Eight::same(simd, &other.tree.boxes[*still as usize]);
            let met = swept.meets(simd, &boxes, chord.span, &Spans::same(simd, *span));
            work.count(|work| work.tested(nodes.len()));
            for (lane, span) in met.spans(nodes.len()) {
                if asks.about(span, last) {
                    met_by |= 1 << lane;
                    found.push(NearChild { child: lane as u32, still: *still, span });
                }
            }
        }
        let tests = nodes.len() * (children.len() - list);
        let (still, span) = children[list];
        children.truncate(list);
        if self.tires(tests, NearPair { node, still, span }) {
            return true;
        }
        for (lane, child) in nodes.iter().enumerate() {
            if met_by >> lane & 1 == 0 {
                continue;
            }
            let Stacks { near, found, .. } = &mut *self.stacks;
            let base = near.len();
            for NearChild { child, still, span } in &found[first..] {
                if *child == lane as u32 {
                    near.push((*still, *span));
                }
            }
            if self.child_blocked(*child, chord, &swept, lane, base) {
                return true;
            }
        }
        self.stacks.found.truncate(first);
        false
    }

    #[inline(never)]
    fn child_blocked(
        &mut self,
        node: u32,
        chord: &Chord<S>,
        swept: &SweptBoxes<S>,
        lane: usize,
        base: usize,
    ) -> bool {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.comes_near(node, chord, swept, Some(lane), base),
        )
    }

    /// Counts tests of boxes. When a sample is due to be checked ([`PATIENCE`]), checks it and returns whether
    /// surfaces meet there: those below the two nodes, at a sample within the span in which they may meet, or any.
    #[inline(always)]
    fn tires(&mut self, tests: usize, near: NearPair) -> bool {
        self.patience -= tests as f64;
        self.patience <= 0.0 && self.meets_at_a_sample(near)
    }

    #[inline(never)]
    fn meets_at_a_sample(&mut self, NearPair { node, still, span }: NearPair) -> bool {
        let last = self.clock.samples;
        if last < 2 {
            return false;
        }
        // Blocked motions are blocked most often half way; after that, where the search has come to.
        let (pair, sample) = if std::mem::take(&mut self.whole) {
            ((0, 0), last / 2)
        } else {
            let SampleRange { from, to } = SampleRange::around(span, last);
            ((node, still), (from + (to - from) / 2).clamp(1, last - 1))
        };
        self.patience = self.rest;
        self.rest *= 1.5;
        self.stacks.work.count(|work| work.looks += 1);
        self.meets = self.meeting.any_meet(pair, self.clock.at(sample), &mut self.stacks.pairs);
        self.meets
    }
}
