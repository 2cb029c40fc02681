//! Which atoms of two files of one molecule are the same.

use super::Ligand;
use super::graph::{Neighbour, neighbours};
use std::collections::{BTreeMap, BTreeSet};

/// So many atoms are tried at most: a molecule of a few hundred atoms takes about as many.
const TRIES_MAX: usize = 1_000_000;

/// For every atom of `of` the same atom of `to`: elements are the same, and bonds join the same atoms. Orders of bonds and charges
/// do not count, since files differ in them.
///
/// Where the two have the same elements and bonds in the same order, atoms correspond by their numbers. Otherwise a map of the one graph
/// to the other is searched for: atom after atom, each beside one that has its counterpart already, among those of equal surroundings. Of
/// several maps, as symmetric molecules have them, it is the first that the search comes to. `None` if there is none, or none is found in
/// 10⁶ tries.
pub fn matching(of: &Ligand, to: &Ligand) -> Option<Vec<usize>> {
    let elements =
        |ligand: &Ligand| -> Vec<_> { ligand.atoms().iter().map(|a| a.element).collect() };
    let bonds = |ligand: &Ligand| -> BTreeSet<[usize; 2]> {
        ligand.bonds().iter().map(|bond| sorted(bond.atoms)).collect()
    };
    let count = of.atoms().len();
    if count != to.atoms().len() || of.bonds().len() != to.bonds().len() {
        return None;
    }
    let (wanted, there) = (bonds(of), bonds(to));
    if elements(of) == elements(to) && wanted == there {
        return Some((0..count).collect());
    }
    let near = [of, to].map(|ligand| neighbours(count, ligand.bonds()));
    let kinds = kinds([of, to], &near);
    let mut search = Search {
        near: &near,
        kinds: &kinds,
        there: &there,
        order: order(&near[0]),
        image: vec![None; count],
        is_taken: vec![false; count],
        tries: 0,
    };
    search.place(0).then(|| search.image.into_iter().flatten().collect())
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// What the surroundings of every atom of both ligands are, as numbers: atoms of different numbers are not the same.
fn kinds(ligands: [&Ligand; 2], near: &[Vec<Vec<Neighbour>>; 2]) -> [Vec<usize>; 2] {
    let mut kinds = ligands.map(|ligand| {
        ligand.atoms().iter().map(|atom| usize::from(atom.element.number())).collect::<Vec<_>>()
    });
    let mut different = 0;
    loop {
        let described = [0, 1].map(|side| {
            let describe = |(atom, of): (usize, &Vec<Neighbour>)| {
                let mut around: Vec<usize> = of.iter().map(|n| kinds[side][n.atom]).collect();
                around.sort_unstable();
                (kinds[side][atom], around)
            };
            near[side].iter().enumerate().map(describe).collect::<Vec<_>>()
        });
        let numbers: BTreeMap<_, usize> = described
            .iter()
            .flatten()
            .collect::<BTreeSet<_>>()
            .into_iter()
            .enumerate()
            .map(|(number, described)| (described.clone(), number))
            .collect();
        kinds = described.map(|of| of.iter().map(|one| numbers[one]).collect());
        if numbers.len() == different {
            return kinds;
        }
        different = numbers.len();
    }
}

/// The atoms in an order in which each but the first is bonded to one before it, with that one.
fn order(near: &[Vec<Neighbour>]) -> Vec<(usize, Option<usize>)> {
    let mut order = vec![(0, None)];
    let mut is_seen = vec![false; near.len()];
    is_seen[0] = true;
    let mut next = 0;
    while let Some((atom, _)) = order.get(next).copied() {
        next += 1;
        for neighbour in &near[atom] {
            if !std::mem::replace(&mut is_seen[neighbour.atom], true) {
                order.push((neighbour.atom, Some(atom)));
            }
        }
    }
    order
}

/// A search for a map of one graph to another.
struct Search<'a> {
    near: &'a [Vec<Vec<Neighbour>>; 2],
    kinds: &'a [Vec<usize>; 2],
    there: &'a BTreeSet<[usize; 2]>,
    order: Vec<(usize, Option<usize>)>,
    image: Vec<Option<usize>>,
    is_taken: Vec<bool>,
    tries: usize,
}

