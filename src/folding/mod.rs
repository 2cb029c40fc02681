//! Folding: in which order the parts of a protein's native structure form, over all pathways of a roadmap.
//!
//! A roadmap of a protein that reaches from the native conformation to unstructured ones holds a pathway from each of these: the
//! route of the least cost, Σ −ln P, to the native conformation. Along a pathway a part of the native structure, a helix, a
//! strand, or the pairing of two, is *formed* where a share of its native contacts is there and stays until the
//! end. The orders in which parts form, counted over all pathways, are what is compared with experiments: N. M. Amato & G. Song,
//! *Using motion planning to study protein folding pathways*, J. Comput. Biol. 9 (2002) 149; S. Nath, *Multi-directional
//! rapidly exploring random graph (mRRG) for motion planning*, thesis, Texas A&M 2013, §5.3. `docs/folding.md` says what is taken
//! where they are silent.
//!
//! Contacts are Cα contacts: at most 7 Å apart, of residues at least four places apart along the chain.

mod examples;
mod formation;
mod native;
mod orders;
mod pathways;

pub use examples::examples;
pub use formation::{Formation, Settings};
pub use native::{Native, Part};
pub use orders::{Order, Precedence};

#[cfg(test)]
mod tests;
