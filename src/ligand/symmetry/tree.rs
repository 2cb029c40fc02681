//! The tree of a ligand's blocks: ring systems and single atoms, joined by the bonds that are part of no ring.

use super::super::graph::{Neighbour, in_rings, neighbours, pieces};
use super::super::{Bond, BondOrder, Element, Ligand};
use super::TooSymmetric;
use super::block::{SYMMETRIES_MAX, Shape, Signature};

/// Steps of all searches for maps of one ligand. A drug needs some hundreds.
const STEPS_MAX: usize = 4_000_000;

/// A block: atoms that are joined by bonds in rings, or one atom. With what hangs on it away from the middle it is a branch.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Its atoms by their numbers in the ligand, in rising order.
    pub atoms: Vec<usize>,
    /// The atom of the block before to which it is bonded, if it is not the middle.
    pub parent: Option<usize>,
    /// What the bond to that atom is.
    pub bond: u8,
    /// Branches of one class are alike.
    pub class: usize,
    /// For every atom of the first block of its class the counterpart in this one, both as places in `atoms`.
    pub from_first: Vec<usize>,
}

/// Branches that are alike.
#[derive(Clone, Debug)]
pub(super) struct Class {
    /// The maps of the first block to itself, as places in its atoms; the identity is among them.
    pub maps: Vec<Vec<usize>>,
    /// How many symmetries a branch of the class has.
    pub symmetries: f64,
}

/// The blocks of a ligand from the middle outwards.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// In the order of a search in breadth: the one block in the middle, or the two at both ends of the bond there, come first.
    pub blocks: Vec<Block>,
    /// How many blocks are in the middle: 1 or 2; 0 of a ligand without heavy atoms.
    pub middle: usize,
    pub classes: Vec<Class>,
    /// For every atom of the ligand the blocks that hang on it, in the order of their bonds, classes and numbers.
    pub branches: Vec<Vec<usize>>,
    heavy: Vec<usize>,
    is_heavy: Vec<bool>,
}

/// A block's bonds to others: the own atom, the other one, and what the bond is.
type Joints = Vec<(usize, usize, u8)>;

impl Tree {
    pub fn of(ligand: &Ligand) -> Result<Tree, TooSymmetric> {
        let near = neighbours(ligand.atoms().len(), ligand.bonds());
        let is_in_ring = in_rings(&near, ligand.bonds().len());
        let is_heavy: Vec<bool> = ligand.atoms().iter().map(|a| a.element.is_heavy()).collect();
        // A hydrogen between two atoms holds them together, though its place does not count.
        let is_kept: Vec<bool> =
            is_heavy.iter().zip(&near).map(|(is_heavy, of)| *is_heavy || of.len() > 1).collect();
        let heavy = (0..is_heavy.len()).filter(|atom| is_heavy[*atom]).collect();
        let mut found = pieces(&near, |bond| !is_in_ring[bond]);
        found.retain(|piece| is_kept[piece[0]]);
        let mut block_of = vec![usize::MAX; is_kept.len()];
        for (number, piece) in found.iter().enumerate() {
            piece.iter().for_each(|atom| block_of[*atom] = number);
        }
        let kinds = kinds(ligand, &near);
        let mut joints: Vec<Joints> = vec![Vec::new(); found.len()];
        for (bond, Bond { atoms: [a, b], .. }) in ligand.bonds().iter().enumerate() {
            if !is_in_ring[bond] && is_kept[*a] && is_kept[*b] {
                joints[block_of[*a]].push((*a, *b, kinds[bond]));
                joints[block_of[*b]].push((*b, *a, kinds[bond]));
            }
        }

        let mut tree = Tree {
            blocks: Vec::new(),
            middle: 0,
            classes: Vec::new(),
            branches: vec![Vec::new(); is_kept.len()],
            heavy,
            is_heavy,
        };
        tree.grow(&found, &joints, &block_of);
        tree.classify(ligand, &near, &kinds)?;
        Ok(tree)
    }

