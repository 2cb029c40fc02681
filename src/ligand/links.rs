//! Torsion links: the bonds about which a ligand turns.

use super::graph::{in_rings, neighbours};
use super::perceive::is_single_by_length;
use super::{Atom, Bond, BondOrder, Element, Ligand};

/// Which bonds are torsion links.
///
/// A link is a single bond that is part of no ring, with another heavy neighbour at both ends: a rotation about any
/// other bond changes nothing but where hydrogens are (O. B. Bayazit, "Solving Motion Planning Problems by Iterative
/// Relaxation of Constraints", PhD thesis, Texas A&M University 2003, chapter V; H.-Y. Yeh, PhD thesis, Texas A&M
/// University 2016, chapter 6). With amides among the links the rule gives the degrees of freedom of Bayazit's Table IV.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkRule {
    /// Whether the bond between a carbonyl's carbon and nitrogen is a link. Such bonds turn hardly at room temperature;
    /// the table counts them.
    pub amides: bool,
}

impl Default for LinkRule {
    fn default() -> LinkRule {
        LinkRule { amides: true }
    }
}

impl Ligand {
    /// The torsion links by a rule, as numbers of [bonds](Ligand::bonds), in rising order.
    pub fn torsion_links(&self, rule: LinkRule) -> Vec<usize> {
        let neighbours = neighbours(self.atoms().len(), self.bonds());
        let is_in_ring = in_rings(&neighbours, self.bonds().len());
        let heavy: Vec<usize> = neighbours
            .iter()
            .map(|of| of.iter().filter(|other| self.is_heavy(other.atom)).count())
            .collect();
        let is_carbonyl = |atom: usize| {
            self.atoms()[atom].element == Element::CARBON
                && neighbours[atom].iter().any(|other| {
                    let order = self.bonds()[other.bond].order;
                    let is_unknown = order == BondOrder::Unknown
                        && heavy[other.atom] == 1
                        && neighbours[atom].len() <= 3;
                    [Element::OXYGEN, Element::SULPHUR].contains(&self.atoms()[other.atom].element)
                        && (order == BondOrder::Double || is_unknown)
                })
        };
        let is_amide = |[a, b]: [usize; 2]| {
            let is_nitrogen = |atom: usize| self.atoms()[atom].element == Element::NITROGEN;
            is_nitrogen(a) && is_carbonyl(b) || is_nitrogen(b) && is_carbonyl(a)
        };
        let is_link = |(bond, Bond { atoms: [a, b], .. }): (usize, &Bond)| {
            !is_in_ring[bond]
                && [*a, *b].iter().all(|atom| self.is_heavy(*atom) && heavy[*atom] >= 2)
                && self.is_single(bond)
                && (rule.amides || !is_amide([*a, *b]))
        };
        let bonds = self.bonds().iter().enumerate();
        bonds.filter(|bond| is_link(*bond)).map(|(number, _)| number).collect()
    }

    /// The degrees of freedom of the ligand as a linkage with a free base: 6 of the base, one for each torsion link.
    pub fn degrees_of_freedom(&self, rule: LinkRule) -> usize {
        6 + self.torsion_links(rule).len()
    }

    /// How many atoms are not hydrogen.
    pub fn heavy_atoms(&self) -> usize {
        self.atoms().iter().filter(|atom| atom.element.is_heavy()).count()
    }

    fn is_heavy(&self, atom: usize) -> bool {
        self.atoms()[atom].element.is_heavy()
    }

    /// Whether a bond outside of rings is single, by its order or, where that is unknown, by its length.
    fn is_single(&self, bond: usize) -> bool {
        let Bond { atoms, order } = self.bonds()[bond];
        let [first, second]: [&Atom; 2] = atoms.map(|atom| &self.atoms()[atom]);
        match order {
            BondOrder::Single => true,
            BondOrder::Unknown => is_single_by_length(first, second),
            BondOrder::Double | BondOrder::Triple | BondOrder::Aromatic => false,
        }
    }
}
