//! Validity of a rigid body among obstacles.

use super::inside::Inside;
use super::{Scratch, Validity};
use crate::math;
use crate::scene::{Body, Shape};
use crate::space::{Motion, Space};
use bincode::{Decode, Encode};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query::{DefaultQueryDispatcher, QueryDispatcher};
use parry3d_f64::shape::SharedShape;
use serde::{Deserialize, Serialize};

/// Which points of the robot the bounds hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum BoundsMeaning {
    /// Every point of the robot stays inside (of a planar robot: in x and y).
    Body,
    /// Only the robot's reference point, the origin of its frame, does.
    Reference,
}

/// The box that bounds the robot, in the world's frame.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Bounds {
    /// Least x, y and z; z is not used for planar robots.
    pub min: [f64; 3],
    /// Largest x, y and z.
    pub max: [f64; 3],
    /// What must stay inside.
    pub meaning: BoundsMeaning,
}

/// A body prepared for collision tests. A point has no shape.
struct Piece {
    shape: Option<SharedShape>,
    /// The shape's frame in the robot's or the world's.
    pose: Pose,
    /// The body's own frame in the robot's or the world's (a cylinder's differs from its shape's).
    body: Pose,
    form: Shape,
    inside: Option<Inside>,
    /// In the body's frame.
    witnesses: Vec<Vector>,
    /// Of an obstacle: its box in the world's frame.
    aabb: Aabb,
}

impl Piece {
    fn new(body: &Body) -> Piece {
        let frame = body.pose.to_parry();
        let (shape, pose) = match body.shape.to_parry() {
            Some((shape, local)) => (Some(shape), frame * local),
            None => (None, frame),
        };
        let inside = match &body.shape {
            Shape::Mesh(mesh) if body.solid => Some(Inside::new(mesh)),
            _ => None,
        };
        let origin = Vector::from_array(body.pose.translation);
        let aabb = match &shape {
            Some(shape) => shape.compute_aabb(&pose),
            None => Aabb::new(origin, origin),
        };
        let witnesses = body.shape.witnesses().into_iter().map(Vector::from_array).collect();
        Piece { shape, pose, body: frame, form: body.shape.clone(), inside, witnesses, aabb }
    }

    /// Whether the piece, its body's frame standing at `body`, holds a point of the other, whose
    /// body's frame stands at `other_body`.
    fn encloses(&self, body: &Pose, other: &Piece, other_body: &Pose) -> bool {
        let Some(inside) = &self.inside else {
            return false;
        };
        other.witnesses.iter().any(|witness| {
            let world = other_body.transform_point(*witness);
            inside.contains(body.inverse_transform_point(world))
        })
    }
}

/// Validity of one rigid body, made of several pieces, among obstacles that stand still.
///
/// Bodies collide when their surfaces meet or when one lies wholly inside another that is solid.
/// Motions are checked at discrete steps: no robot point moves farther between two checks than
/// the resolution, for it moves at most |Δtranslation| + radius · |Δangle|.
pub struct RigidValidity {
    space: Space,
    motion: Motion,
    bounds: Bounds,
    resolution: f64,
    /// A bound on the distance of the robot's points from its reference point.
    radius: f64,
    robot: Vec<Piece>,
    obstacles: Vec<Piece>,
}

impl RigidValidity {
    /// Prepares the bodies. `resolution` is a length; see [`Validity::motion`].
    pub fn new(
        space: Space,
        motion: Motion,
        bounds: Bounds,
        resolution: f64,
        robot: &[Body],
        obstacles: &[Body],
    ) -> RigidValidity {
        RigidValidity {
            space,
            motion,
            bounds,
            resolution,
            radius: robot_radius(robot),
            robot: robot.iter().map(Piece::new).collect(),
            obstacles: obstacles.iter().map(Piece::new).collect(),
        }
    }

    /// The pose of the robot's frame in the world's.
    pub fn pose(&self, q: &[f64]) -> Pose {
        robot_pose(self.motion, q)
    }

    fn in_bounds(&self, q: &[f64], robot: &Pose) -> bool {
        if !self.space.within_bounds(q) {
            return false;
        }
        if self.bounds.meaning == BoundsMeaning::Reference {
            return true;
        }
        let Bounds { min, max, .. } = self.bounds;
        let axes = self.motion.translations();
        // The ball about the reference point settles most configurations.
        if (0..axes).all(|i| q[i] - self.radius >= min[i] && q[i] + self.radius <= max[i]) {
            return true;
        }
        let axes = &[Vector::X, Vector::Y, Vector::Z][..axes];
        self.robot.iter().all(|piece| {
            let frame = *robot * piece.body;
            axes.iter().enumerate().all(|(i, axis)| {
                let direction = frame.rotation.inverse() * *axis;
                let centre = frame.translation.to_array()[i];
                centre + piece.form.extent(direction.to_array()) <= max[i]
                    && centre - piece.form.extent((-direction).to_array()) >= min[i]
            })
        })
    }

