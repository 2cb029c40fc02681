//! Which conformations are possible: no two parts of the chain are too close.

mod pairs;
mod rules;

pub use pairs::{Atom, Counts, Obstacles, Rule, Violation};
pub use rules::{Limits, Rules};
