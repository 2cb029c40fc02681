//! Answers single queries from the roadmap of a run, in the way that the command line asks for.

use crate::cli::{PathFormat, QueryArguments};
use crate::work::Recorded;
use roadmill::export::{parasol_path, path_csv};
use roadmill::model::Scratch;
use roadmill::query::{Answer, Path, shorten};
use roadmill::{Context, Ends};
use std::time::Instant;

/// A run together with everything that decides how its paths are written.
pub(super) struct Asker<'a> {
    pub run: &'a Recorded,
    /// How many shortcuts are tried on a path that was found; `None` leaves paths as they are.
    shorten_tries: Option<u32>,
    format: PathFormat,
}

/// The answer to a query, and the wall-clock seconds that it took, shortening included.
pub(super) struct TimedAnswer {
    pub answer: Answer,
    pub seconds: f64,
}

impl<'a> Asker<'a> {
    /// How the command line wants paths.
    pub fn new(run: &'a Recorded, arguments: &QueryArguments) -> Asker<'a> {
        Asker {
            run,
            shorten_tries: arguments.shorten.then_some(arguments.shorten_tries),
            format: arguments.format,
        }
    }

    /// The problem made ready for work.
    pub fn cx(&self) -> &Context {
        self.run.context()
    }

    /// Searches the roadmap for a path between two configurations.
    pub fn ask(&self, start: &[f64], goal: &[f64]) -> TimedAnswer {
        self.ask_any(&Ends::new(start.to_vec(), goal.to_vec()))
    }

    /// Searches the roadmap for a path to any goal of a query; where there are several, for that which costs least.
    pub fn ask_any(&self, ends: &Ends) -> TimedAnswer {
        let begun = Instant::now();
        let mut scratch = Scratch::new();
        let mut answer = self.run.solve_any(ends, &mut scratch);
        if let (Some(path), Some(tries)) = (&mut answer.path, self.shorten_tries) {
            *path = shorten(self.cx(), path, tries, &mut scratch);
        }
        TimedAnswer { answer, seconds: begun.elapsed().as_secs_f64() }
    }

    /// A path in the format that was asked for.
    pub fn text(&self, path: &Path) -> String {
        match self.format {
            PathFormat::Csv => path_csv(self.cx().space(), path),
            PathFormat::Path => parasol_path(self.cx().space(), path),
        }
    }

    /// The extension of a file in that format, without a dot.
    pub fn extension(&self) -> &'static str {
        match self.format {
            PathFormat::Csv => "csv",
            PathFormat::Path => "path",
        }
    }
}
