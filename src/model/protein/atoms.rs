//! The atoms of a residue that rules and energies know, as they are in the source structure.
//!
//! A residue is its backbone N, CA, C and O, its CB, one point for its side chain, and its amide hydrogen.

use crate::structure::{AminoAcid, Point, Residue};

/// The length of the bond N–H, Å (W. Kabsch and C. Sander, Biopolymers 22, 1983, set it to 1 Å; 1.01 Å is what neutron
/// diffraction finds).
pub const HYDROGEN_BOND_LENGTH: f64 = 1.01;

/// Two residues are joined by a peptide bond if C and N are at most this far apart, Å (Kabsch and Sander 1983).
pub const LONGEST_PEPTIDE_BOND: f64 = 2.5;

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

/// The amide hydrogen where Kabsch and Sander (1983) place it: opposite to the carbonyl oxygen of the residue before, as seen
/// along the peptide bond. `None` where the atoms stand on one another or the residues are not joined.
fn amide_hydrogen(n: &Point, c_before: &Point, o_before: &Point) -> Option<Point> {
    let is_joined = (n - c_before).norm() <= LONGEST_PEPTIDE_BOND;
    let direction = (c_before - o_before).try_normalize(1e-3)?;
    is_joined.then(|| n + direction * HYDROGEN_BOND_LENGTH)
}

impl ResidueAtoms {
    /// The atoms of every residue of a chain; `None` where one lacks N, CA, C or O.
    pub fn of(residues: &[Residue]) -> Option<Vec<ResidueAtoms>> {
        let mut atoms: Vec<ResidueAtoms> = Vec::with_capacity(residues.len());
        for residue in residues {
            let [n, ca, c, o] = ["N", "CA", "C", "O"].map(|name| residue.position(name));
            let (n, ca, c, o) = (n?, ca?, c?, o?);
            let is_proline = residue.amino_acid == Some(AminoAcid::Proline);
            let before = atoms.last().filter(|_| !is_proline);
            atoms.push(ResidueAtoms {
                n,
                ca,
                c,
                o,
                cb: residue.position("CB"),
                centroid: residue.side_chain_centroid(),
                hydrogen: before.and_then(|before| amide_hydrogen(&n, &before.c, &before.o)),
                is_hydrophobic: residue.amino_acid.is_some_and(is_hydrophobic),
            });
        }
        Some(atoms)
    }
}
