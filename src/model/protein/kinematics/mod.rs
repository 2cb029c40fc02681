//! Kinematics: from torsions to the positions of atoms.
//!
//! The chain is cut into four segments of as many residues each, and a lane places one of them: first every segment is turned in
//! a frame of its own, to see where it ends (`Chain::ends`); from the ends follows where each begins; then all atoms
//! are placed. So a single conformation is computed four residues at once. The operations and their order are the same
//! with any lanes, and so are the bits. Linkage of `linkage/` says what is computed, in its plainest form.

mod chain;
mod four;
mod frames;

use super::atoms::ResidueAtoms;
use super::linkage::Linkage;
use super::placed::{Coordinates, Placed};
use crate::lanes::{Lanes, with_lanes};
use crate::structure::Residue;
use chain::Chain;
use fearless_simd::prelude::*;

/// A chain prepared for being placed at any configuration.
#[derive(Clone, Debug)]
pub struct Conformer {
    atoms: Vec<ResidueAtoms>,
    chain: Chain,
    lanes: Lanes,
}

impl Conformer {
    /// Of a chain and its linkage. `None` where a residue lacks N, CA, C or O, or where two of these stand on one another.
    pub fn of(residues: &[Residue], linkage: &Linkage) -> Option<Conformer> {
        let atoms = ResidueAtoms::of(residues)?;
        let chain = Chain::new(&atoms, linkage)?;
        Some(Conformer { atoms, chain, lanes: Lanes::widest() })
    }

    /// The atoms of the source.
    pub fn atoms(&self) -> &[ResidueAtoms] {
        &self.atoms
    }

    /// A conformation of this chain to be filled by [`place`](Conformer::place).
    pub fn placed(&self) -> Placed {
        let zeros = || Coordinates::zeros(self.atoms.len());
        let has = |what: fn(&ResidueAtoms) -> bool| self.atoms.iter().map(what).collect();
        Placed {
            n: zeros(),
            ca: zeros(),
            c: zeros(),
            o: zeros(),
            cb: zeros(),
            centroid: zeros(),
            h: zeros(),
            has_cb: has(|atoms| atoms.cb.is_some()),
            has_centroid: has(|atoms| atoms.centroid.is_some()),
            has_hydrogen: has(|atoms| atoms.hydrogen.is_some()),
            turns: Vec::new(),
        }
    }

    /// Places the chain at the torsions `q`, in radians, as many as the linkage has. `out` is one of
    /// [`placed`](Conformer::placed).
    pub fn place(&self, q: &[f64], out: &mut Placed) {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.chain.place(simd, q, out)
        ));
    }
}

#[cfg(test)]
mod tests;
