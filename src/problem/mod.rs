//! Problems: what is to be planned and how, read from TOML or made from a program's values, and checked before any work
//! starts.
//!
//! `docs/problems.md` describes the file format; [`ProblemBuilder`] takes values.

mod builder;
mod building;
mod changes;
mod chapter;
mod configuration;
mod describe;
mod docking;
mod ends;
mod file;
mod folding;
mod function;
mod goals;
mod hint_files;
mod hinted;
mod import;
mod layout;
mod level;
mod limits;
mod poses;
mod replan;
mod resolve;
mod strategy;
mod transition;
mod write;

pub use crate::source::ProblemError;
use crate::source::read_file;
pub use builder::ProblemBuilder;
pub use changes::ChangedKey;
pub use chapter::EarlierSchedule;
pub use configuration::{configuration, configuration_at_all};
pub use docking::{AffinitySearch, PoseSearch, affinity, docking};
pub use ends::ConfigurationSpec;
pub use folding::folding;
pub use hint_files::read_path;
pub use layout::Layout;
pub use level::{EarlierLevel, NoLevel};
pub use limits::{Limits, NODES_MAX};
pub use poses::PoseSpec;
pub use replan::{Components, OldRun, Replanned, Replanning};
pub use strategy::StrategySpec;
pub use transition::{HOLD, Relaxed, Transition, about_native, transition};
pub use write::Written;

use crate::context::{Context, Ends};
use crate::digest::{Digest, SourceFile};
use crate::evaluate::EvaluatorKind;
use crate::generator::{NoRuns, Runs};
use crate::model::{self, ModelKind, SceneOptions, ValidityFunction};
use crate::numbers::StrategyIndex;
use crate::query::Attachment;
use crate::relaxation::Settings;
use crate::scene::is_mesh_file;
use crate::schedule::Adaptive;
use crate::space::Space;
use crate::strategy::Strategy;
use std::path::Path;

/// The base seed of a problem that names none.
pub const DEFAULT_SEED: u64 = 1;

