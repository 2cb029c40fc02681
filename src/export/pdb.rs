//! A path, or a roadmap's nodes, as the models of a PDB file: for PyMOL, ChimeraX, VMD and what else shows molecules.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use crate::model::Molecule;
use crate::structure::{AminoAcid, Residue};
use std::fmt::Write;

/// The PDB format (wwPDB, *Atomic coordinate entry format*, version 3.3): one model for every configuration of the path that
/// answers the query, in its order; without a path, one for every node in the order of their ids. All atoms of the source
/// structure are there, in Å; those beside the backbone move rigidly along.
///
/// Residues that are none of the twenty amino acids by their names have the record HETATM, and MODRES names what each of them was
/// or is, so that readers that do not know the name keep them in the chain. A residue's name has three columns: where it
/// is longer (NALA, HISE, CYS2), the name of the amino acid is written. Serial numbers begin anew in every model, and TER has
/// the one after its chain's last atom.
pub(super) struct Pdb;

/// The columns hold no more.
const MODELS_MAX: usize = 9_999;
const SERIAL_MAX: usize = 99_999;
const CHAINS_MAX: usize = 26;
const COORDINATES: std::ops::Range<f64> = -999.999..9_999.999;
const NUMBERS: std::ops::RangeInclusive<i32> = -999..=9_999;

impl RoadmapFormat for Pdb {
    fn name(&self) -> &'static str {
        "pdb"
    }

    fn about(&self) -> &'static str {
        "The path's conformations, or all nodes, as models of a PDB file; of molecules only"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let (molecule, configs) = exported.conformations()?;
        Ok(vec![ExportFile::named(pdb(molecule, configs.into_iter())?)])
    }
}

/// Conformations of a molecule as the models of a PDB file, numbered from 1 on, with all atoms of the source structure, in
/// Å.
///
/// # Errors
/// Says what does not fit into the columns of the format.
pub fn pdb<'a>(
    molecule: &dyn Molecule,
    configs: impl ExactSizeIterator<Item = &'a [f64]>,
) -> Result<String, CannotExport> {
    if configs.len() > MODELS_MAX {
        let found = configs.len();
        return Err(CannotExport(format!(
            "{found} models found; at most {MODELS_MAX} fit into a PDB file"
        )));
    }
    text(configs.map(|q| molecule.chains_at(q)))
}

/// A structure as a PDB file with one model, its chains lettered from A on, in Å.
///
/// # Errors
/// Says what does not fit into the columns of the format.
pub fn structure_pdb(chains: Vec<Vec<Residue>>) -> Result<String, CannotExport> {
    text(std::iter::once(chains))
}

/// The text of a file with these models, each a list of chains.
fn text(models: impl Iterator<Item = Vec<Vec<Residue>>>) -> Result<String, CannotExport> {
    let mut out = String::new();
    for (index, chains) in models.enumerate() {
        if index == 0 {
            modified(&chains, &mut out)?;
        }
        writeln!(out, "MODEL     {:>4}", index + 1).expect("writing to memory cannot fail");
        model(&chains, &mut out)?;
        out += "ENDMDL\n";
    }
    out += "END\n";
    Ok(out)
}

/// The chains with their letters.
fn lettered(
    chains: &[Vec<Residue>],
) -> Result<impl Iterator<Item = (char, &Vec<Residue>)>, CannotExport> {
    if chains.len() > CHAINS_MAX {
        let found = chains.len();
        return Err(CannotExport(format!(
            "{found} chains found; at most {CHAINS_MAX} fit into a PDB file"
        )));
    }
    Ok((b'A'..=b'Z').map(char::from).zip(chains))
}

/// The name of a residue in three columns: its own, or that of its amino acid if its own is longer.
fn name_of(residue: &Residue) -> &str {
    match residue.amino_acid {
        Some(amino_acid) if residue.name.len() > 3 => amino_acid.code(),
        _ => &residue.name,
    }
}

/// The amino acid that a residue was before it was modified, or is by another name, by its code; `None` if it has that name.
fn parent_of(residue: &Residue) -> Option<&'static str> {
    residue.amino_acid.map(AminoAcid::code).filter(|code| *code != name_of(residue))
}

