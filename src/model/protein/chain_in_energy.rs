//! The model: a chain made ready for work.

use super::atoms::ResidueAtoms;
use super::energy::{Constraints, Hydrophobic, Mixture, carried_over, constraints_of};
use super::kinematics::Conformer;
use super::motion::{MotionLimits, Motions, MotionScratch};
use super::placed::Placed;
use super::validity::{Limits, Obstacles};
use super::{ENERGY, Protein};
use crate::model::{Cost, Directed, Model, ModelScratch, NodeValue, Scratch, Validity};
use crate::space::Space;

/// A protein whose torsions turn, in its energy.
pub(super) struct ChainInEnergy {
    space: Space,
    native: Vec<f64>,
    conformer: Conformer,
    limits: Limits,
    obstacles: Obstacles,
    motions: Motions,
    energy: Mixture,
    highest: Option<f64>,
    step: f64,
}

/// A conformation, and what motions are looked at with.
#[derive(Default)]
pub(super) struct ProteinScratch {
    placed: Placed,
    motion: MotionScratch,
}
