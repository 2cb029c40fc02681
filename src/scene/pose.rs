use bincode::{Decode, Encode};
use parry3d_f64::math as parry;

/// A rigid motion: `p ↦ rotation · p + translation`.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Pose {
    /// Translation `x y z`.
    pub translation: [f64; 3],
    /// Unit quaternion `w x y z`.
    pub rotation: [f64; 4],
}

impl Pose {
    /// The motion that moves nothing.
    pub const IDENTITY: Pose = Pose { translation: [0.0; 3], rotation: [1.0, 0.0, 0.0, 0.0] };

    /// This motion after `other`: `p ↦ self(other(p))`.
    pub fn then(&self, other: &Pose) -> Pose {
        let both = self.to_parry() * other.to_parry();
        let [x, y, z, w] = both.rotation.to_array();
        Pose { translation: both.translation.to_array(), rotation: [w, x, y, z] }
    }

    /// Where the motion takes a point.
    pub fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        self.to_parry().transform_point(parry::Vector::from_array(point)).to_array()
    }

    /// The same motion in parry's types.
    pub fn to_parry(self) -> parry::Pose {
        let [w, x, y, z] = self.rotation;
        parry::Pose {
            rotation: parry::Rotation::from_xyzw(x, y, z, w),
            translation: parry::Vector::from_array(self.translation),
        }
    }
}
