//! Byte messages between one coordinator process (the [`Hub`]) and many worker processes (the
//! [`Link`]s), through shared memory of iceoryx2.
//!
//! A worker sends a message and gets exactly one reply to it, possibly much later; meanwhile it may work.
//! That is request-response reversed: the hub is the one server, the workers are its clients, and the
//! reply brings the next jobs. The hub never waits for a worker.
//!
//! Messages are cut into chunks of [`CHUNK_BYTES`], so that the shared memory has a fixed, small
//! size whatever the messages' lengths:
//!
//! ```text
//! link                          hub
//!  ── Data 0 ─────────────────▶      a message of three chunks:
//!  ◀───────────────── Ack 1 ──       each is a request, the hub acknowledges
//!  ── Data 1 ─────────────────▶      all but the last at once
//!  ◀───────────────── Ack 2 ──
//!  ── Data 2 ─────────────────▶      Hub::receive yields the message
//!                                    … until Hub::reply
//!  ◀──────────────── Data 0 ──       a reply of two chunks is pulled:
//!  ── Continue 1 ─────────────▶      the hub keeps it until the worker has asked
//!  ◀──────────────── Data 1 ──       for all of it
//! ```
//!
//! What all workers are to know, the hub writes once into a file in shared memory (the [`Store`]), as long
//! as there is room; messages only say where it stands. What the workers make of it and all of them have, the
//! first that needs it writes for the others (the [`SharedShelf`]).
//!
//! Every chunk has a header with a checksum; a chunk that is malformed or out of turn
//! ends the conversation with that worker, and only with that worker.
//!
//! Each hub has a private folder for locks and sockets, and another in the memory file system for everything that is
//! shared. Only its own user may enter them, and what is in them is opened without following links and looked at
//! through its descriptor before it is mapped. Both vanish with the hub, or, should it be killed, when the next
//! run of the same user starts.

mod assembly;
mod bell;
mod error;
mod header;
#[cfg(test)]
mod hostile;
mod hub;
mod link;
mod peer;
mod private_memory;
mod run_folder;
mod run_lock;
mod service;
mod shared_files;
mod shelf;
mod store;

use rustix::fs::Mode;

pub use crate::id::WorkerId;
pub use crate::message::MESSAGE_BYTES_MAX;
pub use error::ChannelError;
pub use header::Fault;
pub use hub::{Delivery, Hub, Received};
pub use link::Link;
pub use run_folder::remove_leftovers;
pub use shelf::SharedShelf;
pub use store::{Store, StoreReader};

/// Bytes of a message that travel at once. Throughput hardly changes from 128 KiB on, and with this
/// the channel of 64 workers, whose memory is taken at the start, still fits into 64 MB, the `/dev/shm` that
/// containers often get.
pub const CHUNK_BYTES: usize = 128 << 10;

/// Makes every file that this process creates from now on accessible to its own user only.
///
/// For worker processes, which write nothing that is meant for others. The channel itself protects its files
/// whatever the umask. To be called once, before any thread is started.
pub fn private_umask() {
    rustix::process::umask(Mode::RWXG | Mode::RWXO);
}
