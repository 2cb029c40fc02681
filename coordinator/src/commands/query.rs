use super::asker::{Asker, TimedAnswer};
use super::batch;
use super::place::{check_page, check_place};
use super::solved::run_in;
use crate::cli::{ClearestBy, QueryArguments};
use crate::exit::{Code, Failure};
use crate::files::{expect_folder, write_out, write_whole};
use crate::output::{self, note};
use crate::work::{Recorded, Run};
use roadmill::Ends;
use roadmill::clearance::AlongMotion;
use roadmill::export::animation;
use roadmill::problem::configuration;
use roadmill::query::{ClearPath, Clearest, PATH_REFINEMENT, Path};
use std::time::Instant;

/// Answers one query from the roadmap of a run, or, with `--queries`, all queries of a file.
pub fn query(arguments: &QueryArguments) -> Result<Code, Failure> {
    let out = arguments.out.as_ref().filter(|_| arguments.queries.is_none());
    out.map_or(Ok(()), |file| check_place("--out", file))?;
    let folder = arguments.out.as_ref().filter(|_| arguments.queries.is_some());
    folder.map_or(Ok(()), |folder| expect_folder("--out", folder))?;
    arguments.animate.as_ref().map_or(Ok(()), |file| check_page("--animate", file))?;
    let run = Run::at(run_in(&arguments.run)?).read()?;
    match run.stopped() {
        None => note("the build has not ended; its complete rounds are searched"),
        Some(stopped) => note(format_args!("the build ended: {}", stopped.reason)),
    }
    let asker = Asker::new(&run, arguments);
    if let (Some(file), Some(folder)) = (&arguments.queries, &arguments.out) {
        return batch::batch(&asker, file, folder);
    }
    let ends = ends(&run, &arguments.start, &arguments.goal)?;
    if let Some(by) = arguments.clearest {
        return clearest(&asker, arguments, &ends, by);
    }

    let TimedAnswer { answer, seconds } = asker.ask_any(&ends);
    let dropped = answer.dropped_edges;
    if dropped > 0 {
        note(format_args!(
            "{dropped} edges failed the {PATH_REFINEMENT} times finer check and were left out"
        ));
    }
    let Some(path) = &answer.path else {
        let why = answer.why_no_path();
        return Err(Failure::new(Code::NoSuccess, format!("no path: {why} ({seconds:.3} s)")));
    };
    give(&asker, arguments, path)?;
    let (configs, length) = (path.configs.len(), path.length);
    let plural = if configs == 1 { "" } else { "s" };
    let to = match ends.goal_number(path.configs.iter()) {
        Some(number) => format!(" to goal {number} of {}", ends.goals().count()),
        None => String::new(),
    };
    note(format_args!(
        "path of {configs} configuration{plural}{to}, length {length:.6}, in {seconds:.3} s"
    ));
    Ok(Code::Done)
}

/// Finds the path that keeps away from obstacles best.
///
/// # Errors
/// Exit code 2: the problem has several goals and the command line gives none, or it has no clearances. Exit code 3: there is no path.
fn clearest(
    asker: &Asker,
    arguments: &QueryArguments,
    ends: &Ends,
    by: ClearestBy,
) -> Result<Code, Failure> {
    if !ends.other_goals.is_empty() {
        let count = ends.goals().count();
        return Err(Failure::usage(format!(
            "--clearest: {count} goals of the problem found, one expected, by --goal"
        )));
    }
    let by = match by {
        ClearestBy::Widest => Clearest::Widest,
        ClearestBy::Weighted => Clearest::Weighted,
    };
    let begun = Instant::now();
    let found = asker.run.clearest((&ends.start, &ends.goal), by)?;
    let seconds = begun.elapsed().as_secs_f64();
    let Some(ClearPath { path, clearance }) = found else {
        let why = asker.ask_any(ends).answer.why_no_path();
        return Err(Failure::new(Code::NoSuccess, format!("no path: {why} ({seconds:.3} s)")));
    };
    give(asker, arguments, &path)?;
    let (configs, length) = (path.configs.len(), path.length);
    let AlongMotion { least, mean, .. } = clearance;
    note(format_args!(
        "path of {configs} configurations, length {length:.6}, clearance {least:.6} at least and {mean:.6} in the mean, in {seconds:.3} s"
    ));
    Ok(Code::Done)
}

/// Writes a path to where the command line wants it, and the page that plays it.
fn give(asker: &Asker, arguments: &QueryArguments, path: &Path) -> Result<(), Failure> {
    let text = asker.text(path);
    match &arguments.out {
        Some(file) => write_out(file, &text)?,
        None => {
            output::data(&text);
        }
    }
    let Some(file) = &arguments.animate else { return Ok(()) };
    match animation(asker.run.problem(), path) {
        Some(page) => write_whole(file, page),
        None => Err(Failure::usage("--animate: this model cannot be drawn")),
    }
}

/// The start and the goal that the command line gives, or else the problem's, of which there may be several goals.
///
/// # Errors
/// Exit code 2: one is given that cannot be used, or none where the problem has no query; or the problem has a validity
/// function, which the program cannot have.
pub(super) fn ends(
    run: &Recorded,
    start: &Option<String>,
    goal: &Option<String>,
) -> Result<Ends, Failure> {
    run.expect_validity_function()?;
    let given = run.problem().query();
    let end = |name: &str, text: &Option<String>, given: Option<&Vec<f64>>| match (text, given) {
        (Some(text), _) => configuration(run.context(), text)
            .map_err(|error| Failure::usage(format!("--{name}: {error}"))),
        (None, Some(q)) => Ok(q.clone()),
        (None, None) => Err(Failure::usage(format!("--{name} expected: the problem has no query"))),
    };
    let start = end("start", start, given.map(|query| &query.start))?;
    let is_given = goal.is_some();
    let goal = end("goal", goal, given.map(|query| &query.goal))?;
    let others = given.filter(|_| !is_given).map(|query| query.other_goals.clone());
    Ok(Ends { start, goal, other_goals: others.unwrap_or_default() })
}
