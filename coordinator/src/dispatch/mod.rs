//! The dispatcher: which worker gets which jobs, whatever the crew.

mod dispatcher;
mod imported;
mod log;
mod roster;

pub use dispatcher::Dispatcher;
pub use imported::Imported;
