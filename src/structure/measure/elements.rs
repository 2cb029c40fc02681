//! Elements of secondary structure: the helices and strands of a chain, one after the other.

use super::secondary_structure::{SecondaryStructure, ThreeStates, secondary_structure};
use crate::structure::Residue;
use std::ops::Range;

/// A helix has at least so many residues: one turn.
const HELIX_LEAST: usize = 4;

/// A strand has at least so many residues; one alone is a bridge.
const STRAND_LEAST: usize = 2;

/// A helix or a strand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element {
    /// `α1`, `α2` … and `β1`, `β2` …, counted along the chain.
    pub name: String,
    /// [`ThreeStates::Helix`] or [`ThreeStates::Strand`].
    pub kind: ThreeStates,
    /// Its residues, by their indices in the chain.
    pub residues: Range<usize>,
}

/// The helices and strands of one chain, by [`secondary_structure`], in their order along it.
///
/// A helix is a run of at least four residues each of which is of a helix of any kind (H, G or I), a strand a run of at least
/// two that are in a ladder (E). Elements that follow one another without a residue between them are one if both are helices, or
/// both strands.
pub fn elements(residues: &[Residue]) -> Vec<Element> {
    let kinds: Vec<ThreeStates> = (secondary_structure(residues).into_iter())
        .map(|kind| match kind {
            SecondaryStructure::Bridge => ThreeStates::Coil,
            kind => kind.three_states(),
        })
        .collect();
    let mut elements: Vec<Element> = Vec::new();
    let mut start = 0;
    for run in kinds.chunk_by(|a, b| a == b) {
        let (kind, residues) = (run[0], start..start + run.len());
        start = residues.end;
        let (letter, least) = match kind {
            ThreeStates::Helix => ('α', HELIX_LEAST),
            ThreeStates::Strand => ('β', STRAND_LEAST),
            ThreeStates::Coil => continue,
        };
        if residues.len() >= least {
            let number = 1 + elements.iter().filter(|known| known.kind == kind).count();
            elements.push(Element { name: format!("{letter}{number}"), kind, residues });
        }
    }
    elements
}

#[cfg(test)]
mod tests {
    use super::super::tests::ideal_chain;
    use super::*;

    #[test]
    fn a_helix_is_one_element_and_a_stretched_chain_has_none() {
        let helix = elements(&ideal_chain(14, -57.0, -47.0));
        assert_eq!(helix.len(), 1);
        assert_eq!((&*helix[0].name, helix[0].kind), ("α1", ThreeStates::Helix));
        assert!(helix[0].residues.len() >= 10, "{helix:?}");
        assert_eq!(elements(&ideal_chain(14, -139.0, 135.0)), []);
        assert_eq!(elements(&[]), []);
    }
}
