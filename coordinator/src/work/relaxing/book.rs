//! What is written of a loop beside the runs of its levels.

use super::level::{Came, LevelRun};
use crate::exit::{Code, Failure};
use crate::files::{
    cannot_write, is_unfinished_of, make_empty, read_regular_text, remove_unfinished, write_whole,
};
use crate::run::{LEVEL, LOCK, Ledgers, PATH_CSV, RELAXATION_JSON, outside_of_runs};
use crate::work::{Recorded, Run};
use roadmill::model::SceneOptions;
use roadmill::problem::Problem;
use roadmill::relaxation::{Attempt, Ended, Outcome, Settings, Step, Tried, chain, next};
use roadmill::roadmap::Digest;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// The problem, complete.
const PROBLEM_TOML: &str = "problem.toml";
/// The folder of its meshes, beside it.
const PROBLEM_FILES: &str = "problem-meshes";
/// What the file says it is.
const FORMAT: &str = "roadmill relaxation 1";

/// Which levels were tried, and what they came to: the contents of `relaxation.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Book {
    /// What the file is.
    pub format: String,
    /// The digest of the problem, its query and how it is relaxed, with which the chain begins.
    pub problem: Digest,
    /// The levels in the order in which they were tried.
    pub levels: Vec<BookLevel>,
    /// How the loop ended: `solved`, `nothing-solved`, `stuck` or `too-many`; `null` while it goes on.
    pub end: Option<String>,
}

/// A level that was tried.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BookLevel {
    /// As which number it was tried, from 1.
    pub number: u32,
    /// The level: 1 is the problem itself.
    pub level: f64,
    /// What helped: `nothing`, `path`, `dissimilar-paths` or `distinct-paths`.
    pub guide: String,
    /// Of which level, by its number.
    pub of: Option<u32>,
    /// `solved`, `unsolved`, or `invalid-ends` where nothing could be built.
    pub outcome: String,
    /// Why nothing could.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// Its run folder.
    pub folder: Option<String>,
    /// What was built.
    pub built: Option<BuiltLevel>,
    /// A digest over all levels so far: see [`roadmill::relaxation::chain`].
    pub chain: Digest,
}

/// What was built of a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BuiltLevel {
    /// Nodes of the roadmap.
    pub nodes: u64,
    /// Its sets.
    pub sets: u64,
    /// Digest of the level's problem.
    pub problem: Digest,
    /// Digest of the roadmap.
    pub roadmap: Digest,
    /// The hash of the run's ledger up to its last complete round. Unlike all other digests here it depends on whether a signal or a limit
    /// of time ended the build on the way, as ledgers keep that.
    pub ledger: Digest,
}

/// Whether there is a relaxation in a folder.
pub fn is_relaxation(folder: &Path) -> bool {
    folder.join(RELAXATION_JSON).is_file()
}

/// Refuses a folder in which a relaxation is.
fn expect_none(folder: &Path) -> Result<(), Failure> {
    if !is_relaxation(folder) {
        return Ok(());
    }
    let there = folder.display();
    Err(Failure::usage(format!(
        "{there}: a relaxation is there already; a new folder expected, or `roadmill resume {there}`, which goes on with it"
    )))
}

impl Book {
    /// Makes the folder of a new loop, or takes an empty one. With `or_beginning` one is taken, too, that whoever was killed before there was a book
    /// has left.
    ///
    /// # Errors
    /// Exit code 2: something is there, or it cannot be made.
    pub(super) fn make_folder(folder: &Path, or_beginning: bool) -> Result<(), Failure> {
        outside_of_runs(folder)?;
        expect_none(folder)?;
        let is_known = |entry: &fs::DirEntry| {
            entry.file_name() == LOCK || is_unfinished_of(entry, &[RELAXATION_JSON])
        };
        let is_beginning = || {
            let mut entries = fs::read_dir(folder).into_iter().flatten().flatten();
            entries.all(|entry| is_known(&entry))
        };
        if or_beginning && folder.is_dir() && is_beginning() {
            return Ok(());
        }
        make_empty(folder)
    }

    /// Writes a book without levels into a folder that this process has locked, and then the problem: the book is there before anything else is, so
    /// that whoever finds the folder knows what it is to be, whenever this process is killed.
    ///
    /// # Errors
    /// Exit code 2: another process has begun a loop here meanwhile; 1: the system refuses.
    pub(super) fn begin(folder: &Path, problem: &Problem) -> Result<(), Failure> {
        expect_none(folder)?;
        let digest = digest_of(problem)?;
        let book =
            Book { format: FORMAT.to_owned(), problem: digest, levels: Vec::new(), end: None };
        remove_unfinished(folder, &[RELAXATION_JSON, PROBLEM_TOML, PATH_CSV]);
        book.write(folder)?;
        Book::write_problem(folder, problem)
    }

