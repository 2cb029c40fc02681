//! Commands that make a problem, grow its roadmap and write a page about it, all in one.

use super::build::{bounded_problem, grow_in};
use super::load::load_file;
use super::place::check_page;
use super::written::{remove_problem, write_problem};
use crate::cli::JobArguments;
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::output::note;
use crate::run::outside_of_runs;
use crate::signals::Signals;
use crate::work::{Recorded, Run};
use roadmill::problem::Problem;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// The share of `--max-time` that the search for the page's paths has in any case: a build that ends because of the time leaves
/// nothing of it.
const SEARCH_MIN: f64 = 0.1;

/// What such a command makes, and where.
pub(super) struct Job<'a> {
    arguments: &'a JobArguments,
    cpu: CpuClock,
    /// The run folder, without a slash at the end, as shells complete it.
    out: PathBuf,
    /// The problem file beside it.
    pub file: PathBuf,
    page: PathBuf,
}

/// A page that is to be written.
pub(super) struct Page<'a> {
    /// The run folder.
    pub run: &'a Path,
    /// The page's file.
    pub out: &'a Path,
    /// How many seconds there are for what is looked for.
    pub max_time: Option<f64>,
    /// What may end it.
    pub signals: &'a Signals,
}

impl<'a> Job<'a> {
    /// # Errors
    /// Exit code 2: something can be seen not to be writable, lies in the folder of another run, or is a page that may not be replaced.
    pub fn begin(arguments: &'a JobArguments) -> Result<Job<'a>, Failure> {
        let cpu = CpuClock::start();
        let out: PathBuf = arguments.out.components().collect();
        if out.file_name().is_none() {
            let message = format!("--out: {} found; the name of a folder expected", out.display());
            return Err(Failure::usage(message));
        }
        let beside = |extension: &str| {
            let mut file = OsString::from(&out);
            file.push(extension);
            PathBuf::from(file)
        };
        let (file, page) = (beside(".toml"), beside(".html"));
        outside_of_runs(&out)?;
        check_page("--out", &page)?;
        if page.try_exists().unwrap_or(true) && !(arguments.force || arguments.or_resume) {
            let message = format!("{}: it is there already; --force replaces it", page.display());
            return Err(Failure::usage(message));
        }
        Ok(Job { arguments, cpu, out, file, page })
    }

    /// Writes the problem, grows its roadmap, and has the page written by `write`; `announce` says of what, once the problem is
    /// there.
    ///
    /// The problem is written beside the run folder first, and read from there, so that whatever becomes of the build it can
    /// be looked at, changed, and built again. A problem file that is there already is used if it is the same problem. Where the
    /// command line or the run folder cannot be used, so that no build begins, no problem is left either.
    pub fn carry_out(
        self,
        problem: &Problem,
        comment: &str,
        announce: impl FnOnce(),
        write: impl FnOnce(&Recorded, &Page) -> Result<Code, Failure>,
    ) -> Result<Code, Failure> {
        let Job { arguments, cpu, out, file, page } = self;
        let JobArguments { seed, force, or_resume, growth, .. } = arguments;
        let problem = problem.clone().with_seed(seed.unwrap_or(problem.seed()));
        // What cannot be used of the command line is said before anything is written.
        bounded_problem(problem.clone(), growth)?;
        // From here on a signal never leaves half of anything unexplained.
        let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
        let is_there = file.try_exists().unwrap_or(true);
        if is_there && !force {
            let there = load_file(&file)?;
            if there.digest() != problem.digest() {
                let message = format!(
                    "{}: another problem found; the same, or --force, or another --out expected",
                    file.display()
                );
                return Err(Failure::usage(message));
            }
            note(format_args!("{}: the problem is there already", file.display()));
        } else {
            if let Some(folder) = out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                fs::create_dir_all(folder).map_err(|error| {
                    Failure::system(format!("{}: cannot be made: {error}", folder.display()))
                })?;
            }
            write_problem(&problem, comment, &file, (*force, growth.json))?;
        }
        announce();
        let begun = Instant::now();
        let ended = load_file(&file).and_then(|problem| {
            let (problem, workers) = bounded_problem(problem, growth)?;
            let growing = Run::begin(problem).workers(&workers).signals(&signals);
            let growing = growing.max_seconds(growth.max_time);
            grow_in(growing, (Some(&out), *force, *or_resume), growth, cpu)
        });
        let code = ended.as_ref().map_or_else(|failure| failure.code, |code| *code);
        // Such a failure comes before the first round: the run folder is taken, or another process works on the run.
        if code == Code::Usage && !is_there {
            remove_problem(&problem, &file);
        }
        // Also of a roadmap that a limit has ended: the page says so.
        if matches!(code, Code::Done | Code::NoSuccess) {
            let left = |whole: f64| (whole - begun.elapsed().as_secs_f64()).max(SEARCH_MIN * whole);
            let max_time = growth.max_time.map(left);
            let page = Page { run: &out, out: &page, max_time, signals: &signals };
            write(&Run::at(&out).read()?, &page)?;
        }
        ended
    }
}
