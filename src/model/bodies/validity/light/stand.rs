//! Eight moving boxes, placed in the standing frame, and their gaps to standing boxes along separating axes.

use super::{Eight, Frames, Many, Three, WIDE, all_times, dot, three};
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f32x16};

/// The centres and axes of eight moving boxes in the standing frame.
#[derive(Clone, Copy)]
pub(in crate::model::bodies::validity) struct Stands<S: Simd, V: Many<S>> {
    centre: Three<V>,
    pub axes: [Three<V>; 3],
    /// Half their sides.
    pub half: Three<f32x8<S>>,
}

/// The position of each of eight moving boxes relative to the standing box of the same lane.
pub(in crate::model::bodies::validity) struct Across<V> {
    pub between: Three<V>,
    /// Absolute values of the scalar products of the moving box's axes with the standing box's axes.
    turns: [Three<V>; 3],
}

/// By how much two boxes overlap along an axis, measured from either side; negative where there is a gap.
#[derive(Clone, Copy)]
pub(in crate::model::bodies::validity) struct Gaps<V>(pub V, pub V);

impl<S: Simd, V: Many<S>> Stands<S, V> {
    #[inline(always)]
    pub fn new(Frames { turn, shift }: &Frames<V>, own: &Eight<S>) -> Stands<S, V> {
        let axes =
            [turned(turn, &own.axes[0]), turned(turn, &own.axes[1]), turned(turn, &own.axes[2])];
        let [x, y, z] = turned(turn, &own.centre);
        let centre = [x + shift[0], y + shift[1], z + shift[2]];
        Stands { centre, axes, half: own.half }
    }

    #[inline(always)]
    pub fn across(&self, still: &Eight<S>) -> Across<V> {
        let [x, y, z] = all_times::<S, V>(&still.centre);
        let between = [x - self.centre[0], y - self.centre[1], z - self.centre[2]];
        let axes =
            [all_times(&still.axes[0]), all_times(&still.axes[1]), all_times(&still.axes[2])];
        let [a, b, c] = &self.axes;
        Across { between, turns: [turns(a, &axes), turns(b, &axes), turns(c, &axes)] }
    }

    /// The overlaps along the axes of the standing boxes; `room` is the length by which boxes are enlarged.
    #[inline(always)]
    pub fn along_still(
        &self,
        still: &Eight<S>,
        across: &Across<V>,
        room: f32x8<S>,
    ) -> Three<Gaps<V>> {
        let sides = all_times(&self.half);
        let [a, b, c] = &across.turns;
        three(
            #[inline(always)]
            |i| {
                let reach = reach(&[a[i], b[i], c[i]], &sides, room + still.half[i]);
                Gaps::new(reach, dot(&across.between, &all_times(&still.axes[i])))
            },
        )
    }

    /// The overlaps along the moving boxes' own axes.
    #[inline(always)]
    pub fn along_own(
        &self,
        still: &Eight<S>,
        across: &Across<V>,
        room: f32x8<S>,
    ) -> Three<Gaps<V>> {
        let sides = all_times(&still.half);
        let room = still.widened(room);
        three(
            #[inline(always)]
            |i| {
                let reach = reach(&across.turns[i], &sides, room + self.half[i]);
                Gaps::new(reach, dot(&across.between, &self.axes[i]))
            },
        )
    }

    /// The overlaps along any axis, of any length; overlaps are multiplied by that length, and so is `room` already, which
    /// is to be that of [`Eight::widened`].
    #[inline(always)]
    pub fn along(
        &self,
        axis: &Three<f32x8<S>>,
        still: &Eight<S>,
        across: &Across<V>,
        room: f32x8<S>,
    ) -> Gaps<V> {
        let [a, b, c] = &still.axes;
        let room =
            reach(&[dot(a, axis).abs(), dot(b, axis).abs(), dot(c, axis).abs()], &still.half, room);
        let axis = all_times(axis);
        let [a, b, c] = &self.axes;
        let turns = [dot(a, &axis).abs(), dot(b, &axis).abs(), dot(c, &axis).abs()];
        Gaps::new(reach(&turns, &all_times(&self.half), room), dot(&across.between, &axis))
    }
}

