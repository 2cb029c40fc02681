//! Configurations as points of a Euclidean space, in single precision.
//!
//! Searches measure points, which is cheaper than to measure configurations, and ask [`ErrorBounds`] what the
//! distance of two points says of the distance of their configurations.

use crate::lanes::Lanes;
use crate::math;
use crate::space::{FactorKind, Space};
use smallvec::SmallVec;

/// Fan-out of the tree and bucket size of its leaves. So many boxes or points are measured together; along
/// each axis their coordinates lie side by side.
pub(super) const FAN: usize = 16;

/// Squared distances below this are not told apart, since single precision ends near 10⁻³⁸.
const TINY: f64 = 1e-36;

/// The point of a query. Up to 64 coordinates need no allocation, which is more than most robots have.
pub(super) type Point = SmallVec<[f32; 64]>;

/// Euclidean length of a point, taken as a vector from the origin.
pub(super) fn length(point: &[f32]) -> f64 {
    point.iter().map(|value| f64::from(*value) * f64::from(*value)).sum::<f64>().sqrt()
}

/// The map from configurations to points of single precision.
///
/// A real value becomes one coordinate, counted from the middle of its interval. An angle becomes one
/// coordinate that wraps. A rotation becomes four, its quaternion times two; a quaternion and its opposite are
/// the same rotation, so the nearer of the two is measured. All coordinates are multiplied by the weight of
/// their part of the space; parts without weight are left out.
#[derive(Clone, Debug)]
pub(super) struct Embedding {
    reals: Vec<Real>,
    angles: Vec<Angle>,
    rotations: Vec<Rotation>,
    /// Largest error of a squared distance that comes from the scalar products of quaternions, see
    /// [`ErrorBounds`].
    product_error: f64,
    /// Which instructions measure points and boxes.
    pub(super) lanes: Lanes,
}

/// Bounds on the distance of two configurations, given the distance of their points, and the other way round.
/// Both distances are meant as they are computed, rounding errors included, so that a search that prunes by
/// these bounds misses nothing.
///
/// *In exact arithmetic.* Take two rotations that differ by an angle θ in [0, π], and let w be the weight of
/// their part. The part adds (wθ)² to the squared distance of configurations, and the squared chord
/// c² = 8 w² x with x = 1 − cos(θ/2) to that of points. A chord is no longer than its arc, so the distance of
/// points is at most that of their configurations. From above, (wθ)² = c² (1 + x/6 + …), a series without
/// negative terms whose sum at x = 1 is π²/8, so (wθ)² ≤ c² (1 + (π²/8 − 1) x). There x is at most 1, and at
/// most the whole squared distance of the points over 8 w² for the least weight w of a rotation. Reals and
/// angles add the same to both distances.
///
/// *Margin: errors of coordinates.* Rounding to single precision changes a coordinate by at most 2⁻²⁴ of
/// itself, so a point by 2⁻²⁴ of its length. Where an angle wraps, the length of a full turn has the same
/// relative error, and is at most twice as long as the two points together. The scalar product of two
/// quaternions in double precision has an error below 2⁻⁴⁹, the error of their own lengths included; where the
/// quaternions nearly agree the arc cosine turns that into 2⁻²³, which is 2⁻²⁵ of what the quaternions
/// contribute to the lengths of the points. Together this is below 2⁻²² of the sum of both lengths; twice as
/// much is allowed. The square of a sum a + b is at most a² (1 + s) + b² (1 + 1/s) for every s > 0.
///
/// *Rounding: errors of squared distances.* For a rotation with scale s = 2w the squared chord is computed as
/// 2s² − 2|p·q|. The error of the scalar product p·q is 2⁻²⁴ s² for each of two roundings to single precision,
/// one multiplication and three additions; each other operation rounds a number of at most 2s². Together this
/// is below 2⁻²⁰ s²; twice as much is allowed. Differences, other squares and sums have a relative error of
/// 2⁻²⁴ each, and there are at most a few more of them than axes; four times as much is allowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct ErrorBounds {
    /// Factor between the two squared distances.
    factor: f64,
    /// Difference of the two squared distances, in addition to the factor, for errors of coordinates.
    margin: f64,
    /// The same for errors of the squared distance of points.
    rounding: f64,
    /// How fast arcs outgrow their chords: by this times the squared distance of points, relative to the
    /// squared chord.
    curvature: f64,
}

