//! At which samples of a chord boxes may meet, the ones moving, four pairs of them at once.

use crate::robot::Rates;
use crate::validity::frame::Frame;
use crate::validity::light::{
    Four, Frames, Gaps, LightBox, Stands, Three, above, all_times, dot, points, three,
};
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8};
use parry3d_f64::math::Vector;

/// A stretch of samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub from: u64,
    pub to: u64,
}

impl Span {
    pub fn length(self) -> u64 {
        self.to - self.from
    }

    pub fn with(self, other: Span) -> Span {
        Span { from: self.from.min(other.from), to: self.to.max(other.to) }
    }
}

/// A number that grows with the distance of the farthest point from where the motion turns.
#[derive(Clone, Copy)]
struct Linear(f32, f32);

impl Linear {
    fn new(least: f64, slope: f64) -> Linear {
        Linear(above(least), above(slope))
    }

    #[inline(always)]
    fn at<S: Simd>(self, simd: S, reach: f32x4<S>) -> f32x4<S> {
        reach.mul_add(f32x4::splat(simd, self.1), f32x4::splat(simd, self.0))
    }
}

/// What all boxes of a motion share.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub rates: Rates,
    /// The time in which the tolerance is used up: that of half a step, or none.
    pub spare: f64,
    /// A length that outweighs rounding.
    pub slack: f64,
    /// One that does so in single precision.
    pub grain: f32,
}

/// A share of the motion between two samples.
pub(super) struct Chord<S: Simd> {
    pub span: Span,
    frames: Frames<f32x8<S>>,
    /// How far points leave the straight lines.
    bend: Linear,
    /// Added along axes that stand still.
    still_room: Linear,
    /// Added along the boxes' own axes.
    own_room: Linear,
}

impl<S: Simd> Chord<S> {
    #[inline(always)]
    pub fn new(
        simd: S,
        course: &Course,
        (span, time): (Span, f64),
        frames: [&Frame; 2],
    ) -> Chord<S> {
        let Course { rates, spare, slack, grain } = course;
        let (eighth, turn_bend) = (time * time / 8.0, rates.turn_bend());
        let slack = slack + f64::from(*grain);
        let bend = (rates.bend * eighth, turn_bend * eighth);
        // Half a step away from a sample a point is no farther than this from where it was.
        let margin = (spare * rates.speed, spare * rates.spin);
        // What stands still, as seen from the box: near it at one sample, and then carried away.
        let away = (margin.0 + rates.speed * time, 1.0 + margin.1);
        let own = rates.bend + turn_bend * away.0 + 2.0 * rates.spin * rates.speed;
        Chord {
            span,
            frames: Frames::new(simd, frames),
            bend: Linear::new(bend.0, bend.1),
            still_room: Linear::new(bend.0 + margin.0 + slack, bend.1 + margin.1),
            own_room: Linear::new(
                own * eighth + margin.0 + slack,
                turn_bend * away.1 * eighth + margin.1,
            ),
        }
    }
}

/// Four boxes of the moving tree over a chord: where they are at both ends, and how much larger they must
/// be for the straight lines between to hold what is within their reach at every sample.
#[derive(Clone, Copy)]
pub(super) struct SweptBoxes<S: Simd> {
    stands: Stands<S, f32x8<S>>,
    /// How far their points leave the straight lines.
    bend: f32x4<S>,
    still_room: f32x4<S>,
    own_room: f32x4<S>,
}

impl<S: Simd> SweptBoxes<S> {
    #[inline(always)]
    pub fn new(simd: S, course: &Course, chord: &Chord<S>, own: &Four<S>) -> SweptBoxes<S> {
        let reach = reach(simd, course, own);
        SweptBoxes {
            stands: Stands::new(&chord.frames, own),
            bend: chord.bend.at(simd, reach),
            still_room: chord.still_room.at(simd, reach),
            own_room: chord.own_room.at(simd, reach),
        }
    }

    /// That of one lane in all.
    #[inline(always)]
    pub fn only(&self, simd: S, lane: usize) -> SweptBoxes<S> {
        SweptBoxes {
            stands: self.stands.only(simd, lane),
            bend: f32x4::splat(simd, self.bend[lane]),
            still_room: f32x4::splat(simd, self.still_room[lane]),
            own_room: f32x4::splat(simd, self.own_room[lane]),
        }
    }

