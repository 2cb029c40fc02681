//! Molecular structures: atoms with positions, residues, chains, and the files that they come from.
//!
//! [`read()`] reads a PDB or mmCIF file; [`select_chain`] takes a chain of it, or a part of one; [`backbone::check`] says
//! whether the chain is whole; [`comparison::compare`] says how two conformations of one protein differ.
//! `docs/structures.md` says what is read and what is decided where files leave it open.
//!
//! All lengths are in ångströms (Å), angles in radians, positions in the frame of the file.

mod alignment;
mod amino_acid;
pub mod backbone;
pub mod comparison;
pub mod disulphides;
mod error;
pub mod matching;
pub mod measure;
mod mmcif;
pub mod peptides;
mod read;
mod residue;
mod selection;
#[cfg(test)]
mod tests;
mod torsion;

pub use amino_acid::AminoAcid;
pub use error::StructureError;
pub use mmcif::mmcif;
pub use read::{COORDINATE_MAX, read, read_bytes};
pub use residue::{Atom, Residue, ResidueNumber, is_water};
pub use selection::{ChainSelection, find_chain, parse_range, select_chain, select_model};
pub use torsion::torsion;

use crate::digest::SourceFile;
use std::fmt;

/// A position or a direction, in Å.
pub type Point = nalgebra::Vector3<f64>;

/// A chain: residues that peptide bonds join, or that were one before parts of it went unseen, and what else the file
/// counts as the chain's.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Its name in the file; empty where the file leaves it blank.
    pub name: String,
    /// The amino acid residues of the polymer, in their order along it.
    pub residues: Vec<Residue>,
    /// What else has the chain's name: ligands, ions, waters, caps of the ends, nucleotides.
    pub others: Vec<Residue>,
}

impl Chain {
    /// The sequence in codes of one letter, modified residues as what they were.
    pub fn sequence(&self) -> String {
        let letter = |residue: &Residue| residue.amino_acid.map_or('X', AminoAcid::letter);
        self.residues.iter().map(letter).collect()
    }
}

/// One of the models of a structure: NMR files have many.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureModel {
    /// Its number in the file; 1 where the file has none.
    pub number: i32,
    /// Its chains, in the order in which they begin in the file.
    pub chains: Vec<Chain>,
}

/// A structure file.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// The format that it has by its content.
    pub format: StructureFormat,
    /// Its models, at least one.
    pub models: Vec<StructureModel>,
    /// How much the file has of each model, before anything is chosen or left out.
    pub counts: Vec<ModelCounts>,
    /// The residues that have alternative locations, and what was chosen.
    pub alternatives: Vec<Alternative>,
    /// What was passed over, for people to read.
    pub notes: Vec<String>,
    /// The file and the digest of its bytes.
    pub source: SourceFile,
}

/// The format of a structure file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StructureFormat {
    /// Lines with columns: the PDB format.
    Pdb,
    /// PDBx/mmCIF.
    Mmcif,
}

impl fmt::Display for StructureFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            StructureFormat::Pdb => "PDB",
            StructureFormat::Mmcif => "mmCIF",
        })
    }
}

/// How much a file has of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ModelCounts {
    /// Atoms, each alternative location counted.
    pub atoms: usize,
    /// Residues, molecules of water and single ions included; those that share a number are counted by their names.
    pub residues: usize,
}

/// A residue whose atoms have alternative locations.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// The number of the model.
    pub model: i32,
    /// The name of the chain.
    pub chain: String,
    /// The number of the residue.
    pub number: ResidueNumber,
    /// Its name as chosen.
    pub name: String,
    /// The letters in the order of the alphabet, each with the sum of its atoms' occupancies.
    pub letters: Vec<(char, f64)>,
    /// The letter whose atoms are the residue's.
    pub chosen: char,
}
