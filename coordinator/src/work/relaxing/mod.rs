//! A problem that is too hard, solved by way of easier versions of it: a folder of runs, one for each level of its relaxation.
//!
//! ```text
//! removal/
//!   problem.toml         the problem with its relaxation, complete, with its meshes in problem-meshes/
//!   relaxation.json      which levels were tried, what each came to, and a chain of digests over all of it
//!   level-01-1.0000/     the run of the level that was tried first: a run folder as any
//!   level-02-0.5000/     …
//!   path.csv             the path of the problem itself, once it is found
//!   lock                 who works on it
//! ```
//!
//! [`roadmill::relaxation::next`] decides which level is tried next; everything it needs to know follows from the runs, so that a loop
//! that was killed goes on where it was.

mod book;
mod help;
mod level;
mod standing;
mod verification;

pub use crate::run::RELAXATION_JSON;
pub use book::{Book, BookLevel, is_relaxation};
pub use standing::{AtWork, Standing};
pub use verification::{RelaxationVerification, VerifiedLevels};

use super::interrupt::Interrupt;
use super::{Ended, Run, Watch, Workers};
use crate::exit::{Code, Failure};
use crate::files::write_whole;
use crate::run::{PATH_CSV, RunLock};
use crate::signals::Signals;
use level::{Came, LevelRun, Made};
use roadmill::Cancel;
use roadmill::export::path_csv;
use roadmill::problem::Problem;
use roadmill::query::Path as QueryPath;
use roadmill::relaxation::{self, Attempt, Outcome, Settings, Step, next};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Why a search for paths was ended. What it had found by then is not used, as which that was is a matter of time.
const OUT_OF_TIME: &str =
    "the limit of time is reached while paths are looked for that help; that search begins anew";

/// A problem to be solved by way of relaxed ones: see [`Relaxing::begin`] and [`Relaxing::at`].
#[must_use = "nothing is built before `solve`"]
pub struct Relaxing<'a> {
    folder: PathBuf,
    /// The problem of a loop that begins.
    problem: Option<Problem>,
    or_resume: bool,
    workers: Workers,
    watch: Option<Box<dyn WatchLevels + 'a>>,
    interrupt: Interrupt,
    seconds: Option<f64>,
    memory: Option<u64>,
}

/// Whoever is told how the levels go.
pub trait WatchLevels {
    /// A level is begun, or gone on with, as this number, the first of which is 1, in this folder. What it gives is told how the build goes.
    fn begins(&mut self, _number: u32, _attempt: &Attempt, _folder: &Path) -> Box<dyn Watch> {
        Box::new(())
    }

    /// A level has come to this; `run` is its build, if anything was built now or before.
    fn came_to(&mut self, _level: &BookLevel, _run: Option<&Ended>) {}
}

/// Nobody.
impl WatchLevels for () {}

/// What a loop came to.
#[derive(Debug)]
pub struct Relaxed {
    /// The folder.
    pub folder: PathBuf,
    /// The problem.
    pub problem: Problem,
    /// What all levels came to.
    pub book: Book,
    /// How the loop ended; `None` where a level was not finished.
    pub ended: Option<relaxation::Ended>,
    /// By what exit code the loop was ended between two builds, and why, for people: by a signal, or by the limit of time while paths were looked
    /// for that help.
    pub cut: Option<(Code, String)>,
    /// The last level's build, where there is one.
    pub last: Option<Ended>,
    /// The path of the problem itself, once it is found.
    pub path: Option<QueryPath>,
}

