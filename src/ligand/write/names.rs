//! Names of atoms in four columns.

use super::super::{Atom, Element, Ligand};
use std::collections::BTreeMap;

/// A name for every atom, each once, of at most four characters: those of the file if all atoms have one that fits and no
/// two have the same; otherwise the element's symbol with the atom's number among those of its element, as `C12`. Where the number is
/// too long for the columns, a letter and further letters and digits follow the symbol.
pub fn atom_names(ligand: &Ligand) -> Vec<String> {
    let fits = |atom: &Atom| {
        (1..=4).contains(&atom.name.len()) && atom.name.bytes().all(|byte| byte.is_ascii_graphic())
    };
    let mut own: Vec<&str> = ligand.atoms().iter().map(|atom| &*atom.name).collect();
    own.sort_unstable();
    if ligand.atoms().iter().all(fits) && own.windows(2).all(|two| two[0] != two[1]) {
        return ligand.atoms().iter().map(|atom| atom.name.clone()).collect();
    }
    let mut counts: BTreeMap<Element, usize> = BTreeMap::new();
    let mut name = |atom: &Atom| {
        let count = counts.entry(atom.element).or_default();
        *count += 1;
        format!("{}{}", atom.element.symbol().to_ascii_uppercase(), number(*count, atom.element))
    };
    ligand.atoms().iter().map(&mut name).collect()
}

/// What the ligand is called as a residue: its own name where that is one to three letters or digits, and else `UNL`, as the PDB calls
/// unknown ligands.
pub fn residue_name(ligand: &Ligand) -> &str {
    let name = ligand.name();
    let fits = (1..=3).contains(&name.len()) && name.bytes().all(|b| b.is_ascii_alphanumeric());
    if fits { name } else { "UNL" }
}

/// A number from 1 on in the columns beside an element's symbol: three, or two.
fn number(number: usize, element: Element) -> String {
    let columns = 4 - element.symbol().len();
    let decimal = if columns == 3 { 1000 } else { 100 };
    if number < decimal {
        return number.to_string();
    }
    // The first is a letter, so that the text is none of those above. Ligands have at most 1000 atoms, and two columns have
    // room for 26 · 36 numbers more.
    let mut rest = number - decimal;
    let mut text = Vec::new();
    for _ in 1..columns {
        text.push(b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"[rest % 36]);
        rest /= 36;
    }
    text.push(b'A' + (rest % 26) as u8);
    text.iter().rev().map(|byte| char::from(*byte)).collect()
}
