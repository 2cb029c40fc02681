//! What a worker needs of the outside: a line to its coordinator, and what it shares with other workers.

use crate::error::WorkerError;
use roadmill::internal::shelf::Shelf;
use std::io;
use std::sync::Arc;
use std::time::Duration;

/// How often a worker shows that it lives, whatever its line and however long its job.
pub const HEARTBEAT: Duration = Duration::from_secs(1);

/// A worker's end of the line to its coordinator. The two take turns: to every message of the worker comes
/// exactly one reply, possibly much later, and the worker sends no other message before it. Meanwhile it
/// may work.
///
/// That the coordinator is gone is an error like others; [`WorkerError::is_end`] tells it from them.
pub trait Line {
    /// Sends a message. The coordinator finds it when it next looks, which [`nudge`](Line::nudge) and
    /// [`receive`](Line::receive) hasten.
    ///
    /// # Errors
    /// When the line is broken, or the last message has not been answered.
    fn send(&mut self, message: &[u8]) -> Result<(), WorkerError>;

    /// Sleeps until the whole reply to the last message is there.
    ///
    /// # Errors
    /// When the line is broken, or no message awaits a reply.
    fn receive(&mut self) -> Result<Vec<u8>, WorkerError>;

    /// The reply to the last message, or `None` if it is not there yet. Does not sleep.
    ///
    /// # Errors
    /// As [`receive`](Line::receive).
    fn try_receive(&mut self) -> Result<Option<Vec<u8>>, WorkerError>;

    /// Makes the coordinator look at the message sent last now.
    fn nudge(&mut self);

    /// Whether a message was sent whose reply has not been received.
    fn is_awaiting(&self) -> bool;

    /// Sends a message and sleeps until the reply is there.
    ///
    /// # Errors
    /// As [`send`](Line::send) and [`receive`](Line::receive).
    fn call(&mut self, message: &[u8]) -> Result<Vec<u8>, WorkerError> {
        self.send(message)?;
        self.receive()
    }
}

/// What the workers of one machine share besides their lines, so that it is there once and not once for each.
pub trait SharedData {
    /// Reads bytes that the coordinator has stored for all its workers: `length` of them from `offset` on.
    /// Whether they are the right ones is for the caller to check.
    ///
    /// # Errors
    /// When they are not there.
    fn stored(&self, offset: u64, length: u64) -> io::Result<Vec<u8>>;

    /// Where replicas of the roadmap keep the parts that never change any more; `None` where each keeps its own.
    fn shelf(&self) -> Option<Arc<dyn Shelf>>;
}

/// Of a worker that shares nothing: all that it needs to know comes in messages, and its replica of the
/// roadmap is its own.
#[derive(Debug, Clone, Copy, Default)]
pub struct NothingShared;

impl SharedData for NothingShared {
    fn stored(&self, _offset: u64, _length: u64) -> io::Result<Vec<u8>> {
        Err(io::Error::new(io::ErrorKind::NotFound, "this worker has no store"))
    }

    fn shelf(&self) -> Option<Arc<dyn Shelf>> {
        None
    }
}
