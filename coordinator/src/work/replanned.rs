//! Runs that replan others.

use super::Run;
use crate::exit::{Code, Failure};
use roadmill::problem::{OldRun, Problem};
use std::path::{Path, PathBuf};

/// Whether the run in `folder` goes on from the run that its first problem names: the other run's ledger has the hash that
/// is recorded, and its roadmap and its scene are those that the survivors were made of. `parent` says where the other
/// run is, if it is no longer where it was.
///
/// # Errors
/// Exit code 2: the other run is not found, or has another ledger; 7: it is another than what is recorded.
pub(super) fn check_parent(
    folder: &Path,
    problem: &Problem,
    parent: Option<&Path>,
) -> Result<(), Failure> {
    let run = folder.display();
    let ledger = problem.survivors().and_then(|survivors| survivors.ledger());
    let named = problem.sources().iter().rev().find(|source| Some(source.digest) == ledger);
    let place: PathBuf = match (parent, named) {
        (Some(parent), _) => parent.to_owned(),
        (None, Some(named)) => folder.join(&named.path),
        (None, None) => {
            let message = format!("{run}: the run that it replans is not named; --parent expected");
            return Err(Failure::usage(message));
        }
    };
    let needs = |why: String| {
        Failure::usage(format!(
            "{run}: the run that it replans is needed, {}: {why}; --parent says where it is",
            place.display()
        ))
    };
    let old = Run::at(&place).read().map_err(|failure| needs(failure.message))?;
    if ledger != Some(old.ledger()) {
        let expected = ledger.map_or_else(String::new, |hash| hash.to_string());
        return Err(needs(format!(
            "its ledger has the hash {}; {expected} expected (a run that has gone on since has another)",
            old.ledger()
        )));
    }
    let old_run =
        OldRun { problem: old.problem(), roadmap: old.roadmap(), ledger: old.ledger(), place: "" };
    let checked = problem.check_survivors(&old_run);
    checked.map_err(|why| {
        Failure::new(
            Code::Differs,
            format!("{run}: the first chapter: {why} ({})", place.display()),
        )
    })
}
