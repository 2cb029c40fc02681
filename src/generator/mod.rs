//! Generators: what makes a node set. One file per method.
//!
//! A generator makes an increment of the roadmap, a pure function of the problem, the set's seed and what the
//! generator says that it reads. One that reads nothing, or the roadmap of a *parent* run, is given out to workers
//! ahead of the rounds; one that *grows* the roadmap reads it as it was at the start of the set's round.
//!
//! ```
//! use roadmill::generator::{Generator, Sample};
//! use roadmill::{model::Scratch, numbers::Ordinal, problem::Problem, seed::Seed};
//!
//! let cx = Problem::load("tests/problems/slide.toml".as_ref())?.context();
//! // Uniform milestones, each tried with its nearest.
//! let generator = Sample { sampler: Default::default(), within: Default::default() };
//! let seed = Seed::of_set(1, "uniform", Ordinal(0));
//! let increment = generator.generate(&cx, &seed, 20, None, &mut Scratch::new());
//! let increment = increment.expect("there is room for 20 milestones");
//! assert_eq!(increment.configs.len(), 20);
//! assert!(!increment.edges.is_empty());
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod bent_trees;
mod contact_trees;
mod elastic_growth;
mod elastic_walk;
mod end_trees;
mod expansion_step;
mod growth;
mod hint_path;
mod hinting;
mod hints;
mod hopping;
mod interpolation;
mod local_trees;
mod minima;
mod mrrg;
mod parent;
mod retraction_trees;
mod reuse;
mod rrg;
mod rrt;
mod rrt_connect;
mod sample;
mod sliding_trees;
mod survivors;
mod tree;

methods! {
    /// The generators, as a problem file names them.
    pub enum GeneratorKind: dyn Generator {
        Sample(sample::Sample),
        ExpansionStep(expansion_step::ExpansionStep),
        Reuse(reuse::Reuse),
        ElasticGrowth(elastic_growth::ElasticGrowth),
        Interpolation(interpolation::Interpolation),
        Rrt(rrt::Rrt),
        Rrg(rrg::Rrg),
        Mrrg(mrrg::Mrrg),
        Tree(tree::Tree),
        RrtConnect(rrt_connect::RrtConnect),
        Survivors(survivors::Survivors),
        EndTrees(end_trees::EndTrees),
        RetractionTrees(retraction_trees::RetractionTrees),
        Hints(hints::Hints),
        ContactTrees(contact_trees::ContactTrees),
        SlidingTrees(sliding_trees::SlidingTrees),
        LocalTrees(local_trees::LocalTrees),
        Minima(minima::Minima),
        Hopping(hopping::Hopping), // new ones at the end, since ledgers know methods by number
    }
}

pub use crate::finder::NeighborCount;
pub use bent_trees::BentTrees;
pub use contact_trees::ContactTrees;
pub use elastic_growth::{ElasticGrowth, GrowthAim};
pub use end_trees::EndTrees;
pub use expansion_step::ExpansionStep;
pub use growth::{FoundNeighbors, GraphNeighbors};
pub use hint_path::HintPath;
pub(crate) use hint_path::{CONFIGURATIONS_MAX, too_long};
pub use hints::Hints;
pub use hopping::Hopping;
pub use interpolation::Interpolation;
pub use local_trees::LocalTrees;
pub use minima::Minima;
pub use mrrg::Mrrg;
pub use parent::{NoRuns, Parent, ParentRoadmap, ParentRun, Runs};
pub use retraction_trees::RetractionTrees;
pub use reuse::Reuse;
pub use rrg::Rrg;
pub use rrt::Rrt;
pub use rrt_connect::RrtConnect;
pub use sample::Sample;
pub use sliding_trees::SlidingTrees;
pub use survivors::{Start, Survived, Survivors};
pub use tree::Tree;

use crate::context::Context;
use crate::digest::Digest;
use crate::methods::{Complaint, methods};
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::{GaveUp, SamplerKind};
use crate::seed::Seed;

/// The most attempts of a generator for one milestone, each of which draws a configuration or a motion.
const ATTEMPTS_MAX: u64 = 1_000_000_000;

/// What a generator reads beside the problem and its seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// Nothing: sets can be made in any order, in any place, at any time.
    Nothing,
    /// The roadmap as it was at the start of the set's round.
    Roadmap,
    /// The roadmap of another run, which is part of the problem; the digest is the hash of the run's ledger.
    /// Sets can be made in any order, in any place, at any time.
    Parent(Digest),
}

/// A way of making node sets.
pub trait Generator {
    /// What the method reads.
    fn reads(&self) -> Reads {
        Reads::Nothing
    }

    /// Makes an increment of `count` milestones. All randomness comes from the streams of `seed`. `frozen` is
    /// the roadmap at the start of the round, for a method that [`reads`](Generator::reads) it; for others it
    /// is to be passed over.
    ///
    /// # Errors
    /// [`GaveUp`] when the method's bound on attempts is reached; it never spins.
    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp>;

    /// The run whose roadmap the method reads.
    fn parent(&self) -> Option<&Parent> {
        None
    }

    /// The same, to take the roadmap in.
    fn parent_mut(&mut self) -> Option<&mut Parent> {
        None
    }

    /// The approximate paths that the method goes by, to be read.
    fn hint_paths_mut(&mut self) -> Vec<&mut HintPath> {
        Vec::new()
    }

    /// Whether sets depend on the problem's query, see [`Sampler::reads_query`](crate::sampler::Sampler::reads_query).
    fn reads_query(&self) -> bool {
        false
    }

    /// Finds the settings that the problem leaves open and that depend on the model. `seed` is for this alone.
    /// What it finds is part of the problem from then on.
    fn calibrate(&mut self, _cx: &Context, _seed: &Seed) {}

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }

    /// Whether the method is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    fn suits(&self, _cx: &Context) -> Result<(), String> {
        Ok(())
    }
}

impl GeneratorKind {
    /// The sampler and the connection within sets, of the method that has them.
    pub fn as_sample(&self) -> Option<&Sample> {
        match self {
            GeneratorKind::Sample(sample) => Some(sample),
            _ => None,
        }
    }

    /// The sampler of a method that has one.
    pub(crate) fn sampler(&self) -> Option<&SamplerKind> {
        match self {
            GeneratorKind::Sample(sample) => Some(&sample.sampler),
            GeneratorKind::Tree(tree) => Some(&tree.sampler),
            GeneratorKind::Minima(minima) => Some(&minima.sampler),
            _ => None,
        }
    }

    /// Whether the method reads the roadmap at the start of its sets' rounds.
    pub fn grows(&self) -> bool {
        self.method().reads() == Reads::Roadmap
    }
}

#[cfg(test)]
mod elastic_tests;
#[cfg(test)]
mod tests;
