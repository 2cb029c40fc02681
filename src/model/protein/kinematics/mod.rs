//! Kinematics: from torsions to the positions of atoms.

use super::atoms::ResidueAtoms;
use super::linkage::Linkage;
use super::placed::{Coordinates, Placed};
use crate::structure::{Point, Residue};

/// A chain prepared for being placed at any configuration.
#[derive(Clone, Debug)]
pub struct Conformer {
    atoms: Vec<ResidueAtoms>,
    linkage: Linkage,
}

impl Conformer {
    /// Of a chain and its linkage. `None` where a residue lacks N, CA, C or O.
    pub fn of(residues: &[Residue], linkage: &Linkage) -> Option<Conformer> {
        Some(Conformer { atoms: ResidueAtoms::of(residues)?, linkage: linkage.clone() })
    }

    /// The atoms of the source.
    pub fn atoms(&self) -> &[ResidueAtoms] {
        &self.atoms
    }

    /// A conformation of this chain to be filled by [`place`](Conformer::place).
    pub fn placed(&self) -> Placed {
        let zeros = || Coordinates::zeros(self.atoms.len());
        Placed {
            n: zeros(),
            ca: zeros(),
            c: zeros(),
            o: zeros(),
            cb: zeros(),
            centroid: zeros(),
            h: zeros(),
            has_cb: self.atoms.iter().map(|atoms| atoms.cb.is_some()).collect(),
            has_centroid: self.atoms.iter().map(|atoms| atoms.centroid.is_some()).collect(),
            has_hydrogen: self.atoms.iter().map(|atoms| atoms.hydrogen.is_some()).collect(),
        }
    }

    /// Places the chain at the torsions `q`, in radians, as many as the linkage has. `out` is one of
    /// [`placed`](Conformer::placed).
    pub fn place(&self, q: &[f64], out: &mut Placed) {
        let motions = self.linkage.motions(q);
        for (residue, atoms) in self.atoms.iter().enumerate() {
            let body = |name: &str| &motions[self.linkage.body(residue, name)];
            let at = |name: &str, position: &Point| body(name).apply(position);
            let ca = at("CA", &atoms.ca);
            let or_ca = |name: &str, position: &Option<Point>| {
                position.as_ref().map_or(ca, |position| at(name, position))
            };
            out.n.put(residue, &at("N", &atoms.n));
            out.ca.put(residue, &ca);
            out.c.put(residue, &at("C", &atoms.c));
            out.o.put(residue, &at("O", &atoms.o));
            out.cb.put(residue, &or_ca("CB", &atoms.cb));
            out.centroid.put(residue, &or_ca("CB", &atoms.centroid));
            out.h.put(residue, &or_ca("H", &atoms.hydrogen));
        }
    }
}
