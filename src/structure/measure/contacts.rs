//! Contacts of residues, and how many of a native structure's are formed.
//!
//! There are many definitions of a contact; here are two, each with a name.
//!
//! - **Cα contacts**: Cα atoms at most a distance apart, and residues at least a number of places apart along the chain.
//!   [`CA_REACH`] and [`APART`] are usual, and what this library's studies of folding count.
//! - **Contacts of heavy atoms**, and the share of them Q as in R. B. Best, G. Hummer & W. A. Eaton, *Native contacts determine
//!   protein folding mechanisms in atomistic simulations*, PNAS 110 (2013) 17874: pairs (i, j) of heavy atoms of residues with
//!   |i − j| > 3 that are nearer than 4.5 Å in the native structure, at a distance r⁰ there; Q is the mean over all pairs
//!   of 1 / (1 + exp(β (r − λ r⁰))) with β = 5 Å⁻¹ and λ = 1.8.

use super::cells::Cells;
use crate::math;
use crate::structure::{Point, Residue};

/// The largest distance of two Cα atoms that are in contact, in Å, unless told otherwise.
pub const CA_REACH: f64 = 7.0;

/// How many places along the chain residues in contact are apart at least, unless told otherwise.
pub const APART: usize = 4;

/// Best, Hummer & Eaton: heavy atoms in contact are nearer than this, in Å.
const HEAVY_REACH: f64 = 4.5;

/// Best, Hummer & Eaton: how sharply a contact ends, in Å⁻¹.
const BETA: f64 = 5.0;

/// Best, Hummer & Eaton: how far a contact may stretch, as a multiple of its native length.
const LAMBDA: f64 = 1.8;

/// The pairs of residues, by their indices, that are in contact by their Cα atoms: at most `reach` Å apart and at least
/// `apart` places. The first index is the smaller one; pairs are in ascending order. Residues without Cα have none.
pub fn ca_contacts(residues: &[Residue], reach: f64, apart: usize) -> Vec<(usize, usize)> {
    let positions: Vec<(usize, Point)> =
        residues.iter().enumerate().filter_map(|(i, r)| Some((i, r.position("CA")?))).collect();
    let (indices, positions): (Vec<usize>, Vec<Point>) = positions.into_iter().unzip();
    let pairs = contacts_of_points(&positions, reach, 0).into_iter();
    let pairs = pairs.map(|(a, b)| (indices[a], indices[b]));
    pairs.filter(|(a, b)| b - a >= apart).collect()
}

/// The same of a chain by the positions of its Cα atoms, which are those of all residues in their order.
pub fn contacts_of_points(positions: &[Point], reach: f64, apart: usize) -> Vec<(usize, usize)> {
    near_pairs(positions, reach)
        .filter(|(a, b, distance)| *distance <= reach && b - a >= apart)
        .map(|(a, b, _)| (a, b))
        .collect()
}

/// The share of contacts that the Cα atoms at `positions` still have, which are those of all residues in their order:
/// those at most `reach` Å apart. 1 if there are no contacts.
pub fn share_of_ca_contacts(contacts: &[(usize, usize)], positions: &[Point], reach: f64) -> f64 {
    let holds = |(a, b): &&(usize, usize)| {
        let ends = positions.get(*a).zip(positions.get(*b));
        ends.is_some_and(|(a, b)| (a - b).norm() <= reach)
    };
    share(contacts.iter().filter(holds).count() as f64, contacts.len())
}

/// The contacts of heavy atoms of a native structure: Best, Hummer & Eaton 2013.
#[derive(Clone, Debug, PartialEq)]
pub struct NativeContacts {
    /// Two atoms, the first of the residue that comes first, and their distance in the native structure.
    pairs: Vec<(AtomIndex, AtomIndex, f64)>,
}

/// Residue, and atom in the residue.
type AtomIndex = (usize, usize);

