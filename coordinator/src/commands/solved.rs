//! Which run of a relaxation is looked at by commands that look at one run.

use crate::exit::Failure;
use crate::output::note;
use crate::run::levels_in;
use crate::work::relaxing::{Book, is_relaxation};
use std::path::{Path, PathBuf};

/// The run folder that a command looks at: the folder that it is given, or, where that is a relaxation's, the run of the level that was solved
/// last, which is said.
///
/// # Errors
/// Exit code 2: no level is solved; 4: what the relaxation came to cannot be read.
pub(super) fn run_in(given: &Path) -> Result<PathBuf, Failure> {
    if !is_relaxation(given) {
        return Ok(given.to_owned());
    }
    let (book, folder) = (Book::of(given)?, given.display());
    let Some(solved) = book.last_solved() else {
        let last = levels_in(given).and_then(|levels| levels.last().cloned());
        let those = last.map_or_else(
            || "a run expected".to_owned(),
            |last| format!("the run of a level expected, as {}", given.join(last).display()),
        );
        let message = format!("{folder}: a relaxation found, of which no level is solved; {those}");
        return Err(Failure::usage(message));
    };
    let run = given.join(book.folder_of(solved.number.saturating_sub(1) as usize)?);
    let what = if solved.level >= 1.0 { ", the problem itself" } else { ", an easier problem" };
    note(format_args!(
        "{folder}: a relaxation; the level that was solved last is number {} at {:.4}{what}: {}",
        solved.number,
        solved.level,
        run.display()
    ));
    Ok(run)
}