    /// How far the points of one leave the straight lines.
    #[inline(always)]
    pub fn bend(&self, lane: usize) -> f32 {
        self.bend[lane]
    }

    /// When the boxes may be within the margin of those that stand still, each of that of its lane.
    #[inline(always)]
    pub fn meets(&self, simd: S, still: &Four<S>) -> Met {
        let across = self.stands.across(still);
        let first = turned(self.stands.along_still(still, &across, self.still_room));
        let overlap = least(&first);
        if apart(overlap) == 15 {
            return Met::NOTHING;
        }
        let own = turned(self.stands.along_own(still, &across, self.own_room));
        let overlap = overlap.min(least(&own));
        if apart(overlap) == 15 {
            return Met::NOTHING;
        }
        let axis = self.crossing(still);
        let square = dot(&axis, &axis);
        let room = self.still_room * square.sqrt();
        let crossing = Turned::new(self.stands.along(&axis, still, &across, room));
        let apart = apart(overlap.min(crossing.both()));
        if apart == 15 {
            return Met::NOTHING;
        }
        let mut clip = Clip::whole(simd);
        clip.cut_all(&first);
        clip.cut_all(&own);
        clip.cut(&crossing);
        clip.met(!apart)
    }

    /// The product of the longest axes half way, which tells crossing boxes apart.
    #[inline(always)]
    fn crossing(&self, still: &Four<S>) -> Three<f32x4<S>> {
        let [a, b, c] = still.axes[2];
        let [x, y, z] = &self.stands.axes[2];
        let (x, y, z) = (halves_sum(x), halves_sum(y), halves_sum(z));
        [b * z - c * y, c * x - a * z, a * y - b * x]
    }
}

/// Twice the mean of what there is at both ends.
#[inline(always)]
fn halves_sum<S: Simd>(both: &f32x8<S>) -> f32x4<S> {
    let (first, last) = both.split();
    first + last
}

/// A bound on the distance of the points of boxes from where the motion turns them.
#[inline(always)]
fn reach<S: Simd>(simd: S, course: &Course, own: &Four<S>) -> f32x4<S> {
    // In this unit squares neither overflow nor vanish.
    let unit = course.grain;
    let [x, y, z] = own.centre;
    let (x, y, z) = (x * unit.recip(), y * unit.recip(), z * unit.recip());
    let away = match &course.rates.steady {
        None => [x, y, z],
        Some(steady) => {
            let (a, b, c) = (steady.axis.x as f32, steady.axis.y as f32, steady.axis.z as f32);
            [z * b - y * c, x * c - z * a, y * a - x * b]
        }
    };
    let distance = dot(&away, &away).sqrt() * unit;
    let reach = (own.radius + distance) * (1.0 + 2e-6) + unit;
    // Nothing is as far, and no product with it is not a number.
    reach.min(f32x4::splat(simd, 1e35))
}

/// The ball around a box during the whole motion.
pub(super) struct SweptBall<S: Simd> {
    ends: Three<f32x8<S>>,
    /// Its radius, and by how much it must be larger for the straight line between to do.
    room: f32x4<S>,
}

impl<S: Simd> SweptBall<S> {
    #[inline(always)]
    pub fn new(simd: S, ends: [Vector; 2], room: f64, grain: f32) -> SweptBall<S> {
        let room = f32x4::splat(simd, above(room) + grain);
        SweptBall { ends: points(simd, ends), room }
    }

    /// When the ball may meet boxes that stand still.
    #[inline(always)]
    pub fn meets(&self, simd: S, still: &Four<S>) -> Met {
        let [x, y, z] = all_times::<S, f32x8<S>>(&still.centre);
        let between = [x - self.ends[0], y - self.ends[1], z - self.ends[2]];
        let gaps = three(
            #[inline(always)]
            |i| {
                let reach = f32x8::block_splat(self.room + still.half[i]);
                Turned::new(Gaps::new(reach, dot(&between, &all_times(&still.axes[i]))))
            },
        );
        let apart = apart(least(&gaps));
        if apart == 15 {
            return Met::NOTHING;
        }
        let mut clip = Clip::whole(simd);
        clip.cut_all(&gaps);
        clip.met(!apart)
    }
}

/// Gaps at the beginning, from either side, and at the end.
struct Turned<S: Simd> {
    begin: f32x8<S>,
    end: f32x8<S>,
}

