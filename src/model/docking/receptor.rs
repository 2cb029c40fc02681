//! What of a structure file is the protein.

use super::spec::{Policy, ReceptorFile, ReceptorSpec, StillChain};
use crate::source::Source;
use crate::structure::{
    Atom, Chain, Point, Residue, StructureError, StructureModel, mmcif, read, read_bytes,
    select_model,
};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Caps of the ends of chains, which are bonded to them.
const CAPS: [&str; 5] = ["ACE", "NME", "NMA", "NH2", "FOR"];

/// Elements of single ions that are no metals.
const NO_METALS: [&str; 20] = [
    "H", "D", "He", "B", "C", "N", "O", "F", "Ne", "Si", "P", "S", "Cl", "Ar", "As", "Se", "Br",
    "Kr", "I", "Xe",
];

/// The chains of the protein that is asked for. `ligand` is the residue that is the ligand, if that stands in the same file.
pub(super) fn receptor(
    spec: &ReceptorSpec,
    hydrogens: Policy,
    ligand: Option<&LigandResidue>,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Vec<StillChain>, StructureError> {
    let mut chains = match spec {
        ReceptorSpec::Chains(chains) => chains.clone(),
        ReceptorSpec::File(file) => in_file(file, ligand, source, notes)?,
    };
    let mut removed = 0;
    for residue in chains.iter_mut().flat_map(|chain| &mut chain.residues) {
        let before = residue.atoms.len();
        residue.atoms.retain(|atom| {
            !atom.element.is_empty() && (hydrogens == Policy::Keep || atom.is_heavy())
        });
        removed += before - residue.atoms.len();
    }
    if removed > 0 {
        notes.push(format!("protein: {removed} hydrogens and atoms of no element left out"));
    }
    if hydrogens == Policy::Keep && removed == 0 && !has_hydrogens(&chains) {
        notes.push("protein: hydrogens are kept, but the protein has none".to_owned());
    }
    for chain in &mut chains {
        chain.residues.retain(|residue| !residue.atoms.is_empty());
    }
    chains.retain(|chain| !chain.residues.is_empty());
    if chains.is_empty() {
        let message =
            "no atoms of a protein found; amino acids, or residues that `keep` names, expected";
        return Err(StructureError::pathless(message.to_owned()));
    }
    written_and_read(&chains)
}

/// The residue of the protein's file that is the ligand.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LigandResidue {
    /// The positions of its heavy atoms, by which it is told, whatever it is called.
    pub atoms: Vec<Point>,
}

fn has_hydrogens(chains: &[StillChain]) -> bool {
    let residues = chains.iter().flat_map(|chain| &chain.residues);
    residues.flat_map(|residue| &residue.atoms).any(|atom| !atom.is_heavy())
}

fn in_file(
    spec: &ReceptorFile,
    ligand: Option<&LigandResidue>,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Vec<StillChain>, StructureError> {
    let path = source.folder.join(&spec.file);
    let structure = read(&path)?;
    source.read(crate::digest::SourceFile {
        path: spec.file.to_string_lossy().into_owned(),
        ..structure.source.clone()
    });
    let model = select_model(&structure, spec.model).map_err(|error| error.in_file(&path))?;
    if structure.models.len() > 1 && spec.model.is_none() {
        let count = structure.models.len();
        notes.push(format!("protein: model {} of {count}, the first", model.number));
    }
    let alternatives = structure.alternatives.iter().filter(|of| of.model == model.number).count();
    if alternatives > 0 {
        notes.push(format!(
            "protein: of {alternatives} residues with alternative locations those of the highest occupancy are taken"
        ));
    }
    let chosen = choose(spec, model).map_err(|error| error.in_file(&path))?;
    let names = names_of(&chosen);
    let mut left_out: BTreeMap<String, usize> = BTreeMap::new();
    let mut chains = Vec::new();
    for (chain, name) in chosen.iter().zip(names) {
        let mut residues = chain.residues.clone();
        for other in &chain.others {
            if is_ligand(other, ligand) {
                continue;
            }
            match stays(other, spec) {
                true => residues.push(other.clone()),
                false => *left_out.entry(other.name.clone()).or_default() += 1,
            }
        }
        chains.push(StillChain { name, residues });
    }
    if !left_out.is_empty() {
        let listed = left_out.iter().map(|(name, count)| format!("{count} {name}"));
        let listed = listed.collect::<Vec<_>>().join(", ");
        notes.push(format!("protein: left out {listed}"));
    }
    let without = ["N", "CA", "C", "O"];
    let is_short = |residue: &&Residue| {
        residue.amino_acid.is_some() && without.iter().any(|name| residue.position(name).is_none())
    };
    let short = chosen.iter().flat_map(|chain| &chain.residues).filter(is_short).count();
    if short > 0 {
        notes.push(format!(
            "protein: {short} residues lack atoms of the backbone; the energy is without what is not there"
        ));
    }
    Ok(chains)
}

/// The chains that are asked for: those that have amino acids, or anything that may stay.
fn choose<'a>(
    spec: &ReceptorFile,
    model: &'a StructureModel,
) -> Result<Vec<&'a Chain>, StructureError> {
    let Some(names) = &spec.chains else { return Ok(model.chains.iter().collect()) };
    let known = || {
        let names: BTreeSet<&str> = model.chains.iter().map(|chain| chain.name.as_str()).collect();
        names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
    };
    if names.is_empty() {
        let message = format!("chains = [] found; names of some of {} expected", known());
        return Err(StructureError::pathless(message));
    }
    for name in names {
        if !model.chains.iter().any(|chain| chain.name == *name) {
            let message = format!("no chain `{name}` found; one of {} expected", known());
            return Err(StructureError::pathless(message));
        }
    }
    Ok(model.chains.iter().filter(|chain| names.contains(&chain.name)).collect())
}

