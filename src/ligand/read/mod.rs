//! Reading files of small molecules.

mod mol2;
mod pdb;
mod pdbqt;
mod sdf;
mod smiles;

pub use pdb::Group;
pub use smiles::from_smiles;

use super::error::{LigandError, LigandFault, syntax};
use super::{Atom, Bond, BondSource, Ligand, check};
use crate::source::{NoText, read_file, text_of};
use crate::structure::Point;
use std::borrow::Cow;
use std::path::Path;

/// The most molecules of a file.
const MOLECULES_MAX: usize = 100_000;

/// Reads the one small molecule of a file: SDF (V2000 or V3000), MOL2, PDBQT, or a PDB file with one group of HETATM
/// records of more than one atom, waters excepted. The content tells the format, whatever the file's name.
///
/// # Errors
/// What is wrong, with the file, and the line where it is known; several molecules: how many, and how one is chosen.
pub fn read(path: impl AsRef<Path>) -> Result<Ligand, LigandError> {
    with_bytes(path.as_ref(), |bytes| {
        let (format, mut ligands) = all(bytes)?;
        if ligands.len() == 1 {
            return Ok(ligands.remove(0));
        }
        let choose = match format {
            Format::Pdb => "choose it by residue name, chain, number and insertion code",
            _ => "read all of them, or write one into a file of its own",
        };
        let names = ligands.iter().map(|ligand| {
            let name = if ligand.name.is_empty() { "without a name" } else { &ligand.name };
            format!("{name} at line {}", ligand.line.unwrap_or(1))
        });
        let names = names.collect();
        Err(LigandError::pathless(LigandFault::Several { count: ligands.len(), names, choose }))
    })
}

/// Reads every small molecule of a file, in its order, each with its name and the line at which it begins. Formats are
/// those of [`read`]; of a PDB file, every group of HETATM records of more than one atom, waters excepted.
///
/// # Errors
/// As [`read`], several molecules excepted; one that is wrong is an error of the whole file.
pub fn read_all(path: impl AsRef<Path>) -> Result<Vec<Ligand>, LigandError> {
    with_bytes(path.as_ref(), read_bytes)
}

/// Reads a group of HETATM records of a PDB file's first model, by its residue name and, where several groups have that,
/// by chain, residue number and insertion code. Bonds are those of CONECT records where they join all atoms of the group; otherwise
/// they are perceived from distances.
///
/// # Errors
/// As [`read`]; a group that is not there, or that several are called alike.
pub fn read_group(path: impl AsRef<Path>, group: &Group) -> Result<Ligand, LigandError> {
    with_bytes(path.as_ref(), |bytes| {
        let text = text(bytes)?;
        if format_of(&text)? != Format::Pdb {
            let fault = syntax("a file in another format", "a PDB file, as a group is named,");
            return Err(LigandError::pathless(fault));
        }
        pdb::group(&text, group)
    })
}

/// Reads every small molecule of a file's bytes, as [`read_all`] does.
///
/// # Errors
/// As [`read_all`], without the file.
pub fn read_bytes(bytes: &[u8]) -> Result<Vec<Ligand>, LigandError> {
    all(bytes).map(|(_, ligands)| ligands)
}

fn with_bytes<T>(
    path: &Path,
    read: impl FnOnce(&[u8]) -> Result<T, LigandError>,
) -> Result<T, LigandError> {
    let bytes = read_file(path)
        .map_err(|error| LigandError::pathless(LigandFault::Unreadable(error.to_string())));
    bytes.and_then(|bytes| read(&bytes)).map_err(|error| error.in_file(path))
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Sdf,
    Mol2,
    Pdbqt,
    Pdb,
}

fn all(bytes: &[u8]) -> Result<(Format, Vec<Ligand>), LigandError> {
    let text = text(bytes)?;
    let format = format_of(&text)?;
    let ligands = match format {
        Format::Sdf => sdf::read(&text)?,
        Format::Mol2 => mol2::read(&text)?,
        Format::Pdbqt => pdbqt::read(&text)?,
        Format::Pdb => pdb::all(&text)?,
    };
    if ligands.is_empty() {
        return Err(LigandError::pathless(LigandFault::Empty));
    }
    Ok((format, ligands))
}

