//! Checking a loop: every level's run, and that each level follows from what those before it came to.

use super::book::{Book, BuiltLevel};
use super::level::{LevelRun, Made};
use crate::exit::{Code, Failure};
use crate::signals::Signals;
use crate::work::interrupt::Interrupt;
use crate::work::{Run, Selection, Verified, Workers};
use roadmill::relaxation::{Ended, Outcome, Step, next};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A loop to be verified.
#[must_use = "nothing is verified before `check`"]
pub struct RelaxationVerification {
    folder: PathBuf,
    selection: Selection,
    workers: Workers,
    interrupt: Interrupt,
}

/// What a verification found to be as it is recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifiedLevels {
    /// Per level that was tried the name of its run folder with what was recomputed of it; `None` where nothing was built.
    pub levels: Vec<Option<(String, Verified)>>,
    /// Whether the loop has ended.
    pub has_ended: bool,
}

impl RelaxationVerification {
    /// The loop in this folder. `selection` says what is recomputed of each level.
    pub fn new(folder: &Path, selection: Selection) -> RelaxationVerification {
        let (workers, interrupt) = (Workers::default(), Interrupt::default());
        RelaxationVerification { folder: folder.to_owned(), selection, workers, interrupt }
    }

    /// Who recomputes; a thread for every processor if nothing is said.
    pub fn workers(self, workers: &Workers) -> RelaxationVerification {
        RelaxationVerification { workers: workers.clone(), ..self }
    }

    /// Ends when a signal comes, with a failure.
    pub fn signals(mut self, signals: &Arc<Signals>) -> RelaxationVerification {
        self.interrupt.signals = Some(signals.clone());
        self
    }

    /// Checks that each level is the one that follows from what those before it came to; that its run is of the problem that follows from
    /// the problem of the loop and from the run that helped; that it came to what is recorded; and recomputes of each run what
    /// was selected.
    ///
    /// # Errors
    /// Exit code 7: something is not as it is recorded, which the message names; 4: the folder is damaged; otherwise as of the
    /// verification of a run.
    pub fn check(self) -> Result<VerifiedLevels, Failure> {
        let RelaxationVerification { folder, selection, workers, interrupt } = self;
        let (problem, book) = Book::read(&folder)?;
        let settings = problem.relaxation().cloned().unwrap_or_default();
        let tried = book.tried(&settings)?;
        let differs =
            |what: String| Failure::new(Code::Differs, format!("{}: {what}", folder.display()));
        let mut levels = Vec::new();
        for (place, (tried, recorded)) in tried.iter().zip(&book.levels).enumerate() {
            let run = LevelRun::of(&folder, &problem, place, &tried.attempt);
            let name = &run.name;
            interrupt.check()?;
            let made = run.problem(&book, (&interrupt, None))?;
            let level = match (made, tried.outcome) {
                // Only what has come ends a search that has all the time.
                (Made::Cut, _) => return Err(interrupt.failure()),
                (Made::InvalidEnds(_), Outcome::InvalidEnds) => {
                    levels.push(None);
                    continue;
                }
                (Made::Problem(level), Outcome::Solved | Outcome::Unsolved) => level,
                (Made::InvalidEnds(why), _) => {
                    return Err(differs(format!("{name}: a run is recorded, but {why}")));
                }
                (Made::Problem(_), Outcome::InvalidEnds) => {
                    return Err(differs(format!(
                        "{name}: an end of the query is recorded as not valid, and is"
                    )));
                }
            };
            if recorded.folder.as_deref() != Some(&**name) {
                return Err(differs(format!("{name}: recorded in another folder")));
            }
            let recorded_run = Run::at(&run.folder).read()?;
            if recorded_run.problem().to_bytes() != level.to_bytes() {
                return Err(differs(format!(
                    "{name}: its problem is not the one that follows from problem.toml and from the level that helped"
                )));
            }
            if recorded.built != Some(BuiltLevel::of(&recorded_run)) {
                return Err(differs(format!("{name}: the run is not what is recorded of it")));
            }
            let has_ended = recorded_run.stopped().is_some_and(|stopped| stopped.is_final());
            let is_solved = recorded_run.path().is_some();
            if !has_ended || is_solved != (tried.outcome == Outcome::Solved) {
                let outcome = tried.outcome.name();
                return Err(differs(format!("{name}: recorded as {outcome}, which it is not")));
            }
            let verification = Run::at(&run.folder).verify(selection.clone());
            let verification = verification.workers(&workers).interrupt(&interrupt);
            levels.push(Some((name.clone(), verification.check()?)));
        }
        let word = match next(&settings, &tried) {
            Step::Try(_) => None,
            Step::End(Ended::Solved(_)) => Some("solved"),
            Step::End(Ended::NothingSolved) => Some("nothing-solved"),
            Step::End(Ended::Stuck { .. }) => Some("stuck"),
            Step::End(Ended::TooMany) => Some("too-many"),
        };
        match (&book.end, word) {
            (None, _) => Ok(VerifiedLevels { levels, has_ended: false }),
            (Some(end), Some(word)) if end == word => {
                Ok(VerifiedLevels { levels, has_ended: true })
            }
            (Some(end), _) => Err(differs(format!("the end `{end}` does not follow"))),
        }
    }
}
