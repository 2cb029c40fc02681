//! The worker process of roadmill: what it says to the coordinator, and its loop.
//!
//! A worker keeps a replica of the roadmap, does one job after the other and knows nothing of the
//! others. It is the same executable as the coordinator.

pub mod channel;
mod desk;
mod error;
mod faults;
pub mod message;
mod worker;

pub use error::WorkerError;
pub use worker::{WorkerArguments, build_id, canary, run};
