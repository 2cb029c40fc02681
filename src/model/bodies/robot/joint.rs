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
    /// Turns about an axis through the joint's origin as another joint moves: by an angle in radians that follows from
    /// the other joint's value.
    RevoluteMimic {
        /// Unit vector in the joint's frame.
        axis: [f64; 3],
        /// How its angle follows from the other joint's value.
        mimic: Mimic,
    },
    /// Slides along an axis as another joint moves: by a length that follows from the other joint's value.
    PrismaticMimic {
        /// Unit vector in the joint's frame.
        axis: [f64; 3],
        /// How its length follows from the other joint's value.
        mimic: Mimic,
    },
    /// Not at all, although the joint could: it is held where it is, and its place is part of [`Joint::before`]. Unlike
    /// [`JointKind::Fixed`] it separates the links on its two sides, as a joint that moves does: which links are
    /// neighbours does not depend on which joints are locked.
    Locked, // new ones at the end, since ledgers know kinds by number
}

/// How the value of a joint follows from that of another: `multiplier · value + offset`.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Mimic {
    /// The other joint's value: its index in a configuration, counted from the first value after the base's. The value
    /// is that of a revolute or prismatic joint.
    pub value: u32,
    /// What the other joint's value is multiplied by. A whole number where the other joint turns on and on, since only
    /// then a turn of it is none of this joint either.
    pub multiplier: f64,
    /// What is added: an angle in radians, or a length.
    pub offset: f64,
}

impl Mimic {
    /// The joint's value where the joints' values, those of the configuration after the base's, are `values`.
    pub fn at(&self, values: &[f64]) -> f64 {
        self.multiplier * values[self.value as usize] + self.offset
    }

    /// A bound on the size of the joint's value where that of the other joint is at most `size`.
    pub fn size(&self, size: f64) -> f64 {
        self.multiplier.abs() * size + self.offset.abs()
    }
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
    /// Whether the joint moves, by values of its own or as another joint does.
    pub fn moves(&self) -> bool {
        self.values() > 0 || self.mimic().is_some()
    }

    /// How the joint follows another, if it does.
    pub fn mimic(&self) -> Option<&Mimic> {
        match self {
            JointKind::RevoluteMimic { mimic, .. } | JointKind::PrismaticMimic { mimic, .. } => {
                Some(mimic)
            }
            _ => None,
        }
    }

    /// How many values of a configuration the joint takes.
    pub fn values(&self) -> usize {
        match self {
            JointKind::Fixed | JointKind::Locked => 0,
            JointKind::RevoluteMimic { .. } | JointKind::PrismaticMimic { .. } => 0,
            JointKind::Revolute { .. } | JointKind::Prismatic { .. } => 1,
            JointKind::Spherical => 4,
        }
    }
}

impl Joint {
    /// The child link's frame in the parent's at the joint's values: its own, or of a joint that follows another the one
    /// that results.
    pub fn pose(&self, values: &[f64]) -> Pose {
        let motion = match self.kind {
            JointKind::Fixed | JointKind::Locked => Pose::IDENTITY,
            JointKind::Revolute { axis: [x, y, z], .. }
            | JointKind::RevoluteMimic { axis: [x, y, z], .. } => {
                let half = values[0] / 2.0;
                let (sine, cosine) = (math::sin(half), math::cos(half));
                Pose { translation: [0.0; 3], rotation: [cosine, x * sine, y * sine, z * sine] }
            }
            JointKind::Prismatic { axis, .. } | JointKind::PrismaticMimic { axis, .. } => Pose {
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
