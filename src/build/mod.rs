//! Builds in this process: a problem goes in, a roadmap and its paths come out.
//!
//! [`Build`] says who does the work and who watches; [`Built`] is what came of it. Underneath is [`crate::img`],
//! which also serves executors of your own.

mod built;

pub use built::Built;

use crate::cancel::Cancel;
use crate::img::{
    self, Cut, InProcess, Job, Judgement, Observer, Progress, Round, Serial, Setup, Stop, Threads,
};
use crate::model::{FunctionFailed, with_functions};
use crate::numbers::RoundNumber;
use crate::problem::Problem;
use crate::roadmap::{Roadmap, Tally};
use std::convert::Infallible;
use std::sync::Arc;

/// Sets per thread that may be generated ahead of the current round.
const LOOKAHEAD_PER_THREAD: u64 = 4;

/// Whoever is told how far a build is.
type Tell<'a> = Box<dyn FnMut(&Progress) + 'a>;

/// A roadmap to be built in this process.
///
/// ```
/// use roadmill::{Build, problem::Problem};
///
/// let problem = Problem::load("problems/maze.toml".as_ref())?;
/// let built = Build::new(problem)
///     .threads(2)
///     .progress(|progress| eprintln!("{} nodes", progress.nodes))
///     .run()?;
/// assert!(built.path().is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// The number of threads changes how long the build takes and nothing else. A build reads no clock: the
/// problem's limit on seconds does not count here; [`Build::cancel`] can take its place. Where that was the only limit,
/// the number of nodes is limited as if there was none.
#[must_use = "nothing is built before `run`"]
pub struct Build<'a> {
    setup: Arc<Setup>,
    threads: Option<usize>,
    progress: Option<Tell<'a>>,
    cancel: Cancel,
    past: Vec<Round>,
    judgement: Option<Judgement>,
}

/// Why a build came to no roadmap.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// The system refused to start the threads.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// What the system said.
        reason: String,
    },
    /// A job that panicked as often as it was tried.
    #[error("{0} panicked {losses} times", losses = img::LOSSES_MAX)]
    Panicked(Job),
    /// The problem's validity function failed, gave two answers, or is not here.
    #[error(transparent)]
    Function(FunctionFailed),
    /// A job that came to something it cannot come to, or to two different things: the machine or the program is
    /// broken.
    #[error("{0} came to what it cannot come to: the machine or the program is broken")]
    Broken(Job),
}

impl<'a> Build<'a> {
    /// The build of a problem, in this thread.
    pub fn new(mut problem: Problem) -> Build<'a> {
        problem.limits = problem.limits_without_clock();
        Build::after(Arc::new(Setup::new(problem)), Vec::new(), None)
    }

    /// The build that goes on after these rounds; `judgement` is that of the last of them, if it was judged.
    fn after(setup: Arc<Setup>, past: Vec<Round>, judgement: Option<Judgement>) -> Build<'a> {
        let cancel = Cancel::new();
        Build { setup, threads: None, progress: None, cancel, past, judgement }
    }

    /// Works in so many threads beside this one, at least one.
    pub fn threads(self, threads: usize) -> Build<'a> {
        Build { threads: Some(threads.max(1)), ..self }
    }

    /// Calls `progress` between jobs, in this thread: often, so that it should not take long.
    pub fn progress(self, progress: impl FnMut(&Progress) + 'a) -> Build<'a> {
        Build { progress: Some(Box::new(progress)), ..self }
    }

    /// Ends the build when `cancel` says so: with the roadmap of the last complete round.
    pub fn cancel(self, cancel: &Cancel) -> Build<'a> {
        Build { cancel: cancel.clone(), ..self }
    }

    /// Builds until the problem's evaluators are satisfied, a limit is reached, a sampler gives up or the build is
    /// cancelled; [`Built::stop`] says which.
    ///
    /// # Errors
    /// When threads cannot be started, jobs panic or contradict themselves, or the problem's validity function fails.
    pub fn run(mut self) -> Result<Built, BuildError> {
        let setup = self.setup.clone();
        match self.threads {
            None => self.run_with(Serial::new(setup), 0),
            Some(threads) => {
                let executor = Threads::start(setup, threads)
                    .map_err(|error| BuildError::Threads { threads, reason: error.to_string() })?;
                self.run_with(executor, LOOKAHEAD_PER_THREAD * threads as u64)
            }
        }
    }

    fn run_with(&mut self, executor: impl InProcess, lookahead: u64) -> Result<Built, BuildError> {
        let mut watch = Watch {
            progress: self.progress.take(),
            cancel: self.cancel.clone(),
            rounds: Vec::new(),
            judgement: self.judgement.take(),
            setup: self.setup.clone(),
        };
        if let Err(message) = self.setup.problem.clone().supplied_with(None) {
            return Err(BuildError::Function(FunctionFailed { message, cause: None }));
        }
        let past = std::mem::take(&mut self.past);
        let (setup, judged) = (&self.setup, watch.judgement.clone());
        let judged = judged.filter(|judged| judged.round.next() == RoundNumber(past.len() as u64));
        let grow = || img::grow(setup, executor, lookahead, &past, judged, &mut watch);
        let (stop, roadmap): (Stop, Roadmap) =
            match with_functions(grow).map_err(BuildError::Function)? {
                Ok(ended) => ended,
                Err(never) => match never {},
            };
        if let Some(failed) = function_failure(&self.setup) {
            return Err(BuildError::Function(failed.clone()));
        }
        match stop {
            Stop::Deadly(job) => return Err(BuildError::Panicked(job)),
            Stop::Contradiction(job, _) | Stop::Nonsense(job) => {
                return Err(BuildError::Broken(job));
            }
            _ => {}
        }
        let mut rounds = past;
        rounds.append(&mut watch.rounds);
        let judgement = watch.judgement.take();
        Ok(Built { setup: self.setup.clone(), roadmap, stop, judgement, rounds })
    }
}

/// Whoever watches for the caller, and keeps what the build may go on from.
struct Watch<'a> {
    progress: Option<Tell<'a>>,
    cancel: Cancel,
    rounds: Vec<Round>,
    judgement: Option<Judgement>,
    setup: Arc<Setup>,
}

/// Why the problem's validity function failed, if it did.
fn function_failure(setup: &Setup) -> Option<&FunctionFailed> {
    setup.problem.validity_function()?.failure()
}

impl Observer for Watch<'_> {
    type Error = Infallible;

    fn folded(&mut self, round: &Round, _: &Tally) -> Result<(), Infallible> {
        self.rounds.push(round.clone());
        Ok(())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Infallible> {
        self.judgement = Some(judgement.clone());
        Ok(())
    }

    fn tick(
        &mut self,
        progress: &Progress,
        _: &Tally,
        _: usize,
    ) -> Result<Option<Cut>, Infallible> {
        if let Some(tell) = &mut self.progress {
            tell(progress);
        }
        let ends = self.cancel.is_cancelled() || function_failure(&self.setup).is_some();
        Ok(ends.then_some(Cut::Interrupted))
    }
}
