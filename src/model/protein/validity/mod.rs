//! Which conformations are possible: no two parts of the chain are too close.

mod check;
mod known;
mod list;
mod near;
mod obstacles;
mod pairs;
mod rules;
mod screen;

pub use obstacles::Obstacles;
pub use pairs::{Atom, Counts, Rule, Violation};
pub use rules::{Limits, Rules};
pub use screen::Screen;

#[cfg(test)]
mod tests;
