//! Where a command may write its file.

use crate::exit::Failure;
use crate::files::{folder_of, is_standard_output};
use crate::run::is_of_run;
use std::fs;
use std::path::Path;

/// Refuses, before any work is done for it, a place at which no file can be written, or at which a run has one of its own; `-` is
/// standard output.
///
/// # Errors
/// Exit code 2: a folder is there, or it is a file that makes up a run.
pub(super) fn check_place(option: &str, path: &Path) -> Result<(), Failure> {
    let found = path.display();
    if is_standard_output(path) {
        return Ok(());
    }
    if path.is_dir() {
        let message = format!("{option}: {found} found, a folder; the name of a file expected");
        return Err(Failure::usage(message));
    }
    let name = path.file_name().and_then(|name| name.to_str());
    if name.is_some_and(|name| is_of_run(folder_of(path), name)) {
        let message =
            format!("{option}: {found} found, a file of a run; the name of another file expected");
        return Err(Failure::usage(message));
    }
    Ok(())
}

/// [`check_place`] of a page, which is a regular file: a named pipe that nobody reads would be waited for, once all work is done.
///
/// # Errors
/// As [`check_place`]; exit code 2, too, if something else than a regular file is there.
pub(super) fn check_page(option: &str, path: &Path) -> Result<(), Failure> {
    if is_standard_output(path) {
        let message = format!("{option}: - found; the name of a regular file expected");
        return Err(Failure::usage(message));
    }
    check_place(option, path)?;
    match fs::metadata(path) {
        Ok(there) if !there.is_file() => Err(Failure::usage(format!(
            "{option}: {} found, a named pipe, a device or a socket; the name of a regular file expected",
            path.display()
        ))),
        _ => Ok(()),
    }
}
