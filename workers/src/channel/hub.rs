//! The coordinator's end.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::os::fd::{AsFd, BorrowedFd};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use iceoryx2::port::ReceiveError;
use iceoryx2::port::update_connections::UpdateConnections;
use rustix::process::{Resource, getrlimit, setrlimit};

use super::bell::{Bell, Note};
use super::error::ChannelError;
use super::header::Fault;
use super::peer::{Peer, Step};
use super::run_folder::{RunFolder, hub_socket, worker_socket};
use super::service::{self, HubPort, Question, RunNode, RunService};
use super::store::Store;
use super::{MESSAGE_BYTES_MAX, WorkerId};

/// Keeps one `receive` short when several workers send long messages.
const CHUNKS_PER_RECEIVE_MAX: usize = 64;
/// The library's ports fail transiently when a worker comes or goes meanwhile.
const RECEIVE_TRIES: usize = 3;
const DESCRIPTORS_PER_WORKER: u64 = 8;
const DESCRIPTORS_BESIDES: u64 = 256;

/// What has come from a worker.
#[derive(Debug, PartialEq, Eq)]
pub enum Received {
    /// A whole message, its checksums verified. The worker waits until [`Hub::reply`].
    Message {
        /// who sent it
        worker: WorkerId,
        /// its bytes
        message: Vec<u8>,
    },
    /// The worker broke the protocol. Nothing more will come from it: end it, then
    /// [`Hub::forget`] it.
    Broken {
        /// who did it
        worker: WorkerId,
        /// how
        reason: Fault,
    },
}

/// What became of a reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub enum Delivery {
    /// It is on its way; the hub serves the rest of a long one in [`Hub::receive`].
    Sent,
    /// No such worker waits for a reply: it is dead, forgotten or broken, or it was answered
    /// already. This is ordinary; whoever watches the processes finds out which.
    Gone,
}

/// The coordinator's end of the channel. It belongs to one thread.
///
/// # Example
///
/// ```no_run
/// # use roadmill_workers::channel::{ChannelError, Hub, Received};
/// # fn main() -> Result<(), ChannelError> {
/// let mut hub = Hub::create(4)?;
/// // … start workers with hub.directory(), poll hub.as_fd(), and when it is readable:
/// while let Some(received) = hub.receive()? {
///     if let Received::Message { worker, message } = received {
///         let _ = hub.reply(worker, message)?;
///     }
/// }
/// hub.close()
/// # }
/// ```
pub struct Hub {
    // dropped in this order: questions before the port, the port before its node, files last
    peers: BTreeMap<WorkerId, Peer>,
    port: HubPort,
    service: RunService,
    node: RunNode,
    bell: Bell,
    pub(super) store: Store,
    folder: RunFolder,
    /// the library's numbers of the workers' ports
    workers_of_ports: BTreeMap<u128, WorkerId>,
    /// forgotten or broken: what still comes from them is dropped
    ignored: BTreeSet<WorkerId>,
    inbox: VecDeque<Received>,
    /// Whether the rings have been taken since there was nothing to receive.
    is_drained: bool,
    /// workers that have said so, with the message for whose answer
    asleep: Vec<(WorkerId, u64)>,
}

impl Hub {
    /// Removes what dead runs have left, then makes this run's private folder and opens the
    /// channel for at most `workers_max` workers at a time. Raises the limit of open files
    /// if that many workers need it.
    ///
    /// # Errors
    ///
    /// [`ChannelError::NoSpace`], [`ChannelError::Unsafe`], [`ChannelError::Busy`], and whatever
    /// files and shared memory may refuse.
    pub fn create(workers_max: usize) -> Result<Hub, ChannelError> {
        let folder = RunFolder::create()?;
        // after the reaping, which may make space
        service::check_free_space(workers_max)?;
        raise_descriptor_limit(workers_max);
        let bell = Bell::bind(&hub_socket(folder.path()))?;
        let node = service::open_node(folder.path(), workers_max)?;
        let (service, port) = service::create_service(&node, workers_max)?;
        service::secure_hub_memory(folder.path())?;
        let store = Store::create(folder.path(), workers_max);
        Ok(Hub {
            peers: BTreeMap::new(),
            port,
            service,
            node,
            bell,
            store,
            folder,
            workers_of_ports: BTreeMap::new(),
            ignored: BTreeSet::new(),
            inbox: VecDeque::new(),
            is_drained: false,
            asleep: Vec::new(),
        })
    }

