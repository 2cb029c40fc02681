//! Two elements during a stretch of samples.

use super::Asks;
use super::search::Sweep;
use super::span::{Samples, Span};
use crate::model::bodies::validity::directions::separating_axis;
use crate::model::bodies::validity::element::Element;
use fearless_simd::Simd;
use parry3d_f64::math::Vector;

/// What keeps two elements apart at one sample.
enum Apart {
    /// The gap along an axis that points to the moving one.
    Along(Vector, f64),
    /// A distance.
    By(f64),
}

impl<S: Simd> Sweep<'_, '_, S> {
    /// Whether two elements come as near, at a sample of the span, as half a step moves the points of
    /// the moving one.
    ///
    /// If only samples are asked about: whether they meet at one. The gap at one sample keeps them apart for a while, for its change is bounded; what is left on
    /// either side is looked at in the same way.
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
        // A sample is cut off by far less than rounding could move it.
        let samples = self.clock.samples as f64 * (1.0 - 1e-9);
        self.stacks.work.count(|work| work.pairs += 1);
        let Samples { from, to } = Samples::around(span, self.clock.samples);
        let (from, to) = (from.max(self.asked.from), to.min(self.asked.to));
        let mut open = [Samples { from, to }; 64];
        let mut count = usize::from(from <= to);
        while count > 0 {
            count -= 1;
            let Samples { from, to } = open[count];
            let middle = from + (to - from) / 2;
            self.stacks.work.count(|work| work.advances += 1);
            let frame = self.frame(middle);
            let corners = element.corners.map(|corner| frame.point(corner));
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
                Some(Apart::Along(axis, gap)) => match &self.course.rates.steady {
                    Some(steady) => {
                        let drift = steady.velocity - steady.turning.cross(frame.shift);
                        let rates = corners.map(|p| axis.dot(drift + steady.turning.cross(p)));
                        hold(&corners.map(|p| axis.dot(p)), &rates, gap - margin, bend)
                    }
                    None => {
                        let time = (gap - margin) / speed;
                        (time, time)
                    }
                },
            };
            // The later part lies on top and is looked at first; both are shorter than half.
            let first = middle as f64 - before * samples;
            if first > from as f64 {
                let held = first as i64 as u64;
                let held = if (held as f64) < first { held + 1 } else { held };
                if held.min(middle) > from {
                    open[count] = Samples { from, to: held.min(middle) - 1 };
                    count += 1;
                }
            }
            let last = middle as f64 + after * samples;
            if last < to as f64 {
                open[count] = Samples { from: (last as i64 as u64).max(middle) + 1, to };
                count += 1;
            }
        }
        false
    }

    /// What keeps two elements apart by more than `margin` at a sample, the one with its corners at
    /// `corners`.
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
        // Two may be farther apart than along any of the axes.
        let way = self.meeting.nearest((element, corners), other, self.clock.at(sample));
        let flat = element.flat || other.flat;
        (way.distance > margin).then_some(match flat {
            true => Apart::By(way.distance),
            false => Apart::Along(way.axis, way.distance),
        })
    }
}

/// For how long, before and after, no corner comes nearer by more than `gap` to what lies below the
/// lowest along an axis: heights, their rates and a bound on their second derivatives.
fn hold(heights: &[f64; 3], rates: &[f64; 3], gap: f64, bend: f64) -> (f64, f64) {
    let bend = bend.max(1e-300);
    let lowest = heights[0].min(heights[1]).min(heights[2]);
    let (mut before, mut after) = (f64::INFINITY, f64::INFINITY);
    for (height, rate) in heights.iter().zip(rates) {
        // Where height − lowest + gap ± rate · t − bend · t² / 2 comes to zero.
        let room = height - lowest + gap;
        let root = (rate * rate + 2.0 * bend * room).sqrt();
        let (towards, away) = if *rate > 0.0 {
            (2.0 * room / (rate + root), (rate + root) / bend)
        } else {
            ((root - rate) / bend, 2.0 * room / (root - rate))
        };
        before = before.min(towards);
        after = after.min(away);
    }
    (before, after)
}
