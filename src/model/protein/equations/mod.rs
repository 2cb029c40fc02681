//! Linear equations for small steps of a chain: how sites move with torsions, and sums of squares of positions and distances.
//!
//! A refit minimizes such sums, and an elastic network is one. The unknowns are six of the chain's pose ([`POSE`]), a turn about
//! the axes and a shift along them, and then the torsions in their order, in radians.

mod cholesky;
mod contacts;
mod lines;
mod normal;
mod pulls;
mod screws;
mod sites;

pub use cholesky::{Factor, Symmetric};
pub use contacts::{Contact, Contacts, Exceptions};
pub use lines::{Line, add_lines};
pub use normal::NormalEquations;
pub use pulls::{POSE, Pull, add_pulls, columns};
pub use screws::{Screw, distance_gradient, screws};
pub use sites::{FITTED, Kind, Sites};
