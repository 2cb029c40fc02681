//! The executor over worker processes.

mod executor;
mod imported;
mod log;
mod process;
mod roster;

pub use executor::Pool;
pub use imported::Imported;
