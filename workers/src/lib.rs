//! The workers of roadmill: what they say to the coordinator, how it travels, and their loop.
//!
//! A worker keeps a replica of the roadmap, does one job after the other and knows nothing of the
//! others. Its loop ([`serve`]) needs a [`Line`] to its coordinator. There are two: that of a worker process
//! ([`run`]) leads through shared memory ([`channel`]), the other through a pair of byte streams ([`stream`]).

pub mod channel;
mod desk;
mod error;
mod faults;
mod id;
mod line;
pub mod message;
mod process;
mod reserve;
pub mod stream;
mod worker;

pub use error::WorkerError;
pub use id::WorkerId;
pub use line::{HEARTBEAT, Line, NothingShared, SharedData};
pub use process::{WorkerArguments, build_id, build_id_of, run};
pub use reserve::Reserve;
pub use worker::serve;
