//! Small molecules that bind to proteins: atoms, bonds, and the torsions by which they are flexible.
//!
//! [`read()`] reads one molecule from an SDF, MOL2 or PDBQT file or a PDB file's only group, [`read_group`] a group of a
//! PDB file by its name, [`read_all`] every molecule of a file; [`from_smiles`] makes one without positions, to count
//! with. [`Ligand::torsion_links`] says about which bonds it turns, and [`RigidTree`] which pieces are rigid and what
//! each link moves. `docs/ligands.md` says what is read and what is decided where files leave it open.
//!
//! All lengths are in ångströms (Å), charges in elementary charges, positions in the frame of the file. Atoms and bonds
//! are numbered from 0 here, and from 1 in messages, as in files.

mod bytes;
mod check;
mod element;
mod error;
mod graph;
mod links;
mod matching;
mod perceive;
mod read;
mod symmetry;
#[cfg(test)]
mod tests;
mod tree;
mod write;

pub use check::{ATOMS_MAX, BONDS_MAX};
pub use element::Element;
pub use error::{LigandError, LigandFault};
pub use links::LinkRule;
pub use matching::matching;
pub use perceive::{BOND_TOLERANCE, SAME_PLACE};
pub use read::{Group, from_smiles, read, read_all, read_bytes, read_group};
pub use symmetry::{LISTED_MAX, Symmetries, TooSymmetric};
pub use tree::{Link, RigidTree};
pub use write::{PdbPose, PdbResidue, SdfRecord, atom_names, pdb, residue_name, sdf};

pub(crate) use bytes::LigandTable;

use crate::structure::Point;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// An atom of a small molecule.
#[derive(Clone, Debug, PartialEq)]
pub struct Atom {
    /// Its name in the file; empty where the format has none.
    pub name: String,
    /// Its element.
    pub element: Element,
    /// Where it is, in Å; `None` of molecules that come from SMILES.
    pub position: Option<Point>,
    /// Its formal charge in elementary charges; `None` where the file does not tell.
    pub formal_charge: Option<i8>,
    /// Its partial charge in elementary charges, if the file has one.
    pub partial_charge: Option<f64>,
}

/// A covalent bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bond {
    /// The atoms that it joins, by their numbers.
    pub atoms: [usize; 2],
    /// Its order.
    pub order: BondOrder,
}

/// The order of a bond, as far as the file tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum BondOrder {
    /// One pair of electrons.
    Single,
    /// Two pairs.
    Double,
    /// Three pairs.
    Triple,
    /// One of bonds that share their pairs: of an aromatic ring, or where a format says so, of a carboxylate.
    Aromatic,
    /// The file does not tell.
    Unknown,
}

/// Where a ligand's bonds come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BondSource {
    /// The format lists them all.
    Format,
    /// CONECT records of a PDB file.
    Conect,
    /// The distances of its atoms.
    Distances,
}

/// A small molecule: atoms that bonds join to one piece.
///
/// It has at least two atoms, at most [`ATOMS_MAX`], and either all have positions or none has. [`Ligand::new`] checks
/// that, so every ligand that there is can be worked with.
#[derive(Clone, Debug, PartialEq)]
pub struct Ligand {
    name: String,
    line: Option<usize>,
    atoms: Vec<Atom>,
    bonds: Vec<Bond>,
    bond_source: BondSource,
}

impl Ligand {
    /// A molecule of these atoms and bonds.
    ///
    /// # Errors
    /// Too many atoms or bonds; no bonds; bonds of atoms that are not there, of an atom with itself, or twice; pieces that
    /// no bonds join; positions of some atoms only, that are not finite, too far away, or the same for two atoms.
    pub fn new(
        name: impl Into<String>,
        atoms: Vec<Atom>,
        bonds: Vec<Bond>,
    ) -> Result<Ligand, LigandError> {
        check::check(&atoms, &bonds).map_err(LigandError::pathless)?;
        let name = name.into();
        Ok(Ligand { name, line: None, atoms, bonds, bond_source: BondSource::Format })
    }

    /// Its name in the file; of a group of a PDB file the residue's; empty where there is none.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The line of the file, counted from 1, at which it begins.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// Its atoms, in the order of the file.
    pub fn atoms(&self) -> &[Atom] {
        &self.atoms
    }

    /// Its bonds, in the order of the file, or of their atoms where the format has none.
    pub fn bonds(&self) -> &[Bond] {
        &self.bonds
    }

    /// Where its bonds come from.
    pub fn bond_source(&self) -> BondSource {
        self.bond_source
    }

    /// Where its atoms are, in Å, in their order; `None` of a molecule that comes from SMILES.
    pub fn positions(&self) -> Option<Vec<Point>> {
        self.atoms.iter().map(|atom| atom.position).collect()
    }
}