/// Names for chains of a file that is written: letters and digits, each once. Those of the file stay where they are that.
fn names_of(chains: &[&Chain]) -> Vec<String> {
    let is_plain =
        |name: &str| !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric());
    let mut taken: BTreeSet<String> =
        chains.iter().map(|chain| chain.name.clone()).filter(|name| is_plain(name)).collect();
    let mut given = BTreeSet::new();
    let mut number = 0;
    let mut name = |chain: &&Chain| {
        if is_plain(&chain.name) && given.insert(chain.name.clone()) {
            return chain.name.clone();
        }
        loop {
            let letter = char::from(b'A' + (number % 26) as u8);
            let next = match number / 26 {
                0 => letter.to_string(),
                more => format!("{letter}{more}"),
            };
            number += 1;
            if taken.insert(next.clone()) {
                return next;
            }
        }
    };
    chains.iter().map(&mut name).collect()
}

fn is_ligand(residue: &Residue, ligand: Option<&LigandResidue>) -> bool {
    /// So near an atom is the same, Å: files round positions to 0.001 Å, and programs may have moved them a little.
    const SAME: f64 = 0.1;
    ligand.is_some_and(|ligand| {
        let heavy: Vec<&Atom> = residue.atoms.iter().filter(|atom| atom.is_heavy()).collect();
        let is_there =
            |atom: &&&Atom| ligand.atoms.iter().any(|at| (at - atom.position).norm() < SAME);
        let there = heavy.iter().filter(is_there).count();
        there > 1 && 2 * there > heavy.len()
    })
}

/// Whether something that is no amino acid of the chain is a part of the protein.
fn stays(residue: &Residue, spec: &ReceptorFile) -> bool {
    let heavy: Vec<&Atom> = residue.atoms.iter().filter(|atom| atom.is_heavy()).collect();
    let is_metal = heavy.len() == 1 && !NO_METALS.contains(&heavy[0].element.as_str());
    let policy = match residue.is_water() {
        _ if spec.keep.contains(&residue.name) => Policy::Keep,
        _ if CAPS.contains(&residue.name.as_str()) => Policy::Keep,
        true => spec.waters,
        false if is_metal => spec.metals,
        false => spec.others,
    };
    policy == Policy::Keep
}

/// The chains as they are when they have been written as a file and read again, so that a problem that is written out is the same
/// problem when it is read.
pub(super) fn written_and_read(chains: &[StillChain]) -> Result<Vec<StillChain>, StructureError> {
    let structure = read_bytes(Path::new("protein.cif"), file(chains).as_bytes())?;
    let whole = |chain: &Chain| {
        let residues = chain.residues.iter().chain(&chain.others).cloned().collect();
        StillChain { name: chain.name.clone(), residues }
    };
    let read: Vec<StillChain> = structure.models[0].chains.iter().map(whole).collect();
    let mut names = BTreeSet::new();
    if let Some(twice) = read.iter().find(|chain| !names.insert(&chain.name)) {
        let name = &twice.name;
        return Err(StructureError::pathless(format!(
            "chain `{name}`: two residues of one number found; numbers that differ expected"
        )));
    }
    Ok(read)
}

/// The chains as an mmCIF file.
pub(super) fn file(chains: &[StillChain]) -> String {
    let chains: Vec<(&str, &[Residue])> =
        chains.iter().map(|chain| (chain.name.as_str(), chain.residues.as_slice())).collect();
    mmcif("protein", &chains)
}
