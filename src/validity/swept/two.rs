//! Numbers at the two ends of a chord, reckoned side by side.

use parry3d_f64::math::Vector;
use std::ops::{Add, Mul, Sub};

/// A number at either end. Every operation is the same on both, which compilers make one instruction of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Two(pub [f64; 2]);

/// A vector at either end.
#[derive(Clone, Copy, Debug)]
pub(super) struct TwoVectors {
    x: Two,
    y: Two,
    z: Two,
}

impl Two {
    #[inline(always)]
    pub fn abs(self) -> Two {
        Two([self.0[0].abs(), self.0[1].abs()])
    }
}

impl Add for Two {
    type Output = Two;
    #[inline(always)]
    fn add(self, other: Two) -> Two {
        Two([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Sub for Two {
    type Output = Two;
    #[inline(always)]
    fn sub(self, other: Two) -> Two {
        Two([self.0[0] - other.0[0], self.0[1] - other.0[1]])
    }
}

impl Mul for Two {
    type Output = Two;
    #[inline(always)]
    fn mul(self, other: Two) -> Two {
        Two([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}

impl From<f64> for Two {
    #[inline(always)]
    fn from(value: f64) -> Two {
        Two([value, value])
    }
}

impl TwoVectors {
    #[inline(always)]
    pub fn new(first: Vector, last: Vector) -> TwoVectors {
        TwoVectors {
            x: Two([first.x, last.x]),
            y: Two([first.y, last.y]),
            z: Two([first.z, last.z]),
        }
    }

    /// From these to one vector.
    #[inline(always)]
    pub fn to(&self, v: Vector) -> TwoVectors {
        let [x, y, z] = [Two::from(v.x), Two::from(v.y), Two::from(v.z)];
        TwoVectors { x: x - self.x, y: y - self.y, z: z - self.z }
    }

    #[inline(always)]
    pub fn dot(&self, v: Vector) -> Two {
        self.x * Two::from(v.x) + self.y * Two::from(v.y) + self.z * Two::from(v.z)
    }

    #[inline(always)]
    pub fn dot_each(&self, other: &TwoVectors) -> Two {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The sum of the two.
    #[inline(always)]
    pub fn sum(&self) -> Vector {
        Vector::new(self.x.0[0] + self.x.0[1], self.y.0[0] + self.y.0[1], self.z.0[0] + self.z.0[1])
    }
}