    /// The heavy atoms in rising order.
    pub fn heavy(&self) -> &[usize] {
        &self.heavy
    }

    /// Whether the place of an atom counts.
    pub fn is_heavy(&self, atom: usize) -> bool {
        self.is_heavy[atom]
    }

    /// How many symmetries there are.
    pub fn symmetries(&self) -> f64 {
        let middle = &self.blocks[..self.middle];
        let each = middle.iter().map(|block| self.classes[block.class].symmetries);
        each.product::<f64>() * if self.can_swap() { 2.0 } else { 1.0 }
    }

    /// Whether the two halves of the ligand are alike.
    pub fn can_swap(&self) -> bool {
        self.middle == 2 && self.blocks[0].class == self.blocks[1].class
    }

    /// The branches that hang on an atom, those that are alike together.
    pub fn alike(&self, atom: usize) -> impl Iterator<Item = &[usize]> {
        let kind = |block: &usize| (self.blocks[*block].bond, self.blocks[*block].class);
        self.branches[atom].chunk_by(move |a, b| kind(a) == kind(b))
    }

    /// Lists the blocks from the middle on.
    fn grow(&mut self, found: &[Vec<usize>], joints: &[Joints], block_of: &[usize]) {
        let middle = middle(joints, block_of);
        self.middle = middle.len();
        // Each block with the bond by which it was reached: the atom before, and what the bond is.
        let mut order: Vec<(usize, Option<(usize, u8)>)> = match middle[..] {
            [one, other] => {
                let across = |from: usize, to: usize| {
                    let joint = joints[from].iter().find(|joint| block_of[joint.1] == to);
                    joint.map(|joint| (joint.1, joint.2))
                };
                vec![(one, across(one, other)), (other, across(other, one))]
            }
            _ => middle.iter().map(|block| (*block, None)).collect(),
        };
        let mut next = 0;
        while let Some((block, before)) = order.get(next).copied() {
            next += 1;
            for (own, to, kind) in &joints[block] {
                // No two bonds lead to one atom, or they would be part of a ring.
                if before.is_none_or(|(atom, _)| atom != *to) {
                    order.push((block_of[*to], Some((*own, *kind))));
                }
            }
        }
        for (block, before) in order {
            self.blocks.push(Block {
                atoms: found[block].clone(),
                parent: before.map(|(atom, _)| atom),
                bond: before.map_or(0, |(_, kind)| kind),
                class: 0,
                from_first: Vec::new(),
            });
        }
        for (number, block) in self.blocks.iter().enumerate().skip(self.middle) {
            block.parent.into_iter().for_each(|atom| self.branches[atom].push(number));
        }
    }

    /// Finds which branches are alike, from the leaves to the middle.
    fn classify(
        &mut self,
        ligand: &Ligand,
        near: &[Vec<Neighbour>],
        kinds: &[u8],
    ) -> Result<(), TooSymmetric> {
        let mut steps = STEPS_MAX;
        // The first block's shape of every class, with its signature.
        let mut firsts: Vec<(Shape, Signature)> = Vec::new();
        for number in (0..self.blocks.len()).rev() {
            for atom in self.blocks[number].atoms.clone() {
                let mut branches = std::mem::take(&mut self.branches[atom]);
                branches.sort_unstable_by_key(|branch| {
                    let Block { bond, class, .. } = self.blocks[*branch];
                    (bond, class, *branch)
                });
                self.branches[atom] = branches;
            }
            let shape = self.shape(number, ligand, near, kinds);
            let too_symmetric = |_| TooSymmetric { atoms: shape.labels.len() };
            let signature = shape.signature();
            let mut known = None;
            for (class, (first, other)) in firsts.iter().enumerate() {
                if *other == signature {
                    let maps = first.maps(&shape, 1, &mut steps).map_err(too_symmetric)?;
                    known = maps.into_iter().next().map(|map| (class, map));
                }
                if known.is_some() {
                    break;
                }
            }
            let (class, map) = match known {
                Some(known) => known,
                None => {
                    let maps = shape.maps(&shape, SYMMETRIES_MAX + 1, &mut steps);
                    let maps = maps.map_err(too_symmetric)?;
                    if maps.len() > SYMMETRIES_MAX {
                        return Err(TooSymmetric { atoms: shape.labels.len() });
                    }
                    let symmetries = self.symmetries_of(number, maps.len());
                    self.classes.push(Class { maps, symmetries });
                    let identity = (0..shape.labels.len()).collect();
                    firsts.push((shape, signature));
                    (firsts.len() - 1, identity)
                }
            };
            let block = &mut self.blocks[number];
            (block.class, block.from_first) = (class, map);
        }
        Ok(())
    }

