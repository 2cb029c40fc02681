//! Atoms and bonds as a graph: neighbours, connected pieces, and which bonds lie in rings.

use super::Bond;

/// A neighbour of an atom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Neighbour {
    /// The other atom.
    pub atom: usize,
    /// The bond that leads there.
    pub bond: usize,
}

/// The neighbours of every atom, in the order of the bonds.
pub(super) fn neighbours(atoms: usize, bonds: &[Bond]) -> Vec<Vec<Neighbour>> {
    let mut of = vec![Vec::new(); atoms];
    for (bond, Bond { atoms: [a, b], .. }) in bonds.iter().enumerate() {
        of[*a].push(Neighbour { atom: *b, bond });
        of[*b].push(Neighbour { atom: *a, bond });
    }
    of
}

/// The pieces that are left when the bonds are cut of which `is_cut` says so: each its atoms in rising order, all in the
/// order of their lowest atoms.
pub(super) fn pieces(
    neighbours: &[Vec<Neighbour>],
    is_cut: impl Fn(usize) -> bool,
) -> Vec<Vec<usize>> {
    let mut is_seen = vec![false; neighbours.len()];
    let mut pieces = Vec::new();
    for first in 0..neighbours.len() {
        if is_seen[first] {
            continue;
        }
        is_seen[first] = true;
        let mut piece = vec![first];
        let mut next = 0;
        while let Some(atom) = piece.get(next).copied() {
            next += 1;
            for neighbour in &neighbours[atom] {
                if !is_seen[neighbour.atom] && !is_cut(neighbour.bond) {
                    is_seen[neighbour.atom] = true;
                    piece.push(neighbour.atom);
                }
            }
        }
        piece.sort_unstable();
        pieces.push(piece);
    }
    pieces
}

/// Of every bond, whether it is part of a ring, that is, no bridge of the graph.
///
/// R. E. Tarjan, "A note on finding the bridges of a graph", Inf. Process. Lett. 2 (1974) 160-161: in a search in depth
/// a bond is a bridge if nothing beyond it leads back to before it. The search keeps its own stack, so that a long
/// chain does not exhaust the program's.
pub(super) fn in_rings(neighbours: &[Vec<Neighbour>], bonds: usize) -> Vec<bool> {
    const UNSEEN: usize = usize::MAX;
    let atoms = neighbours.len();
    let mut is_in_ring = vec![true; bonds];
    // When the search came to an atom, and the earliest atom that is reached from it or beyond it.
    let mut seen = vec![UNSEEN; atoms];
    let mut earliest = vec![UNSEEN; atoms];
    let mut clock = 0;
    for first in 0..atoms {
        if seen[first] != UNSEEN {
            continue;
        }
        (seen[first], earliest[first]) = (clock, clock);
        clock += 1;
        // Atoms on the way from the first, each with the bond by which it was reached and the neighbours looked at.
        let mut way: Vec<(usize, Option<usize>, usize)> = vec![(first, None, 0)];
        while let Some((atom, came_by, looked_at)) = way.last_mut() {
            let atom = *atom;
            if let Some(neighbour) = neighbours[atom].get(*looked_at).copied() {
                *looked_at += 1;
                if Some(neighbour.bond) == *came_by {
                    continue;
                }
                if seen[neighbour.atom] == UNSEEN {
                    (seen[neighbour.atom], earliest[neighbour.atom]) = (clock, clock);
                    clock += 1;
                    way.push((neighbour.atom, Some(neighbour.bond), 0));
                } else {
                    earliest[atom] = earliest[atom].min(seen[neighbour.atom]);
                }
            } else {
                let came_by = *came_by;
                way.pop();
                if let (Some((before, _, _)), Some(bond)) = (way.last(), came_by) {
                    is_in_ring[bond] = earliest[atom] <= seen[*before];
                    earliest[*before] = earliest[*before].min(earliest[atom]);
                }
            }
        }
    }
    is_in_ring
}
