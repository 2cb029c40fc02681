use super::path::movement;
use super::{Deform, Obstacles, Refusal, SoftBody};
use crate::scene::Pose;
use crate::space::Space;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A deformable robot among obstacles: all that is needed to deform it along motions of the rigid robot.
#[derive(Clone, Copy)]
pub struct DeformableRobot<'a> {
    /// The space of the rigid robot's configurations.
    pub space: &'a Space,
    /// The pose of the robot's frame in the world's at a configuration.
    pub pose: &'a dyn Fn(&[f64]) -> Pose,
    /// The robot at rest.
    pub body: &'a SoftBody,
    /// The method of deformation.
    pub method: &'a dyn Deform,
    /// What the robot must be free of.
    pub obstacles: &'a Obstacles,
    /// The highest energy of a shape that is accepted, a length; it may be infinite.
    pub highest_energy: f64,
    /// The distance from the obstacles that the method of deformation keeps, a length: at least 0.
    pub clearance: f64,
    /// The farthest that a vertex may move from one frame to the next, in the world's frame, a length above 0.
    pub step: f64,
}

/// What deforming a robot took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Deformations {
    /// At how many configurations the method did more than to find the robot at rest free.
    pub tried: u64,
    /// At how many of these it found no shape that is accepted.
    pub failed: u64,
    /// At how many configurations the robot was free at rest.
    pub at_rest: u64,
    /// How many blends of two shapes were tested for obstacles.
    pub blends: u64,
}

/// The clearance at two frames bounds how far the surface may move between them: were it less than twice the clearance, the surface would stay
/// free. This is the factor instead of two, so that a twentieth of the clearance is left for the rounding of distances.
const MOVEMENT_PER_CLEARANCE: f64 = 1.9;

/// A shape of the robot at a configuration.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// The vertices in the robot's frame.
    pub vertices: Arc<[[f64; 3]]>,
    pub energy: f64,
}

/// The shapes at the ends of motions, which several motions have in common, and what all deformations took.
pub(super) struct Shapes<'a> {
    pub robot: DeformableRobot<'a>,
    rest: Arc<[[f64; 3]]>,
    at_ends: BTreeMap<Vec<u64>, Result<Shape, Refusal>>,
    pub took: Deformations,
    /// How many more frames can be kept.
    pub room: usize,
}

/// The most vertices of all frames that a query keeps, 800 MB of them.
const VERTICES_MAX: usize = 1 << 25;

impl DeformableRobot<'_> {
    /// What is wrong with the lengths, in words: the field, what was found and what is expected.
    pub fn complaint(&self) -> Option<String> {
        let DeformableRobot { clearance, step, highest_energy, .. } = self;
        let complaint = |name: &str, found: &f64, expected: &str| {
            Some(format!("{name}: {found} found; {expected} expected"))
        };
        match () {
            () if !(clearance.is_finite() && *clearance >= 0.0) => {
                complaint("clearance", clearance, "a length of at least 0")
            }
            () if !(step.is_finite() && *step > 0.0) => complaint("step", step, "a length above 0"),
            () if highest_energy.is_nan() || *highest_energy < 0.0 => {
                complaint("highest_energy", highest_energy, "a length of at least 0")
            }
            () => None,
        }
    }

    /// The farthest that a vertex moves from one frame to the next: as far as a step, and with a clearance less far than would take the
    /// surface through an obstacle.
    pub fn longest_movement(&self) -> f64 {
        match self.clearance > 0.0 {
            true => self.step.min(MOVEMENT_PER_CLEARANCE * self.clearance),
            false => self.step,
        }
    }

    /// The farthest that a vertex of the robot at rest is moved from one pose to another.
    pub(super) fn rigid_movement(&self, from: &Pose, to: &Pose) -> f64 {
        let rest = self.body.vertices();
        movement(&placed(rest, from), &placed(rest, to))
    }

    /// Whether a blend of two shapes is free of obstacles where the robot's frame has a pose, and accepted by the method.
    fn accepts_blend(&self, pose: &Pose, vertices: &[[f64; 3]]) -> bool {
        self.method.accepts_blend(pose, vertices)
            && self.obstacles.is_free_body(self.body, &placed(vertices, pose), self.clearance)
    }
}

impl<'a> Shapes<'a> {
    pub fn new(robot: DeformableRobot<'a>) -> Shapes<'a> {
        let rest = robot.body.vertices().into();
        let room = VERTICES_MAX / robot.body.vertices().len().max(1);
        Shapes { robot, rest, at_ends: BTreeMap::new(), took: Deformations::default(), room }
    }

    /// The shape at a configuration.
    pub fn at(&mut self, q: &[f64]) -> Result<Shape, Refusal> {
        let found = self.deformed(&(self.robot.pose)(q));
        match &found {
            Ok(shape) if shape.vertices == self.rest => self.took.at_rest += 1,
            Ok(_) => self.took.tried += 1,
            Err(_) => {
                self.took.tried += 1;
                self.took.failed += 1;
            }
        }
        found
    }

    /// The shape at a configuration where motions end: what is found is remembered, be it a shape or none.
    pub fn at_end(&mut self, q: &[f64]) -> Result<Shape, Refusal> {
        let key: Vec<u64> = q.iter().map(|value| value.to_bits()).collect();
        if let Some(known) = self.at_ends.get(&key) {
            return known.clone();
        }
        let found = self.at(q);
        self.at_ends.insert(key, found.clone());
        found
    }

    fn deformed(&self, pose: &Pose) -> Result<Shape, Refusal> {
        let found = self.robot.method.deform(pose)?;
        let is_number = |vertex: &[f64; 3]| vertex.iter().all(|value| value.is_finite());
        if found.vertices.len() != self.rest.len() || !found.vertices.iter().all(is_number) {
            return Err(Refusal::Collides);
        }
        // An energy that is no number is not accepted, either.
        if found.energy <= self.robot.highest_energy {
            let at_rest = found.vertices[..] == self.rest[..];
            let vertices = if at_rest { self.rest.clone() } else { found.vertices.into() };
            return Ok(Shape { vertices, energy: found.energy });
        }
        Err(Refusal::Energy(found.energy))
    }

    /// Whether a blend of two shapes is accepted where the robot's frame has a pose.
    pub fn accept_blend(&mut self, pose: &Pose, blend: &Shape) -> bool {
        self.took.blends += 1;
        self.robot.accepts_blend(pose, &blend.vertices)
    }
}

impl Shape {
    /// The blend of this shape and another at a share of the way to the other. The energy is blended as well: a sum of the lengths of
    /// displacements is convex, so that the blend's own energy is at most that.
    pub fn blended(&self, other: &Shape, share: f64) -> Shape {
        let between = |a: f64, b: f64| a + (b - a) * share;
        let pairs = self.vertices.iter().zip(other.vertices.iter());
        let vertices = pairs.map(|(a, b)| [0, 1, 2].map(|axis| between(a[axis], b[axis])));
        Shape { vertices: vertices.collect(), energy: between(self.energy, other.energy) }
    }
}

/// Where a pose puts points.
pub(super) fn placed(points: &[[f64; 3]], pose: &Pose) -> Vec<[f64; 3]> {
    let pose = pose.to_parry();
    points.iter().map(|point| pose.transform_point((*point).into()).to_array()).collect()
}
