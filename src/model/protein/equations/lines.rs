//! Forces along the line between two sites: their part of the normal equations, however many there are.
//!
//! A spring between a site of body a and one of body b, the later, changes its length with the torsions k from a to before b, by
//! s_k · w, where s_k is the torsion's screw and w the wrench of a unit force at the second site along the line. So the entry
//! of JᵀJ for the torsions k ≤ l is s_kᵀ (Σ κ w wᵀ) s_l, summed over the springs with a ≤ k and b > l. Torsion by torsion, and for each from the
//! end of the chain on, these sums grow by one body: that takes some 50 products per entry, and no more where there are more springs.

use super::normal::NormalEquations;
use super::pulls::POSE;
use super::screws::Screw;
use crate::structure::Point;

/// A spring.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// The bodies of its ends, the first not after the second.
    pub bodies: (usize, usize),
    /// Where its ends are, Å, in the order of the bodies.
    pub ends: [Point; 2],
    /// The second derivative of its energy by its length.
    pub stiffness: f64,
    /// The first derivative.
    pub force: f64,
}

/// The moment about the origin, and the force.
type Wrench = [f64; 6];

/// The upper triangle of a symmetric matrix of six rows, row by row.
type Six = [f64; 21];

fn wrench(line: &Line) -> Wrench {
    let [from, to] = line.ends;
    let apart = to - from;
    let length = apart.norm();
    // Sites on one another are pushed apart along a fixed direction.
    let force = if length > 0.0 { apart / length } else { Point::x() };
    let moment = to.cross(&force);
    [moment.x, moment.y, moment.z, force.x, force.y, force.z]
}

fn screw(screw: &Screw) -> Wrench {
    let Screw { angular, linear } = screw;
    [angular.x, angular.y, angular.z, linear.x, linear.y, linear.z]
}

fn dot(a: &Wrench, b: &Wrench) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds a · w wᵀ.
fn add_square(to: &mut Six, a: f64, w: &Wrench) {
    let mut entries = to.iter_mut();
    for row in 0..6 {
        for column in row..6 {
            *entries.next().expect("there are 21") += a * w[row] * w[column];
        }
    }
}

/// The product with a vector.
fn times(six: &Six, s: &Wrench) -> Wrench {
    let mut product = [0.0; 6];
    let mut entries = six.iter();
    for row in 0..6 {
        for column in row..6 {
            let entry = entries.next().expect("there are 21");
            product[row] += entry * s[column];
            if column > row {
                product[column] += entry * s[row];
            }
        }
    }
    product
}

/// Adds springs to equations whose unknowns are those of the pose and then these torsions.
pub fn add_lines(equations: &mut NormalEquations, torsions: &[Screw], lines: &[Line]) {
    let count = torsions.len();
    let screws: Vec<Wrench> = torsions.iter().map(screw).collect();
    let mut begin: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (number, line) in lines.iter().enumerate() {
        // What lies on one body keeps its length.
        if line.bodies.0 < line.bodies.1 {
            begin[line.bodies.0].push(number);
        }
    }
    // By the later body: the springs that have begun.
    let mut stiffness = vec![[0.0; 21]; count + 1];
    let mut forces = vec![[0.0; 6]; count + 1];
    let mut has_begun = vec![false; count + 1];
    for k in 0..count {
        for number in &begin[k] {
            let line = &lines[*number];
            let (end, w) = (line.bodies.1, wrench(line));
            has_begun[end] = true;
            add_square(&mut stiffness[end], line.stiffness, &w);
            forces[end].iter_mut().zip(&w).for_each(|(sum, w)| *sum += line.force * w);
        }
        let row = equations.matrix.row_mut(POSE + k);
        let (mut held, mut pulled) = ([0.0; 6], [0.0; 6]);
        for l in (k..count).rev() {
            if has_begun[l + 1] {
                let more = times(&stiffness[l + 1], &screws[k]);
                held.iter_mut().zip(&more).for_each(|(sum, more)| *sum += more);
                pulled.iter_mut().zip(&forces[l + 1]).for_each(|(sum, more)| *sum += more);
            }
            row[l - k] += dot(&held, &screws[l]);
        }
        equations.gradient[POSE + k] += dot(&pulled, &screws[k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::protein::equations::distance_gradient;

    #[test]
    fn sums_are_those_of_one_row_per_spring() {
        let at = |k: f64| Point::new(k.sin_like(), (2.0 * k).sin_like(), (0.7 * k).sin_like());
        let torsions: Vec<Screw> = (0..9)
            .map(|k| Screw { angular: at(f64::from(k)), linear: 5.0 * at(f64::from(k) + 0.5) })
            .collect();
        let lines: Vec<Line> = (0..40)
            .map(|i| {
                let (a, b) = ((i * 7) % 10, (i * 3 + 2) % 10);
                let ends = [8.0 * at(i as f64), 8.0 * at(i as f64 * 1.3 + 4.0)];
                Line {
                    bodies: (a.min(b), a.max(b)),
                    ends,
                    stiffness: 1.0 + i as f64,
                    force: 3.0 - i as f64,
                }
            })
            .collect();
        let mut whole = NormalEquations::zeros(POSE + 9);
        add_lines(&mut whole, &torsions, &lines);
        let mut plain = NormalEquations::zeros(POSE + 9);
        for line in &lines {
            let root = line.stiffness.sqrt();
            let slopes = distance_gradient(&torsions, line.bodies, &line.ends[0], &line.ends[1]);
            let row: Vec<f64> = slopes.map(|slope| root * slope).collect();
            plain.add(POSE + line.bodies.0, &row, line.force / root);
        }
        for k in 0..POSE + 9 {
            assert!((whole.gradient[k] - plain.gradient[k]).abs() < 1e-9);
            let plain = plain.matrix.row_mut(k).to_vec();
            for (whole, plain) in whole.matrix.row_mut(k).iter().zip(plain) {
                assert!((*whole - plain).abs() < 1e-9 * (1.0 + plain.abs()), "{whole}, {plain}");
            }
        }
    }

    trait SinLike {
        /// Numbers between −1 and 1 without a pattern.
        fn sin_like(self) -> f64;
    }

    impl SinLike for f64 {
        fn sin_like(self) -> f64 {
            crate::math::sin(3.0 * self + 1.0)
        }
    }
}
