//! Moving boxes over a chord of the motion, up to eight at once.

use super::clip::{Clip, Met, Spans, Turned, apart, least, turned};
use super::span::{SampleRange, Span};
use crate::model::bodies::robot::Rates;
use crate::model::bodies::validity::frame::Frame;
use crate::model::bodies::validity::light::{Eight, Frames, Stands, Three, above, dot, grain};
use crate::model::bodies::validity::meet::Meeting;
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f32x16};
use parry3d_f64::math::Vector;

/// A bound `c + s · d` on how far something moves, `d` being the distance of its farthest point from the axis or the
/// point about which the motion turns it.
#[derive(Clone, Copy)]
struct Linear(f32, f32);

impl Linear {
    fn new(least: f64, slope: f64) -> Linear {
        Linear(above(least), above(slope))
    }

    #[inline(always)]
    fn at<S: Simd>(self, simd: S, reach: f32x8<S>) -> f32x8<S> {
        reach.mul_add(f32x8::splat(simd, self.1), f32x8::splat(simd, self.0))
    }
}

/// What is common to all boxes of a motion.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub rates: Rates,
    /// The tolerance as a time: elements are to be farther apart than points move in it. Half a step, or zero.
    pub spare: f64,
    /// A length greater than what rounding in double precision can add up to.
    slack: f64,
    /// A length greater than what rounding can add up to in the distances of boxes from where the motion turns them.
    grain: f32,
    /// Lengths are measured in this unit where they are squared, so that squares neither overflow nor underflow.
    unit: f32,
    /// The origin of the moving boxes in that unit; of a rigid body, its vector product with the axis of the turn.
    origin: [f32; 3],
}

impl Course {
    pub fn new(rates: Rates, spare: f64, meeting: &Meeting) -> Course {
        Course::of(
            rates,
            spare,
            meeting.slack,
            (meeting.mover.tree.origin, meeting.mover.tree.reach),
        )
    }

    /// From the origin of the moving boxes, and how far they reach from it.
    fn of(rates: Rates, spare: f64, slack: f64, (origin, reach): (Vector, f64)) -> Course {
        if origin == Vector::ZERO {
            let grain = grain(reach);
            return Course { rates, spare, slack, grain, unit: grain, origin: [0.0; 3] };
        }
        let away = rates.steady.map_or(origin, |steady| steady.axis.cross(origin));
        let unit = grain(reach.max(away.length()));
        let origin = (away / f64::from(unit)).to_array().map(|x| x as f32);
        Course { rates, spare, slack, grain: grain(reach), unit, origin }
    }
}

/// The motion between two samples, every point being thought to go straight.
pub(super) struct Chord<S: Simd> {
    pub samples: SampleRange,
    /// The same stretch in time, from 0 at the beginning of the motion to 1 at its end.
    pub span: Span,
    frames: Frames<f32x16<S>>,
    /// How far points of the moving body may leave their straight lines.
    bend: Linear,
    /// By how much a moving box is enlarged along standing axes.
    still_room: Linear,
    /// By how much it is enlarged along its own axes.
    own_room: Linear,
}

