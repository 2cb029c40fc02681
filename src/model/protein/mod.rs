//! Proteins: chains whose backbone torsions turn.

pub mod atoms;
#[cfg(test)]
mod chains;
pub mod energy;
pub mod kinematics;
pub mod linkage;
pub mod motion;
pub mod placed;
pub mod validity;
