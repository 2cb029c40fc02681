use super::{Command, Core, Cut, Event, Job, Judgement, Progress, Round, Stop};
use crate::roadmap::{Increment, Roadmap, Tally};
use std::sync::Arc;
use std::time::Duration;

/// Whatever does the jobs. It may do them in any order and in any place, more than once, or lose
/// them and say so.
pub trait Executor {
    /// Makes the increment of the next set known to the jobs that come.
    fn publish(&mut self, increment: &Arc<Increment>);

    /// Folds the increments published since the last fold.
    fn fold(&mut self, round: &Round);

    /// Takes in a round that was folded before the build was interrupted.
    fn restore(&mut self, round: &Round) {
        for set in &round.sets {
            self.publish(&set.increment);
        }
        self.fold(round);
    }

    /// Takes on a job; everything that it reads has been published or folded before.
    fn submit(&mut self, job: Job);

    /// The next thing that happened, or `None` when nothing did within `wait`.
    fn next(&mut self, wait: Duration) -> Option<Event>;

    /// How many workers are ready or at work.
    fn alive(&self) -> usize;

    /// How many sets beyond the current round keep all workers busy; `None` where that was known before the build
    /// began. It changes how long a build takes and nothing else.
    fn lookahead(&self) -> Option<u64> {
        None
    }

    /// What the roadmap folded so far comes to.
    fn tally(&self) -> &Tally;
}

/// An executor that has the roadmap itself.
pub trait InProcess: Executor {
    /// The roadmap at the end.
    fn into_roadmap(self) -> Roadmap;
}

/// Whoever watches a build and may end it.
pub trait Observer {
    /// Why watching failed (a ledger that cannot be written, say).
    type Error;

    /// A round was folded; `tally` includes it.
    fn folded(&mut self, _round: &Round, _tally: &Tally) -> Result<(), Self::Error> {
        Ok(())
    }

    /// The evaluators judged a round.
    fn judged(&mut self, _judgement: &Judgement) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Called between events, at least every [`TICK`]; a cut ends the build after the last fold.
    /// `alive` is the number of workers.
    fn tick(
        &mut self,
        _progress: &Progress,
        _tally: &Tally,
        _alive: usize,
    ) -> Result<Option<Cut>, Self::Error> {
        Ok(None)
    }
}

/// The longest time between two calls of [`Observer::tick`].
pub const TICK: Duration = Duration::from_millis(200);

/// Runs a build to its end.
///
/// # Errors
/// What the observer fails with.
pub fn drive<E: Executor, O: Observer>(
    core: &mut Core,
    executor: &mut E,
    observer: &mut O,
) -> Result<Stop, O::Error> {
    let mut commands = core.start();
    loop {
        for command in commands {
            match command {
                Command::Publish(increment) => executor.publish(&increment),
                Command::Submit(job) => executor.submit(job),
                Command::Fold(round) => {
                    executor.fold(&round);
                    observer.folded(&round, executor.tally())?;
                }
                Command::Judge(judgement) => observer.judged(&judgement)?,
                Command::Stop(stop) => return Ok(stop),
            }
        }
        let event = match observer.tick(core.progress(), executor.tally(), executor.alive())? {
            Some(cut) => Some(Event::Cut(cut)),
            None => executor.next(TICK),
        };
        if let Some(lookahead) = executor.lookahead() {
            core.look_ahead(lookahead);
        }
        commands = event.map_or_else(Vec::new, |event| core.on_event(event));
    }
}
