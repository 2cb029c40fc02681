//! Eigenvalues and eigenvectors of a symmetric matrix of four rows, by Jacobi's rotations (Golub & Van Loan, *Matrix
//! Computations*, 4th edition, §8.5).
//!
//! Only `+ - * /` and `sqrt` are used, in a fixed order, so the bits are the same on every machine; and the number of
//! steps is bounded, so a matrix with NaN in it ends as well.

use nalgebra::{Matrix4, Vector4};

/// Sweeps after which the matrix is taken as diagonal. Convergence is quadratic: finite matrices need at most about
/// seven.
const SWEEPS: usize = 30;

/// The largest eigenvalue with a unit eigenvector. If several eigenvalues are largest, it is the eigenvector that the
/// rotations leave at the lowest index: of a multiple of the identity, (1, 0, 0, 0).
pub(super) fn largest_eigenpair(matrix: &Matrix4<f64>) -> (f64, Vector4<f64>) {
    let mut a = *matrix;
    let mut vectors = Matrix4::identity();
    for _ in 0..SWEEPS {
        let mut is_diagonal = true;
        for p in 0..3 {
            for q in p + 1..4 {
                is_diagonal &= a[(p, q)] == 0.0;
                rotate(&mut a, &mut vectors, p, q);
            }
        }
        if is_diagonal {
            break;
        }
    }
    let mut largest = 0;
    for i in 1..4 {
        if a[(i, i)] > a[(largest, largest)] {
            largest = i;
        }
    }
    // The product of many rotations is one to about 1e-15; that is mended here.
    let vector: Vector4<f64> = vectors.column(largest).into();
    (a[(largest, largest)], vector / vector.norm())
}

/// Turns the axes p and q so that the entries (p, q) and (q, p) become zero.
fn rotate(a: &mut Matrix4<f64>, vectors: &mut Matrix4<f64>, p: usize, q: usize) {
    let off = a[(p, q)];
    if off == 0.0 {
        return;
    }
    let theta = (a[(q, q)] - a[(p, p)]) / (2.0 * off);
    // The tangent of the smaller of the two angles. Where θ² overflows, the entry is negligible, and so is the angle.
    let tangent = 1.0 / (theta.abs() + (theta * theta + 1.0).sqrt());
    let tangent = if theta < 0.0 { -tangent } else { tangent };
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    a[(p, p)] -= tangent * off;
    a[(q, q)] += tangent * off;
    a[(p, q)] = 0.0;
    a[(q, p)] = 0.0;
    for k in 0..4 {
        if k != p && k != q {
            let (kp, kq) = (a[(k, p)], a[(k, q)]);
            a[(k, p)] = cosine * kp - sine * kq;
            a[(k, q)] = sine * kp + cosine * kq;
            a[(p, k)] = a[(k, p)];
            a[(q, k)] = a[(k, q)];
        }
        let (kp, kq) = (vectors[(k, p)], vectors[(k, q)]);
        vectors[(k, p)] = cosine * kp - sine * kq;
        vectors[(k, q)] = sine * kp + cosine * kq;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_eigenpair_is_one_and_no_eigenvalue_is_larger(entries in prop::array::uniform10(-100f64..100.0)) {
            let mut matrix = Matrix4::zeros();
            let mut entries = entries.into_iter();
            for i in 0..4 {
                for j in i..4 {
                    matrix[(i, j)] = entries.next().unwrap_or_default();
                    matrix[(j, i)] = matrix[(i, j)];
                }
            }
            let (value, vector) = largest_eigenpair(&matrix);
            prop_assert!((matrix * vector - vector * value).norm() < 1e-12 * matrix.norm());
            prop_assert!((vector.norm() - 1.0).abs() < 1e-15);
            let all = matrix.symmetric_eigenvalues();
            prop_assert!((value - all.max()).abs() < 1e-12 * matrix.norm());
        }
    }

    #[test]
    fn matrices_without_one_largest_eigenvalue_have_an_eigenvector_all_the_same() {
        assert_eq!(largest_eigenpair(&Matrix4::zeros()), (0.0, Vector4::new(1.0, 0.0, 0.0, 0.0)));
        let (value, vector) = largest_eigenpair(&Matrix4::from_element(1.0));
        assert!((value - 4.0).abs() < 1e-14 && (vector.x.abs() - 0.5).abs() < 1e-14);
        let (value, _) = largest_eigenpair(&Matrix4::from_element(f64::NAN));
        assert!(value.is_nan());
    }
}
