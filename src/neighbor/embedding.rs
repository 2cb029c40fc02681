//! Configurations as points whose Euclidean distance never exceeds the space's by more than rounding.

use crate::lanes::Lanes;
use crate::math;
use crate::space::{PartKind, Space};

/// So many points or boxes are measured together; along each axis their coordinates lie side by side.
pub(super) const FAN: usize = 16;

/// Squares of distances below this are not told apart: single precision ends near 10⁻³⁸.
const TINY: f64 = 1e-36;

/// Length of a point as a vector.
pub(super) fn length(point: &[f32]) -> f64 {
    point.iter().map(|value| f64::from(*value) * f64::from(*value)).sum::<f64>().sqrt()
}

/// The map from configurations to points of single precision.
///
/// A real value is one coordinate, counted from the middle of its interval; an angle is one
/// coordinate that wraps; a rotation is four, its quaternion times two, and stands for the point and
/// its opposite. All are multiplied by the part's weight; parts without weight are left out.
///
/// [`Bounds`] says how the distances of points and of their configurations bound one another.
#[derive(Clone, Debug)]
pub(super) struct Embedding {
    lines: Vec<Line>,
    circles: Vec<Circle>,
    rotations: Vec<Rotation>,
    /// How wrong the scalar products of quaternions make squares, see [`Bounds`].
    products: f64,
    pub(super) lanes: Lanes,
}

/// How the distances of points and of their configurations, both as they are computed, bound one another.
///
/// *Exactly.* The chord between two quaternions on one side is at most the angle between them, so that
/// the distance of points is at most that of their configurations. Of a rotation by θ with weight w it
/// is c² = 8 w² x, x = 1 − cos(θ/2), and (wθ)² = c² (1 + x/6 + …), a series without negative terms
/// that comes to π²/8 at x = 1, so that (wθ)² ≤ c² (1 + (π²/8 − 1) x). As x is at most 1, and at most the
/// square of the whole distance of points over 8 w² for the least w, this bounds distances from above.
///
/// *Margin.* A coordinate of single precision is wrong by at most 2⁻²⁴ of itself, so a point by 2⁻²⁴ of its
/// length; where angles wrap the turn is wrong by as much, and is at most twice as long as the two
/// points together. The scalar product of two quaternions in double precision is wrong by less than 2⁻⁴⁹,
/// their own lengths included; where they nearly agree the arc cosine makes 2⁻²³ of that, a 2⁻²⁵th of what
/// they add to the lengths. Together that is under 2⁻²² of the lengths; twice as much is allowed. A
/// sum of lengths a + b has at most the square a² (1 + s) + b² (1 + 1/s), whatever s.
///
/// *Squares.* Of a rotation with scale s the square is computed as 2s² − 2|p·q|. The scalar product is wrong
/// by 2⁻²⁴ s² for each of two roundings to single precision, one of the products and three of the sums,
/// the rest by a rounding each of 2s²: together under 2⁻²⁰ s², of which twice as much is allowed.
/// Differences, other squares and sums are wrong by 2⁻²⁴ of themselves, at most as often as there are axes and
/// a few times more; four times as much is allowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// By what factor squares may differ.
    share: f64,
    /// How much they may differ beside it for their margin, and for rounding.
    margin: f64,
    rounding: f64,
    /// How much, relative to itself, a square grows with itself where chords become angles.
    bend: f64,
}

/// The s of the square of a sum.
const SPLIT: f64 = 1.0 / 1024.0;
/// π²/8 − 1, rounded up.
const BEND: f64 = 0.23371;

impl Bounds {
    /// Points whose computed square is beyond this belong to configurations whose distance has a larger
    /// square than this.
    pub(super) fn limit(&self, square: f64) -> f32 {
        // Rounded up; squares beyond single precision are infinite and say nothing.
        ((square * self.share + self.margin + self.rounding) as f32).next_up()
    }

    /// The largest square that the distance of configurations can have whose points have a computed one.
    pub(super) fn most(&self, square: f32) -> f64 {
        let chord = (f64::from(square).max(0.0) + self.rounding) * self.share + self.margin;
        chord * (1.0 + (chord * self.bend).min(BEND))
    }
}

#[derive(Clone, Debug)]
struct Line {
    at: usize,
    weight: f64,
    middle: f64,
}

#[derive(Clone, Debug)]
struct Circle {
    at: usize,
    weight: f64,
    turn: f32,
}

#[derive(Clone, Debug)]
struct Rotation {
    at: usize,
    scale: f64,
    /// Twice the square of the scale.
    whole: f32,
}

