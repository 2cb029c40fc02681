//! At which samples of a chord two boxes may meet, one of them moving.

use super::two::{Two, TwoVectors};
use crate::robot::Rates;
use crate::validity::frame::Frame;
use crate::validity::obb::Obb;
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
}

/// A box of the moving tree over a chord: where it is at both ends, and how much larger it must be for
/// the straight lines between to hold what is within its reach at every sample.
pub(super) struct SweptBox {
    pub node: u32,
    pub chord: Span,
    half: Vector,
    /// See [`Obb::rod`].
    rod: bool,
    centre: TwoVectors,
    axes: [TwoVectors; 3],
    /// How far its points leave the straight lines.
    pub bend: f64,
    /// Added along axes that stand still.
    still_room: f64,
    /// Added along the box's own axes.
    own_room: f64,
}

impl SweptBox {
    /// Over a chord of so much time; `spare` is the time in which the tolerance is used up, `slack` a
    /// length that outweighs rounding.
    pub fn new(
        (node, space): (u32, &Obb),
        (chord, time): (Span, f64),
        frames: [&Frame; 2],
        rates: &Rates,
        (spare, slack): (f64, f64),
    ) -> SweptBox {
        let reach = space.radius + rates.distance(space.centre);
        let eighth = time * time / 8.0;
        // Half a step away from a sample a point is no farther than this from where it was.
        let margin = spare * rates.speed_at(reach);
        let bend = rates.bend_at(reach) * eighth;
        // What stands still, as seen from the box: near it at one sample, and then carried away.
        let away = reach + margin + rates.speed * time;
        let own = (rates.bend_at(away) + 2.0 * rates.spin * rates.speed) * eighth;
        let [first, last] = frames.map(|frame| space.placed(frame));
        SweptBox {
            node,
            chord,
            half: space.half,
            rod: space.rod,
            centre: TwoVectors::new(first.centre, last.centre),
            axes: [0, 1, 2].map(|k| TwoVectors::new(first.axes[k], last.axes[k])),
            bend,
            still_room: bend + margin + slack,
            own_room: own + margin + slack,
        }
    }

    /// How much of the box's own axes lies along an axis.
    #[inline(always)]
    fn across(&self, axis: Vector) -> [Two; 3] {
        let [x, y, z] = &self.axes;
        [x.dot(axis).abs(), y.dot(axis).abs(), z.dot(axis).abs()]
    }

    /// The samples within `span` at which the box may be within the margin of one that stands still;
    /// `None` if there are none.
    #[inline(always)]
    pub fn meets(&self, still: &Obb, span: Span) -> Option<Span> {
        let mut clip = Clip::ALL;
        let apart = self.centre.to(still.centre);
        // Written out, for loops that may end early are not unrolled.
        let [x, y, z] = &still.axes;
        let along_x = self.across(*x);
        let room = Two::from(still.half.x + self.still_room);
        if !clip.axis(room + weigh(along_x, self.half), apart.dot(*x)) {
            return None;
        }
        let along_y = self.across(*y);
        let room = Two::from(still.half.y + self.still_room);
        if !clip.axis(room + weigh(along_y, self.half), apart.dot(*y)) {
            return None;
        }
        let along_z = self.across(*z);
        let room = Two::from(still.half.z + self.still_room);
        if !clip.axis(room + weigh(along_z, self.half), apart.dot(*z)) || clip.empty() {
            return None;
        }
        let own_side = |clip: &mut Clip, j: usize, half: f64| {
            let room = Two::from(half + self.own_room);
            let column = [along_x[j], along_y[j], along_z[j]];
            clip.axis(room + weigh(column, still.half), apart.dot_each(&self.axes[j]))
        };
        let kept = own_side(&mut clip, 0, self.half.x)
            && own_side(&mut clip, 1, self.half.y)
            && own_side(&mut clip, 2, self.half.z);
        if !kept || clip.empty() {
            return None;
        }
        // The product of the two longest axes tells crossing rods apart.
        if self.rod && still.rod {
            let axis = still.axes[2].cross(self.axes[2].sum());
            let square = axis.length_squared();
            if square > 1e-6 {
                let room = still.half.x * axis.dot(still.axes[0]).abs()
                    + still.half.y * axis.dot(still.axes[1]).abs()
                    + self.still_room * square.sqrt();
                let own = self.across(axis);
                let room = Two::from(room) + weigh(own, self.half);
                if !clip.axis(room, apart.dot(axis)) || clip.empty() {
                    return None;
                }
            }
        }
        clip.samples(self.chord, span)
    }
}

