//! At which samples of a chord boxes may meet, the ones moving, four pairs of them at once.

use crate::robot::Rates;
use crate::validity::frame::Frame;
use crate::validity::light::{
    Four, Frames, Gaps, Stands, Three, above, all_times, dot, points, three,
};
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8};
use parry3d_f64::math::Vector;

/// A stretch of time, in shares of the motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub from: f32,
    pub to: f32,
}

impl Span {
    pub const ALL: Span = Span { from: 0.0, to: 1.0 };

    pub fn length(self) -> f32 {
        self.to - self.from
    }

    pub fn with(self, other: Span) -> Span {
        Span { from: self.from.min(other.from), to: self.to.max(other.to) }
    }

    /// Whether any sample is in it.
    pub fn holds_any(self, last: u64) -> bool {
        let [from, to] = self.within(last);
        from.ceil() <= to.floor()
    }

    /// In samples.
    fn within(self, last: u64) -> [f64; 2] {
        [self.from, self.to].map(|time| f64::from(time) * last as f64)
    }
}

/// A stretch of samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples {
    pub from: u64,
    pub to: u64,
}

impl Samples {
    pub fn length(self) -> u64 {
        self.to - self.from
    }

    /// Those of so many that hold a span, the last one being the end of the motion.
    pub fn around(span: Span, last: u64) -> Samples {
        let [from, to] = span.within(last);
        // Samples fit signed integers, to which conversion is one instruction.
        Samples { from: from.max(0.0) as i64 as u64, to: (to as i64 as u64 + 1).min(last) }
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
    pub samples: Samples,
    /// In shares of the motion.
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
        (samples, step): (Samples, f64),
        frames: [&Frame; 2],
    ) -> Chord<S> {
        let Course { rates, spare, slack, grain } = course;
        let time = samples.length() as f64 * step;
        let (eighth, turn_bend) = (time * time / 8.0, rates.turn_bend());
        let slack = slack + f64::from(*grain);
        let bend = (rates.bend * eighth, turn_bend * eighth);
        // Half a step away from a sample a point is no farther than this from where it was.
        let margin = (spare * rates.speed, spare * rates.spin);
        // What stands still, as seen from the box: near it at one sample, and then carried away.
        let away = (margin.0 + rates.speed * time, 1.0 + margin.1);
        let own = rates.bend + turn_bend * away.0 + 2.0 * rates.spin * rates.speed;
        let span = Span {
            from: (samples.from as f64 * step) as f32,
            to: (samples.to as f64 * step) as f32,
        };
        Chord {
            samples,
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
    pub fn meets(&self, simd: S, still: &Four<S>, chord: Span, spans: &[Span; 4]) -> Met {
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
        clip.met(simd, !apart, chord, spans)
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
    pub fn meets(&self, simd: S, still: &Four<S>, asked: Span) -> Met {
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
        clip.met(simd, !apart, Span::ALL, &[asked; 4])
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

/// When boxes may meet.
#[derive(Clone, Copy)]
pub(super) struct Met {
    /// A bit for each lane in which they may.
    lanes: u32,
    from: [f32; 4],
    to: [f32; 4],
}

impl Met {
    const NOTHING: Met = Met { lanes: 0, from: [0.0; 4], to: [0.0; 4] };

    /// The lanes among the first so many in which they may, and when.
    #[inline(always)]
    pub fn spans(&self, count: usize) -> impl Iterator<Item = (usize, Span)> {
        let mut rest = self.lanes & ((1 << count) - 1);
        std::iter::from_fn(
            #[inline(always)]
            move || {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest.wrapping_sub(1);
                (lane < 4).then(|| (lane, Span { from: self.from[lane], to: self.to[lane] }))
            },
        )
    }
}

/// A share of a chord for each lane, as cut from either side.
struct Clip<S: Simd> {
    low: f32x8<S>,
    high: f32x8<S>,
}

/// Outweighs the rounding of times, in shares of a chord.
const CHORD_MOMENT: f32 = 1e-6;
/// The same in shares of the motion.
const MOMENT: f32 = 3e-7;

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

    /// What is left of spans, the share being one of a chord.
    #[inline(always)]
    fn met(self, simd: S, lanes: u32, chord: Span, [a, b, c, d]: &[Span; 4]) -> Met {
        let (low, high) = (self.low.split(), self.high.split());
        let (low, high) = (low.0.max(low.1), high.0.min(high.1));
        let length = f32x4::splat(simd, chord.length());
        let slack = chord.length() * CHORD_MOMENT + MOMENT;
        let low = low.mul_add(length, f32x4::splat(simd, chord.from - slack));
        let high = high.mul_add(length, f32x4::splat(simd, chord.from + slack));
        let from = low.max(f32x4::load_array(simd, [a.from, b.from, c.from, d.from]));
        let to = high.min(f32x4::load_array(simd, [a.to, b.to, c.to, d.to]));
        let left = from.simd_le(to).to_bitmask() as u32;
        Met { lanes: lanes & left, from: from.to_array(), to: to.to_array() }
    }
}