impl Embedding {
    pub(super) fn new(space: &Space) -> Embedding {
        let mut embedding = Embedding {
            lines: Vec::new(),
            circles: Vec::new(),
            rotations: Vec::new(),
            products: 0.0,
            lanes: Lanes::widest(),
        };
        for part in space.parts().iter().filter(|part| part.weight > 0.0) {
            let (at, weight) = (part.at, part.weight);
            match part.kind {
                PartKind::Real { min, max } => {
                    embedding.lines.push(Line { at, weight, middle: min + (max - min) / 2.0 });
                }
                PartKind::Angle => {
                    let turn = (math::TURN * weight) as f32;
                    embedding.circles.push(Circle { at, weight, turn });
                }
                PartKind::Rotation => {
                    let scale = 2.0 * weight;
                    let whole = 2.0 * scale * scale;
                    embedding.rotations.push(Rotation { at, scale, whole: whole as f32 });
                    embedding.products += whole * (1.0 / f64::from(1u32 << 20));
                }
            }
        }
        embedding
    }

    /// Number of coordinates.
    pub(super) fn axes(&self) -> usize {
        self.lines.len() + self.circles.len() + 4 * self.rotations.len()
    }

    /// Appends the point of a configuration in stored form.
    pub(super) fn embed(&self, q: &[f64], out: &mut Vec<f32>) {
        out.extend(self.lines.iter().map(|line| ((q[line.at] - line.middle) * line.weight) as f32));
        out.extend(self.circles.iter().map(|circle| (q[circle.at] * circle.weight) as f32));
        for rotation in &self.rotations {
            let quaternion = &q[rotation.at..rotation.at + 4];
            out.extend(quaternion.iter().map(|value| (value * rotation.scale) as f32));
        }
    }

    /// What the distances of points say of those of configurations, given the largest sum of two
    /// points' lengths.
    pub(super) fn bounds(&self, lengths: f64) -> Bounds {
        let margin = lengths * (1.0 / f64::from(1u32 << 21));
        let slack = 1.0 + (self.axes() + 8) as f64 * (1.0 / f64::from(1u32 << 22));
        let lightest =
            self.rotations.iter().map(|rotation| rotation.scale).fold(f64::INFINITY, f64::min);
        Bounds {
            share: slack * (1.0 + SPLIT),
            margin: margin * margin * (1.0 + 1.0 / SPLIT) * slack,
            rounding: self.products + TINY,
            bend: BEND / (2.0 * lightest * lightest),
        }
    }

    /// Squares of the distances between a point and those of a leaf.
    #[inline(always)]
    pub(super) fn squares(&self, point: &[f32], leaf: &[f32]) -> [f32; FAN] {
        let mut squares = [0.0; FAN];
        let mut axes = point.iter().zip(leaf.as_chunks::<FAN>().0);
        for (at, values) in axes.by_ref().take(self.lines.len()) {
            for (square, value) in squares.iter_mut().zip(values) {
                let difference = value - at;
                *square += difference * difference;
            }
        }
        for (circle, (at, values)) in self.circles.iter().zip(axes.by_ref()) {
            for (square, value) in squares.iter_mut().zip(values) {
                let direct = (value - at).abs();
                let around = circle.turn - direct;
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
                *square += rotation.whole - 2.0 * product.abs();
            }
        }
        squares
    }

    /// Squares of the distances between a point and boxes.
    #[inline(always)]
    pub(super) fn box_squares(&self, point: &[f32], sides: &[f32]) -> [f32; FAN] {
        // 0 where something is not a number.
        fn outside(at: f32, least: f32, largest: f32) -> f32 {
            let (below, above) = (least - at, at - largest);
            let farther = if below > above { below } else { above };
            if farther > 0.0 { farther } else { 0.0 }
        }
        let mut squares = [0.0; FAN];
        let mut axes = point.iter().zip(sides.as_chunks::<FAN>().0.as_chunks::<2>().0);
        for (at, [least, largest]) in axes.by_ref().take(self.lines.len()) {
            for (square, (least, largest)) in squares.iter_mut().zip(least.iter().zip(largest)) {
                let difference = outside(*at, *least, *largest);
                *square += difference * difference;
            }
        }
        for (circle, (at, [least, largest])) in self.circles.iter().zip(axes.by_ref()) {
            for (square, (least, largest)) in squares.iter_mut().zip(least.iter().zip(largest)) {
                let direct = outside(*at, *least, *largest);
                let (up, down) = (largest - at, at - least);
                let around = circle.turn - if up > down { up } else { down };
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
