//! The rigid motion that brings points as near as possible to others, least squares.
//!
//! B. K. P. Horn, *Closed-form solution of absolute orientation using unit quaternions*, J. Opt. Soc. Am. A 4 (1987)
//! 629: the best rotation's quaternion is the eigenvector of the largest eigenvalue of a symmetric matrix of four rows,
//! which is made of the sums of products of the coordinates. It is the rotation of W. Kabsch, Acta Cryst. A 32 (1976)
//! 922, but being a quaternion it can never be a reflection.

use super::jacobi::largest_eigenpair;
use crate::structure::Point;
use nalgebra::{Matrix3, Matrix4};

/// A rigid motion, and how near it brings the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Superposition {
    /// The rotation, about the origin, which comes first: orthogonal, with determinant 1.
    pub rotation: Matrix3<f64>,
    /// The translation, in Å.
    pub translation: Point,
    /// The root of the mean squared distance of the moved points from the fixed ones after the motion, in Å.
    pub rmsd: f64,
}

impl Superposition {
    /// Where the motion brings a point.
    pub fn apply(&self, point: &Point) -> Point {
        self.rotation * point + self.translation
    }
}

/// The motion that brings `moved` as near as possible to `fixed`, each point to the one of the same index.
///
/// All points count alike. Where several rotations are equally good (points on a line, or one point), it is one of them,
/// the same for the same bits of the points; no points have the identity and RMSD 0. Coordinates that are not finite give
/// an RMSD that is not finite either.
///
/// # Panics
///
/// If there are not as many of the one as of the other.
pub fn superpose(moved: &[Point], fixed: &[Point]) -> Superposition {
    assert_eq!(moved.len(), fixed.len(), "points without a counterpart");
    let (from, to) = (centroid(moved), centroid(fixed));
    let mut sums = Matrix3::zeros();
    for (a, b) in moved.iter().zip(fixed) {
        sums += (a - from) * (b - to).transpose();
    }
    let (_, quaternion) = largest_eigenpair(&key_matrix(&sums));
    let rotation = rotation_of([quaternion[0], quaternion[1], quaternion[2], quaternion[3]]);
    // About the centroids, so that a long way from the origin nothing is lost.
    let squares =
        moved.iter().zip(fixed).map(|(a, b)| (rotation * (a - from) - (b - to)).norm_squared());
    let rmsd = root_mean(squares.sum(), moved.len());
    Superposition { rotation, translation: to - rotation * from, rmsd }
}

/// Horn's matrix N, of the sums of products S with `S[(a, b)] = Σ moved_a fixed_b` about the centroids.
pub(super) fn key_matrix(s: &Matrix3<f64>) -> Matrix4<f64> {
    let (xx, xy, xz) = (s[(0, 0)], s[(0, 1)], s[(0, 2)]);
    let (yx, yy, yz) = (s[(1, 0)], s[(1, 1)], s[(1, 2)]);
    let (zx, zy, zz) = (s[(2, 0)], s[(2, 1)], s[(2, 2)]);
    #[rustfmt::skip]
    let matrix = Matrix4::new(
        xx + yy + zz, yz - zy,      zx - xz,      xy - yx,
        yz - zy,      xx - yy - zz, xy + yx,      zx + xz,
        zx - xz,      xy + yx,      yy - xx - zz, yz + zy,
        xy - yx,      zx + xz,      yz + zy,      zz - xx - yy,
    );
    matrix
}

/// The rotation of a unit quaternion `w x y z`.
fn rotation_of([w, x, y, z]: [f64; 4]) -> Matrix3<f64> {
    #[rustfmt::skip]
    let rotation = Matrix3::new(
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z),       2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),       1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),       2.0 * (y * z + w * x),       1.0 - 2.0 * (x * x + y * y),
    );
    rotation
}

/// The mean of points, in Å; the origin if there are none.
pub fn centroid(points: &[Point]) -> Point {
    let sum = points.iter().fold(Point::zeros(), |sum, point| sum + point);
    if points.is_empty() { sum } else { sum / points.len() as f64 }
}