/// A checked problem: plain data, complete in itself (meshes included), so that every process that
/// has its bytes computes the same. It comes from a file ([`Problem::load`]) or from values ([`Problem::builder`]), and
/// what would not pass their checks cannot be said.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Its name: that of its file unless it says otherwise.
    pub(crate) name: String,
    /// The base seed.
    pub(crate) seed: u64,
    /// What is planned for.
    pub(crate) model: ModelKind,
    /// A function that judges configurations beside the model, if the problem has one.
    pub(crate) function: Option<ValidityFunction>,
    /// Start and goal.
    pub(crate) query: Option<Ends>,
    /// The strategies.
    pub(crate) strategies: Vec<Strategy>,
    /// Which strategy makes the next set; set by set, over and over.
    pub(crate) schedule: Vec<StrategyIndex>,
    /// Where the schedule adapts: how sets are given out among those of `schedule`.
    pub(crate) adaptive: Option<Adaptive>,
    /// Sets per round (TR05-007: *k*).
    pub(crate) sets_per_round: u32,
    /// The criteria that a finished roadmap meets, all of them.
    pub(crate) evaluators: Vec<EvaluatorKind>,
    /// Bounds on the build.
    pub(crate) limits: Limits,
    /// Whether the limit on nodes was given, rather than left open. Ledgers do not say so: of a problem that comes from
    /// one it is told by the number.
    pub(crate) nodes_are_given: bool,
    /// What was chosen where the file leaves a choice, for people to read.
    pub(crate) notes: Vec<String>,
    /// The files that were read, first its own, if it came from one.
    pub(crate) sources: Vec<SourceFile>,
    /// Of a build that was continued with another schedule: what came before, in order.
    pub(crate) earlier: Vec<EarlierSchedule>,
    /// How the problem is relaxed where it is too hard, if it says so. It changes nothing of what the problem itself builds: it is no
    /// part of the digest, and ledgers do not keep it.
    pub(crate) relaxation: Option<Settings>,
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
        let bytes = read_file(path).map_err(|error| {
            ProblemError::file(path, format!("cannot read the problem: {error}"))
        })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = 1 + valid.iter().filter(|byte| **byte == b'\n').count();
            let message = "not UTF-8 text; a problem file, which is TOML, expected";
            ProblemError::line(path, line, message)
        })?;
        resolve::resolve_text(path, &text, runs)
    }

    /// Reads and checks a problem's text, which names no run, as if it stood in the file `path`.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place in the file.
    pub fn parse(path: &Path, text: &str) -> Result<Problem, ProblemError> {
        resolve::resolve_text(path, text, &NoRuns)
    }

    /// The digest of all that determines the entries of a ledger: two problems with the same
    /// digest grow the same sets and join them in the same way. The name, the criteria and the
    /// limits do not count.
    pub fn digest(&self) -> Digest {
        layout::digest(self)
    }

    /// Its name: that of its file unless the file says otherwise.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The base seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// What is planned for.
    pub fn model(&self) -> &ModelKind {
        &self.model
    }

    /// Start and goal.
    pub fn query(&self) -> Option<&Ends> {
        self.query.as_ref()
    }

    /// The strategies, at least one.
    pub fn strategies(&self) -> &[Strategy] {
        &self.strategies
    }

    /// Which strategy makes the next set; set by set, over and over.
    pub fn schedule(&self) -> &[StrategyIndex] {
        &self.schedule
    }

    /// Where the schedule adapts: how sets are given out among those of the schedule.
    pub fn adaptive(&self) -> Option<Adaptive> {
        self.adaptive
    }

    /// Sets per round (TR05-007: *k*), at least one.
    pub fn sets_per_round(&self) -> u32 {
        self.sets_per_round
    }

    /// The criteria that a finished roadmap meets, all of them.
    pub fn evaluators(&self) -> &[EvaluatorKind] {
        &self.evaluators
    }

    /// Bounds on the build.
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// Whether the limit on nodes was left open: then it goes by memory, or by a limit of time.
    pub fn leaves_nodes_open(&self) -> bool {
        !self.nodes_are_given
    }

    /// The limit on nodes as a problem file says it; `None` where it is what a file has that does not say it.
    pub(crate) fn nodes_to_say(&self) -> Option<u64> {
        let mut open = Limits::left_open(&self.space());
        if self.limits.seconds.is_some() {
            open = open.with_time(&self.space());
        }
        let is_said = self.nodes_are_given || self.limits.nodes != open.nodes;
        is_said.then_some(self.limits.nodes)
    }

    /// What was chosen where the problem leaves a choice, for people to read.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The files that were read, first the problem's own, if it came from one.
    pub fn sources(&self) -> &[SourceFile] {
        &self.sources
    }

    /// The files that were read beside the problem's own: what its meshes and robots come from. A file is taken for
    /// the problem's own if it comes first and is no mesh.
    pub fn other_sources(&self) -> &[SourceFile] {
        let own = self.sources.first().is_some_and(|file| !is_mesh_file(Path::new(&file.path)));
        &self.sources[usize::from(own)..]
    }

    /// Of a build that was continued with another schedule: what came before, in order.
    pub fn earlier(&self) -> &[EarlierSchedule] {
        &self.earlier
    }

    /// The problem with another base seed.
    pub fn with_seed(self, seed: u64) -> Problem {
        Problem { seed, ..self }
    }

    /// The problem with other bounds on the build. A number of nodes that was left open counts as given if it becomes
    /// one that no problem has which leaves it open.
    ///
    /// # Errors
    /// When one of them bounds nothing: no nodes, no sets, or seconds that are not a positive number.
    pub fn with_limits(self, limits: Limits) -> Result<Problem, ProblemError> {
        match limits.complaint() {
            Some((key, message)) => Err(ProblemError::pathless(format!("limits.{key}: {message}"))),
            None => {
                let is_given = !limits.leaves_nodes_open(&self.space());
                let nodes_are_given = self.nodes_are_given || is_given;
                Ok(Problem { limits, nodes_are_given, ..self })
            }
        }
    }

    /// The limits of a build of it that reads no clock.
    pub(crate) fn limits_without_clock(&self) -> Limits {
        if self.nodes_are_given { self.limits } else { self.limits.without_clock(&self.space()) }
    }

    /// The problem whose limit on nodes counts as given, whatever the number.
    pub fn with_nodes_given(self) -> Problem {
        Problem { nodes_are_given: true, ..self }
    }

    /// The configuration space.
    pub fn space(&self) -> Space {
        self.model.description().space()
    }

    /// Makes the problem ready for work.
    pub fn context(&self) -> Context {
        Context {
            space: self.space(),
            model: self.prepared_model(),
            base_seed: self.seed,
            query: self.query.clone(),
            tries_direct_motion: true,
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
mod level_tests;
#[cfg(test)]
mod soundness_tests;
#[cfg(test)]
mod tests;
