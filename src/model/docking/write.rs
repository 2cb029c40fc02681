//! Docking written out as the table of a problem file.

use super::{Docking, receptor};
use crate::ligand::LigandTable;
use crate::model::Documents;
use crate::source::value;

/// Appends the table. The protein becomes an mmCIF file; the ligand stands in the table, since no format of molecules holds all of
/// it to the last bit.
pub(super) fn write(docking: &Docking, documents: &mut Documents) {
    let Docking { chains, ligand, rigid, amides, bounds, energy, grid, highest, step } = docking;
    let folder = &documents.folder;
    let name = "protein.cif";
    let path = if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
    documents.files.push((name.to_owned(), receptor::file(chains)));
    let [min, max] = bounds;
    // Where there are none, there is nothing to be kept, nor to be said of it when the file is read.
    let has_hydrogens = ligand.atoms().iter().any(|atom| !atom.element.is_heavy())
        || chains.iter().flat_map(|of| &of.residues).flat_map(|of| &of.atoms).any(|atom| !atom.is_heavy());
    let hydrogens = if has_hydrogens { "keep" } else { "remove" };
    documents.text += &format!(
        "\n[docking]\n\
         protein = {{ file = {}, waters = \"keep\", metals = \"keep\", others = \"keep\" }}\n\
         hydrogens = \"{hydrogens}\"\n\
         rigid = {rigid}\n\
         amides = {amides}\n\
         box = {{ min = {min:?}, max = {max:?} }}\n\
         energy = {}\n\
         grid = {}\n\
         highest = {highest:?}\n\
         step = {step:?}\n\
         ligand = {{ table = {} }}\n",
        value(&path),
        value(energy),
        value(grid),
        value(&LigandTable::of(ligand)),
    );
}
