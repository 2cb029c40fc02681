//! A worker as a process of the coordinator's machine: its line is the channel in shared memory, and it ends
//! with its coordinator.

use crate::channel::{SharedShelf, StoreReader, WorkerEnd};
use crate::error::WorkerError;
use crate::faults::Faults;
use crate::id::WorkerId;
use crate::line::{HEARTBEAT, Line, SharedData};
use crate::worker::serve_with_faults;
use roadmill::internal::shelf::Shelf;
use roadmill::internal::wire;
use roadmill::roadmap::Digest;
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
use std::convert::Infallible;
use std::fs::{File, Metadata};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::sync::Arc;

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
pub fn run(arguments: &WorkerArguments) -> Result<Infallible, WorkerError> {
    tie_to_parent(arguments.coordinator)?;
    beat()?;
    let faults = Faults::read()?;
    let link = WorkerEnd::open(&arguments.directory, arguments.worker)?;
    let shared = SharedMemory {
        store: StoreReader::open(&arguments.directory),
        shelf: Arc::new(SharedShelf::open(&arguments.directory, link.workers_max())),
    };
    let mut line = ProcessLine { link, coordinator: arguments.coordinator, faults: &faults };
    let build = build_id().map_err(|error| WorkerError::System("cannot read itself", error))?;
    serve_with_faults(&mut line, &shared, build, &faults)
}

/// The line of a worker process.
struct ProcessLine<'a> {
    link: WorkerEnd,
    coordinator: u32,
    faults: &'a Faults,
}

impl ProcessLine<'_> {
    /// The link, and what it asks about once a second while it waits: whether the coordinator still lives. The
    /// kernel should have ended a worker whose coordinator does not; one that it missed ends itself.
    fn parts(&mut self) -> (&mut WorkerEnd, impl FnMut() -> bool) {
        let (coordinator, faults) = (self.coordinator, self.faults);
        let keep_waiting = move || {
            faults.at_wait();
            is_parent(coordinator)
        };
        (&mut self.link, keep_waiting)
    }
}

impl Line for ProcessLine<'_> {
    fn send(&mut self, message: &[u8]) -> Result<(), WorkerError> {
        let (link, mut keep_waiting) = self.parts();
        Ok(link.send(message, &mut keep_waiting)?)
    }

    fn receive(&mut self) -> Result<Vec<u8>, WorkerError> {
        let (link, mut keep_waiting) = self.parts();
        Ok(link.receive(&mut keep_waiting)?)
    }

    fn try_receive(&mut self) -> Result<Option<Vec<u8>>, WorkerError> {
        let (link, mut keep_waiting) = self.parts();
        Ok(link.try_receive(&mut keep_waiting)?)
    }

    fn nudge(&mut self) {
        self.link.nudge();
    }

    fn is_awaiting(&self) -> bool {
        self.link.is_awaiting()
    }
}

/// What the worker processes of a run share: files in shared memory.
struct SharedMemory {
    store: StoreReader,
    shelf: Arc<SharedShelf>,
}

impl SharedData for SharedMemory {
    fn stored(&self, offset: u64, length: u64) -> io::Result<Vec<u8>> {
        self.store.read(offset, length)
    }

    fn shelf(&self) -> Option<Arc<dyn Shelf>> {
        Some(self.shelf.clone())
    }
}

/// Which file the running executable is: see [`build_id_of`].
///
/// The file is opened and then asked, as whoever starts workers does: an emulator of another processor, such as
/// `qemu-aarch64`, opens the program at this name, but asked about the name it tells of itself.
///
/// # Errors
/// When it cannot be found.
pub fn build_id() -> io::Result<Digest> {
    Ok(build_id_of(&File::open("/proc/self/exe")?.metadata()?))
}

/// Which file an executable is: digest of the numbers of its device and of the file, its length and when it
/// was written. While it runs it cannot be written to, so that within one machine this tells programs apart
/// as their bytes do, which take 20 ms to read and hash. An upgrade that gives the name to another file
/// changes none of them.
pub fn build_id_of(file: &Metadata) -> Digest {
    let written = (file.mtime(), file.mtime_nsec());
    Digest::of(&wire::encode(&(file.dev(), file.ino(), file.len(), written)))
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