impl<S: Simd> Chord<S> {
    /// `frames` are those of the moving boxes' origin as seen from the standing boxes' origin, with a length greater
    /// than what rounding can add up to.
    #[inline(always)]
    pub fn new(
        simd: S,
        course: &Course,
        samples: SampleRange,
        step: f64,
        frames: [&Frame; 2],
        grain: f32,
    ) -> Chord<S> {
        let Course { rates, spare, slack, .. } = course;
        let time = samples.length() as f64 * step;
        let (eighth, turn_bend) = (time * time / 8.0, rates.turn_bend());
        let slack = slack + f64::from(grain);
        let bend = (rates.bend * eighth, turn_bend * eighth);
        // The tolerance: within half a step of a sample a point moves no farther than this.
        let margin = (spare * rates.speed, spare * rates.spin);
        // Seen from the moving box, a standing point moves too. If it is within the tolerance of the box at one
        // sample, its distance from where the box turns stays below `away.0 + away.1 · d` during the chord, with
        // d as in [`Linear`].
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

/// Eight boxes of the moving tree over a chord: their positions at both ends, and by how much they must be enlarged
/// for linear interpolation between the two to hold everything in them, with the tolerance, at every sample.
#[derive(Clone, Copy)]
pub(super) struct SweptBoxes<S: Simd> {
    stands: Stands<S, f32x16<S>>,
    /// How far their points may leave their straight lines.
    bend: f32x8<S>,
    still_room: f32x8<S>,
    own_room: f32x8<S>,
}

impl<S: Simd> SweptBoxes<S> {
    #[inline(always)]
    pub fn new(simd: S, course: &Course, chord: &Chord<S>, own: &Eight<S>) -> SweptBoxes<S> {
        let reach = reach(simd, course, own);
        SweptBoxes {
            stands: Stands::new(&chord.frames, own),
            bend: chord.bend.at(simd, reach),
            still_room: chord.still_room.at(simd, reach),
            own_room: chord.own_room.at(simd, reach),
        }
    }

    /// The box of one lane, in every lane.
    #[inline(always)]
    pub fn only(&self, simd: S, lane: usize) -> SweptBoxes<S> {
        SweptBoxes {
            stands: self.stands.only(simd, lane),
            bend: f32x8::splat(simd, self.bend[lane]),
            still_room: f32x8::splat(simd, self.still_room[lane]),
            own_room: f32x8::splat(simd, self.own_room[lane]),
        }
    }

    /// How far the points of one of the boxes may leave their straight lines.
    #[inline(always)]
    pub fn bend(&self, lane: usize) -> f32 {
        self.bend[lane]
    }

    /// When each of the boxes may come within the tolerance of the standing box of the same lane.
    #[inline(always)]
    pub fn meets(&self, simd: S, still: &Eight<S>, chord: Span, spans: &Spans<S>) -> Met {
        let across = self.stands.across(still);
        let first = turned(self.stands.along_still(still, &across, self.still_room));
        let overlap = least(&first);
        if apart(overlap) == 255 {
            return Met::NOTHING;
        }
        let own = turned(self.stands.along_own(still, &across, self.own_room));
        let overlap = overlap.min(least(&own));
        if apart(overlap) == 255 {
            return Met::NOTHING;
        }
        let axis = self.crossing(still);
        let square = dot(&axis, &axis);
        let room = still.widened(self.still_room) * square.sqrt();
        let crossing = Turned::new(self.stands.along(&axis, still, &across, room));
        let apart = apart(overlap.min(crossing.both()));
        if apart == 255 {
            return Met::NOTHING;
        }
        let mut clip = Clip::whole(simd);
        clip.cut_all(&first);
        clip.cut_all(&own);
        clip.cut(&crossing);
        clip.met(simd, !apart, chord, spans)
    }

    /// The cross product of the longest axes, those of the moving boxes being the mean over the chord: a separating
    /// axis of long boxes that cross each other.
    #[inline(always)]
    fn crossing(&self, still: &Eight<S>) -> Three<f32x8<S>> {
        let [a, b, c] = still.axes[2];
        let [x, y, z] = &self.stands.axes[2];
        let (x, y, z) = (halves_sum(x), halves_sum(y), halves_sum(z));
        [b * z - c * y, c * x - a * z, a * y - b * x]
    }
}

/// The sum of the values at both ends of a chord.
#[inline(always)]
fn halves_sum<S: Simd>(both: &f32x16<S>) -> f32x8<S> {
    let (first, last) = both.split();
    first + last
}

/// A bound on the distance of the points of boxes from the axis or the point about which the motion turns them.
#[inline(always)]
fn reach<S: Simd>(simd: S, course: &Course, own: &Eight<S>) -> f32x8<S> {
    let unit = course.unit;
    let [x, y, z] = own.centre;
    let (x, y, z) = (x * unit.recip(), y * unit.recip(), z * unit.recip());
    let [x, y, z] = match &course.rates.steady {
        None => [x, y, z],
        Some(steady) => {
            let (a, b, c) = (steady.axis.x as f32, steady.axis.y as f32, steady.axis.z as f32);
            [z * b - y * c, x * c - z * a, y * a - x * b]
        }
    };
    let [a, b, c] = course.origin;
    let away = [x + a, y + b, z + c];
    let distance = dot(&away, &away).sqrt() * unit;
    let reach = (own.radius + distance) * (1.0 + 2e-6) + course.grain;
    // No scene is that large; the limit keeps later products finite.
    reach.min(f32x8::splat(simd, 1e35))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Lanes, with_widest_lanes};
    use crate::model::bodies::robot::Steady;
    use crate::model::bodies::validity::light::tests::{Touching, touching};
    use proptest::prelude::*;

    proptest! {
        /// Whatever the scale, and with what bounds so ever on the motion.
        #[test]
        fn boxes_that_touch_at_both_ends_meet(
            ordinal in any::<u64>(), power in -38i32..38, spin in 0.0f64..60.0, speed in 0.0f64..4.0,
            larger in prop::sample::select(vec![1.0, 1e3, 1e6]),
        ) {
            let touching = touching(ordinal, power, larger);
            let grain = touching.grain();
            let Touching { mover, still, frame, reach, size } = touching;
            let stands = Rates::default();
            let moves = Rates { speed: speed * size, bend: spin * size, spin, twist: spin, steady: None };
            let met = |rates: Rates, frame: &Frame, lanes: Lanes| {
                let course = Course::of(rates, 1e-7, 1e-12 * size, (Vector::ZERO, reach));
                with_widest_lanes!(lanes, simd => {
                    let samples = SampleRange { from: 0, to: 1 << 20 };
                    let step = 1.0 / f64::from(1 << 20);
                    let chord = Chord::new(simd, &course, samples, step, [frame, frame], grain);
                    let swept = SweptBoxes::new(simd, &course, &chord, &Eight::same(simd, &mover));
                    let met = swept.meets(simd, &Eight::new(simd, [&still; 8]), Span::ALL, &Spans::same(simd, Span::ALL));
                    met.spans(8).filter(|(_, span)| span.from <= 0.0 && span.to >= 1.0).count()
                })
            };
            let apart = Frame { shift: frame.shift + Vector::X * (20.0 * size), ..frame };
            for lanes in Lanes::all() {
                prop_assert_eq!(met(stands, &frame, lanes), 8);
                prop_assert_eq!(met(moves, &frame, lanes), 8);
                // Where single precision ends nothing is told apart.
                let told = met(stands, &apart, lanes) == 0;
                prop_assert!(told || larger > 1.0 || !(-30..27).contains(&power));
            }
        }

        /// The reach of a box holds the distances of its points from where the motion turns them, however far away
        /// the origin of its coordinates is.
        #[test]
        fn reaches_hold_the_points_of_boxes(
            ordinal in any::<u64>(), power in -30i32..26, far in prop::sample::select(vec![0.0, 1.0, 1e6]),
        ) {
            let Touching { mover, reach: local, size, frame, .. } = touching(ordinal, power, 1.0);
            let axis = frame.turn.x_axis;
            let steady = Steady { axis, velocity: Vector::ZERO, turning: Vector::ZERO };
            let origin = frame.turn.y_axis * (far * size);
            for steady in [None, Some(steady)] {
                let rates = Rates { steady, ..Rates::default() };
                let course = Course::of(rates, 0.0, 0.0, (origin, local));
                let (centre, radius) = mover.ball();
                let expected = rates.distance(centre + origin) + radius;
                for lanes in Lanes::all() {
                    let found = with_widest_lanes!(lanes, simd => {
                        f64::from(super::reach(simd, &course, &Eight::same(simd, &mover))[0])
                    });
                    prop_assert!(found >= expected * (1.0 - 1e-7) - 1e-6 * local, "{} {}", found, expected);
                    prop_assert!(found <= 1.00001 * expected + 1e-4 * local, "{} {}", found, expected);
                }
            }
        }
    }
}
