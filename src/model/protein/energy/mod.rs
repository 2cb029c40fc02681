//! The energy of a conformation, in model kJ/mol: one file per term.
//!
//! Constraints come from known structures, which makes this a Gō-type model: it knows its native states, and its numbers are
//! no rates.

mod constraints;
mod hydrophobic;
mod mixture;

pub use constraints::{Constraint, ConstraintKind, Constraints};
pub use hydrophobic::Hydrophobic;
pub use mixture::{Mixing, Mixture};