/// A record MODRES for every residue that has another name than its amino acid. Its columns for the entry's code are blank.
fn modified(chains: &[Vec<Residue>], out: &mut String) -> Result<(), CannotExport> {
    for (chain, residues) in lettered(chains)? {
        for residue in residues {
            let Some(parent) = parent_of(residue) else { continue };
            let (name, place) = (name_of(residue), place_of(residue)?);
            writeln!(out, "MODRES      {name:>3} {chain} {place} {parent}")
                .expect("writing to memory cannot fail");
        }
    }
    Ok(())
}

/// A residue's number and insertion code in five columns.
fn place_of(residue: &Residue) -> Result<String, CannotExport> {
    let number = residue.number.number;
    if !NUMBERS.contains(&number) {
        return Err(CannotExport(format!(
            "{residue} found; a number of four digits expected in a PDB file"
        )));
    }
    Ok(format!("{number:>4}{}", residue.number.insertion.unwrap_or(' ')))
}

/// The number after this one in five columns.
fn next(serial: &mut usize) -> Result<usize, CannotExport> {
    *serial += 1;
    if *serial > SERIAL_MAX {
        return Err(CannotExport(format!(
            "more atoms and ends of chains than {SERIAL_MAX} found in a model; a PDB file has no number for more"
        )));
    }
    Ok(*serial)
}

