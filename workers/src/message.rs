//! What workers and coordinator say to one another, as bytes of [`roadmill::wire`].
//!
//! ```text
//! worker                                   coordinator
//! Hello { protocol, build }  ───────────▶
//!                            ◀───────────  Problem, or Refused
//! Ready { canary }           ───────────▶
//!                            ◀───────────  Work { entries, job }     as soon as there is a job
//! Finished { job, outcome }  ───────────▶
//!                            ◀───────────  Work …
//! ```
//!
//! `Work` brings the worker's replica up to date before its job. Where the entries are too many
//! for one message it comes without a job, and the worker asks for the rest with `More`.

use bincode::{Decode, Encode};
use roadmill::img::Job;
use roadmill::problem::Problem;
use roadmill::roadmap::Digest;
use std::sync::Arc;

/// Version of these messages.
pub const PROTOCOL: u32 = 2;

/// From a worker.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum FromWorker {
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
    /// The entries are in; there are more.
    More,
    /// A job is done.
    Finished {
        /// Which.
        job: Job,
        /// The bytes of its [`roadmill::img::Outcome`].
        outcome: Vec<u8>,
    },
}

/// To a worker.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum ToWorker {
    /// What is to be planned.
    Problem(Box<Problem>),
    /// The worker cannot take part; why.
    Refused(String),
    /// Entries for the replica, then a job.
    Work {
        /// The next ones, in order.
        entries: Vec<Entry>,
        /// The job, unless more entries are to come.
        job: Option<Job>,
    },
}

/// What changes a replica. Its bytes are encoded once.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum Entry {
    /// The increment at the next place: the bytes of the [`roadmill::img::Outcome`] that it is.
    Increment(Bytes),
    /// The end of a round: the bytes of a `Vec<Vec<Edge>>`, for each of its sets the edges that join it.
    Fold(Bytes),
}

/// Bytes for all workers.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum Bytes {
    /// In the channel's store, once for all.
    Stored {
        /// Where they begin.
        offset: u64,
        /// How many.
        length: u64,
        /// Their digest.
        digest: Digest,
    },
    /// In the message itself, where shared memory is short.
    Here(Arc<Vec<u8>>),
}
