//! The executor over worker processes.

mod executor;
mod imported;
mod log;
mod process;

pub use executor::Pool;
pub use imported::Imported;
