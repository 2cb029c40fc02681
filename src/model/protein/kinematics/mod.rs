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
use super::placed::{Placed, Row, SITES};
use crate::lanes::{Lanes, with_lanes};
use crate::structure::Residue;
use chain::Chain;
use fearless_simd::prelude::*;
use std::sync::Arc;

/// A chain prepared for being placed at any configuration.
#[derive(Clone, Debug)]
pub struct Conformer {
    atoms: Vec<ResidueAtoms>,
    chain: Chain,
    /// By which conformations of this chain are known.
    name: Arc<()>,
    lanes: Lanes,
}

impl Conformer {
    /// Of a chain and its linkage. `None` where a residue lacks N, CA, C or O, or where two of these stand on one another.
    pub fn of(residues: &[Residue], linkage: &Linkage) -> Option<Conformer> {
        let atoms = ResidueAtoms::of(residues)?;
        let chain = Chain::new(&atoms, linkage)?;
        Some(Conformer { atoms, chain, name: Arc::new(()), lanes: Lanes::widest() })
    }

    /// The atoms of the source.
    pub fn atoms(&self) -> &[ResidueAtoms] {
        &self.atoms
    }

    /// A conformation of this chain to be filled by [`place`](Conformer::place).
    pub fn placed(&self) -> Placed {
        let has = |what: fn(&ResidueAtoms) -> bool| self.atoms.iter().map(what).collect();
        Placed {
            rows: vec![Row([[0.0; SITES]; 3]); self.atoms.len()],
            has_cb: has(|atoms| atoms.cb.is_some()),
            has_centroid: has(|atoms| atoms.centroid.is_some()),
            has_hydrogen: has(|atoms| atoms.hydrogen.is_some()),
            turns: Vec::new(),
            chain: None,
        }
    }

    /// Places the chain at the torsions `q`, in radians, as many as the linkage has. `out` is one of
    /// [`placed`](Conformer::placed).
    pub fn place(&self, q: &[f64], out: &mut Placed) {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.chain.place(simd, q, out)
        ));
        if !out.chain.as_ref().is_some_and(|chain| Arc::ptr_eq(chain, &self.name)) {
            out.chain = Some(self.name.clone());
        }
    }
}

#[cfg(test)]
mod tests;
