//! Crews: which workers there are, and how messages travel to them and back.
//!
//! A crew carries bytes. It starts workers, ends them, and notices when one is lost; it knows nothing of
//! jobs, entries and roadmaps. Those are the [dispatcher](crate::dispatch)'s, which for its part knows nothing
//! of processes, shared memory and sockets. A member of a crew is one worker.
//!
//! - [`LocalCrew`]: worker processes of this machine, with messages and more in shared memory.
//! - [`StreamCrew`]: workers at the other end of connected sockets, wherever they run.

mod executable;
mod local;
mod process;
mod stream;
mod thread;

pub use executable::Executable;
pub use local::LocalCrew;
pub use stream::{Ending, FarEnd, Started, StreamCrew};
pub use thread::{WorkerThread, serve_stream};

use roadmill::roadmap::Digest;
use roadmill_workers::WorkerId;
use roadmill_workers::channel::ChannelError;
use std::io;
use std::os::fd::BorrowedFd;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::Duration;

/// A member from which nothing, not even a sign of life, has come for this long is stopped, stuck or cut off,
/// and is given up. Jobs may take as long as they like: the signs of life come from a thread of their own.
pub const SILENCE_MAX: Duration = Duration::from_secs(30);

/// What has happened in a crew.
#[derive(Debug)]
pub enum News {
    /// A whole message has come, its checksums verified. The member waits for one reply.
    Message {
        /// Who sent it.
        member: WorkerId,
        /// Its bytes.
        message: Vec<u8>,
    },
    /// A worker has died of itself: by a signal, a panic or an exit. What it was doing may be the reason.
    Died {
        /// Who did.
        member: WorkerId,
        /// How, for people.
        why: String,
    },
    /// A member is lost for a reason that has nothing to do with what it was doing: its connection broke, it
    /// fell silent, or what came from it is no message.
    Lost {
        /// Who is.
        member: WorkerId,
        /// The reason, for people.
        why: String,
    },
}

/// Why a crew cannot be made, or can go on no longer.
#[derive(Debug, thiserror::Error)]
pub enum CrewError {
    /// The channel in shared memory failed.
    #[error(transparent)]
    Channel(#[from] ChannelError),
    /// The system refused something; what was tried comes first.
    #[error("{0}: {1}")]
    System(String, #[source] io::Error),
}

impl CrewError {
    /// Puts what was tried before the system's answer.
    pub(crate) fn system(what: impl Into<String>) -> impl FnOnce(io::Error) -> CrewError {
        move |error| CrewError::System(what.into(), error)
    }
}

/// The workers of a build and the way to them. All methods are to be called from one thread, which lives as
/// long as the crew.
pub trait Crew {
    /// How many members it is to have.
    fn size(&self) -> usize;

    /// What its members run, for people: the path of a program, say.
    fn program(&self) -> String;

    /// Which program its members must be, in their first message: see [`roadmill_workers::build_id`].
    fn build(&self) -> Digest;

    /// Starts another member; its name, which no other ever has.
    ///
    /// # Errors
    /// When none can be started. Those that there are stay.
    fn hire(&mut self) -> io::Result<WorkerId>;

    /// Ends a member, if it has not ended, and forgets it: no news comes of it any more. How its process
    /// ended, for people, where there was one.
    fn dismiss(&mut self, member: WorkerId) -> Option<String>;

    /// Replies to the last message of a member, without waiting until the reply has arrived. It need not: a
    /// member that is gone shows it in the news.
    ///
    /// # Errors
    /// When the message is longer than [`MESSAGE_BYTES_MAX`](roadmill_workers::message::MESSAGE_BYTES_MAX).
    fn send(&mut self, member: WorkerId, message: Arc<Vec<u8>>) -> Result<(), CrewError>;

    /// Sleeps until there may be news, `also` is readable, or the time is over.
    fn wait(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>);

    /// The next news, without waiting: to be asked for until there is none. What a member had sent before it
    /// was lost comes before its loss.
    ///
    /// # Errors
    /// When the crew can go on no longer, whoever its members.
    fn next(&mut self) -> Result<Option<News>, CrewError>;

    /// Keeps bytes where all members can read them ([`roadmill_workers::SharedData::stored`]); at which
    /// offset. `None` where they share nothing, or there is no room: the bytes then have to go in messages.
    fn store(&mut self, _bytes: &[u8]) -> Option<u64> {
        None
    }

    /// How many bytes of shared memory are taken by what was stored, now and whenever it is looked at.
    fn stored_bytes(&self) -> Arc<AtomicU64> {
        Arc::default()
    }

    /// Ends all members and removes every trace of them.
    ///
    /// # Errors
    /// When something cannot be removed.
    fn close(self) -> Result<(), CrewError>;
}
