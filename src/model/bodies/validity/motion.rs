//! Whether motions of a robot of rigid links are valid.

use super::BodyScratch;
use super::bodies::{BodyValidity, Edges};
use super::swept::{Asks, Clock, Finds, find, stays_inside};
use crate::model::Validity;
use crate::space::Motion;
use parry3d_f64::math::Vector;

/// A swept motion that is found not to be free comes, at some time, nearer to something than the
/// resolution divided by this.
pub const TOLERANCE: u64 = 2 * FINENESS;
/// Swept motions are cut into steps so many times finer than the resolution; half a step is the
/// tolerance. Milestones nearer than that to something have no edges and count as components of their
/// own, which crowd out those that could be joined: with 64, one in 2500 among thin walls.
const FINENESS: u64 = 1 << 16;
/// More samples than this would be told apart by rounding alone.
const SAMPLES_MAX: u64 = 1 << 50;

impl BodyValidity {
    /// See [`Model::motion`](crate::model::Model::motion).
    pub(super) fn judge(
        &self,
        a: &[f64],
        b: &[f64],
        refinement: u32,
        scratch: &mut BodyScratch,
    ) -> bool {
        // The base's origin goes straight, so that the ball around it needs its ends only.
        let bounded = self.settled_by_ball(a) && self.settled_by_ball(b);
        let within = self.space.within_bounds(a) && self.space.within_bounds(b);
        if self.edges == Edges::Swept && !within {
            return false;
        }
        if within && bounded && self.keeps_away(a, b, self.resolution / f64::from(refinement)) {
            return true;
        }
        let steps = self.steps(a, b, refinement);
        match self.edges {
            Edges::Swept => {
                let samples = steps.saturating_mul(FINENESS).min(SAMPLES_MAX);
                self.sweep((a, b), samples, bounded, Asks::AllTimes, scratch) == Some(Finds::Free)
            }
            // Without insides it is enough that no surfaces meet at the steps. What is free at all times
            // encloses nothing on the way; if that is in doubt the steps are looked at one by one.
            Edges::Sampled => {
                let asks = if self.solid { Asks::AllTimes } else { Asks::Samples };
                let exact = within && steps <= SAMPLES_MAX;
                match exact.then(|| self.sweep((a, b), steps, bounded, asks, scratch)).flatten() {
                    Some(Finds::Free) => true,
                    Some(Finds::Meets) => false,
                    _ => self.free_at_steps(a, b, steps, scratch),
                }
            }
        }
    }

    /// Whether the ball about the base's origin that holds the robot stays farther than `room` from the box
    /// around all obstacles, and nothing else is to be looked at. It settles most questions where there is
    /// much room.
    pub(super) fn keeps_away(&self, a: &[f64], b: &[f64], room: f64) -> bool {
        if !self.self_pairs.is_empty() || self.robot.motion == Motion::Fixed {
            return false;
        }
        let Some(obstacles) = &self.obstacles else { return true };
        let planar = self.robot.motion.translations() == 2;
        let origin = |q: &[f64]| Vector::new(q[0], q[1], if planar { 0.0 } else { q[2] });
        let room = self.reach + room + self.slack;
        obstacles.tree.nodes[0].space.misses([origin(a), origin(b)], room)
    }

    /// What is found of a motion of valid ends, by looking at so many equal steps: what no surface meets
    /// on the way cannot come to lie inside anything. `None` if the body may leave the bounds.
    fn sweep(
        &self,
        (a, b): (&[f64], &[f64]),
        samples: u64,
        bounded: bool,
        asks: Asks,
        scratch: &mut BodyScratch,
    ) -> Option<Finds> {
        let BodyScratch { timeline, stacks, .. } = scratch;
        let clock = &mut Clock::new((&self.space, &self.robot), (a, b), samples, timeline);
        let inside = bounded
            || self.links.iter().all(|moving| {
                let rates = self.hops.rates((None, moving.link), (a, b), &mut stacks.descent);
                let tree = &moving.group.tree;
                stays_inside(&self.walls(), (tree, moving.link), &rates, clock, stacks)
            });
        if !inside {
            return None;
        }
        // With many pairs of links half of the motions are blocked, most often half way.
        if self.meetings().nth(1).is_some() && samples > 1 {
            stacks.work.count(|work| work.looks += 1);
            let stance = clock.at(samples / 2);
            if self.meetings().any(|meeting| meeting.surfaces_meet(stance, &mut stacks.pairs)) {
                return Some(Finds::Meets);
            }
        }
        let mut found = self.meetings().map(|meeting| {
            let links = (meeting.still_link, meeting.mover_link);
            let rates = self.hops.rates(links, (a, b), &mut stacks.descent);
            find(meeting, rates, asks, clock, stacks)
        });
        Some(found.find(|finds| *finds != Finds::Free).unwrap_or(Finds::Free))
    }

    /// Whether every configuration strictly between the ends is valid, at so many equal steps.
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
        let way = self.space.way(a, b);
        let mut free = true;
        // Halving the gaps finds a blocked motion soonest; every step is visited once.
        let mut stride = steps.next_power_of_two();
        'steps: while stride > 1 {
            stride /= 2;
            for i in (stride..steps).step_by(2 * stride as usize) {
                way.at(i as f64 / steps as f64, &mut between);
                if self.look(&between, scratch) != Validity::Valid {
                    free = false;
                    break 'steps;
                }
            }
        }
        scratch.between = between;
        free
    }
}
