//! Conservative advancement: whether two elements come near each other during a range of samples.

use super::Asks;
use super::search::Sweep;
use super::span::{SampleRange, Span};
use crate::model::bodies::robot::Steady;
use crate::model::bodies::validity::directions::separating_axis;
use crate::model::bodies::validity::element::Element;
use crate::model::bodies::validity::frame::{Frame, Velocities};
use fearless_simd::Simd;
use parry3d_f64::math::Vector;

/// What keeps two elements apart at one sample.
enum Apart {
    /// A unit vector from the standing element towards the moving one, and the gap along it.
    Along(Vector, f64),
    /// Their distance, where no axis along which they are that far apart is known.
    By(f64),
}

impl<S: Simd> Sweep<'_, '_, S> {
    /// Whether the elements of two leaves come nearer to each other, at a sample within the span, than half a step
    /// moves the points of the moving one; with [`Asks::SampleRange`], whether they meet at one of the samples.
    ///
    /// The gap between the elements is computed at the middle sample. Since the velocity of their points is bounded, it
    /// proves that they stay apart for some time before and after; the samples that are left on either side are
    /// examined in the same way.
    #[inline(never)]
    pub(super) fn touches(&mut self, moving: u32, node: u32, span: Span) -> bool {
        let meeting = self.meeting;
        let moving = &meeting.mover.tree.nodes[moving as usize];
        let node = &meeting.still.tree.nodes[node as usize];
        let element = &meeting.mover.tree.elements[moving.element as usize];
        let other = &meeting.still.tree.elements[node.element as usize];
        let reach = element.reach(&self.course.rates);
        let (speed, bend) = (self.course.rates.speed_at(reach), self.course.rates.bend_at(reach));
        let margin = self.course.spare * speed;
        // Slightly fewer samples to a unit of time, so that rounding never makes a proved stretch too long.
        let samples = self.clock.samples as f64 * (1.0 - 1e-9);
        self.stacks.work.count(|work| work.pairs += 1);
        let SampleRange { from, to } = SampleRange::around(span, self.clock.samples);
        let (from, to) = (from.max(self.asked.from), to.min(self.asked.to));
        let mut open = [SampleRange { from, to }; 64];
        let mut count = usize::from(from <= to);
        while count > 0 {
            count -= 1;
            let SampleRange { from, to } = open[count];
            let middle = from + (to - from) / 2;
            self.stacks.work.count(|work| work.advances += 1);
            let frame = self.frame(middle);
            let corners = frame.points(&element.corners);
            let apart = self.apart(element, &corners, other, middle, margin);
            if apart.is_none() {
                self.meets = meeting.ends_meet(moving, node, &frame, self.clock.at(middle))
                    && (1..self.clock.samples).contains(&middle);
                if self.meets || self.asks == Asks::AllTimes {
                    return true;
                }
            }
            if from == to {
                continue;
            }
            let (before, after) = match apart {
                None => (0.0, 0.0),
                Some(Apart::By(distance)) => {
                    let time = (distance - margin) / speed;
                    (time, time)
                }
                Some(Apart::Along(axis, gap)) => {
                    let velocities = self.velocities(middle, &frame);
                    let [a, b, c] = corners;
                    let rates = [velocities.at(a), velocities.at(b), velocities.at(c)];
                    let rates = [axis.dot(rates[0]), axis.dot(rates[1]), axis.dot(rates[2])];
                    let heights = [axis.dot(a), axis.dot(b), axis.dot(c)];
                    let (before, after) = hold(&heights, &rates, gap - margin, bend);
                    // Of a rigid body the bounds on velocities are velocities that points have, so that they hold for no longer.
                    let time = match self.course.rates.steady {
                        Some(_) => 0.0,
                        None => (gap - margin) / speed,
                    };
                    (before.max(time), after.max(time))
                }
            };
            // The later part is pushed last and examined first. Both parts are shorter than half of the range, so
            // that the stack of 64 ranges suffices.
            let first = middle as f64 - before * samples;
            if first > from as f64 {
                let held = first as i64 as u64;
                let held = if (held as f64) < first { held + 1 } else { held };
                if held.min(middle) > from {
                    open[count] = SampleRange { from, to: held.min(middle) - 1 };
                    count += 1;
                }
            }
            let last = middle as f64 + after * samples;
            if last < to as f64 {
                open[count] = SampleRange { from: (last as i64 as u64).max(middle) + 1, to };
                count += 1;
            }
        }
        false
    }

    /// How fast the points of the moving group move at a sample, as seen from the standing one; `frame` is where the moving
    /// group stands then.
    fn velocities(&mut self, sample: u64, frame: &Frame) -> Velocities {
        match &self.course.rates.steady {
            Some(Steady { velocity, turning, .. }) => {
                Velocities { at_origin: *velocity - turning.cross(frame.shift), turning: *turning }
            }
            None => self.clock.at(sample).velocities(&self.stacks.drives, self.meeting.still_link),
        }
    }

    /// What proves that two elements are apart by more than `margin` at a sample, the moving one having its
    /// corners at `corners`; `None` if they are not.
    fn apart(
        &mut self,
        element: &Element,
        corners: &[Vector; 3],
        other: &Element,
        sample: u64,
        margin: f64,
    ) -> Option<Apart> {
        let thick = element.radius + other.radius;
        if let Some((axis, gap)) =
            separating_axis(self.meeting.lanes, corners, &other.corners, margin + thick)
        {
            return Some(Apart::Along(axis, gap - thick));
        }
        // Not conclusive: elements may be farther apart than the widest gap along any of the axes tried.
        let way = self.meeting.nearest(element, corners, other, self.clock.at(sample));
        let flat = element.flat || other.flat;
        (way.distance > margin).then_some(match flat {
            true => Apart::By(way.distance),
            false => Apart::Along(way.axis, way.distance),
        })
    }
}

/// For how long before and after a moment three corners stay above a plane that lies `gap` below the lowest of
/// them, given their heights above some parallel plane, the rates of the heights, and a bound `bend` on the second
/// derivatives of the heights.
fn hold(heights: &[f64; 3], rates: &[f64; 3], gap: f64, bend: f64) -> (f64, f64) {
    let bend = bend.max(1e-300);
    let lowest = heights[0].min(heights[1]).min(heights[2]);
    let (mut before, mut after) = (f64::INFINITY, f64::INFINITY);
    let corners = [(heights[0], rates[0]), (heights[1], rates[1]), (heights[2], rates[2])];
    for (height, rate) in corners {
        // Where height − lowest + gap ± rate · t − bend · t² / 2 comes to zero.
        let room = height - lowest + gap;
        let root = (rate * rate + 2.0 * bend * room).sqrt();
        let (towards, away) = if rate > 0.0 {
            (2.0 * room / (rate + root), (rate + root) / bend)
        } else {
            ((root - rate) / bend, 2.0 * room / (root - rate))
        };
        before = before.min(towards);
        after = after.min(away);
    }
    (before, after)
}
