//! The force of a grid on a ligand, for people to see or feel.

use super::Grid;
use crate::model::docking::energy::sum::PairSum;
use crate::structure::Point;

impl Grid {
    /// The force in kJ/(mol Å) on the ligand as a whole, the sum of the forces on its atoms, at most as large as `largest`,
    /// with its direction kept: what O. B. Bayazit 2003 (chapter V, section C, figure 21) gives to the hand of a user, whose
    /// device ends at 1 N.
    ///
    /// # Panics
    /// If there are not `values_len()` values.
    pub fn force(
        &self,
        values: &[f32],
        sum: &PairSum,
        ligand_positions: &[Point],
        largest: f64,
    ) -> Point {
        let mut gradient = vec![Point::zeros(); ligand_positions.len()];
        self.gradient(values, sum, ligand_positions, &mut gradient);
        let force = gradient.iter().fold(Point::zeros(), |force, atom| force - atom);
        capped(force, largest)
    }
}

/// A force at most as large as `largest` (0 or more), with its direction kept.
pub fn capped(force: Point, largest: f64) -> Point {
    // Scaled by its largest coordinate first, so that no square is too large for a number.
    let widest = force.amax();
    let scaled = force / widest;
    let size = (scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z).sqrt();
    if widest > 0.0 && size * widest > largest { scaled * (largest / size) } else { force }
}
