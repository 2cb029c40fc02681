use crate::exit::Failure;
use crate::run::SetFiles;
use roadmill::img::{Cut, Event, Executor, Finished, Job, Round};
use roadmill::roadmap::{Increment, Tally};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

/// An executor that takes what there is from files of sets and leaves all other jobs to another.
pub struct Imported<E> {
    inner: E,
    files: SetFiles,
    /// Sets to be read.
    waiting: BTreeSet<Job>,
    failure: Option<Failure>,
}

impl<E: Executor> Imported<E> {
    /// Puts files before an executor.
    pub fn new(inner: E, files: SetFiles) -> Imported<E> {
        Imported { inner, files, waiting: BTreeSet::new(), failure: None }
    }

    /// The other executor.
    pub fn into_inner(self) -> E {
        self.inner
    }

    /// Why the build was cut, if that was because a set could not be read.
    pub fn take_failure(&mut self) -> Option<Failure> {
        self.failure.take()
    }
}

fn set_of(job: Job) -> Option<(u32, u64)> {
    match job {
        Job::Generate { strategy, ordinal, .. } => Some((strategy, ordinal)),
        _ => None,
    }
}

impl<E: Executor> Executor for Imported<E> {
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
        let is_here = |(strategy, ordinal)| self.files.has(strategy, ordinal);
        if set_of(job).is_some_and(is_here) {
            self.waiting.insert(job);
        } else {
            self.inner.submit(job);
        }
    }

    fn next(&mut self, wait: Duration) -> Option<Event> {
        let Some(job) = self.waiting.pop_first() else { return self.inner.next(wait) };
        let (strategy, ordinal) = set_of(job)?;
        match self.files.read(strategy, ordinal) {
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

    fn tally(&self) -> &Tally {
        self.inner.tally()
    }
}
