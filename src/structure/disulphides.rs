//! Disulphide bonds.

use super::{AminoAcid, Chain};

/// The longest distance of two SG, in Å, that counts as a bond: it is 2.03 Å long (Engh & Huber 1991), and the radii of
/// sulphurs without one, 1.8 Å (Bondi 1964), keep these 3.6 Å apart.
pub const DISULPHIDE_MAX: f64 = 2.5;

/// A bond between the sulphurs of two cysteines.
#[derive(Clone, Debug, PartialEq)]
pub struct Disulphide {
    /// The first cysteine: the index of its chain, and its own in the chain.
    pub first: (usize, usize),
    /// The second one, after it in the order of the file.
    pub second: (usize, usize),
    /// The distance of the two SG, in Å.
    pub distance: f64,
}

/// The disulphide bonds within and between some chains, in the order of their first cysteines.
pub fn disulphides(chains: &[Chain]) -> Vec<Disulphide> {
    let mut sulphurs = Vec::new();
    for (chain, of) in chains.iter().enumerate() {
        for (place, residue) in of.residues.iter().enumerate() {
            if residue.amino_acid == Some(AminoAcid::Cysteine) {
                sulphurs.extend(residue.position("SG").map(|at| ((chain, place), at)));
            }
        }
    }
    let mut bonds = Vec::new();
    for (index, (first, at)) in sulphurs.iter().enumerate() {
        for (second, other) in &sulphurs[index + 1..] {
            let distance = (other - at).norm();
            if distance <= DISULPHIDE_MAX {
                bonds.push(Disulphide { first: *first, second: *second, distance });
            }
        }
    }
    bonds
}
