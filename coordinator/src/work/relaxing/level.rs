//! The run of one level.

use super::book::Book;
use super::help;
use crate::exit::{Code, Failure};
use crate::run::LEVEL;
use crate::work::interrupt::Interrupt;
use crate::work::{Ended, Run};
use roadmill::problem::{EarlierLevel, NoLevel, Problem};
use roadmill::relaxation::{Attempt, Outcome};
use std::path::{Path, PathBuf};

/// What there is to be built of a level.
pub(super) enum Made {
    /// The level's problem.
    Problem(Box<Problem>),
    /// Nothing, as an end of the query is not valid at this level, for this reason.
    InvalidEnds(String),
    /// Nothing yet: a search for paths through the earlier roadmap was ended before it was done. What it had found by then counts for nothing.
    Cut,
}

/// A level to be tried, and where its run is.
pub(super) struct LevelRun<'a> {
    /// As which number it is tried, the first of which is 1.
    pub number: u32,
    /// The name of its run folder.
    pub name: String,
    /// Its run folder.
    pub folder: PathBuf,
    whole: &'a Path,
    problem: &'a Problem,
    attempt: &'a Attempt,
}

impl<'a> LevelRun<'a> {
    /// The level `attempt` of the loop in the folder `whole`, tried after `before` others.
    pub fn of(
        whole: &'a Path,
        problem: &'a Problem,
        before: usize,
        attempt: &'a Attempt,
    ) -> LevelRun<'a> {
        let number = before as u32 + 1;
        let name = format!("{LEVEL}{number:02}-{:.4}", attempt.level);
        let folder = whole.join(&name);
        LevelRun { number, name, folder, whole, problem, attempt }
    }

    /// The level's problem, with what it takes over from the run of an earlier level, which `book` lists. A search for paths through the earlier
    /// roadmap ends when `interrupt` says so, or as so many seconds are over.
    ///
    /// # Errors
    /// Exit code 2: the problem cannot be relaxed so; 4: the earlier run is not what was recorded of it; 1: the system refuses a thread.
    pub fn problem(
        &self,
        book: &Book,
        (interrupt, seconds): (&Interrupt, Option<f64>),
    ) -> Result<Made, Failure> {
        let LevelRun { number, whole, problem, attempt, .. } = *self;
        let made = match attempt.guide.of() {
            None => problem.at_level(number, attempt.level, None),
            Some(place) => {
                let name = book.folder_of(place)?;
                let run = Run::at(whole.join(name)).read()?;
                book.expect_same(place, whole, &run)?;
                let earlier_level = book.levels[place].level;
                let settings = problem.relaxation().cloned().unwrap_or_default();
                let (guide, count) = (attempt.guide, settings.paths as usize);
                let Some(paths) = help::paths(&run, guide, count, (interrupt, seconds))? else {
                    return Ok(Made::Cut);
                };
                let earlier = EarlierLevel {
                    level: earlier_level,
                    problem: run.problem(),
                    roadmap: run.roadmap(),
                    place: name,
                    paths: &paths,
                };
                problem.at_level(number, attempt.level, Some(&earlier))
            }
        };
        match made {
            Ok(problem) => Ok(Made::Problem(Box::new(problem))),
            Err(NoLevel::InvalidEnds(why)) => Ok(Made::InvalidEnds(why)),
            Err(NoLevel::Refused(why)) => {
                Err(Failure::new(Code::Usage, format!("level {:.4}: {why}", attempt.level)))
            }
        }
    }
}

/// What a level came to.
pub(super) struct Came {
    pub outcome: Outcome,
    /// Its build, if anything was built.
    pub ended: Option<Ended>,
    /// Why nothing was.
    pub why: Option<String>,
}

impl Came {
    /// An end of the query is not valid at the level.
    pub fn invalid_ends(why: String) -> Came {
        Came { outcome: Outcome::InvalidEnds, ended: None, why: Some(why) }
    }

    /// A build that has ended for good.
    pub fn to(ended: Ended) -> Came {
        let outcome = match ended.path() {
            Some(_) => Outcome::Solved,
            None => Outcome::Unsolved,
        };
        Came { outcome, ended: Some(ended), why: None }
    }
}
