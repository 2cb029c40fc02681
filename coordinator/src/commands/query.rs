use super::write_whole;
use crate::cli::QueryArguments;
use crate::exit::{Code, Failure};
use crate::run::Ledger;
use roadmill::export::path_csv;
use roadmill::problem::configuration;
use roadmill::query::{PATH_REFINEMENT, solve};
use roadmill::validity::Scratch;
use std::io::Write;

/// Asks a roadmap for a path.
pub fn query(arguments: &QueryArguments) -> Result<Code, Failure> {
    let ledger = Ledger::read(&arguments.run)?;
    match &ledger.stopped {
        None => eprintln!("the build has not ended; its complete rounds are searched"),
        Some(stopped) => eprintln!("the build ended: {}", stopped.reason),
    }
    let cx = ledger.problem.context();
    let given = ledger.problem.query.as_ref();
    let end = |name: &str, text: &Option<String>, given: Option<&Vec<f64>>| match (text, given) {
        (Some(text), _) => {
            configuration(&cx, text).map_err(|error| Failure::usage(format!("--{name}: {error}")))
        }
        (None, Some(q)) => Ok(q.clone()),
        (None, None) => Err(Failure::usage(format!("--{name} expected: the problem has no query"))),
    };
    let start = end("start", &arguments.start, given.map(|query| &query.start))?;
    let goal = end("goal", &arguments.goal, given.map(|query| &query.goal))?;

    let evaluators = &ledger.problem.evaluators;
    let attachment = evaluators.iter().find_map(|evaluator| evaluator.method().attachment());
    let attachment = attachment.unwrap_or_default();
    let ends = (&start[..], &goal[..]);
    let answer = solve(&cx, &ledger.roadmap, ends, &attachment, &mut Scratch::new());
    let dropped = answer.dropped_edges;
    if dropped > 0 {
        eprintln!(
            "{dropped} edges failed the {PATH_REFINEMENT} times finer check and were left out"
        );
    }
    let Some(path) = answer.path else {
        let [start, goal] = answer.attached;
        let why = match (start, goal, answer.connected) {
            (0, _, _) => "the start connects to no node of the roadmap",
            (_, 0, _) => "the goal connects to no node of the roadmap",
            (_, _, false) => "start and goal connect to different components",
            (_, _, true) => "every path between them has an edge that fails the finer check",
        };
        return Err(Failure::new(Code::NoSuccess, format!("no path: {why}")));
    };
    let csv = path_csv(&cx.space, &path);
    match &arguments.out {
        Some(file) => write_whole(file, &csv)?,
        // Whoever closes the pipe has read enough.
        None => drop(std::io::stdout().write_all(csv.as_bytes())),
    }
    eprintln!("path of {} configurations, length {:.6}", path.configs.len(), path.length);
    Ok(Code::Done)
}
