use super::{batch, write_whole};
use crate::cli::{PathFormat, QueryArguments};
use crate::exit::{Code, Failure};
use crate::run::Ledger;
use roadmill::Context;
use roadmill::export::{animation, parasol_path, path_csv};
use roadmill::model::Scratch;
use roadmill::problem::configuration;
use roadmill::query::{Answer, Attachment, PATH_REFINEMENT, Path, shorten, solve};
use roadmill::roadmap::Roadmap;
use std::io::Write;
use std::time::Instant;

/// Asks a roadmap for a path, or for many.
pub fn query(arguments: &QueryArguments) -> Result<Code, Failure> {
    let ledger = Ledger::read(&arguments.run)?;
    match &ledger.stopped {
        None => eprintln!("the build has not ended; its complete rounds are searched"),
        Some(stopped) => eprintln!("the build ended: {}", stopped.reason),
    }
    let asker = Asker::new(&ledger, arguments);
    let cx = &asker.cx;
    if let (Some(file), Some(folder)) = (&arguments.queries, &arguments.out) {
        return batch::batch(&asker, file, folder);
    }
    let given = ledger.problem.query.as_ref();
    let end = |name: &str, text: &Option<String>, given: Option<&Vec<f64>>| match (text, given) {
        (Some(text), _) => {
            configuration(cx, text).map_err(|error| Failure::usage(format!("--{name}: {error}")))
        }
        (None, Some(q)) => Ok(q.clone()),
        (None, None) => Err(Failure::usage(format!("--{name} expected: the problem has no query"))),
    };
    let start = end("start", &arguments.start, given.map(|query| &query.start))?;
    let goal = end("goal", &arguments.goal, given.map(|query| &query.goal))?;

    let Asked { answer, seconds } = asker.ask(&start, &goal);
    let dropped = answer.dropped_edges;
    if dropped > 0 {
        eprintln!(
            "{dropped} edges failed the {PATH_REFINEMENT} times finer check and were left out"
        );
    }
    let Some(path) = &answer.path else {
        let why = why_not(&answer);
        return Err(Failure::new(Code::NoSuccess, format!("no path: {why} ({seconds:.3} s)")));
    };
    let text = asker.text(path);
    match &arguments.out {
        Some(file) => write_whole(file, &text)?,
        // Whoever closes the pipe has read enough.
        None => drop(std::io::stdout().write_all(text.as_bytes())),
    }
    if let Some(file) = &arguments.animate {
        match animation(&ledger.problem, path) {
            Some(page) => write_whole(file, page)?,
            None => return Err(Failure::usage("--animate: this model cannot be drawn")),
        }
    }
    let (configs, length) = (path.configs.len(), path.length);
    eprintln!("path of {configs} configurations, length {length:.6}, in {seconds:.3} s");
    Ok(Code::Done)
}

/// What asks a roadmap, and how.
pub(super) struct Asker<'a> {
    pub cx: Context,
    roadmap: &'a Roadmap,
    attachment: Attachment,
    shorten_tries: Option<u32>,
    format: PathFormat,
}

/// What a query came to, and the wall seconds that it took, shortening included.
pub(super) struct Asked {
    pub answer: Answer,
    pub seconds: f64,
}

impl<'a> Asker<'a> {
    fn new(ledger: &'a Ledger, arguments: &QueryArguments) -> Asker<'a> {
        let evaluators = &ledger.problem.evaluators;
        let attachment = evaluators.iter().find_map(|evaluator| evaluator.method().attachment());
        Asker {
            cx: ledger.problem.context(),
            roadmap: &ledger.roadmap,
            attachment: attachment.unwrap_or_default(),
            shorten_tries: arguments.shorten.then_some(arguments.shorten_tries),
            format: arguments.format,
        }
    }

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

    /// A path in the chosen format.
    pub fn text(&self, path: &Path) -> String {
        match self.format {
            PathFormat::Csv => path_csv(&self.cx.space, path),
            PathFormat::Path => parasol_path(&self.cx.space, path),
        }
    }

    /// How the names of its files end.
    pub fn extension(&self) -> &'static str {
        match self.format {
            PathFormat::Csv => "csv",
            PathFormat::Path => "path",
        }
    }
}

/// Why there is no path.
fn why_not(answer: &Answer) -> &'static str {
    let [start, goal] = answer.attached;
    match (start, goal, answer.connected) {
        (0, _, _) => "the start connects to no node of the roadmap",
        (_, 0, _) => "the goal connects to no node of the roadmap",
        (_, _, false) => "start and goal connect to different components",
        (_, _, true) => "every path between them has an edge that fails the finer check",
    }
}
