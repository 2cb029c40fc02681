//! Samplers: how a node set chooses its milestones. One file per method.
//!
//! To add one, write its file after the pattern of `uniform.rs` and name it in the two marked
//! places below.
//!
//! ```
//! use roadmill::{model::Scratch, problem::Problem, roadmap::Configs};
//! use roadmill::sampler::{Sampler, Uniform};
//! use roadmill::{numbers::Ordinal, seed::Seed};
//!
//! let cx = Problem::load("tests/problems/slide.toml".as_ref())?.context();
//! let (seed, scratch) = (Seed::of_set(1, "uniform", Ordinal(0)), &mut Scratch::new());
//! let mut milestones = Configs::new(cx.space().len());
//! let sampled = Uniform::default().sample(&cx, &seed, 5, scratch, &mut milestones);
//! assert!(sampled.is_ok() && milestones.len() == 5);
//! assert!(milestones.iter().all(|q| cx.model().is_valid(q, scratch)));
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod bridge;
mod energy;
mod gaps;
mod gaussian;
mod given;
mod grid;
mod halton;
mod low_energy_cells;
mod maprm;
mod mix;
mod obprm;
mod protein_surface;
mod retraction;
mod segments;
mod shares;
mod torsion_noise;
mod umaprm;
mod uniform; // 1: the file
mod uobprm;

methods! {
    /// The samplers, as a problem file names them; each variant holds its settings.
    pub enum SamplerKind: dyn Sampler {
        Gaussian(gaussian::Gaussian),
        Uniform(uniform::Uniform), // 2: the method, at the end, since ledgers know methods by number
        Bridge(bridge::Bridge),
        Grid(grid::Grid),
        Halton(halton::Halton),
        Mix(mix::Mix),
        Obprm(obprm::Obprm),
        Uobprm(uobprm::Uobprm),
        Maprm(maprm::Maprm),
        Energy(energy::Energy),
        TorsionNoise(torsion_noise::TorsionNoise),
        Retraction(retraction::Retraction),
        Umaprm(umaprm::Umaprm),
        Gaps(gaps::Gaps),
        ProteinSurface(protein_surface::ProteinSurface),
        LowEnergyCells(low_energy_cells::LowEnergyCells),
        Given(given::Given),
    }
}

/// Uniform random sampling, the method of a problem that names none.
impl Default for SamplerKind {
    fn default() -> SamplerKind {
        SamplerKind::Uniform(Uniform::default())
    }
}

pub use bridge::Bridge;
pub use energy::Energy;
pub use gaps::Gaps;
pub use gaussian::Gaussian;
pub use given::Given;
pub use grid::Grid;
pub use halton::Halton;
pub use low_energy_cells::LowEnergyCells;
pub use maprm::Maprm;
pub use mix::{Mix, Share};
pub use obprm::{Obprm, Start};
pub use protein_surface::ProteinSurface;
pub use retraction::Retraction;
pub use torsion_noise::{About, CALIBRATED, FEASIBLE, TorsionNoise, WIDTHS};
pub use umaprm::Umaprm;
pub use uniform::Uniform;
pub use uobprm::Uobprm;

use crate::context::Context;
use crate::methods::{BRACKETS_OF_SETTINGS, Complaint, methods};
use crate::model::{Scratch, Validity};
use crate::roadmap::Configs;
use crate::seed::Seed;

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

    /// Finds the settings that the problem leaves open and that depend on the model. `seed` is for this alone.
    /// What it finds is part of the problem from then on.
    fn calibrate(&mut self, _cx: &Context, _seed: &Seed) {}

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }

    /// Whether sets depend on the problem's query. Then the query is part of the problem's digest, and stays what it is as long
    /// as sets of the strategy are made.
    fn reads_query(&self) -> bool {
        false
    }

    /// Whether the method, as a problem file writes it, has at most so many brackets within one another.
    fn is_within(&self, brackets: u32) -> bool {
        brackets >= BRACKETS_OF_SETTINGS
    }

    /// Whether the method is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    fn suits(&self, _cx: &Context) -> Result<(), String> {
        Ok(())
    }
}

fn default_attempts() -> u64 {
    1_000_000
}

/// Fills `out` with `count` milestones. `attempt` proposes one and says whether it is to be kept;
/// `attempts` bounds its calls per milestone.
fn collect(
    count: usize,
    attempts: u64,
    out: &mut Configs,
    mut attempt: impl FnMut(&mut [f64]) -> bool,
) -> Result<(), GaveUp> {
    let mut q = vec![0.0; out.dofs()];
    for _ in 0..count {
        let mut made = 0;
        loop {
            if made == attempts {
                return Err(GaveUp { attempts });
            }
            made += 1;
            if attempt(&mut q) {
                break;
            }
        }
        out.push(&q);
    }
    Ok(())
}

/// How samplers near obstacles take a configuration: as colliding, as free, or (`None`) as one to be dropped.
/// `bounds` says whether a configuration out of bounds is taken as colliding.
fn collides(validity: Validity, bounds: bool) -> Option<bool> {
    match validity {
        Validity::Valid => Some(false),
        Validity::Invalid => Some(true),
        Validity::OutOfBounds => bounds.then_some(true),
    }
}

/// What is wrong with a setting that must be a length.
fn no_length(key: &'static str, length: f64) -> Option<Complaint> {
    Complaint::of_length(key, length, crate::scene::LENGTH_MAX)
}

/// What is wrong with a setting that must be a number of things other than none.
fn zero(key: &'static str, count: impl Into<u64>) -> Option<Complaint> {
    (count.into() == 0).then(|| Complaint::new(key, "0", "at least 1"))
}

/// Whether a problem suits samplers near obstacles: something must be there to collide with.
fn obstructed(cx: &Context, bounds: bool) -> Result<(), String> {
    if bounds || cx.model.is_obstructed() {
        return Ok(());
    }
    let expected = "obstacles, links that must not touch, or `bounds = true` expected";
    Err(format!("a sampler near obstacles found, but nothing to collide with; {expected}"))
}

/// Whether a problem suits samplers that place a ligand at a protein.
fn at_a_protein(cx: &Context) -> Result<(), String> {
    match cx.model.ligand() {
        Some(_) => Ok(()),
        None => {
            Err("a sampler that places ligands found; a ligand at a protein expected".to_owned())
        }
    }
}

/// A sampler or a generator that could not find a milestone.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, bincode::Encode, bincode::Decode)]
#[error("no milestone in {attempts} attempts")]
pub struct GaveUp {
    /// Attempts made for the milestone that was not found.
    pub attempts: u64,
}

#[cfg(test)]
pub(crate) mod tests;
