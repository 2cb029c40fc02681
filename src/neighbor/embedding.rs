//! Configurations as points whose Euclidean distance never exceeds the space's by more than rounding.

use crate::math;
use crate::space::{PartKind, Space};

/// So many points or boxes are measured together; along each axis their coordinates lie side by side.
pub(super) const FAN: usize = 16;

/// The map from configurations to points of single precision.
///
/// A real value is one coordinate, counted from the middle of its interval; an angle is one
/// coordinate that wraps; a rotation is four, its quaternion times two, and stands for the point and
/// its opposite. All are multiplied by the part's weight; parts without weight are left out.
///
/// The chord between two quaternions on one side is at most the angle between them, so in exact
/// arithmetic the distance of two points is at most that of their configurations. [`Embedding::margin`]
/// covers what rounding adds.
#[derive(Clone, Debug)]
pub(super) struct Embedding {
    lines: Vec<Line>,
    circles: Vec<Circle>,
    rotations: Vec<Rotation>,
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
}

impl Embedding {
    pub(super) fn new(space: &Space) -> Embedding {
        let mut embedding =
            Embedding { lines: Vec::new(), circles: Vec::new(), rotations: Vec::new() };
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
                    embedding.rotations.push(Rotation { at, scale: 2.0 * weight });
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

    /// How much the distance of two points may exceed that of their configurations, both as they are
    /// computed, given the sum of the points' lengths.
    ///
    /// A coordinate of single precision is wrong by at most 2⁻²⁴ of itself, so a point by 2⁻²⁴ of its
    /// length; where angles wrap the turn is wrong by as much, and is at most twice as long as the two
    /// points together. The scalar product of two quaternions is wrong by less than 2⁻⁴⁹, their own
    /// lengths included; where they nearly agree the arc cosine makes 2⁻²³ of that, a 2⁻²⁵th of what
    /// they add to the lengths. Together that is under 2⁻²² of the lengths; twice as much is allowed.
    /// Differences, squares and sums are wrong by relative errors beside it: [`Embedding::slack`].
    pub(super) fn margin(&self, lengths: f64) -> f64 {
        lengths * (1.0 / f64::from(1u32 << 21))
    }

    /// By what factor a computed square of a distance of points may exceed the true one.
    pub(super) fn slack(&self) -> f64 {
        1.0 + (self.axes() + 8) as f64 * (1.0 / f64::from(1u32 << 22))
    }

    /// Squares of the distances between a point and those of a leaf.
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
        for _ in &self.rotations {
            let (mut same, mut opposite) = ([0.0; FAN], [0.0; FAN]);
            for (at, values) in axes.by_ref().take(4) {
                for ((same, opposite), value) in same.iter_mut().zip(&mut opposite).zip(values) {
                    *same += (value - at) * (value - at);
                    *opposite += (value + at) * (value + at);
                }
            }
            for ((square, same), opposite) in squares.iter_mut().zip(same).zip(opposite) {
                *square += if opposite < same { opposite } else { same };
            }
        }
        squares
    }

    /// Squares of the distances between a point and boxes: along each axis their least coordinates,
    /// then their largest.
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