#[inline(always)]
fn weigh(across: [Two; 3], half: Vector) -> Two {
    across[0] * Two::from(half.x) + across[1] * Two::from(half.y) + across[2] * Two::from(half.z)
}

/// The ball around a box during the whole motion.
pub(super) struct SweptBall {
    centre: TwoVectors,
    /// Its radius, and by how much it must be larger for the straight line between to do.
    room: f64,
}

impl SweptBall {
    pub fn new(
        space: &Obb,
        [first, last]: &[Frame; 2],
        rates: &Rates,
        spare: f64,
        slack: f64,
    ) -> SweptBall {
        let from_origin = rates.distance(space.centre);
        let margin = spare * rates.speed_at(space.radius + from_origin);
        let room = space.radius + rates.bend_at(from_origin) / 8.0 + margin + slack;
        let centre = TwoVectors::new(first.point(space.centre), last.point(space.centre));
        SweptBall { centre, room }
    }

    /// When the ball may meet a box that stands still.
    #[inline]
    pub fn meets(&self, still: &Obb) -> Option<Clip> {
        let mut clip = Clip::ALL;
        let apart = self.centre.to(still.centre);
        let axis = |clip: &mut Clip, axis: Vector, half: f64| {
            clip.axis(Two::from(half + self.room), apart.dot(axis))
        };
        let [x, y, z] = still.axes;
        let kept = axis(&mut clip, x, still.half.x)
            && axis(&mut clip, y, still.half.y)
            && axis(&mut clip, z, still.half.z);
        (kept && !clip.empty()).then_some(clip)
    }
}

/// Whether a ball of a radius that goes straight misses a box.
pub(in crate::validity) fn misses(from: Vector, to: Vector, radius: f64, still: &Obb) -> bool {
    SweptBall { centre: TwoVectors::new(from, to), room: radius }.meets(still).is_none()
}

/// A share of a chord.
pub(super) struct Clip {
    low: f64,
    high: f64,
}

impl Clip {
    const ALL: Clip = Clip { low: 0.0, high: 1.0 };

    /// Cuts off where the centres are farther apart than the boxes reach, both linear over the chord;
    /// false if nothing is left.
    #[inline(always)]
    fn axis(&mut self, reach: Two, apart: Two) -> bool {
        self.side(reach - apart) && self.side(reach + apart)
    }

    #[inline(always)]
    fn side(&mut self, Two([first, last]): Two) -> bool {
        if first < 0.0 {
            if last < 0.0 {
                return false;
            }
            self.low = self.low.max(first / (first - last));
        } else if last < 0.0 {
            self.high = self.high.min(first / (first - last));
        }
        true
    }

    fn empty(&self) -> bool {
        self.low > self.high + 1e-9
    }

    /// The samples of a chord within it that are in the span, too.
    pub fn samples(&self, chord: Span, span: Span) -> Option<Span> {
        let length = chord.length() as f64;
        let slack = 1e-7 + 1e-9 * length;
        // Samples fit signed integers, to which conversion is one instruction.
        let (low, high) = (self.low * length - slack, self.high * length + slack);
        let floor = low.max(0.0) as i64;
        let first = (floor + i64::from((floor as f64) < low)) as u64;
        let last = high.max(0.0) as i64 as u64;
        let from = span.from.max(chord.from + first);
        let to = span.to.min(chord.from + last);
        (from <= to).then_some(Span { from, to })
    }
}
