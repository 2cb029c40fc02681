//! The executor over worker processes.

mod executor;
mod log;
mod process;

pub use executor::Pool;
