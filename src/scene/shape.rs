use super::{Mesh, Pose};
use bincode::{Decode, Encode};
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::shape as parry;
use std::f64::consts::FRAC_1_SQRT_2;

/// A shape in its own frame.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub enum Shape {
    /// The origin alone: a robot without extent.
    Point,
    /// A box centred on the origin with these edge lengths along x, y and z.
    Box {
        /// Edge lengths.
        size: [f64; 3],
    },
    /// A ball centred on the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A cylinder about the z axis, centred on the origin.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Length along z.
        height: f64,
    },
    /// A cylinder about the z axis with a half ball on either end, centred on the origin.
    Capsule {
        /// Its radius.
        radius: f64,
        /// Length along z without the half balls.
        height: f64,
    },
    /// Triangles.
    Mesh(Mesh),
}

impl Shape {
    /// The convex shape for parry, and its pose in our frame (parry's cylinders stand along y);
    /// `None` for a point and for meshes.
    pub(crate) fn to_parry(&self) -> Option<(parry::SharedShape, ParryPose)> {
        let upright = ParryPose {
            rotation: Rotation::from_xyzw(FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2),
            translation: Vector::ZERO,
        };
        Some(match self {
            Shape::Point | Shape::Mesh(_) => return None,
            Shape::Box { size: [x, y, z] } => {
                (parry::SharedShape::cuboid(x / 2.0, y / 2.0, z / 2.0), ParryPose::IDENTITY)
            }
            Shape::Sphere { radius } => (parry::SharedShape::ball(*radius), ParryPose::IDENTITY),
            Shape::Cylinder { radius, height } => {
                (parry::SharedShape::cylinder(height / 2.0, *radius), upright)
            }
            Shape::Capsule { radius, height } => {
                (parry::SharedShape::capsule_y(height / 2.0, *radius), upright)
            }
        })
    }

    /// How far the shape extends along `direction` (of unit length, in the shape's frame): the
    /// largest `p · direction` over its points.
    pub fn extent(&self, direction: [f64; 3]) -> f64 {
        let [x, y, z] = direction;
        match self {
            Shape::Point => 0.0,
            Shape::Box { size } => {
                (size[0] * x.abs() + size[1] * y.abs() + size[2] * z.abs()) / 2.0
            }
            Shape::Sphere { radius } => *radius,
            Shape::Cylinder { radius, height } => {
                radius * (x * x + y * y).sqrt() + height / 2.0 * z.abs()
            }
            Shape::Capsule { radius, height } => radius + height / 2.0 * z.abs(),
            Shape::Mesh(mesh) => mesh
                .vertices
                .iter()
                .fold(f64::NEG_INFINITY, |most, p| most.max(p[0] * x + p[1] * y + p[2] * z)),
        }
    }

    /// A bound on the distance of the shape's points from the origin of the frame in which it
    /// stands at `pose`; exact for boxes, spheres, capsules and meshes.
    pub fn reach(&self, pose: &Pose) -> f64 {
        let farthest = |points: &[[f64; 3]]| {
            points.iter().fold(0.0f64, |most, p| most.max(length(pose.apply(*p))))
        };
        match self {
            Shape::Point => farthest(&[[0.0; 3]]),
            Shape::Box { size } => {
                let (corners, _) = box_surface(*size);
                farthest(&corners)
            }
            Shape::Sphere { radius } => farthest(&[[0.0; 3]]) + radius,
            Shape::Cylinder { radius, height } => {
                farthest(&[[0.0; 3]]) + (radius * radius + height * height / 4.0).sqrt()
            }
            Shape::Capsule { radius, height } => {
                farthest(&[[0.0, 0.0, -height / 2.0], [0.0, 0.0, height / 2.0]]) + radius
            }
            Shape::Mesh(mesh) => farthest(&mesh.vertices),
        }
    }

    /// The shape of all points within `by` of this one, of a point and of round shapes: `None` of others, whose corners it
    /// would round.
    pub(crate) fn thickened(&self, by: f64) -> Option<Shape> {
        match self {
            Shape::Point => Some(Shape::Sphere { radius: by }),
            Shape::Sphere { radius } => Some(Shape::Sphere { radius: radius + by }),
            Shape::Capsule { radius, height } => {
                Some(Shape::Capsule { radius: radius + by, height: *height })
            }
            Shape::Box { .. } | Shape::Cylinder { .. } | Shape::Mesh(_) => None,
        }
    }

    /// A point of each connected piece of the shape, for tests of containment.
    pub(crate) fn witnesses(&self) -> Vec<[f64; 3]> {
        match self {
            Shape::Mesh(mesh) => mesh.witnesses(),
            _ => vec![[0.0; 3]],
        }
    }

    /// The word a problem file uses for it.
    pub fn name(&self) -> &'static str {
        match self {
            Shape::Point => "point",
            Shape::Box { .. } => "box",
            Shape::Sphere { .. } => "sphere",
            Shape::Cylinder { .. } => "cylinder",
            Shape::Capsule { .. } => "capsule",
            Shape::Mesh(_) => "mesh",
        }
    }
}

/// The corners of a box centred on the origin with these edge lengths along x, y and z, and the triangles of its sides as indices of
/// corners, seen from outside counter-clockwise.
pub fn box_surface(size: [f64; 3]) -> ([[f64; 3]; 8], Vec<[u32; 3]>) {
    let corner =
        |i: usize| [0, 1, 2].map(|axis| size[axis] * if i >> axis & 1 == 1 { 0.5 } else { -0.5 });
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    (std::array::from_fn(corner), sides.into_iter().flat_map(halves).collect())
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}
