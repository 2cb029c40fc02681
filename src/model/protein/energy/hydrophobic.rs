//! The hydrophobic effect: side chains that shun water gain by being close.
//!
//! −20 kJ/mol per pair of side chains of A V I L M F W C P Y whose centroids are less than 6 Å apart, |i − j| ≥ 2. The papers
//! name such a term without its form, so the form is our own choice.

use crate::model::protein::atoms::ResidueAtoms;
use crate::model::protein::placed::Placed;

/// Closer than this, Å, two side chains are a pair.
pub(super) const REACH: f64 = 6.0;
/// What a pair gains, kJ/mol.
const GAIN: f64 = -20.0;

/// The hydrophobic side chains of a chain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hydrophobic {
    residues: Vec<u32>,
}

impl Hydrophobic {
    /// Of a chain.
    pub fn of(atoms: &[ResidueAtoms]) -> Hydrophobic {
        let counts = |atoms: &ResidueAtoms| atoms.is_hydrophobic && atoms.centroid.is_some();
        let residues = (0..).zip(atoms).filter(|(_, atoms)| counts(atoms));
        Hydrophobic { residues: residues.map(|(residue, _)| residue).collect() }
    }

    /// How many pairs there are.
    pub fn pairs(&self, placed: &Placed) -> usize {
        let centroids = &placed.centroid;
        let mut count = 0;
        for (number, i) in self.residues.iter().enumerate() {
            let a = centroids.at(*i as usize);
            for j in self.residues[number + 1..].iter().filter(|j| **j - i >= 2) {
                let b = centroids.at(*j as usize);
                let (x, y, z) = (a.x - b.x, a.y - b.y, a.z - b.z);
                count += usize::from(x * x + y * y + z * z < REACH * REACH);
            }
        }
        count
    }

    /// The energy, model kJ/mol.
    pub fn energy(&self, placed: &Placed) -> f64 {
        GAIN * self.pairs(placed) as f64
    }
}
