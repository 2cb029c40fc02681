//! The dispatcher: which worker gets which jobs, whatever the crew.

mod dispatcher;
mod log;
mod roster;
mod sets_from_files;

pub use dispatcher::Dispatcher;
pub use sets_from_files::SetsFromFiles;