impl NativeContacts {
    /// The contacts of a structure.
    pub fn of(native: &[Residue]) -> NativeContacts {
        let (mut atoms, mut positions) = (Vec::new(), Vec::new());
        for (i, residue) in native.iter().enumerate() {
            for (k, atom) in residue.atoms.iter().enumerate().filter(|(_, atom)| atom.is_heavy()) {
                atoms.push((i, k));
                positions.push(atom.position);
            }
        }
        let pairs = near_pairs(&positions, HEAVY_REACH)
            .map(|(a, b, distance)| (atoms[a], atoms[b], distance))
            .filter(|(a, b, distance)| *distance < HEAVY_REACH && b.0 - a.0 > 3);
        NativeContacts { pairs: pairs.collect() }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Q of a conformation, from 0 to 1: the share of the contacts that are formed; 1 if there are no contacts.
    ///
    /// The residues are the native structure's with the same atoms in the same order; a contact of an atom that is not
    /// there counts as broken.
    pub fn share(&self, residues: &[Residue]) -> f64 {
        let position = |(i, k): AtomIndex| Some(residues.get(i)?.atoms.get(k)?.position);
        let formed = |(a, b, native): &(AtomIndex, AtomIndex, f64)| {
            let Some((a, b)) = position(*a).zip(position(*b)) else { return 0.0 };
            1.0 / (1.0 + math::exp(BETA * ((a - b).norm() - LAMBDA * native)))
        };
        share(self.pairs.iter().map(formed).sum(), self.pairs.len())
    }
}

fn share(of: f64, all: usize) -> f64 {
    if all == 0 { 1.0 } else { of / all as f64 }
}

/// All pairs of points within `reach` of one another, and others, with their distances, ascending by index.
fn near_pairs(points: &[Point], reach: f64) -> impl Iterator<Item = (usize, usize, f64)> {
    // A reach of zero still wants cubes of some size.
    let cells = Cells::new(points.iter().copied(), reach.max(1e-3));
    points.iter().enumerate().flat_map(move |(a, point)| {
        let mut after = Vec::new();
        cells.near(point, |b| {
            if b > a {
                after.push(b);
            }
        });
        after.sort_unstable();
        after.into_iter().map(move |b| (a, b, (point - points[b]).norm()))
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::ideal_chain;
    use super::*;

    fn ca(residues: &[Residue]) -> Vec<Point> {
        residues.iter().filter_map(|residue| residue.position("CA")).collect()
    }

    #[test]
    fn a_helix_touches_the_fourth_residue_by_its_ca() {
        let helix = ideal_chain(12, -57.0, -47.0);
        let contacts = ca_contacts(&helix, CA_REACH, APART);
        assert_eq!(contacts, (0..8).map(|i| (i, i + 4)).collect::<Vec<_>>());
        assert_eq!(share_of_ca_contacts(&contacts, &ca(&helix), CA_REACH), 1.0);
        let stretched = ca(&ideal_chain(12, -139.0, 135.0));
        assert_eq!(share_of_ca_contacts(&contacts, &stretched, CA_REACH), 0.0);
        assert_eq!(share_of_ca_contacts(&[], &stretched, CA_REACH), 1.0);
        assert_eq!(share_of_ca_contacts(&[(3, 99)], &stretched, CA_REACH), 0.0);
    }

    #[test]
    fn all_pairs_are_looked_at() {
        let helix = ideal_chain(60, -57.0, -47.0);
        let positions = ca(&helix);
        for (reach, apart) in [(5.0, 1), (11.0, 3), (0.0, 0), (200.0, 4)] {
            let mut all = Vec::new();
            for a in 0..60 {
                all.extend((a + 1..60).map(|b| (a, b)));
            }
            all.retain(|(a, b)| b - a >= apart && (positions[*a] - positions[*b]).norm() <= reach);
            assert_eq!(ca_contacts(&helix, reach, apart), all);
        }
    }

    #[test]
    fn q_is_nearly_one_at_home_and_nearly_zero_when_stretched() {
        let helix = ideal_chain(12, -57.0, -47.0);
        let native = NativeContacts::of(&helix);
        assert!(!native.is_empty() && native.len() > 8);
        // At home a contact of 3 to 4.5 Å counts 1 / (1 + exp(−4 r⁰)).
        assert!((native.share(&helix) - 1.0).abs() < 1e-4, "{}", native.share(&helix));
        assert!(native.share(&ideal_chain(12, -139.0, 135.0)) < 0.01);
        assert_eq!(native.share(&[]), 0.0);
        assert_eq!(NativeContacts::of(&helix[..3]).share(&helix), 1.0);
    }

    #[test]
    fn one_contact_counts_by_its_distance() {
        let mut pair = ideal_chain(5, -57.0, -47.0);
        for (i, residue) in pair.iter_mut().enumerate() {
            residue.atoms.truncate(1);
            residue.atoms[0].position = Point::x() * if i == 4 { 4.0 } else { -10.0 * i as f64 };
        }
        let native = NativeContacts::of(&pair);
        assert_eq!(native.len(), 1);
        pair[4].atoms[0].position.x = 7.0;
        let expected = 1.0 / (1.0 + math::exp(5.0 * (7.0 - 1.8 * 4.0)));
        assert!((native.share(&pair) - expected).abs() < 1e-15);
    }
}
