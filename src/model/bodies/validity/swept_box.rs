//! The box around everything that a robot passes during a motion, against the boxes of the obstacles.
//!
//! Along a motion the point of a link at distance `d` from where the link turns leaves the straight line between its
//! ends by at most an eighth of the bound on its acceleration ([`Rates`](crate::model::bodies::robot::Rates);
//! `docs/validity.md` derives it). So the boxes around a link at both ends, with that eighth on every side, hold the link
//! all along. Of a base that moves, whose origin goes straight, the ball about the origin that holds the robot gives
//! another box, the better one of far turns; each link is in both.

use super::bodies::{BodyValidity, Moving};
use super::frame::Frame;
use super::motion::TOLERANCE;
use super::scratch::BodyScratch;
use crate::space::BaseJoint;
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::Vector;

impl BodyValidity {
    /// Whether the box around a link along the whole motion from `a` to `b` meets that of an obstacle. Boxes are larger
    /// by the tolerance of [`MotionChecking::Swept`](super::MotionChecking::Swept), so that a motion which meets none is
    /// one that no way of checking refuses because of the obstacles.
    pub(super) fn swept_box_meets(&self, a: &[f64], b: &[f64], scratch: &mut BodyScratch) -> bool {
        let Some(obstacles) = &self.obstacles else { return false };
        let margin = self.resolution / TOLERANCE as f64 + self.slack;
        let mut ball = None;
        if self.robot.motion != BaseJoint::Fixed {
            let planar = self.robot.motion.translations() == 2;
            let origin = |q: &[f64]| Vector::new(q[0], q[1], if planar { 0.0 } else { q[2] });
            let (from, to, reach) = (origin(a), origin(b), self.padded_reach + margin);
            if obstacles.tree.nodes[0].space.misses([from, to], reach) {
                return false;
            }
            let room = Vector::splat(reach);
            let around = Aabb::new(from.min(to) - room, from.max(to) + room);
            if !self.boxes.iter().any(|other| around.intersects(other)) {
                return false;
            }
            ball = Some(around);
        }
        let BodyScratch { stance, stacks, between, .. } = scratch;
        // The boxes at the beginning, six numbers for each link, while those at the end are computed.
        between.clear();
        for q in [a, b] {
            self.robot.link_poses(q, &mut stance.poses);
            stance.update_frames();
            if between.is_empty() {
                for moving in &self.links {
                    let around = box_at(moving, &stance.frames[moving.link]);
                    between.extend(around.mins.to_array());
                    between.extend(around.maxs.to_array());
                }
            }
        }
        self.links.iter().zip(between.chunks_exact(6)).any(|(moving, first)| {
            let rates = self.hops.rates(None, moving.link, (a, b), &mut stacks.descent);
            let space = &moving.among_obstacles().tree.nodes[0].space;
            let farthest = rates.distance(space.centre) + space.radius;
            let room = Vector::splat(rates.bend_at(farthest) / 8.0 + margin);
            let last = box_at(moving, &stance.frames[moving.link]);
            let low = Vector::new(first[0], first[1], first[2]).min(last.mins) - room;
            let high = Vector::new(first[3], first[4], first[5]).max(last.maxs) + room;
            let (low, high) = match &ball {
                Some(ball) => (low.max(ball.mins), high.min(ball.maxs)),
                None => (low, high),
            };
            let around = Aabb::new(low, high);
            self.boxes.iter().any(|other| around.intersects(other))
        })
    }
}

/// The box around a link in the world's frame, the link standing at `frame`.
fn box_at(moving: &Moving, frame: &Frame) -> Aabb {
    let space = &moving.among_obstacles().tree.nodes[0].space;
    let centre = frame.point(space.centre);
    let sides = space.axes.map(|axis| frame.direction(axis).abs());
    let half = sides[0] * space.half.x + sides[1] * space.half.y + sides[2] * space.half.z;
    Aabb::new(centre - half, centre + half)
}
