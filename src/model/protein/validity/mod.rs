//! Which conformations are possible: no two parts of the chain are too close.

mod check;
mod known;
mod list;
mod near;
mod pairs;
mod rules;
mod screen;

pub use pairs::{Atom, Counts, Obstacles, Rule, Violation};
pub use rules::{Limits, Rules};
pub use screen::Screen;

#[cfg(test)]
mod tests;