/// The bytes as text: UTF-8, as all four formats are ASCII but for names and comments.
fn text(bytes: &[u8]) -> Result<Cow<'_, str>, LigandError> {
    let packed = [
        (&b"\x1f\x8b"[..], "gzip"),
        (b"BZh", "bzip2"),
        (b"\xfd7zXZ", "xz"),
        (b"PK\x03\x04", "zip"),
    ];
    if let Some((_, kind)) = packed.iter().find(|(begin, _)| bytes.starts_with(begin)) {
        let found = format!("data packed by {kind}");
        return Err(LigandError::pathless(LigandFault::NotText(found)));
    }
    if let Err(error) = std::str::from_utf8(bytes) {
        let before = &bytes[..error.valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        let found = format!("byte {} of the file, which is not UTF-8,", before.len() + 1);
        return Err(LigandError::at(line, LigandFault::NotText(found)));
    }
    let text = text_of(bytes).map_err(|NoText { line, found }| {
        let found = found.strip_suffix(" found").unwrap_or(&found).to_owned();
        LigandError::at(line, LigandFault::NotText(found))
    })?;
    if text.trim().is_empty() {
        return Err(LigandError::pathless(LigandFault::Empty));
    }
    Ok(text)
}

/// The format of a text by its content.
fn format_of(text: &str) -> Result<Format, LigandError> {
    let is_counts = |line: &str| line.contains("V2000") || line.contains("V3000");
    let fourth = text.lines().nth(3).unwrap_or("");
    // Counts begin with their three columns; a record of a PDB file or a comment begins with neither blank nor digit.
    if fourth.starts_with(|c: char| c == ' ' || c.is_ascii_digit()) && is_counts(fourth) {
        return Ok(Format::Sdf);
    }
    if text.lines().any(|line| line.starts_with("@<TRIPOS>")) {
        return Ok(Format::Mol2);
    }
    // Old files and some programs leave the version out, or a line of the header. Data items may look like any format.
    if text.lines().any(|line| line.starts_with("M  END")) {
        return Ok(Format::Sdf);
    }
    let begins = |words: &[&str]| {
        text.lines().any(|line| words.contains(&line.split_whitespace().next().unwrap_or("")))
    };
    if begins(&["ROOT", "BRANCH", "TORSDOF"]) {
        return Ok(Format::Pdbqt);
    }
    let is_atom = |line: &str| line.starts_with("ATOM  ") || line.starts_with("HETATM");
    // An mmCIF file's atoms begin with the same words.
    let is_mmcif = text.trim_start().starts_with("data_");
    if !is_mmcif && text.lines().any(is_atom) {
        return Ok(Format::Pdb);
    }
    let has_end = text.lines().any(|line| line.starts_with("$$$$"));
    if has_end || text.lines().take(6).any(is_counts) {
        return Ok(Format::Sdf);
    }
    let found = match text.trim_start().as_bytes() {
        [b'<', ..] => "a page of HTML or XML",
        [b'{' | b'[', ..] => "JSON",
        _ if is_mmcif => "an mmCIF file",
        _ => "text in another format",
    };
    Err(LigandError::pathless(LigandFault::UnknownFormat(found.to_owned())))
}

/// A ligand that begins at a line. What is wrong with it as a whole is said of that line.
fn ligand(
    name: &str,
    line: usize,
    atoms: Vec<Atom>,
    bonds: Vec<Bond>,
    bond_source: BondSource,
) -> Result<Ligand, LigandError> {
    check::check(&atoms, &bonds).map_err(|fault| LigandError::at(line, fault))?;
    Ok(Ligand { name: name.trim().to_owned(), line: Some(line), atoms, bonds, bond_source })
}

/// That one more molecule is not one too many.
fn expect_molecule(so_far: usize, line: usize) -> Result<(), LigandError> {
    let (found, most) = (so_far + 1, MOLECULES_MAX);
    match found > most {
        true => Err(LigandError::at(line, LigandFault::TooMany { found, what: "molecules", most })),
        false => Ok(()),
    }
}

/// A finite number from its text; `what` says which.
fn number(text: &str, what: &str) -> Result<f64, LigandFault> {
    let text = text.trim();
    text.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| {
        LigandFault::BadNumber {
            found: format!("`{text}`"),
            expected: format!("{what}, a finite number,"),
        }
    })
}

/// A position in Å from the texts of its coordinates.
fn position(texts: [&str; 3]) -> Result<Point, LigandFault> {
    let mut position = Point::zeros();
    for (axis, text) in texts.into_iter().enumerate() {
        position[axis] = number(text, ["x", "y", "z"][axis])?;
        check::check_coordinate(position[axis])?;
    }
    Ok(position)
}

/// That a line whose fields are told by their columns is ASCII: one character of several bytes would shift all behind it.
fn expect_ascii(line: &str) -> Result<(), LigandFault> {
    match line.chars().find(|c| !c.is_ascii()) {
        Some(c) => {
            let found = format!("a line of an atom or a bond with `{c}`");
            Err(syntax(found, "columns of ASCII"))
        }
        None => Ok(()),
    }
}

/// The columns of a line from `start` to before `end`, counted from 0, as far as the line goes. Where a character
/// of more than one byte is in the way there is no telling columns, and nothing is found.
fn columns(line: &str, start: usize, end: usize) -> &str {
    let end = end.min(line.len());
    line.get(start.min(end)..end).unwrap_or("\u{fffd}")
}
