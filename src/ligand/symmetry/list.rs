//! All symmetries, one by one.

use super::LISTED_MAX;
use super::tree::Tree;

/// All lists together have at most so many numbers.
const NUMBERS_MAX: f64 = 1e6;

/// The symmetries found so far, from the middle of the tree outwards.
struct Partial {
    /// For every atom to which it goes; atoms that are not reached yet, and hydrogens, stay.
    to: Vec<usize>,
    /// For every block so far to which it goes.
    blocks: Vec<usize>,
}

/// For every symmetry the atom to which each goes, the identity among them; `None` if there are more than are listed.
pub(super) fn all(tree: &Tree) -> Option<Vec<Vec<usize>>> {
    let atoms = tree.branches.len();
    let count = tree.symmetries();
    if count > LISTED_MAX as f64 || count * (atoms as f64) > NUMBERS_MAX {
        return None;
    }
    let mut found = vec![Partial { to: (0..atoms).collect(), blocks: Vec::new() }];
    for block in &tree.blocks {
        let mut longer = Vec::new();
        for Partial { to, blocks } in found {
            let candidates: Vec<usize> = match block.parent.filter(|_| blocks.len() >= tree.middle)
            {
                Some(parent) => tree.branches[to[parent]].clone(),
                None => (0..tree.middle).collect(),
            };
            let is_free = |candidate: &&usize| {
                let other = &tree.blocks[**candidate];
                (other.bond, other.class) == (block.bond, block.class)
                    && !blocks.contains(candidate)
            };
            for candidate in candidates.iter().filter(is_free) {
                let image = &tree.blocks[*candidate];
                for map in &tree.classes[block.class].maps {
                    let mut to = to.clone();
                    for (first, goal) in map.iter().enumerate() {
                        let atom = block.atoms[block.from_first[first]];
                        to[atom] = image.atoms[image.from_first[*goal]];
                    }
                    let blocks = blocks.iter().copied().chain([*candidate]).collect();
                    longer.push(Partial { to, blocks });
                }
            }
        }
        found = longer;
    }
    Some(found.into_iter().map(|partial| partial.to).collect())
}
