//! Free-form deformation: points of the robot follow the lattice (T. W. Sederberg, S. R. Parry, *Free-form deformation of solid
//! geometric models*, 1986).
//!
//! A point is displaced by the mean of the displacements of lattice points, with weights that say where in the lattice it rests. With
//! either weights lattice points that are moved by an affine map move the robot by that map, up to rounding, since the weights sum up to 1
//! and the point is the mean of the lattice points.

use super::lattice::Lattice;
use crate::model::deformable::LatticeInterpolation;

/// Weights of all vertices.
pub(super) enum FreeForm {
    /// Per vertex the corner of its cell with the least coordinates, and how far along the cell it is.
    Trilinear(Vec<(usize, [f64; 3])>),
    /// Per vertex and axis a Bernstein polynomial for every place along the axis.
    Bernstein(Vec<[Vec<f64>; 3]>),
}

impl FreeForm {
    /// The weights of vertices within the lattice.
    pub fn new(lattice: &Lattice, how: LatticeInterpolation, vertices: &[[f64; 3]]) -> FreeForm {
        match how {
            LatticeInterpolation::Trilinear => {
                FreeForm::Trilinear(vertices.iter().map(|vertex| lattice.cell(*vertex)).collect())
            }
            LatticeInterpolation::Bernstein => {
                let weights = |vertex: &[f64; 3]| {
                    let shares = lattice.shares(*vertex);
                    [0, 1, 2].map(|axis| bernstein(lattice.counts[axis] - 1, shares[axis]))
                };
                FreeForm::Bernstein(vertices.iter().map(weights).collect())
            }
        }
    }

    /// How far a vertex is displaced.
    pub fn displacement(
        &self,
        lattice: &Lattice,
        displacements: &[[f64; 3]],
        vertex: usize,
    ) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let mut add = |weight: f64, of: [f64; 3]| {
            for k in 0..3 {
                sum[k] += weight * of[k];
            }
        };
        match self {
            FreeForm::Trilinear(cells) => {
                let (first, shares) = cells[vertex];
                for (i, corner) in lattice.corners(first).into_iter().enumerate() {
                    let along = |axis: usize| {
                        if i >> axis & 1 == 1 { shares[axis] } else { 1.0 - shares[axis] }
                    };
                    add(along(0) * along(1) * along(2), displacements[corner]);
                }
            }
            FreeForm::Bernstein(weights) => {
                let [x, y, z] = &weights[vertex];
                let mut row = displacements.chunks_exact(x.len());
                for z in z {
                    for y in y {
                        let mut of_row = [0.0; 3];
                        for (x, of) in x.iter().zip(row.next().unwrap_or_default()) {
                            for k in 0..3 {
                                of_row[k] += x * of[k];
                            }
                        }
                        add(y * z, of_row);
                    }
                }
            }
        }
        sum
    }
}

/// The Bernstein polynomials of a degree at a share, by de Casteljau's recurrence.
fn bernstein(degree: usize, share: f64) -> Vec<f64> {
    let mut values = vec![1.0];
    for _ in 0..degree {
        let mut next = vec![0.0; values.len() + 1];
        for (i, value) in values.iter().enumerate() {
            next[i] += value * (1.0 - share);
            next[i + 1] += value * share;
        }
        values = next;
    }
    values
}
