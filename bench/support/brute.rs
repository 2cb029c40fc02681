//! A checker that looks at every pair of bodies, without any tree of ours: parry's tests of two convex
//! shapes, triangle by triangle where a body is a mesh.

use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::SharedShape;
use roadmill::model::bodies::robot::Robot;
use roadmill::model::bodies::validity::{Bounds, BoundsMeaning};
use roadmill::problem::Problem;
use roadmill::scene::{self, Body, Shape};
use std::f64::consts::FRAC_1_SQRT_2;

/// Convex shapes with their poses in a link's frame or the world's.
type Convex = Vec<(SharedShape, Pose)>;

/// A robot among obstacles. Meshes are taken as surfaces.
pub struct Brute {
    robot: Robot,
    bounds: Bounds,
    links: Vec<Convex>,
    obstacles: Convex,
    self_pairs: Vec<(usize, usize)>,
}

impl Brute {
    pub fn new(problem: &Problem) -> Brute {
        let robot = problem.model().bodies().expect("bodies").robot().clone();
        Brute {
            bounds: problem.model().bodies().expect("bodies").bounds(),
            links: robot.links.iter().map(|link| convex(&link.bodies)).collect(),
            obstacles: convex(problem.model().bodies().expect("bodies").obstacles()),
            self_pairs: robot.self_pairs().collect(),
            robot,
        }
    }

    /// Whether the robot is in bounds and touches nothing.
    pub fn is_free(&self, q: &[f64]) -> bool {
        let placed = self.placed(q);
        self.room(&placed) >= 0.0
            && self.pairs(&placed).all(|(a, b)| {
                let meet = query::intersection_test(&a.1, &*a.0, &b.1, &*b.0);
                !meet.expect("convex shapes").intersecting
            })
    }

    /// How far the robot is from the nearest thing that it must not touch, or from its bounds.
    pub fn apart(&self, q: &[f64]) -> f64 {
        let placed = self.placed(q);
        let room = self.room(&placed).max(0.0);
        self.pairs(&placed).fold(room, |least, (a, b)| {
            let apart = query::distance(&a.1, &*a.0, &b.1, &*b.0).expect("convex shapes");
            least.min(apart.distance)
        })
    }

    fn placed(&self, q: &[f64]) -> Vec<Convex> {
        let mut poses = Vec::new();
        self.robot.link_poses(q, &mut poses);
        let links = self.links.iter().zip(&poses).map(|(link, pose)| {
            let pose = pose_of(pose);
            link.iter().map(|(shape, local)| (shape.clone(), pose * *local)).collect()
        });
        links.collect()
    }

    /// How far the robot's points are inside their bounds.
    fn room(&self, placed: &[Convex]) -> f64 {
        if self.bounds.meaning == BoundsMeaning::Reference {
            return f64::INFINITY;
        }
        let mut room = f64::INFINITY;
        for (shape, pose) in placed.iter().flatten() {
            let held = shape.compute_aabb(pose);
            for axis in 0..self.robot.motion.bounded_axes() {
                room = room.min(held.mins[axis] - self.bounds.min[axis]);
                room = room.min(self.bounds.max[axis] - held.maxs[axis]);
            }
        }
        room
    }

    /// What must not touch.
    fn pairs<'a>(
        &'a self,
        placed: &'a [Convex],
    ) -> impl Iterator<Item = (&'a (SharedShape, Pose), &'a (SharedShape, Pose))> {
        let links = placed.iter().flatten();
        let among = links.flat_map(|part| self.obstacles.iter().map(move |still| (part, still)));
        let own = self.self_pairs.iter().flat_map(|(first, second)| {
            let second = &placed[*second];
            placed[*first].iter().flat_map(move |a| second.iter().map(move |b| (a, b)))
        });
        among.chain(own)
    }
}

fn convex(bodies: &[Body]) -> Convex {
    let mut parts = Vec::new();
    for body in bodies {
        let at = pose_of(&body.pose);
        // parry's cylinders and capsules stand along y, ours along z.
        let rotation = Rotation::from_xyzw(FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2);
        let upright = at * Pose { rotation, translation: Vector::ZERO };
        match &body.shape {
            Shape::Point => parts.push((SharedShape::ball(0.0), at)),
            Shape::Box { size: [x, y, z] } => {
                parts.push((SharedShape::cuboid(x / 2.0, y / 2.0, z / 2.0), at));
            }
            Shape::Sphere { radius } => parts.push((SharedShape::ball(*radius), at)),
            Shape::Cylinder { radius, height } => {
                parts.push((SharedShape::cylinder(height / 2.0, *radius), upright));
            }
            Shape::Capsule { radius, height } => {
                parts.push((SharedShape::capsule_y(height / 2.0, *radius), upright));
            }
            Shape::Mesh(mesh) => parts.extend(mesh.faces().map(|face| {
                let [a, b, c] =
                    face.map(|corner| Vector::from_array(mesh.vertices[corner as usize]));
                (SharedShape::triangle(a, b, c), at)
            })),
        }
    }
    parts
}

fn pose_of(pose: &scene::Pose) -> Pose {
    let [w, x, y, z] = pose.rotation;
    let rotation = Rotation::from_xyzw(x, y, z, w);
    Pose { rotation, translation: Vector::from_array(pose.translation) }
}
