//! At which samples of a chord two boxes may meet, one of them moving.

use crate::robot::Rates;
use crate::validity::frame::Frame;
use crate::validity::light::{Each, Gaps, LightBox, LightPoint, Stand, above, crossing};
use crate::validity::obb::Obb;
use parry3d_f64::math::Vector;
use wide::f32x4;

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
}

/// A box of the moving tree over a chord: where it is at both ends, and how much larger it must be for
/// the straight lines between to hold what is within its reach at every sample.
pub(super) struct SweptBox {
    pub node: u32,
    pub chord: Span,
    /// How far its points leave the straight lines.
    pub bend: f64,
    stands: [Stand; 2],
    half: f32x4,
    sides: Each,
    /// Added along axes that stand still.
    still_room: f32,
    /// Added along the box's own axes.
    own_room: f32,
}

impl SweptBox {
    /// Over a chord of so much time; `spare` is the time in which the tolerance is used up, `slack` a
    /// length that outweighs rounding, `grain` one that does so in single precision.
    pub fn new(
        (node, space, light): (u32, &Obb, &LightBox),
        (chord, time): (Span, f64),
        frames: [&Frame; 2],
        rates: &Rates,
        (spare, slack, grain): (f64, f64, f32),
    ) -> SweptBox {
        let reach = space.radius + rates.distance(space.centre);
        let eighth = time * time / 8.0;
        // Half a step away from a sample a point is no farther than this from where it was.
        let margin = spare * rates.speed_at(reach);
        let bend = rates.bend_at(reach) * eighth;
        // What stands still, as seen from the box: near it at one sample, and then carried away.
        let away = reach + margin + rates.speed * time;
        let own = (rates.bend_at(away) + 2.0 * rates.spin * rates.speed) * eighth;
        SweptBox {
            node,
            chord,
            bend,
            stands: frames.map(|frame| Stand::new(&space.placed(frame))),
            half: light.half,
            sides: light.sides(),
            still_room: above(bend + margin + slack) + grain,
            own_room: above(own + margin + slack) + grain,
        }
    }

    /// The samples within `span` at which the box may be within the margin of one that stands still;
    /// `None` if there are none.
    #[inline(always)]
    pub fn meets(&self, still: &LightBox, span: Span) -> Option<Span> {
        let [first, last] = &self.stands;
        let (from, to) = (first.across(still), last.across(still));
        let room = f32x4::splat(self.still_room);
        let begin = first.along_still(still, &from, &self.sides, room);
        let end = last.along_still(still, &to, &self.sides, room);
        if begin.both_apart(&end) {
            return None;
        }
        let room = f32x4::splat(self.own_room);
        let own_begin = first.along_own(still, &from, self.half, room);
        let own_end = last.along_own(still, &to, self.half, room);
        if own_begin.both_apart(&own_end) {
            return None;
        }
        let mut clip = Clip::ALL;
        clip.cut(&begin, &end);
        clip.cut(&own_begin, &own_end);
        if let Some([begin, end]) =
            crossing(&self.stands, still, [&from, &to], self.half, self.still_room)
        {
            if begin.both_apart(&end) {
                return None;
            }
            clip.cut(&begin, &end);
        }
        clip.samples(self.chord, span)
    }
}

/// The ball around a box during the whole motion.
pub(super) struct SweptBall {
    ends: [LightPoint; 2],
    /// Its radius, and by how much it must be larger for the straight line between to do.
    room: f32,
}

impl SweptBall {
    pub fn new(
        space: &Obb,
        [first, last]: &[Frame; 2],
        rates: &Rates,
        (spare, slack, grain): (f64, f64, f32),
    ) -> SweptBall {
        let from_origin = rates.distance(space.centre);
        let margin = spare * rates.speed_at(space.radius + from_origin);
        let room = space.radius + rates.bend_at(from_origin) / 8.0 + margin + slack;
        let ends = [first, last].map(|frame| LightPoint::new(frame.point(space.centre)));
        SweptBall { ends, room: above(room) + grain }
    }

    /// When the ball may meet a box that stands still.
    #[inline(always)]
    pub fn meets(&self, still: &LightBox) -> Option<Clip> {
        let room = f32x4::splat(self.room) + still.half;
        let [begin, end] = self.ends.each_ref().map(|point| point.gaps(still, room));
        if begin.both_apart(&end) {
            return None;
        }
        let mut clip = Clip::ALL;
        clip.cut(&begin, &end);
        clip.bounds().map(|_| clip)
    }
}

/// Whether a ball of a radius that goes straight misses a box.
pub(in crate::validity) fn misses(
    (from, to): (Vector, Vector),
    (radius, grain): (f64, f32),
    still: &LightBox,
) -> bool {
    let ends = [from, to].map(LightPoint::new);
    SweptBall { ends, room: above(radius) + grain }.meets(still).is_none()
}

/// A share of a chord, cut by one axis in each lane.
pub(super) struct Clip {
    low: f32x4,
    high: f32x4,
}

/// Outweighs the rounding of times.
const MOMENT: f64 = 1e-6;

impl Clip {
    const ALL: Clip = Clip { low: f32x4::ZERO, high: f32x4::ONE };

    /// Cuts off where they are apart, gaps being linear between the ends and not negative at both.
    #[inline(always)]
    fn cut(&mut self, begin: &Gaps, end: &Gaps) {
        for side in 0..2 {
            let (first, last) = (begin.0[side], end.0[side]);
            let crossing = first / (first - last);
            let opens = first.simd_lt(f32x4::ZERO);
            let closes = last.simd_lt(f32x4::ZERO);
            self.low = self.low.fast_max(opens & crossing);
            self.high = self.high.fast_min(closes.bitselect(crossing, f32x4::ONE));
        }
    }

    /// From when to when; `None` if nothing is left.
    #[inline(always)]
    fn bounds(&self) -> Option<(f64, f64)> {
        let [a, b, c, d] = self.low.to_array();
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let low = f64::from(larger(larger(a, b), larger(c, d)));
        let [a, b, c, d] = self.high.to_array();
        let less = |a: f32, b: f32| if a < b { a } else { b };
        let high = f64::from(less(less(a, b), less(c, d)));
        (low <= high + 2.0 * MOMENT).then_some((low - MOMENT, high + MOMENT))
    }

    /// The samples of a chord within it that are in the span, too.
    #[inline(always)]
    pub fn samples(&self, chord: Span, span: Span) -> Option<Span> {
        let (low, high) = self.bounds()?;
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
