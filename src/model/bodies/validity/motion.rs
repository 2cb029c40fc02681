//! Whether motions of a robot of rigid links are valid.

use super::BodyScratch;
use super::bodies::{BodyValidity, MotionChecking};
use super::meet::Meeting;
use super::swept::{Asks, Clock, Finds, find, stays_inside};
use crate::model::Validity;
use crate::space::BaseJoint;
use parry3d_f64::math::Vector;

/// A motion that [`MotionChecking::Swept`] refuses comes, at some time, nearer to something than the resolution divided by this.
pub const TOLERANCE: u64 = 2 * FINENESS;
/// For [`MotionChecking::Swept`] motions are cut into steps this many times finer than the resolution, and half a step is
/// the tolerance. A milestone nearer than the tolerance to an obstacle gets no edges and stays a component by itself,
/// and such components crowd out those that could be joined: with 64, one milestone in 2500 among thin walls was such.
/// The cost of finer steps grows with the logarithm of their number.
const FINENESS: u64 = 1 << 16;
/// The most samples of a motion: rounding would make more of them the same.
const SAMPLES_MAX: u64 = 1 << 50;

impl BodyValidity {
    /// Whether the motion is free; see [`Model::motion`](crate::model::Model::motion). Nothing is counted.
    pub(in crate::model) fn judge(
        &self,
        a: &[f64],
        b: &[f64],
        refinement: u32,
        scratch: &mut BodyScratch,
    ) -> bool {
        // The base's origin goes straight and the bounds are convex: where the ball around it is inside at both
        // ends, it is inside all along.
        let bounded = self.decided_by_ball(a) && self.decided_by_ball(b);
        let within = self.space.within_bounds(a) && self.space.within_bounds(b);
        if self.edges == MotionChecking::Swept && !within {
            return false;
        }
        if within && bounded && self.keeps_away(a, b, self.resolution / f64::from(refinement)) {
            return true;
        }
        let steps = self.steps(a, b, refinement);
        match self.edges {
            MotionChecking::Swept => {
                let samples = steps.saturating_mul(FINENESS).min(SAMPLES_MAX);
                self.sweep((a, b), samples, bounded, Asks::AllTimes, scratch) == Some(Finds::Free)
            }
            // Where no body has an inside, it is enough that no surfaces meet at the steps. Else a body could be
            // enclosed at a step, which is excluded if the surfaces meet at no time at all; where that cannot be
            // proved, the steps are checked one by one.
            // Of what may overlap this is the part that may not, see `BodiesWithPenetration`.
            MotionChecking::Sampled | MotionChecking::Penetrating { .. } => {
                let asks = if self.solid { Asks::AllTimes } else { Asks::SampleRange };
                let exact = within && steps <= SAMPLES_MAX;
                match exact.then(|| self.sweep((a, b), steps, bounded, asks, scratch)).flatten() {
                    Some(Finds::Free) => true,
                    Some(Finds::Meets) => false,
                    _ => self.free_at_steps(a, b, steps, scratch),
                }
            }
        }
    }

    /// Whether the motion is free by the cheapest test: the ball around the base's origin that holds the robot stays
    /// farther than `room` from the box around all obstacles, and no two links could collide. In open space it
    /// settles most questions.
    pub(super) fn keeps_away(&self, a: &[f64], b: &[f64], room: f64) -> bool {
        if !self.self_pairs.is_empty() || self.robot.motion == BaseJoint::Fixed {
            return false;
        }
        let Some(obstacles) = &self.obstacles else { return true };
        let planar = self.robot.motion.translations() == 2;
        let origin = |q: &[f64]| Vector::new(q[0], q[1], if planar { 0.0 } else { q[2] });
        let room = self.padded_reach + room + self.slack;
        obstacles.tree.nodes[0].space.misses([origin(a), origin(b)], room)
    }

    /// What continuous collision detection finds of a motion with valid ends, cut into `samples` equal steps. Surfaces
    /// suffice: a body that meets no surface on the way cannot come to lie inside another. `None` if the robot may
    /// leave the bounds.
    fn sweep(
        &self,
        (a, b): (&[f64], &[f64]),
        samples: u64,
        bounded: bool,
        asks: Asks,
        scratch: &mut BodyScratch,
    ) -> Option<Finds> {
        let BodyScratch { timeline, stacks, .. } = scratch;
        let clock = &mut Clock::new(&self.space, &self.robot, (a, b), samples, timeline);
        let inside = bounded
            || self.links.iter().all(|moving| {
                let rates = self.hops.rates(None, moving.link, (a, b), &mut stacks.descent);
                let tree = &moving.group.tree;
                stays_inside(&self.walls(), tree, moving.link, &rates, clock, stacks)
            });
        if !inside {
            return None;
        }
        // Of robots with several pairs of bodies to test about half of the motions are blocked, most often half way:
        // there a collision check of one configuration comes first.
        if self.meetings().nth(1).is_some() && samples > 1 {
            stacks.work.count(|work| work.looks += 1);
            let stance = clock.at(samples / 2);
            if self.meetings().any(|meeting| meeting.surfaces_meet(stance, &mut stacks.pairs)) {
                return Some(Finds::Meets);
            }
        }
        let mut found = self.meetings().map(|meeting| {
            let Meeting { mover_link, still_link, .. } = meeting;
            let rates = self.hops.rates(still_link, mover_link, (a, b), &mut stacks.descent);
            if rates.steady.is_none() {
                self.hops.drives(still_link, mover_link, (a, b), &mut stacks.drives);
            }
            find(meeting, rates, asks, clock, stacks)
        });
        Some(found.find(|finds| *finds != Finds::Free).unwrap_or(Finds::Free))
    }

    /// Whether the configurations strictly between the ends are valid, the motion being cut into `steps` equal steps.
    pub(super) fn free_at_steps(
        &self,
        a: &[f64],
        b: &[f64],
        steps: u64,
        scratch: &mut BodyScratch,
    ) -> bool {
        let mut between = std::mem::take(&mut scratch.between);
        between.clear();
        between.resize(a.len(), 0.0);
        let free = self
            .all_between(a, b, steps, &mut between, |q| self.look(q, scratch) == Validity::Valid);
        scratch.between = between;
        free
    }

    /// Whether `accepts` accepts all configurations strictly between the ends, the motion being cut into `steps` equal steps.
    /// `q` is for a configuration.
    pub(in crate::model) fn all_between(
        &self,
        a: &[f64],
        b: &[f64],
        steps: u64,
        q: &mut [f64],
        mut accepts: impl FnMut(&[f64]) -> bool,
    ) -> bool {
        let way = self.space.way(a, b);
        // The middle first, then the quarters, and so on: that finds a blocked motion soonest, and visits every step
        // once.
        let mut stride = steps.next_power_of_two();
        while stride > 1 {
            stride /= 2;
            for i in (stride..steps).step_by(2 * stride as usize) {
                way.at(i as f64 / steps as f64, q);
                if !accepts(q) {
                    return false;
                }
            }
        }
        true
    }
}
