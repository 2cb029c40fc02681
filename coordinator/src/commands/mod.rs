//! One file per command.

mod asker;
mod batch;
mod build;
mod check;
mod crew;
mod diff;
mod export;
mod generate;
mod import;
mod load;
mod log;
mod paths;
mod protein;
mod query;
mod report;
mod resume;
mod search;
mod status;
mod verify;
mod worker;
mod written;

pub use build::build;
pub use check::check;
pub use diff::diff;
pub use export::export;
pub use generate::generate;
pub use import::import;
pub use log::log;
pub use paths::paths;
pub use protein::protein;
pub use query::query;
pub use report::report;
pub use resume::resume;
pub use status::status;
pub use verify::verify;
pub use worker::worker;
