use crate::math;
use crate::scene::Pose;
use bincode::{Decode, Encode};

/// The farthest that a joint with limits turns, in radians: ten turns.
pub const TURN_MAX: f64 = 20.0 * std::f64::consts::PI;

/// A joint: the child link's frame in the parent's is `before · motion(value) · after`.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Joint {
    /// Its name, and that of its degree of freedom.
    pub name: String,
    /// Index of the parent link, less than the child's own.
    pub parent: u32,
    /// How it moves.
    pub kind: JointKind,
    /// The joint's frame in the parent link's.
    pub before: Pose,
    /// The child link's frame in the joint's as moved.
    pub after: Pose,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub enum JointKind {
    /// Not at all: the child is fixed to the parent.
    Fixed,
    /// Turns about an axis through the joint's origin, by an angle in radians.
    Revolute {
        /// Unit vector in the joint's frame.
        axis: [f64; 3],
        /// Least and largest angle; `None` where it may turn on and on.
        limits: Option<Limits>,
    },
    /// Slides along an axis, by a length.
    Prismatic {
        /// Unit vector in the joint's frame.
        axis: [f64; 3],
        /// Least and largest value.
        limits: Limits,
    },
    /// Turns in every way about the joint's origin, by a unit quaternion `w x y z`.
    Spherical,
}

/// Least and largest value of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Limits {
    /// Least value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

impl JointKind {
    /// Whether the joint moves.
    pub fn moves(&self) -> bool {
        self.values() > 0
    }

    /// How many values of a configuration the joint takes.
    pub fn values(&self) -> usize {
        match self {
            JointKind::Fixed => 0,
            JointKind::Revolute { .. } | JointKind::Prismatic { .. } => 1,
            JointKind::Spherical => 4,
        }
    }
}

impl Joint {
    /// The child link's frame in the parent's at the joint's values.
    pub fn pose(&self, values: &[f64]) -> Pose {
        let motion = match self.kind {
            JointKind::Fixed => Pose::IDENTITY,
            JointKind::Revolute { axis: [x, y, z], .. } => {
                let half = values[0] / 2.0;
                let (sine, cosine) = (math::sin(half), math::cos(half));
                Pose { translation: [0.0; 3], rotation: [cosine, x * sine, y * sine, z * sine] }
            }
            JointKind::Prismatic { axis, .. } => Pose {
                translation: axis.map(|component| component * values[0]),
                rotation: Pose::IDENTITY.rotation,
            },
            JointKind::Spherical => Pose {
                translation: [0.0; 3],
                rotation: [values[0], values[1], values[2], values[3]],
            },
        };
        self.before.then(&motion).then(&self.after)
    }
}
