use crate::channel::{Link, SharedShelf, StoreReader, WorkerId};
use crate::desk::Desk;
use crate::error::WorkerError;
use crate::faults::{Faults, Slip};
use crate::message::{FromWorker, PROTOCOL, ToWorker};
use roadmill::img::{Outcome, Replica, Setup, Task};
use roadmill::model::Scratch;
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Roadmap};
use roadmill::wire;
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
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
    let replica = Replica::of_worker(&setup, Arc::new(shelf));
    let mut desk = Desk::new(&setup, &store, &faults, replica);
    let ready = FromWorker::Ready { canary: canary(&setup) };
    link.send(&wire::encode(&ready), &mut parent_lives)?;
    loop {
        let reply = match (link.is_awaiting(), desk.has_jobs()) {
            (false, _) => None,
            (true, false) => Some(link.receive(&mut parent_lives)?),
            (true, true) => link.try_receive(&mut parent_lives)?,
        };
        if let Some(reply) = reply {
            desk.take(&reply)?;
        }
        if desk.is_to_tell() && !link.is_awaiting() {
            let (message, slip) = desk.tell();
            match slip {
                None => link.send(&message, &mut parent_lives)?,
                Some(Slip::Instead(rubbish)) => link.send(&rubbish, &mut parent_lives)?,
                Some(Slip::Twice) => {
                    link.call(&message, &mut parent_lives)?;
                    link.send(&message, &mut parent_lives)?;
                }
            }
        }
        if desk.is_to_wake() {
            link.nudge();
        }
        desk.work()?;
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
    // A strategy that grows finds no node to grow from.
    let frozen = setup.grows(0).then(|| Arc::new(Roadmap::new(&setup.cx.space)));
    let task = Task::Generate { strategy: 0, ordinal: u64::MAX, frozen };
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