/// The s in the bound on the square of a sum.
const SPLIT: f64 = 1.0 / 1024.0;
/// π²/8 − 1, rounded up.
const LARGEST_CURVATURE: f64 = 0.23371;

impl ErrorBounds {
    /// The pruning bound for configurations of at most a squared distance: if the computed squared distance of
    /// two points is above the result, that of their configurations is above `square`.
    pub(super) fn pruning_bound(&self, square: f64) -> f32 {
        // Rounded up. Beyond the range of single precision it is infinite and prunes nothing.
        ((square * self.factor + self.margin + self.rounding) as f32).next_up()
    }

    /// The largest squared distance that two configurations can have if `square` is the computed squared
    /// distance of their points.
    pub(super) fn largest_square(&self, square: f32) -> f64 {
        let chord = (f64::from(square).max(0.0) + self.rounding) * self.factor + self.margin;
        chord * (1.0 + (chord * self.curvature).min(LARGEST_CURVATURE))
    }
}

/// A real part of the space.
#[derive(Clone, Debug)]
struct Real {
    /// Index of its value in a configuration.
    at: usize,
    weight: f64,
    /// Middle of its interval.
    middle: f64,
}

/// An angle of the space.
#[derive(Clone, Debug)]
struct Angle {
    /// Index of its value in a configuration.
    at: usize,
    weight: f64,
    /// Length of a full turn.
    turn: f32,
}

/// A rotation of the space.
#[derive(Clone, Debug)]
struct Rotation {
    /// Index of its first value in a configuration.
    at: usize,
    /// Length of the point of a unit quaternion: twice the weight.
    scale: f64,
    /// Twice the square of the scale: the squared distance of two points at right angles.
    right_angle: f32,
}

impl Embedding {
    pub(super) fn new(space: &Space) -> Embedding {
        let mut embedding = Embedding {
            reals: Vec::new(),
            angles: Vec::new(),
            rotations: Vec::new(),
            product_error: 0.0,
            lanes: Lanes::widest(),
        };
        for part in space.factors().iter().filter(|part| part.weight > 0.0) {
            let (at, weight) = (part.at, part.weight);
            match part.kind {
                FactorKind::Real { min, max } => {
                    embedding.reals.push(Real { at, weight, middle: min + (max - min) / 2.0 });
                }
                FactorKind::Angle => {
                    let turn = (math::TURN * weight) as f32;
                    embedding.angles.push(Angle { at, weight, turn });
                }
                FactorKind::Rotation => {
                    let scale = 2.0 * weight;
                    let square = 2.0 * scale * scale;
                    let right_angle = square as f32;
                    embedding.rotations.push(Rotation { at, scale, right_angle });
                    embedding.product_error += square * (1.0 / f64::from(1u32 << 20));
                }
            }
        }
        embedding
    }

    /// Number of coordinates of a point.
    pub(super) fn axes(&self) -> usize {
        self.reals.len() + self.angles.len() + 4 * self.rotations.len()
    }

    /// Appends the coordinates of a configuration's point. The configuration is in stored form.
    pub(super) fn embed(&self, q: &[f64], out: &mut impl Extend<f32>) {
        out.extend(self.reals.iter().map(|real| ((q[real.at] - real.middle) * real.weight) as f32));
        out.extend(self.angles.iter().map(|angle| (q[angle.at] * angle.weight) as f32));
        for rotation in &self.rotations {
            let quaternion = &q[rotation.at..rotation.at + 4];
            out.extend(quaternion.iter().map(|value| (value * rotation.scale) as f32));
        }
    }

