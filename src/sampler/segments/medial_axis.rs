//! The medial axis of the free space.

use super::{Segment, Step, Target};
use crate::context::Context;
use crate::model::{Clearances, Scratch, Validity, Witnesses};
use std::collections::VecDeque;

/// The configurations that have two nearest points of obstacles, crossed where the nearest point jumps (H.-Y. Yeh 2016,
/// Algorithm 8 and §5.2.2).
///
/// *Where it is looked for.* Between two neighbours whose witnesses lie on parts of obstacles that do not lead to each
/// other ([`SurfacePart::leads_to`](crate::model::SurfacePart::leads_to): different obstacles, parts that are not adjacent, two
/// sides of a concavity), or on such parts of the robot. Both halves are searched in the same way down to the tolerance, so that
/// several crossings between two neighbours are all found if the parts tell.
///
/// *When it is there.* Where the base is translated until the robot touches the nearest obstacle, by the witnesses, is a
/// point on the surface of a C-obstacle. Away from the medial axis that point moves no faster than the robot, since to
/// be projected on a polyhedron or a convex body never makes distances longer. So if it moves by more than the robot
/// between the ends of the last interval, the medial axis has been crossed, and where parts change without that, as
/// where two obstacles stand flush, it has not. With rotations and joints the point may move faster than the
/// robot; then it counts as jumping if it does so still in a small part of the last interval.
pub(in crate::sampler) struct MedialAxis<'a> {
    cx: &'a Context,
    clearances: &'a dyn Clearances,
    /// Whether the sides of the bounds are obstacles.
    bounds: bool,
    /// The length of the last interval in the space's metric.
    tolerance: f64,
    /// Whether only the base is translated.
    translates: bool,
}

/// A nearest point of an obstacle, or of a side of the bounds.
#[derive(Clone, Copy)]
pub(in crate::sampler) struct Nearest {
    on: Thing,
    /// The position of the base if it is translated until the robot touches the nearest point.
    contact: [f64; 3],
}

#[derive(Clone, Copy)]
#[expect(clippy::large_enum_variant, reason = "two are kept at a time, and most are of obstacles")]
enum Thing {
    Obstacle(Witnesses),
    Side { axis: usize, upper: usize },
}

impl Nearest {
    /// Whether the nearest point can move from the one to the other without a jump, by the parts that they lie on.
    fn leads_to(&self, other: &Nearest) -> bool {
        match (&self.on, &other.on) {
            (Thing::Obstacle(one), Thing::Obstacle(two)) => {
                one.of_obstacle.leads_to(&two.of_obstacle) && one.of_robot.leads_to(&two.of_robot)
            }
            (Thing::Side { axis: i, upper: one }, Thing::Side { axis: j, upper: two }) => {
                (i, one) == (j, two)
            }
            _ => false,
        }
    }

    /// How far the nearest point moves from the one to the other, as seen by the base.
    fn jump(&self, other: &Nearest) -> f64 {
        let way = [0, 1, 2].map(|i| self.contact[i] - other.contact[i]);
        (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]).sqrt()
    }
}

/// How many times the last interval is halved once more where rotations and joints move, and the share of its first length that a
/// jump must keep by then. A movement without a jump shrinks to a 64th, or, where it goes as a square root, to an eighth.
const HALVINGS: u32 = 6;
const KEPT: f64 = 0.25;

