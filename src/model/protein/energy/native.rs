//! The constraints that a known structure gives.

use super::constraints::Constraint;
use crate::structure::disulphides::disulphides;
use crate::structure::measure::hydrogen_bonds;
use crate::structure::{Chain, Residue};

/// The hydrogen bonds of a structure (W. Kabsch and C. Sander, Biopolymers 22, 1983: below −0.5 kcal/mol), and its
/// disulphides at the distance that they have in it. Residues are counted from 0 along `residues`.
pub fn constraints_of(residues: &[Residue]) -> Vec<Constraint> {
    let bonds = hydrogen_bonds(residues).into_iter();
    let mut constraints: Vec<Constraint> =
        bonds.map(|bond| Constraint::hydrogen_bond(bond.donor, bond.acceptor)).collect();
    let chain = Chain { name: String::new(), residues: residues.to_vec(), others: Vec::new() };
    for bond in disulphides(&[chain]) {
        let (first, second) = (bond.first.1, bond.second.1);
        let centroids = [first, second].map(|residue| residues[residue].side_chain_centroid());
        if let [Some(a), Some(b)] = centroids {
            constraints.push(Constraint::disulphide(first, second, (a - b).norm()));
        }
    }
    constraints
}

/// The constraints of another structure between residues that `matches` has a counterpart for: pairs of a residue here and
/// the residue there, ascending.
pub fn carried_over(constraints: &[Constraint], matches: &[[u32; 2]]) -> Vec<Constraint> {
    let here = |there: usize| {
        let at = matches.binary_search_by_key(&there, |[_, there]| *there as usize).ok()?;
        Some(matches[at][0] as usize)
    };
    let carried = constraints.iter().filter_map(|constraint| {
        let (first, second) = (here(constraint.first)?, here(constraint.second)?);
        Some(Constraint { first, second, ..*constraint })
    });
    carried.collect()
}
