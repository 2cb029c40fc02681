use super::asker::{Asker, TimedAnswer};
use super::batch;
use super::place::{check_page, check_place};
use super::solved::run_in;
use crate::cli::QueryArguments;
use crate::exit::{Code, Failure};
use crate::files::{expect_folder, write_out, write_whole};
use crate::output::{self, note};
use crate::work::{Recorded, Run};
use roadmill::Ends;
use roadmill::export::animation;
use roadmill::problem::configuration;
use roadmill::query::PATH_REFINEMENT;

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
    let text = asker.text(path);
    match &arguments.out {
        Some(file) => write_out(file, &text)?,
        None => {
            output::data(&text);
        }
    }
    if let Some(file) = &arguments.animate {
        match animation(run.problem(), path) {
            Some(page) => write_whole(file, page)?,
            None => return Err(Failure::usage("--animate: this model cannot be drawn")),
        }
    }
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
