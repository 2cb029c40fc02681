use crate::channel::{CHUNK_BYTES, ChannelError, Link, SharedShelf, StoreReader, WorkerId};
use crate::faults::{Faults, Slip};
use crate::message::{Bytes, Done, Entry, FromWorker, PROTOCOL, ToWorker};
use roadmill::img::{Job, Outcome, Replica, Setup, Task};
use roadmill::problem::Problem;
use roadmill::roadmap::Digest;
use roadmill::validity::Scratch;
use roadmill::wire::{self, WireError};
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::io::Write;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often a worker shows that it lives.
pub const HEARTBEAT: Duration = Duration::from_secs(1);

/// A worker that has so many jobs left to begin tells what it has done, so that it need not wait for more.
const HELD_WHEN_TELLING: usize = 2;

/// What a worker is started with.
#[derive(Debug, Clone)]
pub struct WorkerArguments {
    /// The run's folder of the channel.
    pub directory: PathBuf,
    /// The worker's name.
    pub worker: WorkerId,
    /// Process id of the coordinator.
    pub coordinator: u32,
}

/// Why a worker ended.
#[derive(Debug, thiserror::Error)]
pub enum WorkerError {
    /// The coordinator ended before the worker could be tied to it.
    #[error("the coordinator is gone")]
    Orphaned,
    /// The system refused something.
    #[error("{0}: {1}")]
    System(&'static str, #[source] std::io::Error),
    /// The channel failed.
    #[error(transparent)]
    Channel(#[from] ChannelError),
    /// The coordinator said something that is no message.
    #[error("the coordinator sent {0}")]
    Message(#[from] WireError),
    /// The coordinator said something out of turn.
    #[error("the coordinator sent {0} out of turn")]
    Turn(&'static str),
    /// What the coordinator has put into shared memory is not what it said.
    #[error("the store's bytes have another digest")]
    Store,
    /// The coordinator does not want this worker.
    #[error("refused: {0}")]
    Refused(String),
    /// A test asked for faults that there are not.
    #[error("{0}: `{1}` found, faults expected")]
    Faults(&'static str, String),
}

/// Runs a worker until the coordinator is done with it, which it says by ending it.
///
/// Standard output must be a pipe to the coordinator: a byte a second on it shows that the
/// process lives, however long its job takes.
///
/// # Errors
/// Whatever ends the worker.
pub fn run(arguments: &WorkerArguments) -> Result<std::convert::Infallible, WorkerError> {
    tie_to_parent(arguments.coordinator)?;
    beat()?;
    let faults = Faults::read()?;
    let mut link = Link::open(&arguments.directory, arguments.worker)?;
    let store = StoreReader::open(&arguments.directory);
    let workers_max = link.workers_max();
    // An orphan that its parent's death did not end ends itself here.
    let parent = arguments.coordinator;
    let mut parent_lives = || {
        faults.at_wait();
        is_parent(parent)
    };
    let build = build_id().map_err(|error| WorkerError::System("cannot read itself", error))?;
    let hello = FromWorker::Hello { protocol: PROTOCOL, build };
    let problem = match wire::decode(&link.call(&wire::encode(&hello), &mut parent_lives)?)? {
        ToWorker::Problem(problem) => problem,
        ToWorker::Refused(reason) => return Err(WorkerError::Refused(reason)),
        ToWorker::Work { .. } => return Err(WorkerError::Turn("work")),
    };
    let setup = Setup::new(*problem);
    let shelf = SharedShelf::open(&arguments.directory, workers_max);
    let mut replica = Replica::of_worker(&setup, Arc::new(shelf));
    let mut scratch = Scratch::new();
    let ready = FromWorker::Ready { canary: canary(&setup) };
    link.send(&wire::encode(&ready), &mut parent_lives)?;
    let mut held = BTreeSet::new();
    let mut done: Vec<(Job, u64, Vec<u8>)> = Vec::new();
    let mut slip = None;
    let mut is_urgent = false;
    loop {
        let reply = match (link.is_awaiting(), held.is_empty()) {
            (false, _) => None,
            (true, true) => Some(link.receive(&mut parent_lives)?),
            (true, false) => link.try_receive(&mut parent_lives)?,
        };
        if let Some(reply) = reply {
            let (entries, jobs) = match wire::decode(&reply)? {
                ToWorker::Work { entries, jobs } => (entries, jobs),
                ToWorker::Refused(reason) => return Err(WorkerError::Refused(reason)),
                ToWorker::Problem(_) => return Err(WorkerError::Turn("a problem")),
            };
            for entry in entries {
                take_in(&entry, &setup, &store, &mut replica)?;
            }
            held.extend(jobs);
        }
        let bytes: usize = done.iter().map(|(.., outcome)| outcome.len()).sum();
        // Where few jobs come at once, not after each of them.
        let few = HELD_WHEN_TELLING;
        let is_to_tell = match done.is_empty() {
            true => held.is_empty(),
            false => is_urgent || held.len() <= few.min(done.len()) || bytes > CHUNK_BYTES,
        };
        if is_to_tell && !link.is_awaiting() {
            let told = done.iter().map(|(job, micros, outcome)| Done {
                job: *job,
                micros: *micros,
                outcome,
            });
            let message = wire::encode(&FromWorker::Done(told.collect()));
            done.clear();
            match slip.take() {
                None => link.send(&message, &mut parent_lives)?,
                Some(Slip::Instead(rubbish)) => link.send(&rubbish, &mut parent_lives)?,
                Some(Slip::Twice) => {
                    link.call(&message, &mut parent_lives)?;
                    link.send(&message, &mut parent_lives)?;
                }
            }
        }
        if is_urgent {
            // With nothing left to do it rings when it waits.
            if !held.is_empty() {
                link.nudge();
            }
            // Still to be told, where an earlier message has not been answered.
            is_urgent = !done.is_empty();
        }
        if let Some(job) = held.pop_first() {
            if held.is_empty() {
                // The next jobs are to be there when this one is done.
                link.nudge();
            }
            let begun = Instant::now();
            let task = replica.task(&setup, job).ok_or(WorkerError::Turn("a job"))?;
            slip = faults.at(job, &setup).or(slip);
            let outcome = wire::encode(&task.run(&setup, &mut scratch));
            // Its inputs are freed here, before the next fold, which would copy a shared roadmap.
            drop(task);
            let micros = begun.elapsed().as_micros() as u64;
            done.push((job, micros, outcome));
            is_urgent |= is_last_urgent(job, &held);
        }
    }
}

/// Whether `job` was the last urgent one: everybody waits for these, and nobody for sets generated ahead.
fn is_last_urgent(job: Job, held: &BTreeSet<Job>) -> bool {
    let is_urgent = |job: &Job| !matches!(job, Job::Generate { .. });
    is_urgent(&job) && !held.first().is_some_and(is_urgent)
}

/// Brings a replica up to date.
fn take_in(
    entry: &Entry,
    setup: &Setup,
    store: &StoreReader,
    replica: &mut Replica,
) -> Result<(), WorkerError> {
    match entry {
        Entry::Increment(outcome) => match wire::decode(&read(store, outcome)?)? {
            Outcome::Increment(Ok(made)) => replica.publish(setup, Arc::new(made)),
            _ => return Err(WorkerError::Turn("another outcome as an increment")),
        },
        Entry::Fold(outcomes) => {
            let mut joins = Vec::with_capacity(outcomes.len());
            for outcome in outcomes {
                match wire::decode(&read(store, outcome)?)? {
                    Outcome::Joined(joined) => joins.push(joined.edges),
                    _ => return Err(WorkerError::Turn("another outcome as a join")),
                }
            }
            replica.fold(setup, joins.iter().map(|edges| &edges[..]));
        }
    }
    Ok(())
}

/// The bytes of an entry, checked.
fn read<'a>(store: &StoreReader, bytes: &'a Bytes) -> Result<Cow<'a, [u8]>, WorkerError> {
    match bytes {
        Bytes::Here(bytes) => Ok(Cow::Borrowed(bytes)),
        Bytes::Stored { offset, length, digest } => {
            let bytes = store
                .read(*offset, *length)
                .map_err(|error| WorkerError::System("cannot read the store", error))?;
            if Digest::of(&bytes) == *digest {
                Ok(Cow::Owned(bytes))
            } else {
                Err(WorkerError::Store)
            }
        }
    }
}

/// Which file the running executable is: digest of the numbers of its device and of the file, its length
/// and when it was written. While it runs it cannot be written to, so that within one machine this tells
/// programs apart as its bytes do, which take 20 ms to read and hash. An upgrade that gives its name to
/// another file changes none of them.
///
/// # Errors
/// When it cannot be found.
pub fn build_id() -> std::io::Result<Digest> {
    let file = std::fs::metadata("/proc/self/exe")?;
    let written = (file.mtime(), file.mtime_nsec());
    Ok(Digest::of(&wire::encode(&(file.dev(), file.ino(), file.len(), written))))
}

/// Digest of a small increment that no build contains: processes in which it differs must not
/// work on one roadmap.
pub fn canary(setup: &Setup) -> Digest {
    let mut problem: Problem = setup.problem.clone();
    for strategy in &mut problem.strategies {
        strategy.nodes = strategy.nodes.min(4);
    }
    let small = Setup { problem, cx: setup.problem.context(), plan: setup.plan.clone() };
    let task = Task::Generate { strategy: 0, ordinal: u64::MAX };
    let outcome: Outcome = task.run(&small, &mut Scratch::new());
    Digest::of(&wire::encode(&outcome))
}

/// Makes the kernel end this process with its parent.
fn tie_to_parent(coordinator: u32) -> Result<(), WorkerError> {
    set_parent_process_death_signal(Some(Signal::KILL))
        .map_err(|errno| WorkerError::System("cannot tie itself to its parent", errno.into()))?;
    // The parent may have ended before the line above.
    if is_parent(coordinator) { Ok(()) } else { Err(WorkerError::Orphaned) }
}

fn is_parent(coordinator: u32) -> bool {
    getppid().map(Pid::as_raw_nonzero).is_some_and(|pid| pid.get().unsigned_abs() == coordinator)
}

/// Starts the thread that shows that the process lives.
fn beat() -> Result<(), WorkerError> {
    let thread = std::thread::Builder::new().name("heartbeat".to_owned()).spawn(|| {
        let mut pipe = std::io::stdout();
        // With no one at the other end there is nothing to work for.
        while pipe.write_all(b".").and_then(|()| pipe.flush()).is_ok() {
            std::thread::sleep(HEARTBEAT);
        }
        std::process::exit(0);
    });
    thread.map(drop).map_err(|error| WorkerError::System("cannot start a thread", error))
}