/// Writes the atoms of one model, chain by chain, with a `TER` record behind each chain.
///
/// # Errors
/// As [`pdb`].
pub(super) fn model(chains: &[Vec<Residue>], out: &mut String) -> Result<(), CannotExport> {
    let mut serial = 0;
    for (chain, residues) in lettered(chains)? {
        for residue in residues {
            let (residue_name, place) = (name_of(residue), place_of(residue)?);
            let record = if parent_of(residue).is_some() { "HETATM" } else { "ATOM" };
            for atom in &residue.atoms {
                let serial = next(&mut serial)?;
                let [x, y, z] = atom.position.into();
                let fits = residue_name.len() <= 3
                    && atom.name.len() <= 4
                    && atom.element.len() <= 2
                    && [x, y, z].iter().all(|value| COORDINATES.contains(value));
                if !fits {
                    return Err(CannotExport(format!(
                        "{residue} {} does not fit into the columns of a PDB file",
                        atom.name
                    )));
                }
                // Elements of one letter begin in the second column of the name.
                let name = match (atom.element.len(), atom.name.len()) {
                    (1, 1..=3) => format!(" {:<3}", atom.name),
                    _ => format!("{:<4}", atom.name),
                };
                let element = atom.element.to_ascii_uppercase();
                writeln!(
                    out,
                    "{record:<6}{serial:>5} {name} {residue_name:>3} {chain}{place}   {x:>8.3}{y:>8.3}{z:>8.3}  1.00  0.00          {element:>2}",
                )
                .expect("writing to memory cannot fail");
            }
        }
        if let Some(last) = residues.last() {
            let (serial, name, place) = (next(&mut serial)?, name_of(last), place_of(last)?);
            writeln!(out, "TER   {serial:>5}      {name:>3} {chain}{place}")
                .expect("writing to memory cannot fail");
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::{Atom, Point, ResidueNumber, read_bytes};
    use std::path::Path;

    /// A chain of residues of these names, each of the amino acid of this code, 3.8 Å apart.
    fn chain(names: &[(&str, &str)]) -> Vec<Residue> {
        let of = |(index, (name, code)): (usize, &(&str, &str))| {
            let atom = |(name, x, y): (&str, f64, f64)| Atom {
                name: name.to_owned(),
                element: name[..1].to_owned(),
                position: Point::new(3.8 * index as f64 + x, y, 0.0),
            };
            let atoms = [("N", 0.0, 0.0), ("CA", 1.2, 0.8), ("C", 2.5, 0.0), ("O", 2.5, -1.2)];
            Residue {
                number: ResidueNumber { number: index as i32 - 1, insertion: None },
                name: (*name).to_owned(),
                amino_acid: AminoAcid::of_code(code),
                atoms: atoms.map(atom).into(),
            }
        };
        names.iter().enumerate().map(of).collect()
    }

    fn text_of(chains: Vec<Vec<Residue>>) -> Result<String, String> {
        text(std::iter::once(chains)).map_err(|error| error.0)
    }

    /// Names of four letters, modified residues, among them one of which no list knows, and insertion codes.
    #[test]
    fn all_residues_are_amino_acids_of_their_chains_when_read_again() {
        let names = [
            ("NGLY", "GLY"),
            ("HISE", "HIS"),
            ("MSE", "MET"),
            ("XQZ", "TRP"),
            ("HSD", "HIS"),
            ("A1ABC", "LYS"),
            ("ALA", "ALA"),
        ];
        let mut first = chain(&names);
        first[5].number = ResidueNumber { number: 3, insertion: Some('A') };
        let mut second = chain(&[("SER", "SER"), ("CYS2", "CYS")]);
        let atoms = second.iter_mut().flat_map(|residue| &mut residue.atoms);
        atoms.for_each(|atom| atom.position.y += 20.0);
        let text = text_of(vec![first, second]).unwrap();
        let read = read_bytes(Path::new("x.pdb"), text.as_bytes()).unwrap();
        let chains = &read.models[0].chains;
        let sequences: Vec<String> = chains.iter().map(|chain| chain.sequence()).collect();
        assert_eq!(sequences, ["GHMWHKA", "SC"], "{text}");
        assert!(chains.iter().all(|chain| chain.others.is_empty()), "{text}");
        let written: Vec<&str> = chains[0].residues.iter().map(|of| of.name.as_str()).collect();
        assert_eq!(written, ["GLY", "HIS", "MSE", "XQZ", "HSD", "LYS", "ALA"]);
        assert_eq!(chains[0].residues[5].to_string(), "LYS 3A");

        let lines: Vec<&str> = text.lines().collect();
        // Columns by the wwPDB's description: MODRES 13-15, 17, 19-22, 25-27; TER 7-11, 18-20, 22, 23-26.
        assert_eq!(lines[0], "MODRES      MSE A    1  MET");
        assert_eq!(lines[1], "MODRES      XQZ A    2  TRP");
        assert_eq!(lines[3], "MODEL        1");
        assert_eq!(
            lines[4],
            "ATOM      1  N   GLY A  -1       0.000   0.000   0.000  1.00  0.00           N"
        );
        assert!(lines[12].starts_with("HETATM    9  N   MSE A   1 "), "{text}");
        let ends: Vec<&&str> = lines.iter().filter(|line| line.starts_with("TER")).collect();
        assert_eq!(ends, [&"TER      29      ALA A   5 ", &"TER      38      CYS B   0 "]);
        assert!(text.contains("ATOM     30  N   SER B  -1 "), "{text}");
    }

    #[test]
    fn what_has_no_columns_is_refused() {
        let chain_of = |change: fn(&mut Residue)| {
            let mut chain = chain(&[("ALA", "ALA"), ("GLY", "GLY")]);
            change(&mut chain[1]);
            vec![chain]
        };
        for (change, expected) in [
            ((|of| of.number.number = 10_000) as fn(&mut Residue), "GLY 10000 found; a number"),
            (|of| (of.name, of.amino_acid) = ("LONG".to_owned(), None), "LONG 0 N does not fit"),
            (|of| of.atoms[2].name = "HD111".to_owned(), "GLY 0 HD111 does not fit"),
            (|of| of.atoms[2].position.x = f64::NAN, "GLY 0 C does not fit"),
            (|of| of.atoms[2].position.y = -1000.0, "GLY 0 C does not fit"),
        ] {
            let error = text_of(chain_of(change)).unwrap_err();
            assert!(error.starts_with(expected), "{error}");
        }
        let error = text_of(vec![Vec::new(); 27]).unwrap_err();
        assert!(error.starts_with("27 chains found"), "{error}");
        // The number of the last TER, too, has five digits at most.
        let many = |atoms: usize| {
            let mut residue = chain(&[("GLY", "GLY")]).remove(0);
            residue.atoms = vec![residue.atoms[0].clone(); atoms];
            vec![vec![residue]]
        };
        assert!(text_of(many(SERIAL_MAX - 1)).unwrap().contains("\nTER   99999      GLY A  -1 \n"));
        assert!(text_of(many(SERIAL_MAX)).unwrap_err().starts_with("more atoms"), "one more");
    }
}
