//! Symmetric positive definite systems by Cholesky's factorization.
//!
//! It is written here because nalgebra's products of large matrices use fused multiply-add where the processor has it, so
//! that their last bits differ between machines. Here every entry is the same sum in the same order everywhere.

/// A square matrix, row by row. Only the upper triangle is used.
#[derive(Clone, Debug)]
pub struct Symmetric {
    size: usize,
    entries: Vec<f64>,
}

impl Symmetric {
    /// A matrix of zeros.
    pub fn zeros(size: usize) -> Symmetric {
        Symmetric { size, entries: vec![0.0; size * size] }
    }

    /// The part of a row from the diagonal on.
    pub fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.entries[row * self.size + row..(row + 1) * self.size]
    }

    /// An entry of the diagonal.
    pub fn diagonal(&self, row: usize) -> f64 {
        self.entries[row * self.size + row]
    }

    /// Solves this · x = b. `None` if the matrix is not positive definite as far as rounding can tell.
    pub fn solve(self, b: &[f64]) -> Option<Vec<f64>> {
        self.factor()?.solve(b)
    }

    /// The factor U with Uᵀ U = this. `None` if the matrix is not positive definite as far as rounding can tell.
    pub fn factor(mut self) -> Option<Factor> {
        let n = self.size;
        // Row by row: each row, once divided by the root of its diagonal, is taken off the rows below it.
        for k in 0..n {
            let (above, below) = self.entries.split_at_mut((k + 1) * n);
            let row = &mut above[k * n..];
            let pivot = row[k];
            if pivot.is_nan() || pivot <= 0.0 || pivot.is_infinite() {
                return None;
            }
            let root = pivot.sqrt();
            row[k..].iter_mut().for_each(|entry| *entry /= root);
            for (i, target) in (k + 1..n).zip(below.chunks_exact_mut(n)) {
                let factor = row[i];
                if factor != 0.0 {
                    for (entry, above) in target[i..].iter_mut().zip(&row[i..]) {
                        *entry -= factor * above;
                    }
                }
            }
        }
        Some(Factor { size: n, entries: self.entries })
    }
}

/// The upper triangular factor U of a matrix Uᵀ U, row by row. What is below the diagonal means nothing.
#[derive(Clone, Debug)]
pub struct Factor {
    size: usize,
    entries: Vec<f64>,
}

impl Factor {
    fn row(&self, k: usize) -> &[f64] {
        &self.entries[k * self.size..(k + 1) * self.size]
    }

    /// Solves Uᵀ U x = b. `None` if a number of the solution is not finite.
    pub fn solve(&self, b: &[f64]) -> Option<Vec<f64>> {
        // Uᵀ y = b, then U x = y.
        let mut y = b.to_vec();
        for k in 0..self.size {
            let row = self.row(k);
            y[k] /= row[k];
            let value = y[k];
            for (entry, factor) in y[k + 1..].iter_mut().zip(&row[k + 1..]) {
                *entry -= factor * value;
            }
        }
        self.solve_upper(y)
    }

    /// Solves U x = y. Where the numbers of y are independent and normal with variance 1, those of x have the covariance
    /// (Uᵀ U)⁻¹. `None` if a number of the solution is not finite.
    pub fn solve_upper(&self, y: Vec<f64>) -> Option<Vec<f64>> {
        let mut x = y;
        for k in (0..self.size).rev() {
            let row = self.row(k);
            let known: f64 = row[k + 1..].iter().zip(&x[k + 1..]).map(|(u, x)| u * x).sum();
            x[k] = (x[k] - known) / row[k];
        }
        x.iter().all(|value| value.is_finite()).then_some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: &[&[f64]]) -> Symmetric {
        let mut matrix = Symmetric::zeros(rows.len());
        for (k, row) in rows.iter().enumerate() {
            matrix.row_mut(k).copy_from_slice(row);
        }
        matrix
    }

    #[test]
    fn solves_a_system_known_by_hand() {
        // [4 2 0; 2 5 2; 0 2 5] · (1, −2, 3) = (0, 2 − 10 + 6, −4 + 15)
        let x = of(&[&[4.0, 2.0, 0.0], &[5.0, 2.0], &[5.0]]).solve(&[0.0, -2.0, 11.0]).unwrap();
        for (x, expected) in x.iter().zip([1.0, -2.0, 3.0]) {
            assert!((x - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn a_factor_makes_noise_of_the_inverse_covariance() {
        // U = [2 1; 0 2], so U x = (2, 4) has x = (0, 2).
        let factor = of(&[&[4.0, 2.0], &[5.0]]).factor().unwrap();
        assert_eq!(factor.solve_upper(vec![2.0, 4.0]), Some(vec![0.0, 2.0]));
        assert_eq!(factor.solve(&[4.0, 10.0]), Some(vec![0.0, 2.0]));
        assert_eq!(factor.solve_upper(vec![f64::INFINITY, 0.0]), None);
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        assert_eq!(of(&[&[1.0, 2.0], &[1.0]]).solve(&[1.0, 1.0]), None);
        assert_eq!(of(&[&[f64::NAN, 0.0], &[1.0]]).solve(&[1.0, 1.0]), None);
        assert_eq!(of(&[]).solve(&[]), Some(Vec::new()));
    }
}
