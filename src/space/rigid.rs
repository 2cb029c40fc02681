//! Configuration spaces of one rigid body.

use super::{Dof, Part, PartKind, Space};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// How a rigid body may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
pub enum Motion {
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
    /// Number of translational degrees of freedom: 2 or 3.
    pub fn translations(self) -> usize {
        match self {
            Motion::Translation2d | Motion::Rigid2d => 2,
            Motion::Translation3d | Motion::Rigid3d => 3,
        }
    }

    /// Whether the body also turns.
    pub fn rotates(self) -> bool {
        matches!(self, Motion::Rigid2d | Motion::Rigid3d)
    }
}

/// The space of a rigid body whose reference point lies in the box `min`..`max` (of a planar
/// body: in its first two intervals). One radian of rotation counts as `rotation_length`.
pub fn rigid_space(motion: Motion, min: [f64; 3], max: [f64; 3], rotation_length: f64) -> Space {
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
        Motion::Translation2d | Motion::Translation3d => {}
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
    Space::new(parts, dofs)
}