impl<'a> Relaxing<'a> {
    /// The loop of a problem with a query, in a new folder. A problem that does not say how it is relaxed is relaxed as is usual for its
    /// model.
    pub fn begin(problem: Problem, folder: impl Into<PathBuf>) -> Relaxing<'a> {
        Relaxing { problem: Some(problem), ..Relaxing::at(folder) }
    }

    /// The loop in this folder, from where it ended or was killed.
    pub fn at(folder: impl Into<PathBuf>) -> Relaxing<'a> {
        Relaxing {
            folder: folder.into(),
            problem: None,
            or_resume: false,
            workers: Workers::default(),
            watch: None,
            interrupt: Interrupt::default(),
            seconds: None,
            memory: None,
        }
    }

    /// Of a loop that begins: goes on with the one in its folder, if there is one of this problem.
    pub fn or_resume(self) -> Relaxing<'a> {
        Relaxing { or_resume: true, ..self }
    }

    /// Who does the jobs; a thread for every processor if nothing is said.
    pub fn workers(self, workers: &Workers) -> Relaxing<'a> {
        Relaxing { workers: workers.clone(), ..self }
    }

    /// Tells `watch` how the levels go.
    pub fn watch(self, watch: impl WatchLevels + 'a) -> Relaxing<'a> {
        Relaxing { watch: Some(Box::new(watch)), ..self }
    }

    /// Ends the loop when `cancel` says so; the complete rounds are saved.
    pub fn cancel(mut self, cancel: &Cancel) -> Relaxing<'a> {
        self.interrupt.cancel = cancel.clone();
        self
    }

    /// Ends the loop when a signal comes; the complete rounds are saved.
    pub fn signals(mut self, signals: &Arc<Signals>) -> Relaxing<'a> {
        self.interrupt.signals = Some(signals.clone());
        self
    }

    /// Stops after this time, all levels of this call together, instead of that of the problem's limits. As of a build one round is
    /// finished in any case; a search for paths that help ends at once, and begins anew when the loop goes on.
    pub fn max_seconds(self, seconds: Option<f64>) -> Relaxing<'a> {
        Relaxing { seconds, ..self }
    }

    /// Stops at the end of a round when all processes together hold so many bytes of memory.
    pub fn max_memory(self, memory: Option<u64>) -> Relaxing<'a> {
        Relaxing { memory, ..self }
    }

    /// Tries levels until the problem itself is solved, nothing is left to be tried, or something ends the loop before.
    ///
    /// # Errors
    /// Exit code 2: the problem or the folder cannot be used, or another process works in it; 4: something in it is damaged; 1: the system
    /// refuses; 6: it was to end while the lock was waited for. A loop that ends without a path is none: [`Relaxed::outcome`] says what it
    /// came to.
    pub fn solve(self) -> Result<Relaxed, Failure> {
        let begun = Instant::now();
        let Relaxing { folder, problem, or_resume, workers, watch, interrupt, seconds, memory } =
            self;
        let mut watch = watch.unwrap_or_else(|| Box::new(()));
        workers.check()?;
        let given = problem.map(with_relaxation).transpose()?;
        let goes_on = is_relaxation(&folder) && (given.is_none() || or_resume);
        match &given {
            _ if goes_on => {}
            Some(_) => Book::make_folder(&folder, or_resume)?,
            None => {
                let message = "no relaxation here: a folder that `roadmill relax` made expected";
                return Err(Failure::usage(format!("{}: {message}", folder.display())));
            }
        }
        let mut lock = RunLock::take(&folder, || interrupt.came())?;
        match given.as_ref().filter(|_| !goes_on) {
            Some(problem) => Book::begin(&folder, problem)?,
            None => Book::mend(&folder, given.as_ref())?,
        }
        // From here on the problem is the one in the folder, so that a loop that is gone on with is the same to the byte.
        let (problem, mut book) = Book::read(&folder)?;
        workers.check_for(&problem)?;
        let settings = problem.relaxation().cloned().unwrap_or_default();
        let seconds = seconds.or(problem.limits().seconds);
        let left = || seconds.map(|all| (all - begun.elapsed().as_secs_f64()).max(0.0));
        let mut last = None;
        let cut = loop {
            if interrupt.came() {
                break interrupt.failure();
            }
            lock.beat()?;
            let attempt = match next(&settings, &book.tried(&settings)?) {
                Step::Try(attempt) => attempt,
                Step::End(ended) => {
                    let path = conclude(&folder, &problem, &mut book, ended)?;
                    let ended = Some(ended);
                    return Ok(Relaxed { folder, problem, book, ended, cut: None, last, path });
                }
            };
            let run = LevelRun::of(&folder, &problem, book.levels.len(), &attempt);
            let came = match run.problem(&book, (&interrupt, left()))? {
                Made::Cut if interrupt.came() => break interrupt.failure(),
                Made::Cut => break Failure::new(Code::NoSuccess, OUT_OF_TIME),
                Made::InvalidEnds(why) => Came::invalid_ends(why),
                Made::Problem(level) => {
                    let telling = watch.begins(run.number, &attempt, &run.folder);
                    let growing = Run::begin(*level)
                        .folder(&run.folder)
                        .or_resume()
                        .workers(&workers)
                        .watch(Boxed(telling))
                        .max_seconds(left())
                        .max_memory(memory);
                    let ended = match growing.interrupt(&interrupt).grow() {
                        Err(failure) if failure.code == Code::Interrupted => break failure,
                        ended => ended?,
                    };
                    if !ended.stopped().is_final() {
                        let (ended, last) = (None, Some(ended));
                        return Ok(Relaxed {
                            folder,
                            problem,
                            book,
                            ended,
                            cut: None,
                            last,
                            path: None,
                        });
                    }
                    Came::to(ended)
                }
            };
            let level = book.add(&attempt, &run, &came)?;
            book.write(&folder)?;
            watch.came_to(&level, came.ended.as_ref());
            last = came.ended;
        };
        let cut = Some((cut.code, cut.message));
        Ok(Relaxed { folder, problem, book, ended: None, cut, last, path: None })
    }
}

