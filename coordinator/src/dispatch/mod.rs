//! The dispatcher: who does which jobs, and what comes of them.
//!
//! [`Dispatcher`] is the executor of a build. Behind it is [`Staff`]: a [`Foreman`] with the workers of one crew, which take
//! turns with it, or [`Agents`] of several machines, each of which is a foreman of its own.

mod agents;
mod audit;
mod dispatcher;
mod fan_out;
mod foreman;
mod log;
mod roster;
mod sets_from_files;
mod spool;
mod staff;

pub use agents::{AgentOptions, Agents};
pub use dispatcher::Dispatcher;
pub use foreman::Foreman;
pub use roster::Roster;
pub use sets_from_files::SetsFromFiles;
pub use staff::{Audited, Board, Machine, Machines, Made, Report, Staff};
