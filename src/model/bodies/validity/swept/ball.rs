//! The bounding sphere of the moving tree: a cheap first test that yields the nodes from which the recursion starts.

use super::Stacks;
use super::clip::{Clip, Met, Spans, Turned, apart, least};
use super::search::Sweep;
use super::span::Span;
use crate::model::bodies::validity::frame::Frame;
use crate::model::bodies::validity::light::{
    Eight, Gaps, Many, Three, above, all_times, dot, points, three,
};
use crate::model::bodies::validity::meet::Meeting;
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f32x16};
use parry3d_f64::math::Vector;

/// The bounding sphere of a box during a whole motion, its centre going straight.
struct SweptBall<S: Simd> {
    /// Its centre at the beginning and at the end, as seen from the standing tree's origin.
    ends: Three<f32x16<S>>,
    /// Its radius, with the margin, and with what its centre may leave the straight line by.
    room: f32x8<S>,
}

impl<S: Simd> SweptBall<S> {
    #[inline(always)]
    fn new(simd: S, ends: [Vector; 2], room: f64, grain: f32) -> SweptBall<S> {
        let room = f32x8::splat(simd, above(room) + grain);
        SweptBall { ends: points(simd, ends), room }
    }

    /// When the sphere may meet standing boxes.
    #[inline(always)]
    fn meets(&self, simd: S, still: &Eight<S>, asked: Span) -> Met {
        let [x, y, z] = all_times::<S, f32x16<S>>(&still.centre);
        let between = [x - self.ends[0], y - self.ends[1], z - self.ends[2]];
        let gaps = three(
            #[inline(always)]
            |i| {
                let reach = f32x16::always(self.room + still.half[i]);
                Turned::new(Gaps::new(reach, dot(&between, &all_times(&still.axes[i]))))
            },
        );
        let apart = apart(least(&gaps));
        if apart == 255 {
            return Met::NOTHING;
        }
        let mut clip = Clip::whole(simd);
        clip.cut_all(&gaps);
        clip.met(simd, !apart, Span::ALL, &Spans::same(simd, asked))
    }
}

impl<S: Simd> Sweep<'_, '_, S> {
    /// Descends the standing tree to nodes no larger than the moving box, leaves those that the sphere may meet in
    /// the list `open`, and returns the stretch of time that holds all of their times; `None` if there are none.
    pub(super) fn near_the_ball(&mut self) -> Option<Span> {
        let simd = self.simd;
        let frames = [self.frame(0), self.frame(self.clock.samples)];
        simd.vectorize(
            #[inline(always)]
            || self.near_the_ball_at(frames),
        )
    }

    #[inline(always)]
    fn near_the_ball_at(&mut self, frames: [Frame; 2]) -> Option<Span> {
        let (simd, course) = (self.simd, &self.course);
        let Meeting { mover, still, slack, .. } = self.meeting;
        let space = &mover.tree.nodes[0].space;
        let from_origin = course.rates.distance(space.centre);
        let margin = course.spare * course.rates.speed_at(space.radius + from_origin);
        let room = space.radius + course.rates.bend_at(from_origin) / 8.0 + margin + slack;
        let [first, last] = frames;
        let ends = [first.point(space.centre), last.point(space.centre)];
        let ends = [ends[0] - still.tree.origin, ends[1] - still.tree.origin];
        let grain = self.meeting.grain(ends);
        let ball = SweptBall::new(simd, ends, room, grain);
        let radius = mover.tree.boxes[0].radius();
        let tree = &still.tree;
        let (asks, last) = (self.asks, self.clock.samples);
        let Stacks { open, near: todo, work, .. } = &mut *self.stacks;
        open.clear();
        work.count(|work| work.balls += 1);
        let met = ball.meets(simd, &Eight::same(simd, &tree.boxes[0]), Span::ALL);
        todo.extend(met.spans(1).map(|(_, span)| (0, span)));
        let mut whole: Option<Span> = None;
        while let Some((at, span)) = todo.pop() {
            if tree.boxes[at as usize].radius() <= radius || tree.is_leaf(at) {
                open.push((at, span));
                whole = Some(whole.map_or(span, |whole| whole.with(span)));
                continue;
            }
            let (children, boxes) = tree.children(at);
            work.count(|work| work.balls += children.len() as u64);
            let met = ball.meets(simd, &Eight::load(simd, boxes), span);
            for (lane, span) in met.spans(children.len()) {
                if asks.about(span, last) {
                    todo.push((children[lane], span));
                }
            }
        }
        whole
    }
}
