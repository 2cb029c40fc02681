use crate::exit::Failure;
use crate::run::SetFiles;
use roadmill::img::{Cut, Event, Executor, Finished, Job, Round};
use roadmill::numbers::SetName;
use roadmill::roadmap::{Increment, Tally};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

/// An executor that reads sets from files, as far as there are files of them, and leaves all other jobs to the
/// executor behind it.
pub struct SetsFromFiles<E> {
    inner: E,
    files: SetFiles,
    /// Jobs whose sets are still to be read from the files.
    waiting: BTreeSet<Job>,
    failure: Option<Failure>,
}

impl<E: Executor> SetsFromFiles<E> {
    /// Sets come from `files` where these have them, everything else from `inner`.
    pub fn new(inner: E, files: SetFiles) -> SetsFromFiles<E> {
        SetsFromFiles { inner, files, waiting: BTreeSet::new(), failure: None }
    }

    /// The executor behind the files.
    pub fn inner(&self) -> &E {
        &self.inner
    }

    /// The executor behind the files.
    pub fn into_inner(self) -> E {
        self.inner
    }

    /// Why a set could not be read, if that is what ended the build.
    pub fn take_failure(&mut self) -> Option<Failure> {
        self.failure.take()
    }
}

/// The name of the set that a job generates, if that is what the job does.
fn set_of(job: Job) -> Option<SetName> {
    match job {
        Job::Generate { strategy, ordinal, .. } => Some(SetName { strategy, ordinal }),
        _ => None,
    }
}

impl<E: Executor> Executor for SetsFromFiles<E> {
    fn publish(&mut self, increment: &Arc<Increment>) {
        self.inner.publish(increment);
    }

    fn fold(&mut self, round: &Round) {
        self.inner.fold(round);
    }

    fn restore(&mut self, round: &Round) {
        self.inner.restore(round);
    }

    fn submit(&mut self, job: Job) {
        if set_of(job).is_some_and(|set| self.files.has(set)) {
            self.waiting.insert(job);
        } else {
            self.inner.submit(job);
        }
    }

    fn next(&mut self, wait: Duration) -> Option<Event> {
        let Some(job) = self.waiting.pop_first() else { return self.inner.next(wait) };
        match self.files.read(set_of(job)?) {
            Ok(outcome) => Some(Event::Done(job, Finished::new(outcome?))),
            Err(failure) => {
                self.failure = Some(failure);
                Some(Event::Cut(Cut::Interrupted))
            }
        }
    }

    fn alive(&self) -> usize {
        self.inner.alive()
    }

    fn lookahead(&self) -> Option<u64> {
        self.inner.lookahead()
    }

    fn tally(&self) -> &Tally {
        self.inner.tally()
    }
}
