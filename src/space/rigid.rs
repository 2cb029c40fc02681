//! How the base of a robot moves, and the values that say where it is.

use super::{Dof, Factor, FactorKind, Space};
use crate::math;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// How a rigid body, or the base of a linkage, may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
pub enum BaseJoint {
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

impl BaseJoint {
    /// Number of translational degrees of freedom: 0, 2 or 3.
    pub fn translations(self) -> usize {
        match self {
            BaseJoint::Fixed => 0,
            BaseJoint::Translation2d | BaseJoint::Rigid2d => 2,
            BaseJoint::Translation3d | BaseJoint::Rigid3d => 3,
        }
    }

    /// Along how many of the world's axes the robot is bounded: x and y only, if it is planar.
    pub fn bounded_axes(self) -> usize {
        match self {
            BaseJoint::Translation2d | BaseJoint::Rigid2d => 2,
            BaseJoint::Fixed | BaseJoint::Translation3d | BaseJoint::Rigid3d => 3,
        }
    }

    /// Number of values of a configuration.
    pub fn values(self) -> usize {
        match self {
            BaseJoint::Fixed => 0,
            BaseJoint::Translation2d => 2,
            BaseJoint::Rigid2d | BaseJoint::Translation3d => 3,
            BaseJoint::Rigid3d => 7,
        }
    }

    /// The angle by which the base turns on the shortest way from `a` to `b`, in radians.
    pub fn angle_between(self, a: &[f64], b: &[f64]) -> f64 {
        match self {
            BaseJoint::Fixed | BaseJoint::Translation2d | BaseJoint::Translation3d => 0.0,
            BaseJoint::Rigid2d => math::angle_between(a[2], b[2]),
            BaseJoint::Rigid3d => {
                let dot: f64 = (3..7).map(|i| a[i] * b[i]).sum();
                2.0 * math::acos(dot.abs())
            }
        }
    }

    /// Whether the body also turns.
    pub fn rotates(self) -> bool {
        matches!(self, BaseJoint::Rigid2d | BaseJoint::Rigid3d)
    }
}

/// The factors and values of a base whose reference point lies in the box `min`..`max` (of a planar
/// base: in its first two intervals). One radian of rotation counts as `rotation_length`.
pub fn rigid_factors(
    motion: BaseJoint,
    min: [f64; 3],
    max: [f64; 3],
    rotation_length: f64,
) -> (Vec<Factor>, Vec<Dof>) {
    let length = |name: &str| Dof { name: name.to_owned(), unit: "length" };
    let mut factors = Vec::new();
    let mut dofs = Vec::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(motion.translations()) {
        factors.push(Factor {
            kind: FactorKind::Real { min: min[axis], max: max[axis] },
            at: axis,
            weight: 1.0,
        });
        dofs.push(length(name));
    }
    let at = dofs.len();
    let weight = rotation_length;
    match motion {
        BaseJoint::Fixed | BaseJoint::Translation2d | BaseJoint::Translation3d => {}
        BaseJoint::Rigid2d => {
            factors.push(Factor { kind: FactorKind::Angle, at, weight });
            dofs.push(Dof { name: "theta".to_owned(), unit: "rad" });
        }
        BaseJoint::Rigid3d => {
            factors.push(Factor { kind: FactorKind::Rotation, at, weight });
            for name in ["qw", "qx", "qy", "qz"] {
                dofs.push(Dof { name: name.to_owned(), unit: "1" });
            }
        }
    }
    (factors, dofs)
}

/// The space of a rigid body: see [`rigid_factors`].
pub fn rigid_space(motion: BaseJoint, min: [f64; 3], max: [f64; 3], rotation_length: f64) -> Space {
    let (factors, dofs) = rigid_factors(motion, min, max, rotation_length);
    Space::new(factors, dofs, motion.translations())
}
