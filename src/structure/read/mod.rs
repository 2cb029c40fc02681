//! Reading structure files.

mod alternatives;
mod assemble;
mod cif;
mod elements;
mod mmcif;
mod names;
mod overlaps;
mod pdb;
mod site;
#[cfg(test)]
mod tests;

pub use site::COORDINATE_MAX;

use super::{Structure, StructureError, StructureFormat};
use crate::digest::SourceFile;
use crate::source::{NoText, read_file, text_of};
use std::path::Path;

/// What can be read, for errors.
const EXPECTED: &str = "a structure in the PDB or mmCIF format expected";

/// Reads a structure file, PDB or mmCIF by its content, whatever its name.
///
/// `docs/structures.md` says what is taken, passed over and decided.
///
/// # Errors
/// What is wrong, with file and line, naming residue and atom: a file that is neither, numbers that are none, lines that
/// are cut off, heavy atoms of amino acids less than 0.5 Å apart, more than 500 000 atoms.
pub fn read(path: impl AsRef<Path>) -> Result<Structure, StructureError> {
    let path = path.as_ref();
    let bytes = read_file(path).map_err(|error| {
        StructureError::file(path, format!("cannot read the structure: {error}"))
    })?;
    read_bytes(path, &bytes).map_err(|error| error.in_file(path))
}

/// Reads the bytes of a structure file; `path` is only its name.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8]) -> Result<Structure, StructureError> {
    if let Some(kind) = packed(bytes) {
        let message = format!("data packed by {kind} found; {EXPECTED}: unpack it first");
        return Err(StructureError::pathless(message));
    }
    let text = text_of(bytes).map_err(|NoText { line, found }| {
        StructureError::line(line, format!("{found}; {EXPECTED}"))
    })?;
    let format = format_of(&text)?;
    let (mut raw, parents, notes) = match format {
        StructureFormat::Pdb => {
            let pdb = pdb::read(&text)?;
            (pdb.models, pdb.parents, pdb.notes)
        }
        StructureFormat::Mmcif => {
            let mmcif = mmcif::read(&text)?;
            (mmcif.models, mmcif.parents, mmcif.notes)
        }
    };
    if raw.is_empty() {
        return Err(StructureError::pathless(format!("no atoms found; {EXPECTED}")));
    }
    let mut structure = Structure {
        format,
        models: Vec::with_capacity(raw.len()),
        counts: Vec::with_capacity(raw.len()),
        alternatives: Vec::new(),
        notes,
        source: SourceFile::named(path, bytes),
    };
    for model in &mut raw {
        let assembled = assemble::assemble(model, &parents)?;
        structure.models.push(assembled.model);
        structure.counts.push(assembled.counts);
        structure.alternatives.extend(assembled.alternatives);
        if assembled.repeated > 0 {
            structure.notes.push(format!(
                "model {}: {} atoms of amino acids stand there twice and are taken once",
                model.number, assembled.repeated
            ));
        }
    }
    Ok(structure)
}

/// The program that packed the bytes, if they begin as those of one do.
fn packed(bytes: &[u8]) -> Option<&'static str> {
    [(&b"\x1f\x8b"[..], "gzip"), (b"BZh", "bzip2"), (b"\xfd7zXZ", "xz"), (b"PK\x03\x04", "zip")]
        .into_iter()
        .find_map(|(begin, kind)| bytes.starts_with(begin).then_some(kind))
}

/// The format of a text by its content.
fn format_of(text: &str) -> Result<StructureFormat, StructureError> {
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    let significant = |line: &str| !line.trim().is_empty() && !line.starts_with('#');
    let Some((number, first)) = lines.find(|(_, line)| significant(line)) else {
        return Err(StructureError::pathless(format!("nothing found; {EXPECTED}")));
    };
    let begin = first.trim_start();
    if begin.get(..5).is_some_and(|word| word.eq_ignore_ascii_case("data_")) {
        return Ok(StructureFormat::Mmcif);
    }
    let other = match begin.as_bytes()[0] {
        b'<' => Some("a page of HTML or XML"),
        b'{' | b'[' => Some("JSON"),
        _ => None,
    };
    if let Some(other) = other {
        return Err(StructureError::line(number, format!("{other} found; {EXPECTED}")));
    }
    let torsions =
        |line: &str| ["ROOT", "BRANCH", "TORSDOF"].contains(&line.split(' ').next().unwrap_or(""));
    if let Some((index, _)) = text.lines().enumerate().find(|(_, line)| torsions(line)) {
        let message = format!("a ligand in the PDBQT format found; {EXPECTED}");
        return Err(StructureError::line(index + 1, message));
    }
    Ok(StructureFormat::Pdb)
}
