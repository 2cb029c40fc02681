//! A worker's desk: the jobs that the worker holds, what they read, and the outcomes that the coordinator has
//! not been told yet.

use crate::error::WorkerError;
use crate::faults::{Faults, Slip};
use crate::line::SharedData;
use crate::message::{Bytes, Done, Entry, FromWorker, ToWorker};
use roadmill::img::{Job, Outcome, Replica, Setup};
use roadmill::internal::wire;
use roadmill::model::Scratch;
use roadmill::roadmap::Digest;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

/// A worker that has so many jobs left to begin tells what it has done, so that it need not wait for more.
const HELD_WHEN_TELLING: usize = 2;
/// A worker tells what it has done once that takes more bytes than this, so that long outcomes are on their
/// way while it works.
const TOLD_BYTES: usize = 128 << 10;

/// A job that is done.
struct Finished {
    job: Job,
    micros: u64,
    /// The bytes of its [`Outcome`].
    outcome: Vec<u8>,
}

/// A worker's jobs and outcomes.
pub struct Desk<'a> {
    setup: &'a Setup,
    shared: &'a dyn SharedData,
    faults: &'a Faults,
    replica: Replica,
    scratch: Scratch,
    /// Jobs to be done, the most urgent first.
    jobs: BTreeSet<Job>,
    /// Jobs that are done, of which the coordinator is to be told.
    done: Vec<Finished>,
    /// What a test wants to go wrong when the coordinator is told.
    slip: Option<Slip>,
    /// Whether the build waits for something among what is done.
    is_urgent: bool,
}

impl<'a> Desk<'a> {
    /// A desk without jobs.
    pub fn new(
        setup: &'a Setup,
        shared: &'a dyn SharedData,
        faults: &'a Faults,
        replica: Replica,
    ) -> Desk<'a> {
        Desk {
            setup,
            shared,
            faults,
            replica,
            scratch: Scratch::new(),
            jobs: BTreeSet::new(),
            done: Vec::new(),
            slip: None,
            is_urgent: false,
        }
    }

    /// Whether there is something to do.
    pub fn has_jobs(&self) -> bool {
        !self.jobs.is_empty()
    }

    /// Takes in what the coordinator says.
    ///
    /// # Errors
    /// When it is no work.
    pub fn take(&mut self, reply: &[u8]) -> Result<(), WorkerError> {
        let (entries, jobs) = match wire::decode(reply)? {
            ToWorker::Work { entries, jobs } => (entries, jobs),
            ToWorker::Refused(reason) => return Err(WorkerError::Refused(reason)),
            ToWorker::Problem(_) => return Err(WorkerError::Turn("a problem")),
        };
        for entry in &entries {
            self.take_in(entry)?;
        }
        self.jobs.extend(jobs);
        Ok(())
    }

    /// Whether it is time to tell what is done, or to ask for jobs.
    pub fn is_to_tell(&self) -> bool {
        if self.done.is_empty() {
            return self.jobs.is_empty();
        }
        let bytes: usize = self.done.iter().map(|done| done.outcome.len()).sum();
        // Where few jobs come at once, not after each of them.
        let few = HELD_WHEN_TELLING.min(self.done.len());
        self.is_urgent || self.jobs.len() <= few || bytes > TOLD_BYTES
    }

    /// The message that tells all that is done, and what goes wrong with it.
    pub fn tell(&mut self) -> (Vec<u8>, Option<Slip>) {
        let told = self.done.iter().map(|Finished { job, micros, outcome }| Done {
            job: *job,
            micros: *micros,
            outcome,
        });
        let message = wire::encode(&FromWorker::Done(told.collect()));
        self.done.clear();
        (message, self.slip.take())
    }

    /// Whether the coordinator is to look now: somebody waits for what was told, or the next jobs are to be there
    /// when the last one is done. A worker with nothing to do wakes it by waiting.
    pub fn is_to_wake(&mut self) -> bool {
        let is_urgent = self.is_urgent && self.has_jobs();
        // Still to be told, where an earlier message has not been answered.
        self.is_urgent &= !self.done.is_empty();
        is_urgent || self.jobs.len() == 1
    }

    /// Does the most urgent job, if there is one.
    ///
    /// # Errors
    /// When the replica is not where the job needs it.
    pub fn work(&mut self) -> Result<(), WorkerError> {
        let Some(job) = self.jobs.pop_first() else { return Ok(()) };
        let begun = Instant::now();
        let task = self.replica.task(self.setup, job).ok_or(WorkerError::Turn("a job"))?;
        self.slip = self.faults.at(job, self.setup).or(self.slip.take());
        let outcome = wire::encode(&task.run(self.setup, &mut self.scratch));
        // Its inputs are freed here, before the next fold, which would copy a shared roadmap.
        drop(task);
        let micros = begun.elapsed().as_micros() as u64;
        self.done.push(Finished { job, micros, outcome });
        self.is_urgent |= is_urgent(&job) && !self.jobs.first().is_some_and(is_urgent);
        Ok(())
    }

    /// Brings the replica up to date.
    fn take_in(&mut self, entry: &Entry) -> Result<(), WorkerError> {
        match entry {
            Entry::Increment(outcome) => match wire::decode(&self.read(outcome)?)? {
                Outcome::Increment(Ok(made)) => self.replica.publish(self.setup, Arc::new(made)),
                _ => return Err(WorkerError::Turn("another outcome as an increment")),
            },
            Entry::Fold(outcomes) => {
                let mut joins = Vec::with_capacity(outcomes.len());
                for outcome in outcomes {
                    match wire::decode(&self.read(outcome)?)? {
                        Outcome::Joined(joined) => joins.push(joined.edges),
                        _ => return Err(WorkerError::Turn("another outcome as a join")),
                    }
                }
                self.replica.fold(self.setup, joins.iter().map(|edges| &edges[..]));
            }
        }
        Ok(())
    }

    /// The bytes of an entry, checked.
    fn read<'b>(&self, bytes: &'b Bytes) -> Result<Cow<'b, [u8]>, WorkerError> {
        match bytes {
            Bytes::Here(bytes) => Ok(Cow::Borrowed(bytes)),
            Bytes::Stored { offset, length, digest } => {
                let bytes = (self.shared.stored(*offset, *length))
                    .map_err(|error| WorkerError::System("cannot read the store", error))?;
                if Digest::of(&bytes) == *digest {
                    Ok(Cow::Owned(bytes))
                } else {
                    Err(WorkerError::Store)
                }
            }
        }
    }
}

/// Everybody waits for joins and verdicts, and nobody for sets generated ahead.
fn is_urgent(job: &Job) -> bool {
    !matches!(job, Job::Generate { .. })
}
