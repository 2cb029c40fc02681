//! What is measured of structures, one file per measure.
//!
//! Lengths are in Å, areas in Å², angles in radians.

mod jacobi;
mod rmsd;
mod superposition;

pub use rmsd::{CentredPoints, rmsd, rmsd_in_place};
pub use superposition::{Superposition, centroid, superpose};
