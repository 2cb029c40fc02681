//! What makes a description of docking sound, whether it comes from a file or from bytes.

use super::ligand_in_energy::LigandInEnergy;
use super::receptor::written_and_read;
use super::{Docking, StillChain};
use crate::scene::LENGTH_MAX;
use crate::structure::COORDINATE_MAX;
use std::collections::BTreeSet;

/// The most atoms of a protein.
const ATOMS_MAX: usize = 200_000;
/// The range of the step of motions, Å.
const STEP_RANGE: [f64; 2] = [1e-3, 10.0];
/// The largest size of the highest valid energy, kJ/mol.
const HIGHEST_MAX: f64 = 1e9;

impl Docking {
    /// What is wrong with the description, if anything: the key of the table by which a problem file says it, what was found and
    /// what is expected.
    pub(super) fn complaint(&self) -> Option<(&'static str, String)> {
        let Docking { chains, ligand, bounds, energy, grid, highest, step, .. } = self;
        if let Some(message) = complaint_of_chains(chains) {
            return Some(("protein", message));
        }
        if ligand.positions().is_none() {
            let message = "no positions found; a molecule with positions in space expected";
            return Some(("ligand", message.to_owned()));
        }
        // What is the same molecule when it is written and read, has neither line nor source of bonds.
        if *ligand != ligand.clone().detached() {
            return Some((
                "ligand",
                "a line of a file found; a molecule alone expected".to_owned(),
            ));
        }
        let [min, max] = bounds;
        for axis in 0..3 {
            let (low, high) = (min[axis], max[axis]);
            // Written so that NaN fails it.
            let fits = low.abs() <= LENGTH_MAX && high.abs() <= LENGTH_MAX && low < high;
            if !fits {
                let name = ["x", "y", "z"][axis];
                let message = format!(
                    "{low} to {high} in {name} found; a least value below the largest, both within ±{LENGTH_MAX:e}, expected"
                );
                return Some(("box", message));
            }
        }
        if let Some((key, message)) = energy.complaint() {
            return Some(("energy", format!("{key} {message}")));
        }
        if let Some(message) = grid.complaint() {
            return Some(("grid", message));
        }
        // Written so that NaN fails it.
        let fits = highest.abs() <= HIGHEST_MAX;
        if !fits {
            let message = format!("{highest} found; an energy within ±{HIGHEST_MAX:e} expected");
            return Some(("highest", message));
        }
        let [least, most] = STEP_RANGE;
        if !(least..=most).contains(step) {
            return Some(("step", format!("{step} found; {least} to {most} Å expected")));
        }
        LigandInEnergy::of(self).err().map(|message| ("grid", message))
    }
}

/// What is wrong with the protein, if anything.
fn complaint_of_chains(chains: &[StillChain]) -> Option<String> {
    let mut names = BTreeSet::new();
    for chain in chains {
        let is_plain = !chain.name.is_empty()
            && chain.name.len() <= 100
            && chain.name.bytes().all(|byte| byte.is_ascii_alphanumeric());
        if !is_plain || !names.insert(&chain.name) {
            return Some(format!(
                "chain `{}` found; names of letters and digits, each once, expected",
                crate::internal::plain::plain(&chain.name)
            ));
        }
    }
    let atoms =
        || chains.iter().flat_map(|chain| &chain.residues).flat_map(|residue| &residue.atoms);
    let count = atoms().count();
    if !(1..=ATOMS_MAX).contains(&count) {
        return Some(format!("{count} atoms found; 1 to {ATOMS_MAX} expected"));
    }
    let is_far = |value: &f64| value.abs() > COORDINATE_MAX || value.is_nan();
    if let Some(atom) = atoms().find(|atom| atom.position.iter().any(is_far)) {
        let name = crate::internal::plain::plain(&atom.name);
        return Some(format!(
            "atom {name} at {:?} found; coordinates of at most {COORDINATE_MAX} Å expected",
            <[f64; 3]>::from(atom.position)
        ));
    }
    if let Some(atom) =
        atoms().find(|atom| crate::ligand::Element::of_symbol(&atom.element).is_none())
    {
        let element = crate::internal::plain::plain(&atom.element);
        return Some(format!("element `{element}` found; a symbol such as C expected"));
    }
    match written_and_read(chains) {
        Err(error) => Some(error.to_string()),
        Ok(read) if read != chains => Some(
            "residues found that would be others once they were written and read again; those of a \
             structure file expected"
                .to_owned(),
        ),
        Ok(_) => None,
    }
}
