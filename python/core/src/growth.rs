//! Builds in threads of the process.

use crate::failure::raised;
use crate::problem::load_with;
use crate::validity::{Given, PythonFunction, exception};
use pyo3::prelude::*;
use roadmill::Cancel;
use roadmill::model::ValidityFunction;
use roadmill::problem::{Limits, Problem};
use roadmill_coordinator::exit::Failure;
use roadmill_coordinator::work::{Ended, Status, Watch};
use roadmill_coordinator::{Growth, ProgressReport, Run, Workers};
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Between two times that Python is asked whether a signal came.
const SIGNALS_PAUSE: Duration = Duration::from_millis(50);
/// Between two times that the caller is told how far the build is.
const PROGRESS_PAUSE: Duration = Duration::from_millis(200);

/// What a build came to: the run folder, why it stopped in one word and for people, the exit code, and the exception that ended it.
type Grown = (PathBuf, String, String, u8, Option<Py<PyAny>>);

/// How long a build goes on, beside the problem's own limits, and who is told.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Course {
    threads: usize,
    max_nodes: Option<u64>,
    max_sets: Option<u64>,
    max_seconds: Option<f64>,
    max_memory: Option<u64>,
    /// Is called with a JSON object a few times a second.
    progress: Option<Py<PyAny>>,
    validity: Option<Given>,
}

/// Builds a roadmap in threads, in a run folder, while Python's other threads go on. A signal whose handler raises, as Ctrl-C does,
/// or an exception in `progress`, ends the build with the roadmap of the last complete round; so does an exception in a validity
/// function, which is raised.
///
/// Gives the run folder, why the build stopped in one word and for people, the exit code that the program would have, and the
/// exception that ended the build, if one did.
#[pyfunction]
#[pyo3(signature = (problem, out, seed, force, or_resume, course))]
pub fn grow(
    py: Python<'_>,
    problem: PathBuf,
    out: Option<PathBuf>,
    seed: Option<u64>,
    force: bool,
    or_resume: bool,
    course: Course,
) -> PyResult<Grown> {
    let max_seconds = course.max_seconds;
    grown(py, course, |function| {
        let problem = with_seconds(load_with(&problem, function)?, max_seconds)?;
        let seed = seed.unwrap_or(problem.seed());
        let mut growth = Run::begin(problem.with_seed(seed));
        if let Some(folder) = out {
            growth = growth.folder(folder);
        }
        if force {
            growth = growth.replace();
        }
        if or_resume {
            growth = growth.or_resume();
        }
        Ok(growth)
    })
}

/// Goes on with the build in the folder `run`, perhaps as the problem file `changed` says; as `grow` else.
#[pyfunction]
#[pyo3(signature = (run, changed, course))]
pub fn go_on(
    py: Python<'_>,
    run: PathBuf,
    changed: Option<PathBuf>,
    course: Course,
) -> PyResult<Grown> {
    grown(py, course, |function| {
        let mut growth = Run::at(run).resume();
        if let Some(function) = function {
            growth = growth.validity_function(function);
        }
        Ok(match changed {
            Some(file) => growth.with(load_with(&file, function)?),
            None => growth,
        })
    })
}

/// Grows what `begin` makes, given the validity function.
fn grown<'a>(
    py: Python<'_>,
    course: Course,
    begin: impl FnOnce(Option<&ValidityFunction>) -> Result<Growth<'a>, Failure> + Send,
) -> PyResult<Grown> {
    let Course { threads, max_nodes, max_sets, max_seconds, max_memory, progress, validity } =
        course;
    let function = validity.map(PythonFunction::new).transpose().map_err(raised)?;
    let error = Mutex::new(None);
    let grown = py.detach(|| -> Result<Ended, Failure> {
        let cancel = Cancel::new();
        let now = Instant::now();
        let watching = Watching {
            progress,
            cancel: &cancel,
            error: &error,
            begun: now,
            next_look: now,
            next_report: now + PROGRESS_PAUSE,
        };
        let mut growth = begin(function.as_ref().map(|function| &function.function))?
            .workers(&Workers::threads(threads))
            .cancel(&cancel)
            .watch(watching)
            .max_seconds(max_seconds)
            .max_memory(max_memory);
        if let Some(nodes) = max_nodes {
            growth = growth.max_nodes(nodes);
        }
        if let Some(sets) = max_sets {
            growth = growth.max_sets(sets);
        }
        growth.grow()
    });
    if let Some(function) = &function {
        // Before the calls are ended, which is no failure.
        let failed = function.function.failure().map(|failed| exception(py, failed));
        function.end_calls(py)?;
        if let Some(failed) = failed {
            return Err(failed);
        }
    }
    let error: Option<PyErr> = error.into_inner().unwrap_or(None);
    match (grown, error) {
        (Ok(ended), error) => {
            let folder = ended.run().folder().to_owned();
            let (code, _) = ended.outcome();
            let error = error.map(|error| error.into_value(py).into_any());
            let word = ended.stopped().word.clone();
            Ok((folder, word, ended.reason().to_owned(), code as u8, error))
        }
        (Err(_), Some(error)) => Err(error),
        (Err(failure), None) => Err(raised(failure)),
    }
}

/// The problem with another limit of time, if one is given.
fn with_seconds(problem: Problem, seconds: Option<f64>) -> Result<Problem, Failure> {
    let own = problem.limits();
    let limits = Limits { seconds: seconds.or(own.seconds), ..own };
    problem.with_limits(limits).map_err(|error| Failure::usage(error.to_string()))
}

/// Looks for signals, and tells the caller how far the build is.
struct Watching<'a> {
    progress: Option<Py<PyAny>>,
    cancel: &'a Cancel,
    /// What was raised.
    error: &'a Mutex<Option<PyErr>>,
    begun: Instant,
    next_look: Instant,
    next_report: Instant,
}

impl Watch for Watching<'_> {
    fn progress(&mut self, status: &Status) {
        let now = Instant::now();
        if now < self.next_look || self.cancel.is_cancelled() {
            return;
        }
        self.next_look = now + SIGNALS_PAUSE;
        let told = Python::attach(|py| {
            py.check_signals()?;
            if let Some(progress) = self.progress.as_ref().filter(|_| now >= self.next_report) {
                let report = ProgressReport::of(status, self.begun.elapsed().as_secs_f64());
                let text = serde_json::to_string(&report).unwrap_or_default();
                progress.call1(py, (text,))?;
                self.next_report = Instant::now() + PROGRESS_PAUSE;
            }
            Ok(())
        });
        if let Err(raised) = told {
            self.cancel.cancel();
            if let Ok(mut error) = self.error.lock() {
                *error = Some(raised);
            }
        }
    }
}
