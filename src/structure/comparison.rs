//! Two conformations of one protein: how far residues are apart, and which torsions differ.

use super::matching::{Matching, match_chains};
use super::measure::{Superposition, superpose};
use super::peptides::phi_psi;
use super::{Chain, Point, StructureError};
use crate::math;

/// What differs between two conformations.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Which residues were compared.
    pub matching: Matching,
    /// How the second chain is moved onto the first, by the CA of all pairs that have them; with the RMSD that is left.
    pub superposition: Superposition,
    /// For each pair the distance of its two CA after that, in Å; `None` where one has no CA.
    pub motions: Vec<Option<f64>>,
    /// How phi and psi of the pairs differ, the largest difference first.
    pub turns: Vec<Turn>,
}

/// How far a torsion is turned from one conformation to the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// The index of the pair in the matching.
    pub pair: usize,
    /// `phi` or `psi`.
    pub torsion: &'static str,
    /// The torsion in the first chain, in radians, in [−π, π).
    pub first: f64,
    /// The torsion in the second.
    pub second: f64,
    /// The shortest turn from the one to the other, in radians, not negative.
    pub turn: f64,
}

/// Compares two conformations of one protein.
///
/// # Errors
/// As [`match_chains`], and where no pair has two CA.
pub fn compare(first: &Chain, second: &Chain) -> Result<Comparison, StructureError> {
    let matching = match_chains(first, second)?;
    let cas: Vec<Option<(Point, Point)>> = matching
        .pairs
        .iter()
        .map(|pair| {
            let ours = first.residues[pair.first].position("CA");
            ours.zip(second.residues[pair.second].position("CA"))
        })
        .collect();
    let (fixed, moved): (Vec<Point>, Vec<Point>) = cas.iter().flatten().copied().unzip();
    if fixed.is_empty() {
        let message = "no residue with CA in both chains found; some expected";
        return Err(StructureError::pathless(message));
    }
    let superposition = superpose(&moved, &fixed);
    let motion = |(fixed, moved): (Point, Point)| (superposition.apply(&moved) - fixed).norm();
    let motions = cas.iter().map(|ends| ends.map(motion)).collect();
    let turns = turns(&matching, first, second);
    Ok(Comparison { matching, superposition, motions, turns })
}

/// The turns of all torsions that both conformations have, the largest first, equal ones in the order of the chain.
fn turns(matching: &Matching, first: &Chain, second: &Chain) -> Vec<Turn> {
    let [ours, theirs] = [first, second].map(|chain| phi_psi(&chain.residues));
    let mut turns = Vec::new();
    for (pair, of) in matching.pairs.iter().enumerate() {
        let both = ours[of.first].into_iter().zip(theirs[of.second]);
        for (torsion, ends) in ["phi", "psi"].into_iter().zip(both) {
            let (Some(first), Some(second)) = ends else { continue };
            let turn = math::angle_between(first, second);
            turns.push(Turn { pair, torsion, first, second, turn });
        }
    }
    turns.sort_by(|a, b| b.turn.total_cmp(&a.turn));
    turns
}