impl Search<'_> {
    /// Finds counterparts of the atoms from a place of the order on; whether there are any. A ligand has at most a thousand atoms, so the
    /// calls are not nested too deeply.
    fn place(&mut self, at: usize) -> bool {
        let Some((atom, beside)) = self.order.get(at).copied() else { return true };
        let candidates: Vec<usize> = match beside.and_then(|beside| self.image[beside]) {
            Some(image) => self.near[1][image].iter().map(|neighbour| neighbour.atom).collect(),
            None => (0..self.is_taken.len()).collect(),
        };
        for candidate in candidates {
            if self.is_taken[candidate] || self.kinds[0][atom] != self.kinds[1][candidate] {
                continue;
            }
            self.tries += 1;
            if self.tries > TRIES_MAX {
                return false;
            }
            let fits = self.near[0][atom].iter().all(|neighbour| {
                self.image[neighbour.atom]
                    .is_none_or(|image| self.there.contains(&sorted([image, candidate])))
            });
            if !fits {
                continue;
            }
            (self.image[atom], self.is_taken[candidate]) = (Some(candidate), true);
            if self.place(at + 1) {
                return true;
            }
            (self.image[atom], self.is_taken[candidate]) = (None, false);
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ligand::{Atom, Bond, from_smiles};

    /// The molecule with its atoms in another order: atom `k` becomes atom `k * by + 1`, modulo their number.
    fn shuffled(ligand: &Ligand, by: usize) -> Ligand {
        let count = ligand.atoms().len();
        let place = |atom: usize| (atom * by + 1) % count;
        let mut atoms: Vec<Option<Atom>> = vec![None; count];
        for (number, atom) in ligand.atoms().iter().enumerate() {
            atoms[place(number)] = Some(atom.clone());
        }
        let bonds = ligand.bonds().iter().rev();
        let bonds = bonds.map(|bond| Bond { atoms: bond.atoms.map(place), order: bond.order });
        Ligand::new("", atoms.into_iter().flatten().collect(), bonds.collect()).unwrap()
    }

    #[test]
    fn a_molecule_matches_itself_in_any_order() {
        for smiles in ["NC(=[NH2+])c1ccccc1", "OC(=O)CCCCC1SCC2NC(=O)NC12", "FC(F)(F)C(Cl)Br"] {
            let ligand = from_smiles(smiles).unwrap();
            let count = ligand.atoms().len();
            assert_eq!(matching(&ligand, &ligand), Some((0..count).collect()));
            // A factor without a common divisor with the number of atoms.
            let by = [7, 5, 11].into_iter().find(|by| !count.is_multiple_of(*by)).unwrap();
            let other = shuffled(&ligand, by);
            let to = matching(&ligand, &other).expect("it is the same molecule");
            let there: BTreeSet<_> = other.bonds().iter().map(|bond| sorted(bond.atoms)).collect();
            for bond in ligand.bonds() {
                assert!(there.contains(&sorted(bond.atoms.map(|atom| to[atom]))));
            }
            let element = |(of, to): (usize, &usize)| {
                ligand.atoms()[of].element == other.atoms()[*to].element
            };
            assert!(to.iter().enumerate().all(element));
        }
    }

    #[test]
    fn other_molecules_do_not_match() {
        let molecule = |smiles| from_smiles(smiles).unwrap();
        for (a, b) in [("CCO", "COC"), ("CCO", "CCN"), ("CCO", "CCCO"), ("C1CC1CCC", "C1CCC1CC")] {
            assert_eq!(matching(&molecule(a), &molecule(b)), None, "{a} {b}");
        }
    }
}
