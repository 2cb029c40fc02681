//! Commands about structures of proteins, one file each.

mod compare;
mod info;
mod problem;

use crate::cli::ProteinCommand;
use crate::exit::{Code, Failure};
use roadmill::structure::Residue;
use std::collections::BTreeMap;

pub(super) use problem::{announce, name_of, problem_of, spec_of};

/// Does what is to be done with structures of proteins.
pub fn protein(command: &ProteinCommand) -> Result<Code, Failure> {
    match command {
        ProteinCommand::Info(arguments) => info::info(arguments),
        ProteinCommand::Compare(arguments) => compare::compare(arguments),
        ProteinCommand::Problem(arguments) => problem::problem(arguments),
    }
}

/// How many residues there are of each name, all waters under one: `4 CA, 139 water`.
fn names_of<'a>(residues: impl Iterator<Item = &'a Residue>) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for residue in residues {
        let name = if residue.is_water() { "water" } else { residue.name.as_str() };
        *counts.entry(name).or_default() += 1;
    }
    list(counts.iter().map(|(name, count)| format!("{count} {name}")))
}

/// Words with commas between; `none` if there are none.
fn list(words: impl Iterator<Item = String>) -> String {
    let words: Vec<String> = words.collect();
    if words.is_empty() { "none".to_owned() } else { words.join(", ") }
}
