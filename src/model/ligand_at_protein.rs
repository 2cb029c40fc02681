use crate::ligand::Ligand;
use crate::structure::Point;
use std::sync::Arc;

/// The capability of a model of a ligand at a protein that stands still: what its atoms are and where, for methods that place ligands.
///
/// Atoms of the ligand have the numbers that they have in [`LigandAtProtein::ligand`]. Positions are in the frame of the protein's
/// file, Å, energies in kJ/mol.
pub trait LigandAtProtein: Send + Sync {
    /// The ligand, in the pose that it was given with.
    fn ligand(&self) -> &Ligand;

    /// The atoms of the ligand's rigid pieces: first the root's, then one piece for each torsion, in the order of the torsions; of two
    /// pieces on one way from the root the nearer one comes first.
    fn pieces(&self) -> &[Vec<usize>];

    /// The place among a configuration's values of the torsion that turns the piece with this number, which is not the root.
    fn torsion_of(&self, piece: usize) -> usize;

    /// The piece on the side of the root, of the piece with this number, which is not the root.
    fn parent_of(&self, piece: usize) -> usize;

    /// The atom of the root piece that is nearest to the piece's centre, in the pose that the ligand was given with; of several the first.
    fn central_atom(&self) -> usize;

    /// The positions of the ligand's atoms at the configuration `q`.
    fn positions(&self, q: &[f64]) -> Vec<Point>;

    /// In how many steps the straight motion from `a` to `b` is divided so that no atom moves farther than `length` in one, Å.
    fn steps(&self, a: &[f64], b: &[f64], length: f64) -> usize;

    /// The largest distance of two atoms of the ligand in the shape that it was given with.
    fn diameter(&self) -> f64;

    /// The positions of the protein's atoms that count in the energy.
    fn protein(&self) -> &[Point];

    /// Calls `visit` with the position of every atom of the protein that is at most `reach` from a place, and perhaps of some others, each
    /// once, in an order that follows from their positions.
    fn atoms_near(&self, at: &Point, reach: f64, visit: &mut dyn FnMut(&Point));

    /// The protein's residues that are exposed to the solvent.
    fn exposed(&self) -> &[ExposedResidue];

    /// The energy of one atom of the ligand at a place, in the field of the protein, as the nearest point of the grid has it.
    fn atom_energy(&self, atom: usize, at: &Point) -> f64;

    /// The force of the protein on the ligand at `q`, kJ/(mol Å), by the model's own energy: if it is larger than `most`, it is made
    /// as large as that, in its direction (O. B. Bayazit 2003, chapter V C: so that a hand can hold what it feels).
    fn force(&self, q: &[f64], most: f64) -> Point;

    /// The cells of the grid whose energy is low for an atom of the ligand.
    fn low_cells(&self, atom: usize, limits: CellLimits) -> Arc<LowCells>;

    /// The energy at `q` by exact sums over all pairs of atoms, part by part.
    fn exact(&self, q: &[f64]) -> EnergyParts;
}

/// A residue of the protein that is exposed to the solvent.
#[derive(Clone, Debug, PartialEq)]
pub struct ExposedResidue {
    /// Its chain, its name and its number, as `A SER 195`.
    pub name: String,
    /// The positions of its heavy atoms.
    pub atoms: Vec<Point>,
}

/// Which cells of the grid are low, and which are high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellLimits {
    /// Up to this energy a cell is low, kJ/mol.
    pub low: f64,
    /// From this energy on a cell is high, kJ/mol.
    pub high: f64,
}

/// The low cells of a grid: cubes about its points.
#[derive(Clone, Debug, PartialEq)]
pub struct LowCells {
    /// The edge of a cell, Å.
    pub spacing: f64,
    /// The centres of those of which a neighbour, along an axis, is high.
    pub at_boundary: Vec<Point>,
    /// The centres of the others.
    pub inside: Vec<Point>,
}

/// An energy part by part, kJ/mol.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyParts {
    /// 12-6 terms of pairs of the protein's and the ligand's atoms.
    pub van_der_waals: f64,
    /// Coulomb terms of these pairs; 0 if the energy has none.
    pub coulomb: f64,
    /// Hydrophobic terms of these pairs; 0 if the energy has none.
    pub hydrophobic: f64,
    /// The terms of pairs within the ligand; 0 if the energy has none.
    pub own: f64,
}

impl EnergyParts {
    /// Their sum.
    pub fn sum(&self) -> f64 {
        self.van_der_waals + self.coulomb + self.hydrophobic + self.own
    }
}
