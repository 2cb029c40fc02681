//! Which residues of two chains are the same, and what differs.

use super::alignment::align;
use super::{AminoAcid, Chain, Residue, StructureError};
use std::collections::{BTreeMap, BTreeSet};

/// The least share of matched residues with one amino acid, of the shorter chain: below it two chains are no two states
/// of one protein. Random sequences that are aligned have about a quarter.
pub const IDENTITY_MIN: f64 = 0.5;

/// The longest chains that are aligned, in residues; the table of an alignment has the product of both.
const ALIGNED_MAX: usize = 5_000;

/// How residues were matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchedBy {
    /// By their numbers, at which at least nine in ten amino acids agree.
    Number,
    /// By an alignment of the two sequences.
    Sequence,
}

/// Two residues that are one, as indices into the two chains.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// In the first chain.
    pub first: usize,
    /// In the second.
    pub second: usize,
    /// Whether the amino acids differ.
    pub differs: bool,
    /// Names of heavy atoms that only the first has, sorted.
    pub only_first: Vec<String>,
    /// Names of heavy atoms that only the second has, sorted.
    pub only_second: Vec<String>,
}

/// What two chains have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Matching {
    /// How it was found.
    pub by: MatchedBy,
    /// The residues that both have, in order.
    pub pairs: Vec<Pair>,
    /// Residues that only the first chain has.
    pub only_first: Vec<usize>,
    /// Residues that only the second chain has.
    pub only_second: Vec<usize>,
    /// The share of pairs with one amino acid, of the residues of the shorter chain.
    pub identity: f64,
}

impl Matching {
    /// How many heavy atoms of matched residues only one of the two has.
    pub fn atoms_that_differ(&self) -> usize {
        self.pairs.iter().map(|pair| pair.only_first.len() + pair.only_second.len()).sum()
    }
}

/// Matches the residues of two chains: by number if numbers and amino acids agree, else by sequence.
///
/// # Errors
/// Sequences of which less than [`IDENTITY_MIN`] agrees, and chains too long to be aligned.
pub fn match_chains(first: &Chain, second: &Chain) -> Result<Matching, StructureError> {
    let shorter = first.residues.len().min(second.residues.len());
    let (by, pairs) = match by_number(first, second) {
        Some(pairs) => (MatchedBy::Number, pairs),
        None => {
            if first.residues.len().max(second.residues.len()) > ALIGNED_MAX {
                let message = format!(
                    "chains of {} and {} residues found; at most {ALIGNED_MAX} expected where numbers differ",
                    first.residues.len(),
                    second.residues.len()
                );
                return Err(StructureError::pathless(message));
            }
            let sequence = |chain: &Chain| -> Vec<Option<AminoAcid>> {
                chain.residues.iter().map(|residue| residue.amino_acid).collect()
            };
            (MatchedBy::Sequence, align(&sequence(first), &sequence(second)))
        }
    };
    let of = |(a, b): &(usize, usize)| (&first.residues[*a], &second.residues[*b]);
    let same = pairs.iter().map(of).filter(|(a, b)| a.amino_acid == b.amino_acid).count();
    let identity = if shorter == 0 { 0.0 } else { same as f64 / shorter as f64 };
    if identity < IDENTITY_MIN {
        let message = format!(
            "chains `{}` ({} residues) and `{}` ({}) found, of which {same} residues agree, {:.0} % of the shorter; two \
             states of one protein, at least {:.0} %, expected",
            first.name,
            first.residues.len(),
            second.name,
            second.residues.len(),
            100.0 * identity,
            100.0 * IDENTITY_MIN
        );
        return Err(StructureError::pathless(message));
    }
    let without = |count: usize, matched: &BTreeSet<usize>| -> Vec<usize> {
        (0..count).filter(|place| !matched.contains(place)).collect()
    };
    let in_first = pairs.iter().map(|(a, _)| *a).collect();
    let in_second = pairs.iter().map(|(_, b)| *b).collect();
    Ok(Matching {
        by,
        only_first: without(first.residues.len(), &in_first),
        only_second: without(second.residues.len(), &in_second),
        pairs: pairs.iter().map(|(a, b)| pair(first, *a, second, *b)).collect(),
        identity,
    })
}

/// Pairs of one number, unless there are fewer than half of the shorter chain's, or of ten amino acids there more than
/// one differs, or their order does.
fn by_number(first: &Chain, second: &Chain) -> Option<Vec<(usize, usize)>> {
    let places: BTreeMap<_, _> = second
        .residues
        .iter()
        .enumerate()
        .map(|(place, residue)| (residue.number, place))
        .collect();
    let numbered = first.residues.iter().enumerate();
    let pairs: Vec<(usize, usize)> = numbered
        .filter_map(|(place, residue)| Some((place, *places.get(&residue.number)?)))
        .collect();
    let shorter = first.residues.len().min(second.residues.len());
    let is_same =
        |(a, b): &&(usize, usize)| first.residues[*a].amino_acid == second.residues[*b].amino_acid;
    let same = pairs.iter().filter(is_same).count();
    let is_ordered = pairs.windows(2).all(|pair| pair[0].1 < pair[1].1);
    (is_ordered && 2 * pairs.len() >= shorter && 10 * same >= 9 * pairs.len()).then_some(pairs)
}

fn pair(first: &Chain, a: usize, second: &Chain, b: usize) -> Pair {
    let (one, other) = (&first.residues[a], &second.residues[b]);
    let heavy = |residue: &Residue| -> BTreeSet<String> {
        let heavy = residue.atoms.iter().filter(|atom| atom.is_heavy());
        heavy.map(|atom| atom.name.clone()).collect()
    };
    let (ours, theirs) = (heavy(one), heavy(other));
    Pair {
        first: a,
        second: b,
        differs: one.amino_acid != other.amino_acid,
        only_first: ours.difference(&theirs).cloned().collect(),
        only_second: theirs.difference(&ours).cloned().collect(),
    }
}
