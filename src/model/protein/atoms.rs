//! The atoms of a residue that rules and energies know, as they are in the source structure.
//!
//! A residue is its backbone N, CA, C and O, its CB, one point for its side chain, and its amide hydrogen.

use crate::structure::measure::amide_hydrogens;
use crate::structure::{AminoAcid, Point, Residue};

/// The positions of a residue's atoms in the source, Å.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidueAtoms {
    /// The amide nitrogen.
    pub n: Point,
    /// The alpha carbon.
    pub ca: Point,
    /// The carbonyl carbon.
    pub c: Point,
    /// The carbonyl oxygen.
    pub o: Point,
    /// The beta carbon, which glycine does not have.
    pub cb: Option<Point>,
    /// The centroid of the side chain's heavy atoms, which glycine does not have.
    pub centroid: Option<Point>,
    /// The amide hydrogen, placed ideally. The first residue, prolines and residues after a break have none.
    pub hydrogen: Option<Point>,
    /// Whether the side chain counts as hydrophobic: A V I L M F W C P Y.
    pub is_hydrophobic: bool,
}

/// Whether the side chain of an amino acid counts as hydrophobic.
pub fn is_hydrophobic(amino_acid: AminoAcid) -> bool {
    use AminoAcid::*;
    matches!(
        amino_acid,
        Alanine
            | Valine
            | Isoleucine
            | Leucine
            | Methionine
            | Phenylalanine
            | Tryptophan
            | Cysteine
            | Proline
            | Tyrosine
    )
}

impl ResidueAtoms {
    /// The atoms of every residue of a chain; `None` where one lacks N, CA, C or O.
    pub fn of(residues: &[Residue]) -> Option<Vec<ResidueAtoms>> {
        let mut atoms: Vec<ResidueAtoms> = Vec::with_capacity(residues.len());
        for (residue, hydrogen) in residues.iter().zip(amide_hydrogens(residues)) {
            let [n, ca, c, o] = ["N", "CA", "C", "O"].map(|name| residue.position(name));
            let (n, ca, c, o) = (n?, ca?, c?, o?);
            atoms.push(ResidueAtoms {
                n,
                ca,
                c,
                o,
                cb: residue.position("CB"),
                centroid: residue.side_chain_centroid(),
                hydrogen,
                is_hydrophobic: residue.amino_acid.is_some_and(is_hydrophobic),
            });
        }
        Some(atoms)
    }
}
