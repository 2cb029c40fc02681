//! How a loop stands, as its files tell: for whoever looks while it goes on, or after it has ended.

use super::book::{Book, BookLevel};
use super::level::LevelRun;
use crate::exit::Failure;
use crate::run::{Holder, Scan};
use roadmill::model::Relaxation;
use roadmill::problem::Problem;
use roadmill::relaxation::{Outcome, Settings, Step, next};
use std::path::{Path, PathBuf};

/// How a loop stands. Nothing is locked: it may be at work.
pub struct Standing {
    folder: PathBuf,
    problem: Problem,
    settings: Settings,
    /// The levels that were tried.
    pub book: Book,
    /// The level that is being tried, or that the loop goes on with; none once it has ended.
    pub at_work: Option<AtWork>,
    /// Who works on it, if anybody has not let go of it.
    pub holder: Option<Holder>,
}

/// A level that is not done.
#[derive(Clone, Debug, PartialEq)]
pub struct AtWork {
    /// As which number it is tried, from 1.
    pub number: u32,
    /// The level: 1 is the problem itself.
    pub level: f64,
    /// What helps.
    pub guide: &'static str,
    /// Of which level, by its number.
    pub of: Option<u32>,
    /// The name of its run folder, if the run has begun.
    pub folder: Option<String>,
    /// Nodes of the run's complete rounds.
    pub nodes: u64,
    /// Why the run was ended before it was done, in a word and for people, if it was.
    pub stopped: Option<(String, String)>,
}

impl Standing {
    /// How the loop in a folder stands.
    ///
    /// # Errors
    /// Exit code 2: there is none, or its problem cannot be used; 4: the book is damaged, or not that of the problem.
    pub fn read(folder: &Path) -> Result<Standing, Failure> {
        let (problem, book) = Book::read(folder)?;
        let settings = problem.relaxation().cloned().unwrap_or_default();
        let folder = folder.to_owned();
        let mut standing =
            Standing { folder, problem, settings, book, at_work: None, holder: None };
        standing.look()?;
        Ok(standing)
    }

    /// Looks again.
    ///
    /// # Errors
    /// Exit code 4: the book is damaged.
    pub fn read_on(&mut self) -> Result<(), Failure> {
        self.book = Book::of(&self.folder)?;
        self.look()
    }

    fn look(&mut self) -> Result<(), Failure> {
        self.holder = Holder::read(&self.folder);
        let tried = self.book.tried(&self.settings)?;
        self.at_work = match next(&self.settings, &tried) {
            Step::Try(attempt) => {
                let run = LevelRun::of(&self.folder, &self.problem, tried.len(), &attempt);
                // A run that is only just being begun is none yet.
                let scan = Scan::read(&run.folder).ok();
                let end = scan.as_ref().and_then(|scan| scan.last_round.as_ref());
                let stopped = scan.as_ref().and_then(|scan| scan.stopped.as_ref());
                Some(AtWork {
                    number: run.number,
                    level: attempt.level,
                    guide: attempt.guide.name(),
                    of: attempt.guide.of().map(|place| place as u32 + 1),
                    nodes: end.map_or(0, |end| end.nodes),
                    stopped: stopped.map(|stop| (stop.word.clone(), stop.reason.clone())),
                    folder: scan.map(|_| run.name),
                })
            }
            Step::End(_) => None,
        };
        Ok(())
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The problem that is to be solved.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// How it is relaxed.
    pub fn kind(&self) -> Option<&Relaxation> {
        self.settings.kind.as_ref()
    }

    /// By how much it is relaxed at a level, for people.
    pub fn amount_at(&self, level: f64) -> String {
        self.kind().map_or_else(String::new, |kind| kind.amount_at(level))
    }

    /// Whether somebody works on it; `None` where that cannot be told from here.
    pub fn is_held(&self) -> Option<bool> {
        self.holder.as_ref().map_or(Some(false), Holder::lives)
    }
}

impl Book {
    /// The level that was solved last: the highest that is solved.
    pub fn last_solved(&self) -> Option<&BookLevel> {
        self.levels.iter().rev().find(|level| level.outcome == Outcome::Solved.name())
    }
}
