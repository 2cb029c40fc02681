//! Proteins: chains whose backbone torsions turn.

pub mod linkage;
pub mod motion;