    fn collide(&self, robot: &Pose, piece: usize, obstacle: usize) -> bool {
        let (piece, obstacle) = (&self.robot[piece], &self.obstacles[obstacle]);
        let frame = *robot * piece.pose;
        let touching = match (&piece.shape, &obstacle.shape) {
            (_, None) => false,
            (None, Some(shape)) => {
                // A mesh has no inside for parry; `encloses` below knows better.
                shape.as_trimesh().is_none()
                    && shape.contains_point(&obstacle.pose, frame.translation)
            }
            (Some(moving), Some(still)) => {
                if !moving.compute_aabb(&frame).intersects(&obstacle.aabb) {
                    return false;
                }
                let pos12 = obstacle.pose.inv_mul(&frame);
                DefaultQueryDispatcher
                    .intersection_test(&pos12, &*still.0, &*moving.0)
                    .expect("parry tests every pair of our shapes")
                    .intersecting
            }
        };
        let body = *robot * piece.body;
        touching
            || obstacle.encloses(&obstacle.body, piece, &body)
            || piece.encloses(&body, obstacle, &obstacle.body)
    }

    fn check(&self, q: &[f64], last_hit: &mut Option<(usize, usize)>) -> bool {
        let robot = self.pose(q);
        if !self.in_bounds(q, &robot) {
            return false;
        }
        if let Some((piece, obstacle)) = *last_hit
            && piece < self.robot.len()
            && obstacle < self.obstacles.len()
            && self.collide(&robot, piece, obstacle)
        {
            return false;
        }
        let reach = Vector::splat(self.radius);
        let near = Aabb::new(robot.translation - reach, robot.translation + reach);
        for (index, obstacle) in self.obstacles.iter().enumerate() {
            if !near.intersects(&obstacle.aabb) {
                continue;
            }
            for piece in 0..self.robot.len() {
                if self.collide(&robot, piece, index) {
                    *last_hit = Some((piece, index));
                    return false;
                }
            }
        }
        true
    }

    /// Number of steps in which a motion is checked.
    pub(super) fn steps(&self, a: &[f64], b: &[f64], refinement: u32) -> u64 {
        let step = self.resolution / f64::from(refinement);
        (self.farthest(a, b) / step).ceil().max(1.0) as u64
    }

    /// The farthest that any robot point can move between the two configurations.
    fn farthest(&self, a: &[f64], b: &[f64]) -> f64 {
        let axes = self.motion.translations();
        let mut translation = 0.0;
        for i in 0..axes {
            translation += (b[i] - a[i]) * (b[i] - a[i]);
        }
        let angle = match self.motion {
            Motion::Translation2d | Motion::Translation3d => 0.0,
            Motion::Rigid2d => math::angle_between(a[2], b[2]),
            Motion::Rigid3d => {
                let dot: f64 = (3..7).map(|i| a[i] * b[i]).sum();
                2.0 * math::acos(dot.abs())
            }
        };
        translation.sqrt() + self.radius * angle
    }
}

impl Validity for RigidValidity {
    fn valid(&self, q: &[f64], scratch: &mut Scratch) -> bool {
        scratch.asked.configurations += 1;
        self.check(q, &mut scratch.last_hit)
    }

    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> bool {
        scratch.asked.motions += 1;
        let steps = self.steps(a, b, refinement);
        scratch.between.clear();
        scratch.between.resize(a.len(), 0.0);
        // Halving the gaps finds a blocked motion soonest; every step is visited once.
        let mut stride = steps.next_power_of_two();
        while stride > 1 {
            stride /= 2;
            for i in (stride..steps).step_by(2 * stride as usize) {
                let t = i as f64 / steps as f64;
                self.space.interpolate(a, b, t, &mut scratch.between);
                if !self.check(&scratch.between, &mut scratch.last_hit) {
                    return false;
                }
            }
        }
        true
    }
}

/// A bound on the distance of the robot's points from the origin of its frame.
pub(crate) fn robot_radius(robot: &[Body]) -> f64 {
    robot.iter().fold(0.0f64, |most, body| most.max(body.shape.reach(&body.pose)))
}

/// The pose of the robot's frame in the world's at a configuration.
pub(crate) fn robot_pose(motion: Motion, q: &[f64]) -> Pose {
    match motion {
        Motion::Translation2d => Pose::from_translation(Vector::new(q[0], q[1], 0.0)),
        Motion::Rigid2d => {
            let (sine, cosine) = (math::sin(q[2] / 2.0), math::cos(q[2] / 2.0));
            Pose::from_parts(
                Vector::new(q[0], q[1], 0.0),
                Rotation::from_xyzw(0.0, 0.0, sine, cosine),
            )
        }
        Motion::Translation3d => Pose::from_translation(Vector::new(q[0], q[1], q[2])),
        Motion::Rigid3d => Pose::from_parts(
            Vector::new(q[0], q[1], q[2]),
            Rotation::from_xyzw(q[4], q[5], q[6], q[3]),
        ),
    }
}
