//! The energy of a ligand at a protein: sums over pairs of atoms, and grids that stand for them.
//!
//! U = Σ (A/r¹² − B/r⁶) over the pairs of an atom of the protein and one of the ligand (O. B. Bayazit 2003, equation 5.2),
//! and, if asked for, Coulomb and hydrophobic terms. [`PairSum`] is the exact sum, [`OwnTerms`] the ligand's own atoms
//! among themselves, [`Grid`] the protein's part looked up in a grid. `docs/ligand-energy.md` has the formulas, the
//! numbers and where they come from. Energies are in kJ/mol, lengths in Å, charges in elementary charges, positions in the
//! frame of the protein.

mod cells;
mod grid;
mod ligand;
mod own;
mod parameters;
mod particle;
mod protein;
mod spec;
mod sum;
mod switch;
mod terms;
#[cfg(test)]
mod tests;

pub use grid::{Grid, Lookup, SPACING_RANGE, VALUES_MAX, capped};
pub use ligand::ligand_particles;
pub use own::OwnTerms;
pub use parameters::{KCAL, PairCoefficients, VanDerWaals, hydrophobic_radius};
pub use particle::Particle;
pub use protein::{UnknownElement, protein_particles};
pub use spec::{CUTOFF_MAX, CUTOFF_MIN, EnergySpec, Own, ParameterSet, SWITCH_WIDTH};
pub use sum::{AtomKind, PairSum, Parts};
pub use terms::{COULOMB, HYDROPHOBIC_DEPTH, HYDROPHOBIC_FAR, HYDROPHOBIC_NEAR};