impl<S: Simd> Eight<S> {
    /// The length by which boxes are enlarged along axes that are not those of the standing boxes, given that along these.
    #[inline(always)]
    pub fn widened(&self, room: f32x8<S>) -> f32x8<S> {
        self.radius * WIDE + room
    }
}

#[inline(always)]
fn turned<S: Simd, V: Many<S>>(turn: &[Three<V>; 3], v: &Three<f32x8<S>>) -> Three<V> {
    let v = all_times(v);
    [dot(&turn[0], &v), dot(&turn[1], &v), dot(&turn[2], &v)]
}

#[inline(always)]
fn turns<S: Simd, V: Many<S>>(own: &Three<V>, [a, b, c]: &[Three<V>; 3]) -> Three<V> {
    [dot(own, a).abs(), dot(own, b).abs(), dot(own, c).abs()]
}

/// How far boxes extend along an axis, given half their sides, the absolute cosines between these and the axis, and an
/// addition.
#[inline(always)]
fn reach<S: Simd, V: Many<S>>(turns: &Three<V>, sides: &Three<V>, room: f32x8<S>) -> V {
    let [x, y, z] = turns;
    z.mul_add(sides[2], y.mul_add(sides[1], x.mul_add(sides[0], V::always(room))))
}

impl<S: Simd> Stands<S, f32x16<S>> {
    /// The box of one lane, in every lane.
    #[inline(always)]
    pub fn only(&self, simd: S, lane: usize) -> Stands<S, f32x16<S>> {
        let [a, b, c] = &self.axes;
        Stands {
            centre: only_pairs(simd, &self.centre, lane),
            axes: [only_pairs(simd, a, lane), only_pairs(simd, b, lane), only_pairs(simd, c, lane)],
            half: [
                f32x8::splat(simd, self.half[0][lane]),
                f32x8::splat(simd, self.half[1][lane]),
                f32x8::splat(simd, self.half[2][lane]),
            ],
        }
    }
}

#[inline(always)]
fn only_pairs<S: Simd>(simd: S, [x, y, z]: &Three<f32x16<S>>, lane: usize) -> Three<f32x16<S>> {
    [only_pair(simd, x, lane), only_pair(simd, y, lane), only_pair(simd, z, lane)]
}

#[inline(always)]
fn only_pair<S: Simd>(simd: S, v: &f32x16<S>, lane: usize) -> f32x16<S> {
    let lane = lane & 7;
    f32x8::splat(simd, v[lane]).combine(f32x8::splat(simd, v[lane + 8]))
}

impl<S: Simd> Stands<S, f32x8<S>> {
    /// A bit for each box that may be within `room` of the standing box of its lane: no face normal separates the two.
    #[inline(always)]
    pub fn may_meet(&self, simd: S, still: &Eight<S>, room: f32) -> u32 {
        let (across, room) = (self.across(still), f32x8::splat(simd, room));
        let met = !apart(self.along_still(still, &across, room)) & 255;
        if met == 0 { 0 } else { met & !apart(self.along_own(still, &across, room)) }
    }
}

/// A bit for each lane with a gap along one of three axes.
#[inline(always)]
fn apart<S: Simd>([a, b, c]: Three<Gaps<f32x8<S>>>) -> u32 {
    let overlap = a.0.min(a.1).min(b.0.min(b.1)).min(c.0.min(c.1));
    overlap.simd_lt(0.0).to_bitmask() as u32
}

impl<V> Gaps<V> {
    #[inline(always)]
    pub fn new<S: Simd>(reach: V, apart: V) -> Gaps<V>
    where
        V: Many<S>,
    {
        Gaps(reach - apart, reach + apart)
    }
}
