//! What workers and coordinator say to one another, as bytes of [`roadmill::internal::wire`].
//!
//! ```text
//! worker                                   coordinator
//! Hello { protocol, build }  ───────────▶
//!                            ◀───────────  Problem, or Refused
//! Ready { canary }           ───────────▶
//!                            ◀───────────  Work { entries, jobs }     as soon as there is a job
//! Done: one or several       ───────────▶
//!     it goes on with        ◀───────────  Work …                     at once where it holds jobs yet
//!     what it holds
//! ```
//!
//! `Work` brings the worker's replica up to date and adds jobs to those that the worker holds; it does the
//! most urgent first. It tells what it has done when few are left to begin, so that the reply comes
//! while it works, and when its last urgent one is done, since others may wait for that. Where the entries
//! are too many for one message they come without jobs; a worker that has neither job nor outcome says
//! `Done` of nothing to get the rest.

use bincode::{BorrowDecode, Decode, Encode};
use roadmill::img::Job;
use roadmill::problem::Problem;
use roadmill::roadmap::Digest;
use std::sync::Arc;

/// Version of these messages.
pub const PROTOCOL: u32 = 4;

/// The longest message in bytes, either way.
pub const MESSAGE_BYTES_MAX: u64 = 1 << 30;

/// From a worker.
#[derive(Debug, Clone, PartialEq, Encode, BorrowDecode)]
pub enum FromWorker<'a> {
    /// The first message.
    Hello {
        /// [`PROTOCOL`] of the worker.
        protocol: u32,
        /// Which executable it runs: see [`crate::build_id`].
        build: Digest,
    },
    /// The problem is set up.
    Ready {
        /// Digest of a small increment made for comparison: the same arithmetic gives the same.
        canary: Digest,
    },
    /// Jobs that are done, in the order in which they were.
    Done(Vec<Done<'a>>),
}

/// A job that is done.
#[derive(Debug, Clone, PartialEq, Encode, BorrowDecode)]
pub struct Done<'a> {
    /// Which.
    pub job: Job,
    /// How long it took, in microseconds on the clock. It tells how many jobs make a message, never what
    /// comes of them.
    pub micros: u64,
    /// The bytes of its [`roadmill::img::Outcome`].
    pub outcome: &'a [u8],
}

/// To a worker.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum ToWorker {
    /// What is to be planned.
    Problem(Box<Problem>),
    /// The worker cannot take part; why.
    Refused(String),
    /// Entries for the replica, then jobs.
    Work {
        /// The next ones, in order.
        entries: Vec<Entry>,
        /// More jobs; none while more entries are to come.
        jobs: Vec<Job>,
    },
}

/// What changes a replica. Its bytes are encoded once.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum Entry {
    /// The increment of the next set: the bytes of the [`roadmill::img::Outcome`] that it is.
    Increment(Bytes),
    /// The end of a round: for each of its sets the bytes of the [`roadmill::img::Outcome`] that joins it.
    Fold(Vec<Bytes>),
}

/// Bytes for all workers.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum Bytes {
    /// Stored where all workers can read them: see [`SharedData::stored`](crate::SharedData::stored).
    Stored {
        /// Where they begin.
        offset: u64,
        /// How many.
        length: u64,
        /// Their digest.
        digest: Digest,
    },
    /// In the message itself, where workers share no memory or it is short.
    Here(Arc<Vec<u8>>),
}
