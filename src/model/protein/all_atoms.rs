//! All atoms of a protein at a configuration: what the rules and the energy do not know moves rigidly along.

use super::Protein;
use crate::model::Molecule;
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
}