impl<S: Simd> Turned<S> {
    #[inline(always)]
    fn new(Gaps(below, above): Gaps<f32x8<S>>) -> Turned<S> {
        let ((a, b), (c, d)) = (below.split(), above.split());
        Turned { begin: a.combine(c), end: b.combine(d) }
    }

    /// Negative where they are apart at both ends, from the same side.
    #[inline(always)]
    fn both(&self) -> f32x8<S> {
        self.begin.max(self.end)
    }
}

#[inline(always)]
fn turned<S: Simd>([a, b, c]: Three<Gaps<f32x8<S>>>) -> [Turned<S>; 3] {
    [Turned::new(a), Turned::new(b), Turned::new(c)]
}

#[inline(always)]
fn least<S: Simd>([a, b, c]: &[Turned<S>; 3]) -> f32x8<S> {
    a.both().min(b.both()).min(c.both())
}

/// A bit for each lane that is apart from one side or the other.
#[inline(always)]
fn apart<S: Simd>(overlap: f32x8<S>) -> u32 {
    let sides = overlap.simd_lt(0.0).to_bitmask() as u32;
    (sides | sides >> 4) & 15
}

/// Shares of a chord in which boxes may meet, those of each lane.
#[derive(Clone, Copy)]
pub(super) struct Met {
    /// A bit for each lane in which there is any.
    pub lanes: u32,
    low: [f32; 4],
    high: [f32; 4],
}

/// A share of a chord for each lane, as cut from either side.
struct Clip<S: Simd> {
    low: f32x8<S>,
    high: f32x8<S>,
}

/// Outweighs the rounding of times.
const MOMENT: f64 = 1e-6;

impl<S: Simd> Clip<S> {
    #[inline(always)]
    fn whole(simd: S) -> Clip<S> {
        Clip { low: f32x8::splat(simd, 0.0), high: f32x8::splat(simd, 1.0) }
    }

    /// Cuts off where they are apart, gaps being linear between the ends and not negative at both.
    #[inline(always)]
    fn cut(&mut self, Turned { begin, end }: &Turned<S>) {
        let crossing = *begin / (*begin - *end);
        self.low = begin.simd_lt(0.0).select(self.low.max(crossing), self.low);
        self.high = end.simd_lt(0.0).select(self.high.min(crossing), self.high);
    }

    #[inline(always)]
    fn cut_all(&mut self, [a, b, c]: &[Turned<S>; 3]) {
        self.cut(a);
        self.cut(b);
        self.cut(c);
    }

    #[inline(always)]
    fn met(self, lanes: u32) -> Met {
        let ((a, b), (c, d)) = (self.low.split(), self.high.split());
        let (low, high) = (a.max(b), c.min(d));
        let left = (low - 2.0 * MOMENT as f32).simd_le(high).to_bitmask() as u32;
        Met { lanes: lanes & left, low: low.to_array(), high: high.to_array() }
    }
}

impl Met {
    const NOTHING: Met = Met { lanes: 0, low: [0.0; 4], high: [0.0; 4] };

    /// The samples of a chord within the share of a lane that are in the span, too.
    #[inline(always)]
    pub fn samples(&self, lane: usize, chord: Span, span: Span) -> Option<Span> {
        let low = f64::from(self.low[lane]) - MOMENT;
        let high = f64::from(self.high[lane]) + MOMENT;
        let length = chord.length() as f64;
        let slack = 1e-7 + 1e-9 * length;
        // Samples fit signed integers, to which conversion is one instruction.
        let (low, high) = (low * length - slack, high * length + slack);
        let floor = low.max(0.0) as i64;
        let first = (floor + i64::from((floor as f64) < low)) as u64;
        let last = high.max(0.0) as i64 as u64;
        let from = span.from.max(chord.from + first);
        let to = span.to.min(chord.from + last);
        (from <= to).then_some(Span { from, to })
    }
}

/// Whether a ball of a radius that goes straight misses a box.
#[inline(always)]
pub(in crate::validity) fn misses<S: Simd>(
    simd: S,
    ends: [Vector; 2],
    (radius, grain): (f64, f32),
    still: &LightBox,
) -> bool {
    SweptBall::new(simd, ends, radius, grain).meets(simd, &Four::same(simd, still)).lanes == 0
}