/// The problem, relaxed in the way that is usual for its model unless it says how.
///
/// # Errors
/// Exit code 2: it has no query, or its model has no usual way.
fn with_relaxation(problem: Problem) -> Result<Problem, Failure> {
    let name = problem.name().to_owned();
    let refuse = |why: String| Failure::usage(format!("{name}: {why}"));
    if problem.query().is_none() {
        return Err(refuse("no [query] found; one expected, whose path is sought".to_owned()));
    }
    if problem.relaxation().is_some() {
        return Ok(problem);
    }
    problem.with_relaxation(Settings::default()).map_err(|error| refuse(error.to_string()))
}

/// Writes what the loop ended with.
fn conclude(
    folder: &Path,
    problem: &Problem,
    book: &mut Book,
    ended: relaxation::Ended,
) -> Result<Option<QueryPath>, Failure> {
    let path = match ended {
        relaxation::Ended::Solved(place) => {
            let run = Run::at(folder.join(book.folder_of(place)?)).read()?;
            // What a file says may have been changed: the path is given out of the run that the level was solved by, and of no other.
            book.expect_same(place, folder, &run)?;
            Some(run.path().cloned().ok_or_else(|| {
                let why = "no path found in the run of the level that is solved";
                Failure::new(Code::BrokenRun, format!("{}: {why}", folder.display()))
            })?)
        }
        _ => None,
    };
    if let Some(path) = &path {
        write_whole(&folder.join(PATH_CSV), path_csv(&problem.space(), path))?;
    }
    book.end(ended);
    book.write(folder)?;
    Ok(path)
}

/// A watch behind a pointer.
struct Boxed(Box<dyn Watch>);

impl Watch for Boxed {
    fn begun(&mut self, begun: &super::Begun) {
        self.0.begun(begun);
    }

    fn progress(&mut self, status: &super::Status) {
        self.0.progress(status);
    }
}

impl Relaxed {
    /// The exit code of the program `roadmill` for such an end, and what it says of it.
    pub fn outcome(&self) -> (Code, String) {
        let levels = self.book.levels.len();
        match self.ended {
            Some(relaxation::Ended::Solved(_)) => {
                (Code::Done, format!("solved, by {levels} level{}", plural(levels)))
            }
            Some(relaxation::Ended::NothingSolved) => (
                Code::NoSuccess,
                "not even the most relaxed level is solved: a larger limit of nodes, or more that is relaxed, may help".to_owned(),
            ),
            Some(relaxation::Ended::Stuck { solved, failed }) => (
                Code::NoSuccess,
                format!(
                    "level {solved:.4} is solved and level {failed:.4} is not, whatever helped: a larger limit of nodes, smaller \
                     steps, another kind of relaxation or another seed may help"
                ),
            ),
            Some(relaxation::Ended::TooMany) => (
                Code::NoSuccess,
                format!("{levels} level{} tried, as many as the relaxation allows", plural(levels)),
            ),
            None => match (&self.cut, &self.last) {
                (Some(cut), _) => cut.clone(),
                (None, Some(last)) => match last.outcome() {
                    (Code::Done, reason) => (Code::NoSuccess, reason),
                    other => other,
                },
                (None, None) => (Code::NoSuccess, "nothing was tried".to_owned()),
            },
        }
    }

    /// Whether the loop goes on when it is resumed.
    pub fn goes_on(&self) -> bool {
        self.ended.is_none()
    }

    /// What the highest level came to that is solved, if any is.
    pub fn highest_solved(&self) -> Option<&BookLevel> {
        let solved = |level: &&BookLevel| level.outcome == Outcome::Solved.name();
        self.book.levels.iter().filter(solved).max_by(|a, b| a.level.total_cmp(&b.level))
    }
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
