//! Names of a ligand and of its atoms for formats in which every atom has one.

use super::Ligand;
use std::collections::BTreeSet;

/// A name for each atom, in their order, each once, of at most four letters where there are few enough atoms: the file's own where it is one
/// and no other atom has it, else the element's symbol in capitals and a number.
pub fn atom_names(ligand: &Ligand) -> Vec<String> {
    let is_name = |name: &str| {
        (1..=4).contains(&name.len()) && name.bytes().all(|byte| byte.is_ascii_graphic())
    };
    let mut taken = BTreeSet::new();
    let given: Vec<Option<String>> = ligand
        .atoms()
        .iter()
        .map(|atom| {
            let is_free = is_name(&atom.name) && taken.insert(atom.name.clone());
            is_free.then(|| atom.name.clone())
        })
        .collect();
    let mut numbers = std::collections::BTreeMap::new();
    let mut made = |symbol: &'static str| {
        let number = numbers.entry(symbol).or_insert(0usize);
        loop {
            *number += 1;
            let name = format!("{}{number}", symbol.to_ascii_uppercase());
            if taken.insert(name.clone()) {
                return name;
            }
        }
    };
    let name = |(atom, given): (&super::Atom, Option<String>)| {
        given.unwrap_or_else(|| made(atom.element.symbol()))
    };
    ligand.atoms().iter().zip(given).map(name).collect()
}

/// A residue name of three letters or digits: the ligand's own where that is one, else `LIG`.
pub fn residue_name(ligand: &Ligand) -> String {
    let name = ligand.name();
    let is_name = (1..=3).contains(&name.len())
        && name.bytes().all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit());
    if is_name { name.to_owned() } else { "LIG".to_owned() }
}
