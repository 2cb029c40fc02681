//! Answers single queries from the roadmap of a run, in the way that the command line asks for.

use crate::cli::{PathFormat, QueryArguments};
use crate::run::Ledger;
use roadmill::Context;
use roadmill::export::{parasol_path, path_csv};
use roadmill::model::Scratch;
use roadmill::query::{Answer, Attachment, Path, shorten, solve};
use roadmill::roadmap::Roadmap;
use std::time::Instant;

/// A roadmap together with everything that decides how its queries are answered and written.
pub(super) struct Asker<'a> {
    pub cx: Context,
    roadmap: &'a Roadmap,
    attachment: Attachment,
    /// How many shortcuts are tried on a path that was found; `None` leaves paths as they are.
    shorten_tries: Option<u32>,
    format: PathFormat,
}

/// The answer to a query, and the wall-clock seconds that it took, shortening included.
pub(super) struct Asked {
    pub answer: Answer,
    pub seconds: f64,
}

impl<'a> Asker<'a> {
    /// Start and goal are attached to the roadmap as the problem's first evaluator that attaches
    /// configurations does it, or, without one, with the default settings.
    pub fn new(ledger: &'a Ledger, arguments: &QueryArguments) -> Asker<'a> {
        Asker {
            cx: ledger.problem.context(),
            roadmap: &ledger.roadmap,
            attachment: ledger.problem.attachment(),
            shorten_tries: arguments.shorten.then_some(arguments.shorten_tries),
            format: arguments.format,
        }
    }

    /// Searches the roadmap for a path between two configurations.
    pub fn ask(&self, start: &[f64], goal: &[f64]) -> Asked {
        let begun = Instant::now();
        let mut scratch = Scratch::new();
        let mut answer =
            solve(&self.cx, self.roadmap, (start, goal), &self.attachment, &mut scratch);
        if let (Some(path), Some(tries)) = (&mut answer.path, self.shorten_tries) {
            *path = shorten(&self.cx, path, tries, &mut scratch);
        }
        Asked { answer, seconds: begun.elapsed().as_secs_f64() }
    }

    /// A path in the format that was asked for.
    pub fn text(&self, path: &Path) -> String {
        match self.format {
            PathFormat::Csv => path_csv(&self.cx.space, path),
            PathFormat::Path => parasol_path(&self.cx.space, path),
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
