use super::{Direction, Factor, FactorKind, Space, quaternion};
use crate::math;

/// The shortest motion of a factor from one configuration to another in the factor's own unit: three numbers of a rotation, of any other factor
/// one and two zeros.
fn tangent_of(factor: &Factor, from: &[f64], to: &[f64]) -> [f64; 3] {
    let at = factor.at;
    match factor.kind {
        FactorKind::Real { .. } => [to[at] - from[at], 0.0, 0.0],
        FactorKind::Angle => [math::wrap_angle(to[at] - from[at]), 0.0, 0.0],
        FactorKind::Rotation => {
            let four = |q: &[f64]| [q[at], q[at + 1], q[at + 2], q[at + 3]];
            quaternion::rotation_vector(four(from), four(to))
        }
    }
}

/// How many numbers of a tangent vector are a factor's.
fn numbers_of(factor: &Factor) -> usize {
    if factor.kind == FactorKind::Rotation { 3 } else { 1 }
}

impl Space {
    /// The displacement from `from` to `to`: the vector tangent to the space at `from` along which the shortest motion
    /// leaves it, whose length is the [distance](Space::distance) of the two.
    ///
    /// Of a real factor it is the difference, of an angle the shortest turn, of a rotation the rotation vector of the turn
    /// from the one to the other (the logarithm of the rotation between them: its direction the axis, in the frame of
    /// `from`, its length the angle in radians, at most π), each times the factor's weight, so that all are lengths in the
    /// scene's unit. It is the inverse of [`Space::along`]: `along(from, displacement, distance)` is `to`, up to rounding.
    ///
    /// ```
    /// use roadmill::space::{BaseJoint, rigid_space};
    ///
    /// // A body in the plane whose turn by a radian counts as a length of 2.
    /// let space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [9.0; 3], 2.0);
    /// let (from, to) = ([1.0, 1.0, 3.0], [1.0, 4.0, -3.0]);
    /// let displacement = space.displacement(&from, &to);
    /// // The turn is the short one, past π.
    /// assert!((displacement.length() - space.distance(&from, &to)).abs() < 1e-12);
    /// let mut there = [0.0; 3];
    /// space.along(&from, &displacement, displacement.length(), &mut there);
    /// assert!(space.distance(&there, &to) < 1e-12);
    /// ```
    pub fn displacement(&self, from: &[f64], to: &[f64]) -> Direction {
        let components = |factor: &Factor| {
            tangent_of(factor, from, to).map(|component| component * factor.weight)
        };
        let factors: Vec<[f64; 3]> = self.factors.iter().map(components).collect();
        let square = factors.iter().flatten().map(|component| component * component).sum::<f64>();
        Direction { factors, size: square.sqrt() }
    }

    /// The vector by which [`Space::moved`] takes `from` to `to`: the [displacement](Space::displacement) in the factors' own
    /// units, per real factor and angle one number, per rotation the three of a rotation vector in the frame of `from`.
    ///
    /// ```
    /// use roadmill::space::{BaseJoint, rigid_space};
    ///
    /// let space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [9.0; 3], 2.0);
    /// let by = space.tangent(&[1.0, 1.0, 3.0], &[1.0, 4.0, -3.0]);
    /// assert_eq!(by[..2], [0.0, 3.0]);
    /// let mut there = [0.0; 3];
    /// space.moved(&[1.0, 1.0, 3.0], &by, &mut there);
    /// assert!(space.distance(&there, &[1.0, 4.0, -3.0]) < 1e-12);
    /// ```
    pub fn tangent(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let of_factor =
            |factor: &Factor| tangent_of(factor, from, to).into_iter().take(numbers_of(factor));
        self.factors.iter().flat_map(of_factor).collect()
    }

    /// Per number of [`Space::moved`] its weight in the metric: 1 for a length, the length that a radian counts as for a turn.
    pub fn tangent_weights(&self) -> Vec<f64> {
        let weights = |factor: &Factor| std::iter::repeat_n(factor.weight, numbers_of(factor));
        self.factors.iter().flat_map(weights).collect()
    }

