//! One file per command.

mod asker;
mod batch;
mod build;
mod check;
mod diff;
mod difference;
mod export;
mod generate;
mod grow;
mod import;
mod load;
mod log;
mod query;
mod resume;
mod status;
mod verify;
mod worker;

pub use build::build;
pub use check::check;
pub use diff::diff;
pub use export::export;
pub use generate::generate;
pub use import::import;
pub use log::log;
pub use query::query;
pub use resume::resume;
pub use status::status;
pub use verify::verify;
pub use worker::worker;

use crate::exit::Failure;
use std::path::Path;

/// Writes a file so that it is there whole or not at all.
///
/// # Errors
/// Exit code 2: it cannot be written.
fn write_whole(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), Failure> {
    let cannot = |error| Failure::usage(format!("{}: cannot write: {error}", path.display()));
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}", std::process::id()));
    let beside = path.with_file_name(name);
    std::fs::write(&beside, contents).map_err(cannot)?;
    std::fs::rename(&beside, path).map_err(|error| {
        // The temporary file is of no use to anybody now.
        let _ = std::fs::remove_file(&beside);
        cannot(error)
    })
}
