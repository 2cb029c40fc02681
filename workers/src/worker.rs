use crate::channel::{ChannelError, Link, SharedShelf, StoreReader, WorkerId};
use crate::faults::{Faults, Slip};
use crate::message::{Bytes, Entry, FromWorker, PROTOCOL, ToWorker};
use roadmill::img::{Outcome, Replica, Setup, Task};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Edge};
use roadmill::validity::Scratch;
use roadmill::wire::{self, WireError};
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
use std::borrow::Cow;
use std::io::Write;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// How often a worker shows that it lives.
pub const HEARTBEAT: Duration = Duration::from_secs(1);

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
    let mut call = |message: &[u8]| -> Result<ToWorker, WorkerError> {
        let reply = link.call(message, &mut parent_lives)?;
        Ok(wire::decode(&reply)?)
    };

    let build = build_id().map_err(|error| WorkerError::System("cannot read itself", error))?;
    let hello = FromWorker::Hello { protocol: PROTOCOL, build };
    let problem = match call(&wire::encode(&hello))? {
        ToWorker::Problem(problem) => problem,
        ToWorker::Refused(reason) => return Err(WorkerError::Refused(reason)),
        ToWorker::Work { .. } => return Err(WorkerError::Turn("work")),
    };
    let setup = Setup::new(*problem);
    let shelf = SharedShelf::open(&arguments.directory, workers_max);
    let mut replica = Replica::of_worker(&setup, Arc::new(shelf));
    let mut scratch = Scratch::new();
    let mut message = wire::encode(&FromWorker::Ready { canary: canary(&setup) });
    loop {
        let (entries, job) = match call(&message)? {
            ToWorker::Work { entries, job } => (entries, job),
            ToWorker::Refused(reason) => return Err(WorkerError::Refused(reason)),
            ToWorker::Problem(_) => return Err(WorkerError::Turn("a problem")),
        };
        for entry in entries {
            match entry {
                Entry::Increment(outcome) => match wire::decode(&read(&store, &outcome)?)? {
                    Outcome::Increment(Ok(made)) => replica.publish(&setup, Arc::new(made)),
                    _ => return Err(WorkerError::Turn("another outcome as an increment")),
                },
                Entry::Fold(joins) => {
                    let joins: Vec<Vec<Edge>> = wire::decode(&read(&store, &joins)?)?;
                    replica.fold(&setup, joins.iter().map(|edges| &edges[..]));
                }
            }
        }
        message = match job {
            None => wire::encode(&FromWorker::More),
            Some(job) => {
                let task = replica.task(&setup, job).ok_or(WorkerError::Turn("a job"))?;
                let slip = faults.at(job, &setup);
                let outcome = wire::encode(&task.run(&setup, &mut scratch));
                // Free the inputs before the next fold, which would copy a shared roadmap.
                drop(task);
                let answer = wire::encode(&FromWorker::Finished { job, outcome });
                match slip {
                    None => answer,
                    Some(Slip::Instead(rubbish)) => rubbish,
                    Some(Slip::Twice) => {
                        call(&answer)?;
                        answer
                    }
                }
            }
        };
    }
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