/// The root of a mean; 0 if there is nothing to average.
pub(super) fn root_mean(sum: f64, count: usize) -> f64 {
    if count == 0 { 0.0 } else { (sum / count as f64).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use proptest::prelude::*;

    fn points(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Point>> {
        let point = prop::array::uniform3(-30f64..30.0).prop_map(Point::from);
        prop::collection::vec(point, count)
    }

    fn is_proper(rotation: &Matrix3<f64>) -> bool {
        let unit = rotation * rotation.transpose() - Matrix3::identity();
        unit.norm() < 1e-14 && (rotation.determinant() - 1.0).abs() < 1e-14
    }

    /// Rotation by `angle` about the direction (1, 2, 3).
    fn turn(angle: f64) -> Matrix3<f64> {
        let (sine, cosine) = (math::sin(angle / 2.0), math::cos(angle / 2.0));
        let axis = Point::new(1.0, 2.0, 3.0).normalize() * sine;
        rotation_of([cosine, axis.x, axis.y, axis.z])
    }

    proptest! {
        #[test]
        fn a_motion_is_found_again(points in points(3..40), angle in -3.2f64..3.2, shift in prop::array::uniform3(-1e3f64..1e3)) {
            let rotation = turn(angle);
            let moved: Vec<Point> = points.iter().map(|p| rotation * p + Point::from(shift)).collect();
            let found = superpose(&points, &moved);
            prop_assert!(is_proper(&found.rotation));
            prop_assert!(found.rmsd < 1e-11, "{}", found.rmsd);
            for (point, moved) in points.iter().zip(&moved) {
                prop_assert!((found.apply(point) - moved).norm() < 1e-11);
            }
        }

        #[test]
        fn no_other_motion_is_nearer(a in points(1..20), b in points(20..21), angle in -0.5f64..0.5) {
            let b = &b[..a.len()];
            let best = superpose(&a, b);
            prop_assert!(is_proper(&best.rotation));
            let (from, to) = (centroid(&a), centroid(b));
            let other = turn(angle) * best.rotation;
            let sum: f64 = a.iter().zip(b).map(|(p, q)| (other * (p - from) - (q - to)).norm_squared()).sum();
            prop_assert!(best.rmsd <= root_mean(sum, a.len()) + 1e-12);
        }
    }

    #[test]
    fn a_mirror_image_is_not_reached_by_reflecting() {
        let hand =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]].map(Point::from);
        let other = hand.map(|p| Point::new(p.x, p.y, -p.z));
        let found = superpose(&hand, &other);
        assert!(is_proper(&found.rotation) && found.rmsd > 0.5, "{found:?}");
    }

    #[test]
    fn few_points_and_points_on_lines_and_planes_have_a_motion() {
        assert_eq!(superpose(&[], &[]).rotation, Matrix3::identity());
        let p = Point::new(1.0, -2.0, 0.5);
        let one = superpose(&[p], &[p * 3.0]);
        assert_eq!((one.rotation, one.rmsd), (Matrix3::identity(), 0.0));
        assert!((one.apply(&p) - p * 3.0).norm() < 1e-15);
        // All points at one place, too, leave every rotation open.
        assert_eq!(superpose(&[p; 5], &[p; 5]).rmsd, 0.0);

        let directions = [Point::x(), Point::y(), -Point::x(), Point::new(0.6, 0.0, 0.8)];
        for (from, to) in directions.iter().flat_map(|a| directions.iter().map(move |b| (a, b))) {
            for steps in [2, 3, 10] {
                let line = |d: &Point| (0..steps).map(|i| d * f64::from(i) + p).collect::<Vec<_>>();
                let found = superpose(&line(from), &line(to));
                assert!(is_proper(&found.rotation) && found.rmsd < 1e-14, "{from} {to} {found:?}");
            }
            let other = Point::new(0.3, 0.2, 0.9);
            let plane = |d: &Point| [p, p + d, p + d * 2.0, p + d.cross(&other).normalize()];
            let found = superpose(&plane(from), &plane(to));
            assert!(is_proper(&found.rotation) && found.rmsd < 1e-14, "{from} {to} {found:?}");
        }
    }

    #[test]
    fn what_is_no_number_gives_none() {
        for bad in [f64::NAN, f64::INFINITY, f64::MAX] {
            let points = [Point::new(bad, 0.0, 0.0), Point::new(0.0, bad, 1.0), Point::x()];
            assert!(!superpose(&points, &[Point::x(); 3]).rmsd.is_finite());
        }
    }
}
