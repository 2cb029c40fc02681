//! The normal equations of a sum of squares: JᵀJ δ = −Jᵀr.

use super::cholesky::Symmetric;

/// JᵀJ and Jᵀr.
#[derive(Clone, Debug)]
pub struct NormalEquations {
    /// JᵀJ.
    pub matrix: Symmetric,
    /// Jᵀr, the gradient of half the sum of squares.
    pub gradient: Vec<f64>,
}

impl NormalEquations {
    /// Both zero.
    pub fn zeros(size: usize) -> NormalEquations {
        NormalEquations { matrix: Symmetric::zeros(size), gradient: vec![0.0; size] }
    }

    /// Adds a residual whose derivatives are these from the unknown number `first` on, and zero elsewhere.
    pub fn add(&mut self, first: usize, derivatives: &[f64], residual: f64) {
        for (k, derivative) in derivatives.iter().enumerate() {
            self.gradient[first + k] += derivative * residual;
            let row = self.matrix.row_mut(first + k);
            for (entry, other) in row.iter_mut().zip(&derivatives[k..]) {
                *entry += derivative * other;
            }
        }
    }
}
