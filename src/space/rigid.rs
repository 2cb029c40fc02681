//! How the base of a robot moves, and the values that say where it is.

use super::{Dof, Part, PartKind, Space};
use crate::math;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// How a rigid body, or the base of a linkage, may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
pub enum Motion {
    /// Not at all: the base of a linkage that stands still.
    #[serde(rename = "fixed")]
    Fixed,
    /// `x y`: translation in the plane z = 0.
    #[serde(rename = "translation-2d")]
    Translation2d,
    /// `x y theta`: translation in the plane z = 0 and rotation about the z axis.
    #[serde(rename = "rigid-2d")]
    Rigid2d,
    /// `x y z`: translation.
    #[serde(rename = "translation-3d")]
    Translation3d,
    /// `x y z qw qx qy qz`: translation and rotation.
    #[serde(rename = "rigid-3d")]
    Rigid3d,
}

impl Motion {
    /// Number of translational degrees of freedom: 0, 2 or 3.
    pub fn translations(self) -> usize {
        match self {
            Motion::Fixed => 0,
            Motion::Translation2d | Motion::Rigid2d => 2,
            Motion::Translation3d | Motion::Rigid3d => 3,
        }
    }

    /// Along how many of the world's axes the robot is bounded: x and y only, if it is planar.
    pub fn bounded_axes(self) -> usize {
        match self {
            Motion::Translation2d | Motion::Rigid2d => 2,
            Motion::Fixed | Motion::Translation3d | Motion::Rigid3d => 3,
        }
    }

    /// Number of values of a configuration.
    pub fn values(self) -> usize {
        match self {
            Motion::Fixed => 0,
            Motion::Translation2d => 2,
            Motion::Rigid2d | Motion::Translation3d => 3,
            Motion::Rigid3d => 7,
        }
    }

    /// The angle by which the base turns on the shortest way from `a` to `b`, in radians.
    pub fn angle_between(self, a: &[f64], b: &[f64]) -> f64 {
        match self {
            Motion::Fixed | Motion::Translation2d | Motion::Translation3d => 0.0,
            Motion::Rigid2d => math::angle_between(a[2], b[2]),
            Motion::Rigid3d => {
                let dot: f64 = (3..7).map(|i| a[i] * b[i]).sum();
                2.0 * math::acos(dot.abs())
            }
        }
    }

    /// Whether the body also turns.
    pub fn rotates(self) -> bool {
        matches!(self, Motion::Rigid2d | Motion::Rigid3d)
    }
}

/// The factors and values of a base whose reference point lies in the box `min`..`max` (of a planar
/// base: in its first two intervals). One radian of rotation counts as `rotation_length`.
pub fn rigid_parts(
    motion: Motion,
    min: [f64; 3],
    max: [f64; 3],
    rotation_length: f64,
) -> (Vec<Part>, Vec<Dof>) {
    let length = |name: &str| Dof { name: name.to_owned(), unit: "length" };
    let mut parts = Vec::new();
    let mut dofs = Vec::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(motion.translations()) {
        parts.push(Part {
            kind: PartKind::Real { min: min[axis], max: max[axis] },
            at: axis,
            weight: 1.0,
        });
        dofs.push(length(name));
    }
    let at = dofs.len();
    let weight = rotation_length;
    match motion {
        Motion::Fixed | Motion::Translation2d | Motion::Translation3d => {}
        Motion::Rigid2d => {
            parts.push(Part { kind: PartKind::Angle, at, weight });
            dofs.push(Dof { name: "theta".to_owned(), unit: "rad" });
        }
        Motion::Rigid3d => {
            parts.push(Part { kind: PartKind::Rotation, at, weight });
            for name in ["qw", "qx", "qy", "qz"] {
                dofs.push(Dof { name: name.to_owned(), unit: "1" });
            }
        }
    }
    (parts, dofs)
}

/// The space of a rigid body: see [`rigid_parts`].
pub fn rigid_space(motion: Motion, min: [f64; 3], max: [f64; 3], rotation_length: f64) -> Space {
    let (parts, dofs) = rigid_parts(motion, min, max, rotation_length);
    Space::new(parts, dofs, motion.translations())
}
