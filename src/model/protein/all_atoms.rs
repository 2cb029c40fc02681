//! All atoms of a protein at a configuration: what the rules and the energy do not know moves rigidly along.

use super::Protein;
use super::chain_in_energy::ChainInEnergy;
use crate::model::{Energies, Model, Molecule};
use crate::structure::Residue;

impl Molecule for Protein {
    fn chains_at(&self, q: &[f64]) -> Vec<Vec<Residue>> {
        let linkage = self.linkage();
        let motions = linkage.motions(q);
        let mut chain = self.source.clone();
        for (index, residue) in chain.iter_mut().enumerate() {
            for atom in &mut residue.atoms {
                let body = linkage.body(index, &atom.name);
                atom.position = motions[body].apply(&atom.position);
            }
        }
        std::iter::once(chain).chain(self.obstacles.clone()).collect()
    }

    fn has_chains_that_stand_still(&self) -> bool {
        self.has_obstacles()
    }

    /// Each set of constraints on its own, the hydrophobic pairs, and the whole, in model kJ/mol.
    fn energies(&self) -> Energies<'_> {
        let model = ChainInEnergy::of(self);
        let count = model.native().map_or(1, |native| model.basins(native).len());
        let sets = match count {
            2 => vec!["energy_source [kJ/mol]", "energy_target [kJ/mol]"],
            _ => vec!["energy_constraints [kJ/mol]"],
        };
        let rest = ["energy_hydrophobic [kJ/mol]", "energy [kJ/mol]"];
        let at = move |q: &[f64]| {
            let mut energies = model.basins(q);
            energies.extend([model.hydrophobic(q), model.energy_at(q)]);
            energies
        };
        Energies { columns: sets.into_iter().chain(rest).collect(), at: Box::new(at) }
    }

    /// In short what `docs/proteins.md` says under *What a result means*.
    fn about_energies(&self) -> &'static str {
        "Energies are in model kJ/mol. They are made of the contacts of the known structures, a Gō-type model: they say which ways \
         between these structures the chain's geometry leaves open, and rank them by what they break. They are no free energies, \
         and no rates follow from them. Bonds do not bend, side chains do not turn, there is no water. Costs are in kT at 298 K, \
         2.479 kJ/mol."
    }
}