    /// Writes the problem, whose files come before the text that names them. Files that are there from a time before are replaced.
    fn write_problem(folder: &Path, problem: &Problem) -> Result<(), Failure> {
        let written = problem.to_toml(PROBLEM_FILES);
        if !written.files.is_empty() {
            let files = folder.join(PROBLEM_FILES);
            fs::create_dir_all(&files).map_err(|error| cannot_write(&files, &error))?;
            let names: Vec<&str> = written.files.iter().map(|(name, _)| &**name).collect();
            remove_unfinished(&files, &names);
            for (name, contents) in &written.files {
                write_whole(&files.join(name), contents)?;
            }
        }
        write_whole(&folder.join(PROBLEM_TOML), &written.text)
    }

    /// Makes the loop in a folder that this process has locked one that can go on: removes what whoever was killed has left unfinished, and writes
    /// the problem where it is missing still.
    ///
    /// # Errors
    /// Exit code 2: the problem is missing, and none is given; or it is another one than is given; 4: the book is damaged.
    pub(super) fn mend(folder: &Path, given: Option<&Problem>) -> Result<(), Failure> {
        remove_unfinished(folder, &[RELAXATION_JSON, PROBLEM_TOML, PATH_CSV]);
        let Some(given) = given else { return expect_problem(folder) };
        if Book::of(folder)?.problem != digest_of(given)? {
            return Err(Failure::usage(format!(
                "{}: cannot go on: the problem, its query or its relaxation is not what it was; another --out expected",
                folder.display()
            )));
        }
        match folder.join(PROBLEM_TOML).is_file() {
            true => Ok(()),
            false => Book::write_problem(folder, given),
        }
    }

    /// The problem and the book of a folder.
    ///
    /// # Errors
    /// Exit code 2: there is none, or the problem cannot be used; 4: the book is damaged, or not that of the problem.
    pub(super) fn read(folder: &Path) -> Result<(Problem, Book), Failure> {
        let problem = load(folder)?;
        let book = Book::of(folder)?;
        let broken = |why: &str| {
            let file = folder.join(RELAXATION_JSON);
            Failure::new(Code::BrokenRun, format!("{}: {why}", file.display()))
        };
        if book.problem != digest_of(&problem)? {
            return Err(broken("it is not about the problem in problem.toml, which has changed"));
        }
        if book.chain_is_broken(&problem)? {
            return Err(broken("its chain of digests does not fit what it says of the levels"));
        }
        Ok((problem, book))
    }

    /// The book of a folder, as it is written.
    ///
    /// # Errors
    /// Exit code 2: there is none; 4: it is damaged.
    pub fn of(folder: &Path) -> Result<Book, Failure> {
        let file = folder.join(RELAXATION_JSON);
        let text = read_regular_text(&file)
            .map_err(|error| Failure::usage(format!("{}: {error}", file.display())))?;
        let broken =
            |why: String| Failure::new(Code::BrokenRun, format!("{}: {why}", file.display()));
        let book: Book = serde_json::from_str(&text).map_err(|error| broken(error.to_string()))?;
        if book.format != FORMAT {
            return Err(broken(format!("format `{}` found; `{FORMAT}` expected", book.format)));
        }
        Ok(book)
    }

    /// The levels as the loop knows them: which was tried follows from what those before it came to, and is not read.
    ///
    /// # Errors
    /// Exit code 4: a level is not the one that follows.
    pub(super) fn tried(&self, settings: &Settings) -> Result<Vec<Tried>, Failure> {
        let mut tried: Vec<Tried> = Vec::new();
        for level in &self.levels {
            let broken = |what: &str| {
                let number = level.number;
                Failure::new(Code::BrokenRun, format!("{RELAXATION_JSON}: level {number}: {what}"))
            };
            let Step::Try(attempt) = next(settings, &tried) else {
                return Err(broken("found, but the loop had ended before it"));
            };
            if !level.is_of(tried.len(), &attempt) {
                return Err(broken("it does not follow from what the levels before it came to"));
            }
            let outcomes = [Outcome::Solved, Outcome::Unsolved, Outcome::InvalidEnds];
            let outcome = outcomes.into_iter().find(|outcome| outcome.name() == level.outcome);
            let outcome = outcome.ok_or_else(|| broken("an unknown outcome"))?;
            tried.push(Tried { attempt, outcome });
        }
        Ok(tried)
    }

    /// The run folder of the level at a place.
    ///
    /// # Errors
    /// Exit code 4: nothing was built of it.
    pub fn folder_of(&self, place: usize) -> Result<&str, Failure> {
        let folder = self.levels.get(place).and_then(|level| level.folder.as_deref());
        // The name is one that the loop gives: a path in it could lead anywhere.
        let folder = folder.filter(|name| name.starts_with(LEVEL) && !name.contains('/'));
        folder.ok_or_else(|| {
            let message = format!("{RELAXATION_JSON}: level {}: no run folder found", place + 1);
            Failure::new(Code::BrokenRun, message)
        })
    }

