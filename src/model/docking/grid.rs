//! How the energy of the protein's field is looked up, and where the numbers of its grid are.

use super::energy::{Grid, Lookup, PairSum, SPACING_RANGE, VALUES_MAX};
use crate::shelf::{self, Block, BlockName, Shelf};
use crate::structure::Point;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// How the energy of the protein's field is looked up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct GridSpec {
    /// How values at points of the grid become energies in between; or that there is no grid.
    pub lookup: EnergyLookup,
    /// The distance of neighbouring points of the grid, Å.
    pub spacing: f64,
}

/// How the energy of an atom in the protein's field is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum EnergyLookup {
    /// By the sum over all atoms of the protein.
    Exact,
    /// That of the nearest point of the grid (Bayazit 2003, chapter V B, with points 0.5 Å apart).
    Nearest,
    /// Energies between the eight points around, linearly along each axis, as AutoDock does.
    Trilinear,
    /// The same of reciprocal roots of repulsion and attraction, which bend far less beside an atom than energies do.
    #[default]
    Reciprocal,
    /// These reciprocals by splines between the 64 points around.
    Tricubic,
}

impl Default for GridSpec {
    fn default() -> GridSpec {
        GridSpec { lookup: EnergyLookup::default(), spacing: 0.375 }
    }
}

impl GridSpec {
    /// What is wrong with it, if anything: what was found and what is expected.
    pub fn complaint(&self) -> Option<String> {
        let [least, most] = SPACING_RANGE;
        // Written so that NaN fails it.
        let fits = (least..=most).contains(&self.spacing);
        (!fits).then(|| format!("spacing {} found; {least} to {most} Å expected", self.spacing))
    }
}

/// The field of a protein: its exact sum, and a grid of it if the problem has one. The grid's numbers are found when one of them is
/// first asked for, and once for all processes that have a shelf in common.
pub(super) struct Field {
    sum: PairSum,
    /// None where the energy is looked up by exact sums and a grid would have too many numbers.
    grid: Option<Grid>,
    is_exact: bool,
    values: OnceLock<Block>,
    shelf: OnceLock<Arc<dyn Shelf>>,
}

impl Field {
    /// The field within a box, given by its least and largest corner.
    ///
    /// # Errors
    /// The grid would have too many numbers: what was found and what is expected.
    pub fn new(sum: PairSum, corners: [Point; 2], spec: GridSpec) -> Result<Field, String> {
        let lookup = match spec.lookup {
            EnergyLookup::Nearest => Lookup::Nearest,
            EnergyLookup::Trilinear => Lookup::Trilinear,
            EnergyLookup::Reciprocal | EnergyLookup::Exact => Lookup::Reciprocal,
            EnergyLookup::Tricubic => Lookup::Tricubic,
        };
        let is_exact = spec.lookup == EnergyLookup::Exact;
        let grid = Grid::new(&sum, corners, spec.spacing, lookup);
        if grid.is_none() && !is_exact {
            return Err(format!(
                "a grid of more than {VALUES_MAX} numbers found; fewer expected, by a smaller box or a larger spacing"
            ));
        }
        Ok(Field { sum, grid, is_exact, values: OnceLock::new(), shelf: OnceLock::new() })
    }

    /// The exact sum.
    pub fn sum(&self) -> &PairSum {
        &self.sum
    }

    /// The grid and its numbers, if there is one.
    pub fn grid(&self) -> Option<(&Grid, &[f32])> {
        self.grid.as_ref().map(|grid| (grid, self.values(grid)))
    }

    /// Where the grid's numbers are kept, once for all.
    pub fn keep_on(&self, shelf: Arc<dyn Shelf>) {
        // Whoever comes second has a shelf already.
        let _ = self.shelf.set(shelf);
    }

    /// The numbers of the grid.
    fn values(&self, grid: &Grid) -> &[f32] {
        let block = self.values.get_or_init(|| {
            let bytes = grid.values_len() * size_of::<f32>();
            let fill = &mut |out: &mut [u8]| grid.fill(&self.sum, bytemuck::cast_slice_mut(out));
            match self.shelf.get() {
                Some(shelf) => shelf::kept(&**shelf, BlockName::Energies, bytes, fill),
                None => shelf::private(bytes, fill),
            }
        });
        bytemuck::cast_slice(block)
    }

    /// The grid that energies are looked up in.
    #[inline]
    fn looked_up(&self) -> Option<&Grid> {
        self.grid.as_ref().filter(|_| !self.is_exact)
    }

    /// The energy of the ligand's atoms, kJ/mol.
    #[inline]
    pub fn energy(&self, positions: &[Point]) -> f64 {
        match self.looked_up() {
            None => self.sum.energy(positions),
            Some(grid) => grid.energy(self.values(grid), &self.sum, positions),
        }
    }

    /// The energy, and to `out` its gradient by every atom's position, kJ/(mol Å).
    pub fn gradient(&self, positions: &[Point], out: &mut [Point]) -> f64 {
        match self.looked_up() {
            None => self.sum.gradient(positions, out),
            Some(grid) => grid.gradient(self.values(grid), &self.sum, positions, out),
        }
    }
}
