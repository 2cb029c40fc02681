//! Root-mean-square distances (RMSD) of points from their counterparts, with and without superposition.
//!
//! The least RMSD needs only the largest eigenvalue λ of Horn's matrix, not the rotation: with E = ½ Σ (|a|² + |b|²)
//! about the centroids, N · RMSD² = 2 (E − λ). λ is the largest root of the characteristic polynomial, which Newton's
//! method finds from above, beginning at E, in a few steps: D. L. Theobald, *Rapid calculation of RMSDs using a
//! quaternion-based characteristic polynomial*, Acta Cryst. A 61 (2005) 478.

use super::jacobi::largest_eigenpair;
use super::superposition::{centroid, key_matrix, root_mean, superpose};
use crate::structure::Point;
use nalgebra::Matrix3;
use std::cmp::Ordering;

/// Where RMSD² is less than this part of 2 E / N, the difference E − λ has lost too many digits.
const CANCELLED: f64 = 1e-6;

/// Where the polynomial's slope at λ is less than this part of λ³, its largest roots lie too near one another.
const FLAT: f64 = 0.1;

/// Steps of Newton's method; about five are needed where the largest root is well apart.
const STEPS: usize = 50;

/// The RMSD of points from those of the same index as they stand, without superposition, in Å; 0 if there are none.
///
/// # Panics
///
/// If there are not as many of the one as of the other.
pub fn rmsd_in_place(a: &[Point], b: &[Point]) -> f64 {
    assert_eq!(a.len(), b.len(), "points without a counterpart");
    root_mean(a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum(), a.len())
}

/// The least RMSD that a rigid motion of the points can reach, in Å: as of [`superpose`], within 1e-9 Å for proteins
/// of ordinary size, and the same bits if the arguments are exchanged.
///
/// # Panics
///
/// If there are not as many of the one as of the other.
pub fn rmsd(a: &[Point], b: &[Point]) -> f64 {
    CentredPoints::new(a).rmsd(&CentredPoints::new(b))
}

/// Points about their centroid, ready to be compared with many others.
#[derive(Clone, Debug, PartialEq)]
pub struct CentredPoints {
    points: Vec<Point>,
    /// Σ |p|².
    squares: f64,
}

impl CentredPoints {
    /// Points, usually of all Cα atoms of a conformation, in Å.
    pub fn new(points: &[Point]) -> CentredPoints {
        let centre = centroid(points);
        let points: Vec<Point> = points.iter().map(|point| point - centre).collect();
        let squares = points.iter().map(|point| point.norm_squared()).sum();
        CentredPoints { points, squares }
    }

    /// The points about their centroid, in Å.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The radius of gyration of the points, which all count alike, in Å.
    pub fn radius_of_gyration(&self) -> f64 {
        root_mean(self.squares, self.points.len())
    }

    /// The least RMSD that a rigid motion can reach, see [`rmsd`].
    ///
    /// # Panics
    ///
    /// If there are not as many of the one as of the other.
    pub fn rmsd(&self, other: &CentredPoints) -> f64 {
        assert_eq!(self.points.len(), other.points.len(), "points without a counterpart");
        // What is computed is not symmetric in rounding, so the two are put in an order that they themselves give.
        let [a, b] = match compare(&self.points, &other.points) {
            // Zero, and NaN where a coordinate is not finite.
            Ordering::Equal => return 0.0 * self.squares,
            Ordering::Less => [self, other],
            Ordering::Greater => [other, self],
        };
        let mut sums = Matrix3::zeros();
        for (p, q) in a.points.iter().zip(&b.points) {
            sums += p * q.transpose();
        }
        let energy = (a.squares + b.squares) / 2.0;
        let eigenvalue = largest_eigenvalue(&sums, energy);
        let difference = energy - eigenvalue;
        if difference > CANCELLED * energy {
            root_mean(2.0 * difference, a.points.len())
        } else {
            superpose(&a.points, &b.points).rmsd
        }
    }
}

/// The order of two lists of points by their first coordinate that differs.
fn compare(a: &[Point], b: &[Point]) -> Ordering {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// The largest eigenvalue of Horn's matrix of the sums of products `s`; it is at most `bound`.
fn largest_eigenvalue(s: &Matrix3<f64>, bound: f64) -> f64 {
    let matrix = key_matrix(s);
    // λ⁴ + c₂ λ² + c₁ λ + c₀: the matrix has no trace.
    let c2 = -2.0 * s.norm_squared();
    let c1 = -8.0 * s.determinant();
    let c0 = matrix.determinant();
    let mut value = bound;
    for _ in 0..STEPS {
        let square = value * value;
        let polynomial = (square + c2) * square + c1 * value + c0;
        let slope = (4.0 * square + 2.0 * c2) * value + c1;
        let before = value;
        value -= polynomial / slope;
        if (before - value).abs() <= 1e-15 * bound {
            if slope > FLAT * value * value * value {
                return value;
            }
            break;
        }
    }
    largest_eigenpair(&matrix).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Points from a ball (or a plane, or a line) of some size, others near them or not.
        #[test]
        fn the_short_way_finds_what_superposition_finds(
            points in prop::collection::vec(prop::array::uniform3(-1f64..1.0), 1..60),
            noise in prop::collection::vec(prop::array::uniform3(-1f64..1.0), 60),
            flat in prop::sample::select(vec![[1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1e-4, 1e-6]]),
            spread in prop::sample::select(vec![0.0, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0]),
        ) {
            let a: Vec<Point> = points.iter().map(|p| Point::from(*p).component_mul(&Point::from(flat)) * 25.0).collect();
            let b: Vec<Point> = a.iter().zip(noise).map(|(a, n)| Point::new(a.y, a.z, a.x) + Point::from(n) * 25.0 * spread).collect();
            let found = rmsd(&a, &b);
            prop_assert!((found - superpose(&a, &b).rmsd).abs() < 1e-9, "{} {}", found, superpose(&a, &b).rmsd);
            prop_assert_eq!(found.to_bits(), rmsd(&b, &a).to_bits());
            prop_assert!(found <= rmsd_in_place(&a, &b) + 1e-12);
        }
    }

    #[test]
    fn few_points_and_equal_ones_have_an_rmsd() {
        assert_eq!((rmsd(&[], &[]), rmsd_in_place(&[], &[])), (0.0, 0.0));
        assert_eq!(rmsd(&[Point::x()], &[Point::y()]), 0.0);
        assert_eq!(rmsd(&[Point::x(); 4], &[Point::y(); 4]), 0.0);
        // Two points, 1 Å and 3 Å apart: each is half of the difference away from its counterpart.
        let pair = |length: f64| [Point::zeros(), Point::z() * length];
        assert!((rmsd(&pair(1.0), &pair(3.0)) - 1.0).abs() < 1e-14);
        assert_eq!(rmsd_in_place(&pair(0.0), &pair(2.0)), 2f64.sqrt());
        assert!(rmsd(&[Point::x() * f64::NAN; 3], &[Point::x(); 3]).is_nan());
    }
}
