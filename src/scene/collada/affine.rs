use crate::math;
use std::f64::consts::PI;

/// An axis shorter than this has no direction to speak of.
const AXIS_MIN: f64 = 1e-100;

/// An affine map `p ↦ A p + t`: how a COLLADA node stands in its parent.
#[derive(Clone, Copy)]
pub(super) struct Affine {
    /// Each row of A, followed by the same coordinate of t.
    pub rows: [[f64; 4]; 3],
}

impl Affine {
    pub const IDENTITY: Affine = Affine::scaling([1.0; 3]);

    /// The map `p ↦ p + t`.
    pub const fn translation([x, y, z]: [f64; 3]) -> Affine {
        Affine { rows: [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]] }
    }

    /// Multiplication of each coordinate by its own factor.
    pub const fn scaling([x, y, z]: [f64; 3]) -> Affine {
        Affine { rows: [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]] }
    }

    /// The rotation about an axis through the origin, of any length, by Rodrigues' formula; `None` where
    /// the axis is zero.
    pub fn rotation(axis: [f64; 3], degrees: f64) -> Option<Affine> {
        let length = axis.iter().map(|value| value * value).sum::<f64>().sqrt();
        if !(length.is_finite() && length > AXIS_MIN) {
            return None;
        }
        let [x, y, z] = axis.map(|value| value / length);
        let angle = degrees / 180.0 * PI;
        let (sine, cosine) = (math::sin(angle), math::cos(angle));
        let rest = 1.0 - cosine;
        let rows = [
            [rest * x * x + cosine, rest * x * y - sine * z, rest * x * z + sine * y, 0.0],
            [rest * x * y + sine * z, rest * y * y + cosine, rest * y * z - sine * x, 0.0],
            [rest * x * z - sine * y, rest * y * z + sine * x, rest * z * z + cosine, 0.0],
        ];
        Some(Affine { rows })
    }

    /// The composition `p ↦ self(inner(p))`.
    pub fn then(&self, inner: &Affine) -> Affine {
        let b = &inner.rows;
        let column =
            |row: &[f64; 4], j: usize| row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j];
        let rows = self.rows.map(|row| {
            [column(&row, 0), column(&row, 1), column(&row, 2), column(&row, 3) + row[3]]
        });
        Affine { rows }
    }

    /// Where a point comes to stand.
    pub fn apply(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        self.rows.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
    }
}
