//! The rigid pieces of a ligand and the tree in which torsion links join them.

use super::graph::{neighbours, pieces};
use super::{Ligand, LinkRule};

/// The rigid pieces of a ligand, joined by torsion links to a tree.
///
/// The root is the piece with most heavy atoms, so that it is the same with and without hydrogens; of several the one
/// with the lowest atom. Links follow in the order in which a search in breadth from the root comes to them, those of one
/// piece by the numbers of their axes. Everything follows from the order of the atoms alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RigidTree {
    /// The atoms of each piece in rising order. The root comes first; link `k` leads to piece `k + 1`.
    pub pieces: Vec<Vec<usize>>,
    /// The links; of any two on one way from the root, the nearer one comes first.
    pub links: Vec<Link>,
}

/// A torsion link of a [`RigidTree`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The bond, by its number among the ligand's.
    pub bond: usize,
    /// The atoms at the ends of the axis: that on the side of the root, and the other.
    pub axis: [usize; 2],
    /// The piece on the side of the root.
    pub parent: usize,
    /// The atoms that a rotation about the axis moves, in rising order: all beyond it but its own end, which stays.
    pub moved: Vec<usize>,
}

impl RigidTree {
    /// The tree of a ligand by a rule for links.
    pub fn new(ligand: &Ligand, rule: LinkRule) -> RigidTree {
        let links = ligand.torsion_links(rule);
        let neighbours = neighbours(ligand.atoms().len(), ligand.bonds());
        let found = pieces(&neighbours, |bond| links.binary_search(&bond).is_ok());
        let mut piece_of = vec![0; ligand.atoms().len()];
        for (number, piece) in found.iter().enumerate() {
            piece.iter().for_each(|atom| piece_of[*atom] = number);
        }
        let heavy = |piece: &[usize]| {
            piece.iter().filter(|atom| ligand.atoms()[**atom].element.is_heavy()).count()
        };
        // The first of several, which has the lowest atom.
        let root = (0..found.len()).rev().max_by_key(|number| heavy(&found[*number])).unwrap_or(0);

        let mut order = vec![root];
        let mut joined = Vec::with_capacity(links.len());
        let mut next = 0;
        while let Some(piece) = order.get(next).copied() {
            let mut axes: Vec<([usize; 2], usize)> = Vec::new();
            for near in &found[piece] {
                let across = neighbours[*near].iter().filter(|other| {
                    // The links make a tree of the pieces: only that to the piece before leads back.
                    piece_of[other.atom] != piece && !order.contains(&piece_of[other.atom])
                });
                axes.extend(across.map(|other| ([*near, other.atom], other.bond)));
            }
            axes.sort_unstable();
            for (axis, bond) in axes {
                order.push(piece_of[axis[1]]);
                joined.push(Link { bond, axis, parent: next, moved: Vec::new() });
            }
            next += 1;
        }
        // From the last link to the first: what a link moves begins with its piece and takes in what links beyond it move.
        let mut beyond: Vec<Vec<usize>> = order.iter().map(|piece| found[*piece].clone()).collect();
        for (number, link) in joined.iter_mut().enumerate().rev() {
            let mut atoms = std::mem::take(&mut beyond[number + 1]);
            beyond[link.parent].extend_from_slice(&atoms);
            atoms.retain(|atom| *atom != link.axis[1]);
            atoms.sort_unstable();
            link.moved = atoms;
        }
        let pieces = order.iter().map(|piece| found[*piece].clone()).collect();
        RigidTree { pieces, links: joined }
    }
}
