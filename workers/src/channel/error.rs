//! What can go wrong on a channel.

use std::io;
use std::path::PathBuf;

use super::header::Fault;

/// Why a channel could not do what it was asked to.
#[derive(Debug, thiserror::Error)]
pub enum ChannelError {
    /// A file, folder or socket of the run could not be used.
    #[error("{action} {}: {source}", path.display())]
    Io {
        /// what was tried, as "could not …"
        action: &'static str,
        /// on which file
        path: PathBuf,
        /// the system's answer
        source: io::Error,
    },
    /// The shared-memory library refused.
    #[error("shared memory: {action}: {detail}")]
    SharedMemory {
        /// what was tried, as "could not …"
        action: &'static str,
        /// the library's own name of the failure
        detail: String,
    },
    /// Writing to a full memory file system kills the process, so it is refused beforehand.
    #[error(
        "{} has {free_bytes} bytes free, but {workers_max} workers may need {needed_bytes}; use fewer workers or enlarge it",
        path.display()
    )]
    NoSpace {
        /// the memory file system
        path: PathBuf,
        /// bytes an ordinary user may still take there
        free_bytes: u64,
        /// bytes the channel may come to touch
        needed_bytes: u64,
        /// the number of workers that was asked for
        workers_max: usize,
    },
    /// The folder of all runs is not a private folder of this user.
    #[error("{} is not safe to use: {reason}", path.display())]
    Unsafe {
        /// the folder
        path: PathBuf,
        /// what is wrong with it
        reason: &'static str,
    },
    /// Another process has held the lock of the folder of all runs for too long.
    #[error("{} stays locked by another process", path.display())]
    Busy {
        /// the folder
        path: PathBuf,
    },
    /// A message is longer than [`MESSAGE_BYTES_MAX`](super::MESSAGE_BYTES_MAX).
    #[error("a message of {bytes} bytes is longer than the limit of {bytes_max}")]
    TooLarge {
        /// length of the message
        bytes: u64,
        /// the limit
        bytes_max: u64,
    },
    /// `keep_waiting` said that the answer is no longer wanted.
    #[error("waiting for the coordinator's answer was given up")]
    Abandoned,
    /// The coordinator has ended, or has never been there.
    #[error("the coordinator is gone")]
    HubGone,
    /// The coordinator dropped the message without an answer.
    #[error("the coordinator refused the message")]
    Refused,
    /// The coordinator's answer is malformed.
    #[error("the coordinator's answer is broken: {0}")]
    BrokenReply(#[source] Fault),
    /// An earlier call on this link failed half-way, so both ends no longer agree.
    #[error("the link cannot be used after a failed call")]
    Spoiled,
}

impl ChannelError {
    /// Puts the file and the attempt beside the system's answer.
    pub(super) fn io(
        action: &'static str,
        path: impl Into<PathBuf>,
    ) -> impl FnOnce(io::Error) -> ChannelError {
        let path = path.into();
        move |source| ChannelError::Io { action, path, source }
    }

    /// Puts the attempt beside the library's failure, whose only text is its name.
    pub(super) fn shared<E: std::fmt::Debug>(
        action: &'static str,
    ) -> impl FnOnce(E) -> ChannelError {
        move |error| ChannelError::SharedMemory { action, detail: format!("{error:?}") }
    }
}
