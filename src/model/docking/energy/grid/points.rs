//! Energies at the grid's own points.

use super::Grid;
use crate::model::docking::energy::PairSum;
use crate::structure::Point;

impl Grid {
    /// The distance of neighbouring points, Å.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// The energy that an atom of the ligand has at a point of the grid, by its place along x, y and z.
    pub fn point_energy(
        &self,
        values: &[f32],
        sum: &PairSum,
        atom: usize,
        place: [usize; 3],
    ) -> f64 {
        self.of_atom(values, sum, atom, self.point(place)).0
    }

    /// The energy that an atom of the ligand has at the point of the grid that is nearest to a place; beyond the grid, its exact energy.
    pub fn nearest_energy(&self, values: &[f32], sum: &PairSum, atom: usize, at: &Point) -> f64 {
        let mut place = [0; 3];
        for axis in 0..3 {
            let there = (at[axis] - self.low[axis]) / self.spacing + 0.5;
            if !(there >= 0.0 && there < self.counts[axis] as f64) {
                return sum.of_atom(atom, *at).0.total();
            }
            place[axis] = there as usize;
        }
        self.point_energy(values, sum, atom, place)
    }
}