impl<'a> MedialAxis<'a> {
    /// `None` of a model that has no clearances.
    pub fn new(cx: &'a Context, bounds: bool, tolerance: f64) -> Option<MedialAxis<'a>> {
        let clearances = cx.model.clearances()?;
        let translates = cx.space.cube_dimensions() == cx.space.translations();
        Some(MedialAxis { cx, clearances, bounds, tolerance, translates })
    }

    /// The nearest obstacle or side of the bounds; among those that are equally near an obstacle, then the first axis.
    fn nearest(&self, q: &[f64], scratch: &mut Scratch) -> Option<Nearest> {
        let mut base = [0.0; 3];
        let translations = self.cx.space.translations();
        base[..translations].copy_from_slice(&q[..translations]);
        scratch.count_configuration();
        let mut best = self.clearances.witnesses(q, scratch).map(|found| {
            let clearance = &found.clearance;
            let toward = |i: usize| clearance.on_obstacle[i] - clearance.on_robot[i];
            let contact = [0, 1, 2].map(|i| base[i] + toward(i));
            (clearance.distance, Nearest { on: Thing::Obstacle(found), contact })
        });
        if self.bounds {
            let room = self.clearances.room(q, scratch);
            for (axis, upper) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
                let distance = room[axis][upper];
                if distance.is_finite() && best.is_none_or(|(least, _)| distance < least) {
                    let mut contact = base;
                    contact[axis] += [-distance, distance][upper];
                    let on = Thing::Side { axis, upper };
                    best = Some((distance, Nearest { on, contact }));
                }
            }
        }
        best.map(|(_, nearest)| nearest)
    }

    /// The configuration of a segment at a distance from its start.
    fn step(&mut self, segment: &Segment, at: f64, scratch: &mut Scratch) -> Step<Option<Nearest>> {
        let mut q = vec![0.0; self.cx.space.len()];
        segment.at(at, &mut q);
        let side = self.side(&q, scratch);
        Step { at, q, side }
    }

    /// Whether the nearest point jumps between the ends of an interval no longer than the tolerance.
    fn jumps(
        &mut self,
        segment: &Segment,
        [first, last]: [&Step<Option<Nearest>>; 2],
        scratch: &mut Scratch,
    ) -> bool {
        let (Some(mut one), Some(mut two)) = (first.side, last.side) else { return false };
        let jump = one.jump(&two);
        if jump <= self.tolerance {
            return false;
        }
        let (mut low, mut high) = (first.at, last.at);
        for _ in 0..if self.translates { 0 } else { HALVINGS } {
            let middle = low + (high - low) / 2.0;
            let Some(between) = self.step(segment, middle, scratch).side else { return false };
            // On to the half in which it moves farther.
            if one.jump(&between) >= between.jump(&two) {
                (high, two) = (middle, between);
            } else {
                (low, one) = (middle, between);
            }
        }
        one.jump(&two) > KEPT * jump
    }
}

impl Target for MedialAxis<'_> {
    /// What is nearest; `None` where the configuration collides, or nothing is near.
    type Side = Option<Nearest>;

    fn side(&mut self, q: &[f64], scratch: &mut Scratch) -> Option<Nearest> {
        match self.cx.model.validity(q, scratch) {
            Validity::Invalid => None,
            Validity::OutOfBounds if self.bounds => None,
            // Between a configuration out of bounds and one within them there may be one of the axis within them.
            Validity::OutOfBounds | Validity::Valid => self.nearest(q, scratch),
        }
    }

    fn crossings(
        &mut self,
        segment: &Segment,
        [before, now]: [&Step<Option<Nearest>>; 2],
        scratch: &mut Scratch,
        found: &mut VecDeque<Vec<f64>>,
    ) {
        let (Some(one), Some(two)) = (&before.side, &now.side) else { return };
        if one.leads_to(two) {
            return;
        }
        let middle = before.at + (now.at - before.at) / 2.0;
        if now.at - before.at > self.tolerance && before.at < middle && middle < now.at {
            let between = self.step(segment, middle, scratch);
            self.crossings(segment, [before, &between], scratch, found);
            self.crossings(segment, [&between, now], scratch, found);
        } else if self.jumps(segment, [before, now], scratch) {
            let mut q = vec![0.0; self.cx.space.len()];
            segment.at(middle, &mut q);
            if self.cx.model.is_valid(&q, scratch) {
                found.push_back(q);
            }
        }
    }
}