    /// A block as the search for maps sees it. The classes of what hangs on it are known.
    fn shape(
        &self,
        number: usize,
        ligand: &Ligand,
        near: &[Vec<Neighbour>],
        kinds: &[u8],
    ) -> Shape {
        let block = &self.blocks[number];
        let label = |atom: &usize| {
            let hanging = self.branches[*atom].iter().map(|branch| &self.blocks[*branch]);
            let hanging = hanging.map(|branch| (branch.bond, branch.class)).collect();
            let is_entry = near[*atom].iter().any(|other| Some(other.atom) == block.parent);
            (ligand.atoms()[*atom].element.number(), is_entry, hanging)
        };
        let inside = |atom: &usize| {
            let place = |other: &Neighbour| {
                block.atoms.binary_search(&other.atom).ok().map(|place| (place, kinds[other.bond]))
            };
            near[*atom].iter().filter_map(place).collect()
        };
        Shape {
            labels: block.atoms.iter().map(label).collect(),
            neighbours: block.atoms.iter().map(inside).collect(),
        }
    }

    /// How many symmetries a branch has whose block has so many: each permutes what is alike on every atom.
    fn symmetries_of(&self, number: usize, maps: usize) -> f64 {
        let mut count = maps as f64;
        for alike in self.blocks[number].atoms.iter().flat_map(|atom| self.alike(*atom)) {
            for (before, branch) in alike.iter().enumerate() {
                count *= (before + 1) as f64 * self.classes[self.blocks[*branch].class].symmetries;
            }
        }
        count.min(f64::MAX)
    }
}

/// The middle of the tree of blocks: what is left when its leaves are taken away until one or two blocks are left.
fn middle(joints: &[Joints], block_of: &[usize]) -> Vec<usize> {
    let mut degrees: Vec<usize> = joints.iter().map(Vec::len).collect();
    let mut left: Vec<usize> = (0..joints.len()).collect();
    while left.len() > 2 {
        let leaves: Vec<usize> = left.iter().copied().filter(|b| degrees[*b] == 1).collect();
        left.retain(|block| degrees[*block] != 1);
        for leaf in leaves {
            degrees[leaf] = 0;
            for (_, to, _) in &joints[leaf] {
                let other = &mut degrees[block_of[*to]];
                *other = other.saturating_sub(1);
            }
        }
    }
    left
}

/// What each bond is to a symmetry: 0 if both its atoms can share electrons, so that its order may be that of one of several
/// structures; 1 if not. One of its atoms is then a carbon with single bonds only, so that it is single.
fn kinds(ligand: &Ligand, near: &[Vec<Neighbour>]) -> Vec<u8> {
    let shares = |atom: usize| {
        let is_multiple = |other: &Neighbour| ligand.bonds()[other.bond].order != BondOrder::Single;
        ligand.atoms()[atom].element != Element::CARBON || near[atom].iter().any(is_multiple)
    };
    let is_fixed = |bond: &Bond| bond.atoms.iter().any(|atom| !shares(*atom));
    ligand.bonds().iter().map(|bond| u8::from(is_fixed(bond))).collect()
}
