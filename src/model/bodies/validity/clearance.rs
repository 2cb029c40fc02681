//! How far the robot is from the nearest obstacle, and where.

use super::BodyScratch;
use super::bodies::BodyValidity;
use super::contacts::{Moved, carried};
use super::frame::{Frame, Stance};
use super::meet::Meeting;
use super::obb::Obb;
use crate::model::{Approach, Clearance, Clearances, Scratch, Witnesses};
use parry3d_f64::math::Vector;

/// Which two elements a clearance lies between. The lesser order wins where clearances are equal.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Order {
    /// Index of the obstacle's element.
    pub still: u32,
    /// The robot's link.
    pub link: usize,
    /// Index of the link's element.
    pub mover: u32,
}

/// A clearance together with what breaks ties.
#[derive(Clone, Copy)]
pub(super) struct Best {
    pub clearance: Clearance,
    pub order: Order,
}

impl Clearances for BodyValidity {
    fn clearance(&self, q: &[f64], scratch: &mut Scratch) -> Option<Clearance> {
        let scratch: &mut BodyScratch = scratch.of_model();
        self.nearest_obstacle(q, scratch).map(|best| best.clearance)
    }

    fn approach(&self, q: &[f64], scratch: &mut Scratch) -> Option<Approach> {
        let scratch: &mut BodyScratch = scratch.of_model();
        let Best { clearance, order } = self.nearest_obstacle(q, scratch)?;
        let [point, toward] = [clearance.on_robot, clearance.on_obstacle].map(Vector::from_array);
        // Where surfaces meet there is no direction, and zeros are the rates.
        let direction = (toward - point).try_normalize().unwrap_or(Vector::ZERO);
        let (link, stance) = (order.link, &scratch.stance);
        let moved = self.moved_stances(q);
        let rate = |moved: &Moved| {
            let apart = carried(stance, link, point, &moved.more)
                - carried(stance, link, point, &moved.less);
            direction.dot(apart) / (2.0 * moved.by)
        };
        Some(Approach { clearance, rates: moved.iter().map(rate).collect() })
    }

    fn witnesses(&self, q: &[f64], scratch: &mut Scratch) -> Option<Witnesses> {
        let scratch: &mut BodyScratch = scratch.of_model();
        let best = self.nearest_obstacle(q, scratch)?;
        self.parts(&best, &scratch.stance.frames)
    }

    fn room(&self, q: &[f64], scratch: &mut Scratch) -> [[f64; 2]; 3] {
        let scratch: &mut BodyScratch = scratch.of_model();
        self.robot.link_poses(q, &mut scratch.stance.poses);
        scratch.stance.update_frames();
        self.room_at(q, &scratch.stance.frames)
    }

    fn farthest(&self, a: &[f64], b: &[f64]) -> f64 {
        self.speeds.farthest(&self.robot, a, b)
    }
}

impl BodyValidity {
    /// The clearance at a configuration; the scratch holds afterwards how the links stand there.
    fn nearest_obstacle(&self, q: &[f64], scratch: &mut BodyScratch) -> Option<Best> {
        self.robot.link_poses(q, &mut scratch.stance.poses);
        scratch.stance.update_frames();
        let BodyScratch { stance, stacks, .. } = scratch;
        let among = self.meetings().take_while(|meeting| meeting.still_link.is_none());
        among.fold(None, |best, meeting| meeting.nearer(stance, &mut stacks.pairs, best))
    }
}

impl Meeting<'_> {
    /// The smaller of `best` and the distance of the two groups, the standing one being the obstacles: branch and
    /// bound over both trees.
    pub fn nearer(
        &self,
        stance: &Stance,
        stack: &mut Vec<(u32, u32)>,
        mut best: Option<Best>,
    ) -> Option<Best> {
        let (movers, stills) = (&self.mover.tree.nodes, &self.still.tree.nodes);
        let frame = stance.seen(self.mover_link, self.still_link);
        stack.clear();
        stack.push((0, 0));
        while let Some((i, j)) = stack.pop() {
            let (mover, still) = (&movers[i as usize], &stills[j as usize]);
            let bound = apart(&mover.space, &still.space, &frame) - self.slack;
            if best.is_some_and(|best| bound > best.clearance.distance) {
                continue;
            }
            if mover.is_leaf() && still.is_leaf() {
                let found = self.way(mover.element, still.element, stance, &frame);
                let ahead = |best: &Best| {
                    let (old, new) = (best.clearance.distance, found.clearance.distance);
                    new.total_cmp(&old).then(found.order.cmp(&best.order)).is_lt()
                };
                if best.as_ref().is_none_or(ahead) {
                    best = Some(found);
                }
                continue;
            }
            let mut children = if !mover.is_leaf()
                && (still.is_leaf() || mover.space.radius > still.space.radius)
            {
                [(mover.left, j), (mover.left + 1, j)]
            } else {
                [(i, still.left), (i, still.left + 1)]
            };
            // The nearer pair is examined first: it lowers the bound that may rule out the other.
            let [first, second] = children.map(|(i, j)| {
                let from = frame.point(movers[i as usize].space.centre);
                (stills[j as usize].space.centre - from).length_squared()
            });
            if first < second {
                children.swap(0, 1);
            }
            stack.extend(children);
        }
        best
    }

    fn way(&self, mover: u32, still: u32, stance: &Stance, frame: &Frame) -> Best {
        let element = &self.mover.tree.elements[mover as usize];
        let other = &self.still.tree.elements[still as usize];
        let corners = element.corners.map(|corner| frame.point(corner));
        let way = self.nearest(element, &corners, other, stance);
        let clearance = Clearance {
            distance: way.distance,
            on_robot: way.on_mover.to_array(),
            on_obstacle: way.on_still.to_array(),
            obstacle: other.piece as usize,
        };
        Best { clearance, order: Order { still, link: self.mover_link, mover } }
    }
}

/// A lower bound on the distance of two boxes: the largest of the distance of their bounding spheres and the gaps along
/// the axes of both.
pub(super) fn apart(mover: &Obb, still: &Obb, frame: &Frame) -> f64 {
    let way = still.centre - frame.point(mover.centre);
    let axes = mover.axes.map(|axis| frame.direction(axis));
    let mut gap = way.length() - mover.radius - still.radius;
    let reach = |axis: Vector, axes: &[Vector; 3], half: Vector| {
        let [x, y, z] = axes.map(|other| axis.dot(other).abs());
        half.x * x + half.y * y + half.z * z
    };
    for k in 0..3 {
        let (fixed, own) = (still.axes[k], axes[k]);
        gap = gap.max(fixed.dot(way).abs() - still.half[k] - reach(fixed, &axes, mover.half));
        gap = gap.max(own.dot(way).abs() - mover.half[k] - reach(own, &still.axes, still.half));
    }
    gap
}
