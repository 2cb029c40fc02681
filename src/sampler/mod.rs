//! Samplers: how a node set chooses its milestones. One file per method.
//!
//! To add one, write its file after the pattern of `uniform.rs` and name it in the two marked
//! places below.

mod gaussian;
mod uniform; // 1: the file

methods! {
    /// The samplers, as a problem file names them; each variant holds its settings.
    pub enum SamplerKind: dyn Sampler {
        Gaussian(gaussian::Gaussian),
        Uniform(uniform::Uniform), // 2: the method
    }
}

pub use gaussian::Gaussian;
pub use uniform::Uniform;

use crate::context::Context;
use crate::methods::{Complaint, methods};
use crate::roadmap::Configs;
use crate::seed::Seed;
use crate::validity::Scratch;

/// A sampling method.
pub trait Sampler {
    /// Appends `count` milestones, valid and in stored form, to `out`. All randomness comes from
    /// the streams of `seed`, so the same seed gives the same milestones.
    ///
    /// # Errors
    /// [`GaveUp`] when the method's bound on attempts is reached; it never spins.
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp>;

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }
}

/// A sampler that could not find a milestone.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, bincode::Encode, bincode::Decode)]
#[error("no milestone in {attempts} attempts")]
pub struct GaveUp {
    /// Attempts made for the milestone that was not found.
    pub attempts: u64,
}

#[cfg(test)]
mod tests;
