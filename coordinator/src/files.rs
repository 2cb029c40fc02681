//! Files written whole.

use crate::exit::Failure;
use std::path::Path;

/// Writes a file so that it is there whole or not at all.
///
/// # Errors
/// Exit code 2: it cannot be written.
pub(crate) fn write_whole(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), Failure> {
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
