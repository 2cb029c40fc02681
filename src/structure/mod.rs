//! Molecular structures: atoms with positions, residues, chains, and the files that they come from.
//!
//! All lengths are in ångströms (Å), positions in the frame of the file.

mod amino_acid;
pub mod measure;
mod residue;

pub use amino_acid::AminoAcid;
pub use residue::{Atom, Residue, ResidueNumber};

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
    /// What else has the chain's name: ligands, ions, waters.
    pub others: Vec<Residue>,
}

/// One of the models of a structure: NMR files have many.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureModel {
    /// Its number in the file; 1 where the file has none.
    pub number: i32,
    /// Its chains, in the order in which they begin in the file.
    pub chains: Vec<Chain>,
}