    /// Refuses a run that is not what the book says of it.
    pub(super) fn expect_same(
        &self,
        place: usize,
        folder: &Path,
        run: &Recorded,
    ) -> Result<(), Failure> {
        let name = self.folder_of(place)?;
        let wrong = |why: String| {
            let run = folder.join(name);
            Failure::new(Code::BrokenRun, format!("{}: {why}", run.display()))
        };
        let Some(built) = &self.levels[place].built else {
            return Err(wrong("a run found, but nothing is recorded of it".to_owned()));
        };
        let pairs = [
            ("problem", built.problem, run.problem().digest()),
            ("roadmap", built.roadmap, run.digest()),
        ];
        match pairs.into_iter().find(|(_, recorded, found)| recorded != found) {
            None => Ok(()),
            Some((what, recorded, found)) => Err(wrong(format!(
                "its {what} has the digest {found}; {recorded} expected, as {RELAXATION_JSON} says"
            ))),
        }
    }

    /// Adds a level; what is written of it.
    pub(super) fn add(
        &mut self,
        attempt: &Attempt,
        run: &LevelRun,
        came: &Came,
    ) -> Result<BookLevel, Failure> {
        let built = match &came.ended {
            None => None,
            Some(_) => Some(BuiltLevel::of(&Run::at(&run.folder).read()?)),
        };
        let before = self.levels.last().map_or(self.problem, |level| level.chain);
        let tried = Tried { attempt: *attempt, outcome: came.outcome };
        let level = BookLevel {
            number: run.number,
            level: attempt.level,
            guide: attempt.guide.name().to_owned(),
            of: attempt.guide.of().map(|place| place as u32 + 1),
            outcome: came.outcome.name().to_owned(),
            why: came.why.clone(),
            folder: built.as_ref().map(|_| run.name.clone()),
            chain: chain(before, &tried, built.as_ref().map(BuiltLevel::came_to)),
            built,
        };
        self.levels.push(level.clone());
        Ok(level)
    }

    /// Whether the chain of digests is another than what follows from the levels.
    fn chain_is_broken(&self, problem: &Problem) -> Result<bool, Failure> {
        let settings = problem.relaxation().cloned().unwrap_or_default();
        let mut at = self.problem;
        for (tried, level) in self.tried(&settings)?.iter().zip(&self.levels) {
            at = chain(at, tried, level.built.as_ref().map(BuiltLevel::came_to));
            if at != level.chain {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Notes how the loop ended.
    pub(super) fn end(&mut self, ended: Ended) {
        let word = match ended {
            Ended::Solved(_) => "solved",
            Ended::NothingSolved => "nothing-solved",
            Ended::Stuck { .. } => "stuck",
            Ended::TooMany => "too-many",
        };
        self.end = Some(word.to_owned());
    }

    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(Failure::system)?;
        write_whole(&folder.join(RELAXATION_JSON), text + "\n")
    }
}

impl BookLevel {
    /// Whether it is the level that is tried so, after so many others. Levels are read to within rounding.
    fn is_of(&self, before: usize, attempt: &Attempt) -> bool {
        let of = attempt.guide.of().map(|place| place as u32 + 1);
        let is_same_level = (self.level - attempt.level).abs() < 1e-12;
        self.number as usize == before + 1
            && is_same_level
            && self.guide == attempt.guide.name()
            && self.of == of
    }
}

impl BuiltLevel {
    pub(super) fn of(run: &Recorded) -> BuiltLevel {
        let tally = run.roadmap().tally();
        BuiltLevel {
            nodes: tally.nodes() as u64,
            sets: tally.sets(),
            problem: run.problem().digest(),
            roadmap: run.digest(),
            ledger: run.ledger(),
        }
    }

    /// What of it enters the chain.
    fn came_to(&self) -> [Digest; 2] {
        [self.problem, self.roadmap]
    }
}

/// Refuses the folder of a loop whose problem was not written any more before whoever began it was killed.
fn expect_problem(folder: &Path) -> Result<(), Failure> {
    match folder.join(PROBLEM_TOML).is_file() {
        true => Ok(()),
        false => Err(Failure::usage(format!(
            "{}: no {PROBLEM_TOML} found: whoever began this relaxation was killed before the problem was written; `roadmill relax` of the \
             problem with --or-resume expected",
            folder.display()
        ))),
    }
}

/// The problem of a folder.
fn load(folder: &Path) -> Result<Problem, Failure> {
    expect_problem(folder)?;
    let file = folder.join(PROBLEM_TOML);
    Problem::load_with(&file, &SceneOptions::default(), &Ledgers).map_err(Failure::usage)
}

fn digest_of(problem: &Problem) -> Result<Digest, Failure> {
    let none = || Failure::usage(format!("{}: no [relaxation] found", problem.name()));
    problem.relaxation_digest().ok_or_else(none)
}
