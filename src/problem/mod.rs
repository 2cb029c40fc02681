//! Problems: what is to be planned and how, read from TOML and checked before any work starts.
//!
//! `docs/problems.md` describes the file format.

mod building;
mod chapter;
mod configuration;
mod describe;
mod file;
mod import;
mod layout;
mod resolve;
mod write;

pub use crate::source::ProblemError;
pub use chapter::Earlier;
pub use configuration::configuration;
pub use layout::Layout;
pub use write::Written;

use crate::context::{Context, Ends};
use crate::digest::{Digest, SourceFile};
use crate::evaluate::EvaluatorKind;
use crate::generator::{NoRuns, Runs};
use crate::model::{self, ModelKind, SceneOptions};
use crate::query::Attachment;
use crate::schedule::Adaptive;
use crate::space::Space;
use crate::strategy::Strategy;
use bincode::{Decode, Encode};
use std::path::Path;

/// The base seed of a problem that names none.
pub const DEFAULT_SEED: u64 = 1;

/// A checked problem: plain data, complete in itself (meshes included), so that every process that
/// has its bytes computes the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Its name: that of its file unless it says otherwise.
    pub name: String,
    /// The base seed.
    pub seed: u64,
    /// What is planned for.
    pub model: ModelKind,
    /// Start and goal.
    pub query: Option<Ends>,
    /// The strategies.
    pub strategies: Vec<Strategy>,
    /// Indices of strategies; set by set, over and over.
    pub schedule: Vec<u32>,
    /// Where the schedule adapts: how sets are given out among those of `schedule`.
    pub adaptive: Option<Adaptive>,
    /// Sets per round (TR05-007: *k*).
    pub sets_per_round: u32,
    /// The criteria that a finished roadmap meets, all of them.
    pub evaluators: Vec<EvaluatorKind>,
    /// Bounds on the build.
    pub limits: Limits,
    /// What was chosen where the file leaves a choice, for people to read.
    pub notes: Vec<String>,
    /// The files that it was read from, its own first.
    pub sources: Vec<SourceFile>,
    /// Of a build that was continued with another schedule: what came before, in order.
    pub earlier: Vec<Earlier>,
}

/// Bounds on a build. It stops at the end of the first round that reaches one.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Limits {
    /// Nodes of the roadmap.
    pub nodes: u64,
    /// Node sets.
    pub sets: u64,
    /// Wall-clock seconds. The only limit under which two runs may end at different rounds.
    pub seconds: Option<f64>,
}

impl Problem {
    /// Reads and checks a problem file: TOML, a scene of OMPL.app (`.cfg`) or Parasol (`.env`), or a robot
    /// alone (`.urdf`), see `docs/foreign.md`. Relative paths of meshes start from the file's folder.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the file.
    pub fn load(path: &Path) -> Result<Problem, ProblemError> {
        Problem::load_with(path, &SceneOptions::default(), &NoRuns)
    }

    /// [`Problem::load`] with what is to be taken where a scene of another program leaves a choice, and with a
    /// reader of the runs whose roadmaps the problem's generators read.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the file.
    pub fn load_with(
        path: &Path,
        options: &SceneOptions,
        runs: &dyn Runs,
    ) -> Result<Problem, ProblemError> {
        if let Some(imported) = model::import(path, options) {
            return imported.and_then(|imported| import::problem_of(path, imported));
        }
        let text = std::fs::read_to_string(path).map_err(|error| {
            ProblemError::file(path, format!("cannot read the problem: {error}"))
        })?;
        resolve::resolve(path, &text, runs)
    }

    /// Reads and checks a problem's text, which names no run, as if it stood in the file `path`.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the file.
    pub fn parse(path: &Path, text: &str) -> Result<Problem, ProblemError> {
        resolve::resolve(path, text, &NoRuns)
    }

    /// The digest of all that determines the entries of a ledger: two problems with the same
    /// digest grow the same sets and join them in the same way. The name, the criteria and the
    /// limits do not count.
    pub fn digest(&self) -> Digest {
        layout::digest(self)
    }

    /// The configuration space.
    pub fn space(&self) -> Space {
        self.model.description().space()
    }

    /// Makes the problem ready for work.
    pub fn context(&self) -> Context {
        Context {
            space: self.space(),
            model: self.model.description().prepare(),
            base_seed: self.seed,
            query: self.query.clone(),
        }
    }

    /// How configurations are attached to a roadmap of the problem: as its first evaluator does that attaches
    /// any, or else with the default settings.
    pub fn attachment(&self) -> Attachment {
        let attachment = self.evaluators.iter().find_map(|kind| kind.method().attachment());
        attachment.unwrap_or_default()
    }

    /// What would be built, for people to read: grammar of configurations, scene, strategies,
    /// criteria and limits, and every choice the program made itself.
    pub fn describe(&self) -> String {
        describe::describe(self)
    }
}

#[cfg(test)]
mod soundness_tests;
#[cfg(test)]
mod tests;