    /// The configuration that `q` becomes when it moves along a vector tangent to the space there, in the factors' own units:
    /// per real factor and angle one number, per rotation the three of a rotation vector in the frame of `q`, in the order of
    /// the factors, [`Space::cube_dimensions`] in all. `out` is in stored form but may lie out of bounds.
    pub fn moved(&self, q: &[f64], by: &[f64], out: &mut [f64]) {
        let mut numbers = by.iter().copied();
        let mut next = || numbers.next().unwrap_or(0.0);
        for factor in &self.factors {
            let at = factor.at;
            match factor.kind {
                FactorKind::Real { .. } => out[at] = q[at] + next() + 0.0,
                FactorKind::Angle => out[at] = math::wrap_angle(q[at] + next()),
                FactorKind::Rotation => {
                    let from = [q[at], q[at + 1], q[at + 2], q[at + 3]];
                    let by = [next(), next(), next()];
                    out[at..at + 4].copy_from_slice(&quaternion::turned(from, by));
                }
            }
        }
    }

    /// Moves real values that are out of their intervals to the nearer end.
    pub fn clamp(&self, q: &mut [f64]) {
        for factor in &self.factors {
            if let FactorKind::Real { min, max } = factor.kind {
                q[factor.at] = q[factor.at].clamp(min, max);
            }
        }
    }
}

impl Direction {
    /// The vector's length; that of a [displacement](Space::displacement) is a length in the scene's unit.
    pub fn length(&self) -> f64 {
        self.size
    }

    /// The direction that lies between this one and another: the sum of both as unit vectors, the other one times `share`. Without length, either is
    /// none, and the sum is the other.
    pub(crate) fn bent(&self, aside: &Direction, share: f64) -> Direction {
        let unit = |direction: &Direction| match direction.size > 0.0 {
            true => 1.0 / direction.size,
            false => 0.0,
        };
        let (own, others) = (unit(self), unit(aside) * share);
        let sum = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|i| a[i] * own + b[i] * others);
        let factors: Vec<[f64; 3]> = self.factors.iter().zip(&aside.factors).map(sum).collect();
        let square = factors.iter().flatten().map(|component| component * component).sum::<f64>();
        Direction { factors, size: square.sqrt() }
    }

    /// The angle between two vectors tangent to the space at the same configuration, in radians, in `[0, π]`; `None` where
    /// one of them has no length, and with that no direction.
    ///
    /// Factors count by their weights, as in the metric: two motions by which a body moves alike and turns
    /// differently point the further apart, the more a turn weighs. Symmetric to the bit. Computed as W. Kahan does, twice
    /// the arc tangent of ‖u − v‖ over ‖u + v‖ of the unit vectors, which stays exact where the arc cosine does not: at
    /// angles near 0 and π.
    ///
    /// ```
    /// use roadmill::space::{BaseJoint, rigid_space};
    ///
    /// let space = rigid_space(BaseJoint::Translation2d, [0.0; 3], [9.0; 3], 0.0);
    /// let toward = |to: [f64; 2]| space.displacement(&[1.0, 1.0], &to);
    /// let angle = toward([5.0, 1.0]).angle(&toward([1.0, 2.0])).expect("both have a length");
    /// assert!((angle.to_degrees() - 90.0).abs() < 1e-12);
    /// assert_eq!(toward([5.0, 1.0]).angle(&toward([1.0, 1.0])), None);
    /// ```
    pub fn angle(&self, other: &Direction) -> Option<f64> {
        // Written so that NaN fails it.
        if !(self.size > 0.0 && other.size > 0.0) {
            return None;
        }
        let (mut difference, mut sum) = (0.0, 0.0);
        for (a, b) in self.factors.iter().flatten().zip(other.factors.iter().flatten()) {
            let (a, b) = (a / self.size, b / other.size);
            difference += (a - b) * (a - b);
            sum += (a + b) * (a + b);
        }
        Some(2.0 * math::atan2(difference.sqrt(), sum.sqrt()))
    }
}
