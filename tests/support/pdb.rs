//! Where the structures are, and their residues by the columns of PDB files: a reader of its own, which knows the files
//! that it is asked for.

use roadmill::structure::{AminoAcid, Atom, Point, Residue, ResidueNumber};
use std::path::{Path, PathBuf};

/// Files and their chains of protein.
pub const PROTEINS: &[(&str, &str)] = &[
    ("1A28", "AB"),
    ("1AKE", "A"),
    ("1BDD", "A"),
    ("1CFD", "A"),
    ("1CLL", "A"),
    ("1HVR", "AB"),
    ("1L2Y", "A"),
    ("1MI0", "AB"),
    ("1PGA", "A"),
    ("1PGA_noH", "A"),
    ("1STP", "A"),
    ("1UAO", "A"),
    ("3PTB", "A"),
    ("4AKE", "A"),
    ("4DFR", "AB"),
];

/// Two files, and the first and last residue whose Cα atoms are superposed.
pub const PAIRS: &[(&str, &str, i32, i32)] = &[
    ("1CFD", "1CLL", 4, 147),
    ("1CFD", "1CLL", 65, 92),
    ("4AKE", "1AKE", 1, 214),
    ("1PGA", "1PGA_noH", 1, 56),
];

/// The folder of `ROADMILL_DATA`, or `None`, said aloud.
pub fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("ROADMILL_DATA").map(PathBuf::from);
    if let Some(folder) = folder.filter(|folder| folder.join("structures").is_dir()) {
        return Some(folder);
    }
    let required = std::env::var_os("ROADMILL_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "ROADMILL_DATA names no folder with `structures` in it");
    println!("skipped: ROADMILL_DATA names no folder with `structures` in it");
    None
}

/// The amino acid residues of a chain in the first model. A chain without a name answers to any.
pub fn chain(data: &Path, name: &str, chain: char) -> Vec<Residue> {
    model(data, name, chain, 1)
}

/// The amino acid residues of a chain in the n-th model, n from 1; of alternative positions those called A.
pub fn model(data: &Path, name: &str, chain: char, number: usize) -> Vec<Residue> {
    let path = data.join("structures").join(format!("{name}.pdb"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let model = text.split("\nENDMDL").nth(number - 1).expect("as many models");
    let mut residues: Vec<Residue> = Vec::new();
    for line in model.lines().filter(|line| line.starts_with("ATOM") || line.starts_with("HETATM"))
    {
        let column = |at: usize| line[at..].chars().next().unwrap_or(' ');
        if ![chain, ' '].contains(&column(21)) || !['A', ' '].contains(&column(16)) {
            continue;
        }
        let residue = line[17..20].trim();
        let parent = if residue == "CSO" { "CYS" } else { residue };
        let Some(amino_acid) = AminoAcid::of_code(parent) else { continue };
        let insertion = Some(column(26)).filter(|letter| *letter != ' ');
        let number = line[22..26].trim().parse().expect("a number");
        let number = ResidueNumber { number, insertion };
        if residues.last().is_none_or(|last| last.number != number) {
            let (name, amino_acid) = (residue.to_owned(), Some(amino_acid));
            residues.push(Residue { number, name, amino_acid, atoms: Vec::new() });
        }
        let name = line[12..16].trim().to_owned();
        // Amino acids have elements of one letter only.
        let element = name.chars().find(char::is_ascii_alphabetic).expect("a letter").to_string();
        let [x, y, z] = [30, 38, 46].map(|at| line[at..at + 8].trim().parse().expect("a number"));
        let atoms = &mut residues.last_mut().expect("one was begun").atoms;
        // 1AKE has alternative positions that are not called so.
        if atoms.iter().all(|atom| atom.name != name) {
            atoms.push(Atom { name, element, position: Point::new(x, y, z) });
        }
    }
    residues
}