    /// The run's folder, which each worker needs for [`WorkerEnd::open`](super::WorkerEnd::open).
    pub fn directory(&self) -> &Path {
        self.folder.path()
    }

    /// Keeps what this process has open of the channel from a program that it is about to start.
    pub fn close_on_exec(&self) {
        service::close_on_exec(self.folder.path());
    }

    /// What all workers can read; see [`StoreReader`](super::StoreReader).
    pub fn store(&mut self) -> &mut Store {
        &mut self.store
    }

    /// How many bytes the store takes, now and whenever it is looked at.
    pub fn stored_bytes(&self) -> Arc<AtomicU64> {
        self.store.bytes()
    }

    /// Readable when [`receive`](Hub::receive) has something to do.
    pub fn as_fd(&self) -> BorrowedFd<'_> {
        self.bell.as_fd()
    }

    /// The next message, or `None` if none is complete. Never blocks. To be called until it says
    /// `None` whenever [`as_fd`](Hub::as_fd) is readable: it also moves the chunks of
    /// messages that are not yet complete.
    ///
    /// # Errors
    ///
    /// [`ChannelError::SharedMemory`] if the library refuses repeatedly, whoever the worker.
    pub fn receive(&mut self) -> Result<Option<Received>, ChannelError> {
        if let Some(received) = self.inbox.pop_front() {
            return Ok(Some(received));
        }
        if !std::mem::replace(&mut self.is_drained, true) {
            let asleep = &mut self.asleep;
            self.bell.drain(|note| match note {
                Note::Look => {}
                Note::Asleep(worker, sequence) => asleep.push((worker, sequence)),
            });
        }
        for _ in 0..CHUNKS_PER_RECEIVE_MAX {
            let Some(question) = self.next_question()? else {
                self.is_drained = false;
                self.hear_who_sleeps();
                return Ok(None);
            };
            if let Some(received) = self.take(question) {
                return Ok(Some(received));
            }
        }
        // there may be more, and its ring has been drained
        self.is_drained = false;
        self.ring_self();
        Ok(None)
    }

    /// Answers the message of `worker` and wakes it if it sleeps. Never blocks; a long reply is kept until the
    /// worker has pulled all of it. An `Arc` may be shared among several replies.
    ///
    /// # Errors
    ///
    /// [`ChannelError::TooLarge`]. That the worker cannot be reached is not an error, see
    /// [`Delivery`].
    pub fn reply(
        &mut self,
        worker: WorkerId,
        message: impl Into<Arc<Vec<u8>>>,
    ) -> Result<Delivery, ChannelError> {
        let message = message.into();
        check_length(message.len())?;
        let Some(peer) = self.peers.get_mut(&worker) else {
            return Ok(Delivery::Gone);
        };
        match peer.reply(message) {
            Ok(Some(is_asleep)) => {
                if is_asleep {
                    self.wake(worker);
                }
                Ok(Delivery::Sent)
            }
            Ok(None) => Ok(Delivery::Gone),
            Err(reason) => {
                let broken = self.give_up(worker, reason);
                self.inbox.push_back(broken);
                self.ring_self();
                Ok(Delivery::Gone)
            }
        }
    }

    /// Drops whatever has to do with `worker`, and cleans up after all workers of this run that
    /// have died. To be called when the process has been waited for: as long as it lives, the
    /// library cannot clean up after it.
    pub fn forget(&mut self, worker: WorkerId) {
        self.peers.remove(&worker);
        self.ignored.insert(worker);
        // Requests that the dead worker has sent must be taken out while its connection stands:
        // afterwards the library would keep them, and its memory, for ever.
        self.stash();
        self.inbox.retain(|received| received.worker() != worker);
        service::clean_up_dead_nodes(&self.node, self.folder.path());
        // gives the dead connections back now; a failure is met again in `receive`
        let _ = self.port.update_connections();
        self.workers_of_ports.retain(|_, owner| *owner != worker);
        let _ = std::fs::remove_file(worker_socket(self.folder.path(), worker));
        if !self.inbox.is_empty() {
            self.ring_self();
        }
    }

    /// Ends the run: removes its folder and all its shared memory. The workers should have ended
    /// before. Dropping the hub does the same, but tells nothing.
    ///
    /// # Errors
    ///
    /// [`ChannelError::Io`] if something could not be removed; the next hub tries again.
    pub fn close(self) -> Result<(), ChannelError> {
        let Hub { peers, port, service, node, bell, folder, .. } = self;
        drop((peers, port, service, node, bell));
        folder.remove()
    }

    fn stash(&mut self) {
        for _ in 0..CHUNKS_PER_RECEIVE_MAX {
            match self.next_question() {
                Ok(Some(question)) => {
                    let received = self.take(question);
                    self.inbox.extend(received);
                }
                // an error is met again in `receive`
                Ok(None) | Err(_) => return,
            }
        }
        self.ring_self();
    }

    fn next_question(&mut self) -> Result<Option<Question>, ChannelError> {
        let mut tries = 0;
        loop {
            match self.port.receive() {
                Ok(question) => return Ok(question),
                // the fullest connection is one of a worker that is already given up
                Err(ReceiveError::ExceedsMaxBorrows) => return Ok(None),
                Err(error) => {
                    tries += 1;
                    if tries == RECEIVE_TRIES {
                        return Err(ChannelError::shared("could not receive")(error));
                    }
                }
            }
        }
    }

    fn take(&mut self, question: Question) -> Option<Received> {
        let port = question.origin().value();
        let worker = match self.workers_of_ports.get(&port) {
            Some(worker) => *worker,
            None => {
                // a port that is gone again, or bears no worker's name, cannot be answered
                let worker = service::worker_of(&self.service, port)?;
                self.workers_of_ports.insert(port, worker);
                worker
            }
        };
        if self.ignored.contains(&worker) {
            return None;
        }
        let peer = self.peers.entry(worker).or_insert_with(|| Peer::new(worker));
        match peer.take(question) {
            Ok(Step::Answered) => {
                self.wake(worker);
                None
            }
            Ok(Step::Complete(message)) => Some(Received::Message { worker, message }),
            Err(reason) => Some(self.give_up(worker, reason)),
        }
    }

    /// Notes who sleeps, now that all they sent before has been taken, and wakes those who were answered
    /// meanwhile.
    fn hear_who_sleeps(&mut self) {
        for (worker, sequence) in std::mem::take(&mut self.asleep) {
            if self.peers.get_mut(&worker).is_some_and(|peer| peer.sleeps(sequence)) {
                self.wake(worker);
            }
        }
    }

    fn give_up(&mut self, worker: WorkerId, reason: Fault) -> Received {
        self.peers.remove(&worker);
        self.ignored.insert(worker);
        self.wake(worker);
        Received::Broken { worker, reason }
    }

    fn wake(&self, worker: WorkerId) {
        // a worker that cannot be rung is dead, or looks by itself after a while
        let _ = self.bell.ring(&worker_socket(self.folder.path(), worker), Note::Look);
    }

    fn ring_self(&self) {
        let _ = self.bell.ring(&hub_socket(self.folder.path()), Note::Look);
    }
}

impl Received {
    /// Whom it came from.
    pub fn worker(&self) -> WorkerId {
        match self {
            Received::Message { worker, .. } | Received::Broken { worker, .. } => *worker,
        }
    }
}

/// Refuses messages over the limit.
pub(super) fn check_length(bytes: usize) -> Result<(), ChannelError> {
    let bytes = bytes as u64;
    if bytes > MESSAGE_BYTES_MAX {
        return Err(ChannelError::TooLarge { bytes, bytes_max: MESSAGE_BYTES_MAX });
    }
    Ok(())
}

/// Many systems allow 1024 open files unless asked; should that not do, opening a file will say so.
fn raise_descriptor_limit(workers_max: usize) {
    let needed = DESCRIPTORS_BESIDES + DESCRIPTORS_PER_WORKER * workers_max as u64;
    let mut limit = getrlimit(Resource::Nofile);
    if limit.current.is_some_and(|current| current < needed) {
        limit.current = Some(limit.maximum.map_or(needed, |maximum| maximum.min(needed)));
        let _ = setrlimit(Resource::Nofile, limit);
    }
}
