//! A protein written out as the table of a problem file.

use super::motion::EnergySteps;
use super::{Gaps, Protein};
use crate::model::Documents;
use crate::source::value;
use crate::structure::{Residue, mmcif};

/// Appends the table. The structures become mmCIF files: the source with the obstacles as chains of their own, and the target.
pub(super) fn write(protein: &Protein, documents: &mut Documents) {
    let Protein { source: _, target, gaps, obstacles, rules, energy, highest, step } = protein;
    let folder = documents.folder.clone();
    let file =
        |name: &str| if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
    let (source_text, names) = source_file(protein);
    documents.files.push(("source.cif".to_owned(), source_text));

    let mut text = format!(
        "\n[protein]\nsource = {{ file = {}, chain = {} }}\n",
        value(&file("source.cif")),
        value(&names[0])
    );
    if let Some(target) = target {
        documents.files.push(("target.cif".to_owned(), target_file(&target.residues)));
        text += &format!("target = {{ file = {}, chain = \"A\" }}\n", value(&file("target.cif")));
    }
    if *gaps != Gaps::Error {
        text += &format!("gaps = {}\n", value(gaps));
    }
    if !obstacles.is_empty() {
        text += &format!("obstacles = {}\n", value(&names[1..]));
    }
    text += &format!("rules = {}\nenergy = {}\n", value(rules), value(energy));
    text += &highest.map_or_else(String::new, |highest| format!("highest = {highest:?}\n"));
    text += &match step {
        EnergySteps::Length(length) => format!("step = {length:?}\n"),
        EnergySteps::Turn(turn) => format!("turn = {turn:?}\n"),
    };
    documents.text += &text;
}

/// The file of the source, with the obstacles as chains of their own, and the names of the chains.
pub(super) fn source_file(protein: &Protein) -> (String, Vec<String>) {
    let names: Vec<String> = (0..=protein.obstacles.len()).map(chain_name).collect();
    let residues = std::iter::once(&protein.source).chain(&protein.obstacles);
    let chains: Vec<(&str, &[Residue])> =
        names.iter().zip(residues).map(|(name, chain)| (&name[..], &chain[..])).collect();
    let text = mmcif("source", &chains);
    (text, names)
}

/// The file of the target.
pub(super) fn target_file(residues: &[Residue]) -> String {
    mmcif("target", &[("A", residues)])
}

/// The name of a chain in a file: `A` to `Z`, then `A1` and so on.
fn chain_name(index: usize) -> String {
    let letter = char::from(b'A' + (index % 26) as u8);
    if index < 26 { letter.to_string() } else { format!("{letter}{}", index / 26) }
}