    /// The error bounds for pairs of points whose two lengths sum to at most `lengths`.
    pub(super) fn error_bounds(&self, lengths: f64) -> ErrorBounds {
        let margin = lengths * (1.0 / f64::from(1u32 << 21));
        let slack = 1.0 + (self.axes() + 8) as f64 * (1.0 / f64::from(1u32 << 22));
        let lightest =
            self.rotations.iter().map(|rotation| rotation.scale).fold(f64::INFINITY, f64::min);
        ErrorBounds {
            factor: slack * (1.0 + SPLIT),
            margin: margin * margin * (1.0 + 1.0 / SPLIT) * slack,
            rounding: self.product_error + TINY,
            curvature: LARGEST_CURVATURE / (2.0 * lightest * lightest),
        }
    }

    /// Squared distances between a point and the points of a leaf.
    #[inline(always)]
    pub(super) fn squares(&self, point: &[f32], leaf: &[f32]) -> [f32; FAN] {
        let mut squares = [0.0; FAN];
        let mut axes = point.iter().zip(leaf.as_chunks::<FAN>().0);
        for (at, values) in axes.by_ref().take(self.reals.len()) {
            for (square, value) in squares.iter_mut().zip(values) {
                let difference = value - at;
                *square += difference * difference;
            }
        }
        for (angle, (at, values)) in self.angles.iter().zip(axes.by_ref()) {
            for (square, value) in squares.iter_mut().zip(values) {
                let direct = (value - at).abs();
                let around = angle.turn - direct;
                let difference = if around < direct { around } else { direct };
                *square += difference * difference;
            }
        }
        for rotation in &self.rotations {
            let mut products = [0.0; FAN];
            for (at, values) in axes.by_ref().take(4) {
                for (product, value) in products.iter_mut().zip(values) {
                    *product += value * at;
                }
            }
            for (square, product) in squares.iter_mut().zip(products) {
                *square += rotation.right_angle - 2.0 * product.abs();
            }
        }
        squares
    }

    /// Squared distances between a point and boxes: 0 for a box that contains the point.
    #[inline(always)]
    pub(super) fn box_squares(&self, point: &[f32], sides: &[f32]) -> [f32; FAN] {
        // How far a coordinate is outside an interval; 0 where one of the three is not a number.
        fn outside(at: f32, least: f32, largest: f32) -> f32 {
            let (below, above) = (least - at, at - largest);
            let farther = if below > above { below } else { above };
            if farther > 0.0 { farther } else { 0.0 }
        }
        let mut squares = [0.0; FAN];
        let mut axes = point.iter().zip(sides.as_chunks::<FAN>().0.as_chunks::<2>().0);
        for (at, [least, largest]) in axes.by_ref().take(self.reals.len()) {
            for (square, (least, largest)) in squares.iter_mut().zip(least.iter().zip(largest)) {
                let difference = outside(*at, *least, *largest);
                *square += difference * difference;
            }
        }
        for (angle, (at, [least, largest])) in self.angles.iter().zip(axes.by_ref()) {
            for (square, (least, largest)) in squares.iter_mut().zip(least.iter().zip(largest)) {
                let direct = outside(*at, *least, *largest);
                let (up, down) = (largest - at, at - least);
                let around = angle.turn - if up > down { up } else { down };
                let around = if around > 0.0 { around } else { 0.0 };
                let difference = if around < direct { around } else { direct };
                *square += difference * difference;
            }
        }
        for _ in &self.rotations {
            let (mut same, mut opposite) = ([0.0; FAN], [0.0; FAN]);
            for (at, [least, largest]) in axes.by_ref().take(4) {
                let sides = least.iter().zip(largest);
                for ((same, opposite), (least, largest)) in
                    same.iter_mut().zip(&mut opposite).zip(sides)
                {
                    let difference = outside(*at, *least, *largest);
                    *same += difference * difference;
                    let difference = outside(-at, *least, *largest);
                    *opposite += difference * difference;
                }
            }
            for ((square, same), opposite) in squares.iter_mut().zip(same).zip(opposite) {
                *square += if opposite < same { opposite } else { same };
            }
        }
        squares
    }
}
