//! Incremental Map Generation (D. Xie, S. Thomas, J.-M. Lien, N. M. Amato, TR05-007): a roadmap
//! grown from independently seeded node sets until its evaluators are content.
//!
//! [`Core`] decides, without any input or output; an [`Executor`] works: [`Serial`], [`Threads`]
//! (rayon), [`Simulated`] here, worker processes in the coordinator. [`drive`] brings the two
//! together. Programs that want a roadmap and no more use [`Build`](crate::Build), which is made of this.
//! Whatever the executor does (reorder, repeat, lose), the roadmap is the same.

mod canary;
mod core;
mod drive;
mod job;
mod replica;
mod serial;
mod simulated;
mod threads;

pub use self::core::{
    Command, Core, Cut, Event, Judgement, LOSSES_MAX, Loss, Past, Progress, Stop,
};
pub use crate::roadmap::{Joined, Round, RoundSet};
pub use crate::schedule::Plan;
pub use canary::{canaries, canary};
pub use drive::{Executor, InProcess, Observer, TICK, drive};
pub use job::{Finished, Job, Outcome, Task};
pub use replica::{Front, Replica};
pub use serial::Serial;
pub use simulated::{Memo, Simulated};
pub use threads::Threads;

use crate::context::Context;
use crate::model::Model;
use crate::numbers::StrategyIndex;
use crate::problem::Problem;
use crate::roadmap::Roadmap;
use std::sync::Arc;

/// A problem set up for building.
pub struct Setup {
    /// The problem.
    pub(crate) problem: Problem,
    /// The problem made ready for work.
    pub(crate) cx: Context,
    /// Which set comes where.
    pub(crate) plan: Plan,
}

impl Setup {
    /// Sets a problem up.
    pub fn new(problem: Problem) -> Setup {
        let cx = problem.context();
        let plan = Plan::new(&problem);
        Setup { problem, cx, plan }
    }

    /// The problem.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The problem made ready for work.
    pub fn context(&self) -> &Context {
        &self.cx
    }

    /// The problem made ready for work, so that it can be changed how it is worked on.
    pub fn context_mut(&mut self) -> &mut Context {
        &mut self.cx
    }

    /// Which set comes where.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Puts the model into another that answers as it does, one that counts or times what is asked, say. A model that
    /// answers otherwise makes a roadmap that is none of the problem.
    pub fn wrap_model(mut self, wrap: impl FnOnce(Box<dyn Model>) -> Box<dyn Model>) -> Setup {
        self.cx.model = wrap(self.cx.model);
        self
    }

    /// Whether the sets of a strategy grow from the roadmap at the start of their round.
    pub fn grows(&self, strategy: StrategyIndex) -> bool {
        self.problem.strategies[strategy.index()].generator.grows()
    }
}

/// What the functions here build: the lower layer of [`Built`](crate::Built).
pub struct Grown {
    /// The roadmap.
    pub roadmap: Roadmap,
    /// Why the build stopped.
    pub stop: Stop,
    /// What the evaluators said last.
    pub judgement: Option<Judgement>,
}

/// Builds a roadmap in this thread. The problem's limit on seconds is left to programs that have
/// a clock.
pub fn build(setup: &Arc<Setup>) -> Grown {
    build_with(setup, Serial::new(setup.clone()), 0)
}

/// Builds a roadmap in `threads` threads of this process: the same roadmap as [`build`].
pub fn build_in_threads(setup: &Arc<Setup>, threads: usize) -> Grown {
    build_with(setup, Threads::new(setup.clone(), threads), 4 * threads as u64)
}

/// Builds a roadmap with any executor, up to `lookahead` sets beyond the current round at hand.
pub fn build_with(setup: &Arc<Setup>, executor: impl InProcess, lookahead: u64) -> Grown {
    resume_with(setup, executor, lookahead, &[], None)
}

/// Goes on with a build after these rounds; `judgement` is that of the last of them, if it was judged.
/// What comes of it is what would have come of the build without the interruption.
pub fn resume_with(
    setup: &Arc<Setup>,
    executor: impl InProcess,
    lookahead: u64,
    rounds: &[Round],
    judgement: Option<Judgement>,
) -> Grown {
    struct Last(Option<Judgement>);
    impl Observer for Last {
        type Error = std::convert::Infallible;
        fn judged(&mut self, judgement: &Judgement) -> Result<(), Self::Error> {
            self.0 = Some(judgement.clone());
            Ok(())
        }
    }
    let mut last = Last(judgement.clone());
    match grow(setup, executor, lookahead, rounds, judgement, &mut last) {
        Ok((stop, roadmap)) => Grown { roadmap, stop, judgement: last.0 },
        Err(never) => match never {},
    }
}

/// Goes on with a build after these rounds, watched by `observer`.
pub(crate) fn grow<O: Observer>(
    setup: &Arc<Setup>,
    mut executor: impl InProcess,
    lookahead: u64,
    rounds: &[Round],
    judgement: Option<Judgement>,
    observer: &mut O,
) -> Result<(Stop, Roadmap), O::Error> {
    let mut past = Past::new(setup);
    for round in rounds {
        executor.restore(round);
        past.fold(round);
    }
    past.verdicts = judgement.map(|judgement| judgement.verdicts);
    let mut core = Core::resume(setup, lookahead, past);
    let stop = drive(&mut core, &mut executor, observer)?;
    Ok((stop, executor.into_roadmap()))
}

#[cfg(test)]
mod tests;
