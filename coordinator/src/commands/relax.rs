use super::crew::{Telling, workers};
use super::load::load;
use crate::cli::{GrowthArguments, RelaxArguments, ResumeArguments, VerifyArguments};
use crate::exit::{Code, Failure};
use crate::output::{self, line, note};
use crate::signals::Signals;
use crate::work::relaxing::{BookLevel, RelaxationVerification, Relaxed, WatchLevels};
use crate::work::{Ended, Relaxing, Selection, Watch};
use roadmill::problem::Problem;
use roadmill::relaxation::Attempt;
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;

/// Solves a problem by way of easier versions of it.
pub fn relax(arguments: &RelaxArguments) -> Result<Code, Failure> {
    let RelaxArguments { problem, seed, out, or_resume, growth } = arguments;
    let problem = load(problem)?;
    let seed = seed.unwrap_or(problem.seed());
    let problem = with_limits(problem.with_seed(seed), growth)?;
    let relaxing = Relaxing::begin(problem, out);
    solve(if *or_resume { relaxing.or_resume() } else { relaxing }, growth)
}

/// The problem with the limits that the command line gives for each level.
fn with_limits(problem: Problem, growth: &GrowthArguments) -> Result<Problem, Failure> {
    if growth.max_nodes.is_none() && growth.max_sets.is_none() {
        return Ok(problem);
    }
    let mut settings = problem.relaxation().cloned().unwrap_or_default();
    settings.nodes = growth.max_nodes.unwrap_or(settings.nodes);
    settings.sets = growth.max_sets.or(settings.sets);
    // The problem's own settings have been checked.
    if let Some(complaint) = settings.complaint() {
        return Err(Failure::usage(format!("--max-{}: {complaint}", complaint.key)));
    }
    problem.with_relaxation(settings).map_err(Failure::usage)
}

/// Goes on with a loop.
pub(super) fn resume(arguments: &ResumeArguments) -> Result<Code, Failure> {
    let ResumeArguments { run, with, accept_bits, growth } = arguments;
    let given = [
        ("--with", with.is_some()),
        ("--accept-bits", *accept_bits),
        ("--max-nodes", growth.max_nodes.is_some()),
        ("--max-sets", growth.max_sets.is_some()),
    ];
    if let Some((option, _)) = given.iter().find(|(_, given)| *given) {
        return Err(Failure::usage(format!(
            "{option}: found, but {} is a relaxation, which goes on as it was begun; none expected",
            run.display()
        )));
    }
    solve(Relaxing::at(run), growth)
}

fn solve(relaxing: Relaxing, growth: &GrowthArguments) -> Result<Code, Failure> {
    let workers = workers(&growth.crew)?;
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let telling = TellingLevels { json: growth.json };
    let relaxing = relaxing.workers(&workers).signals(&signals).watch(telling);
    let relaxed = relaxing.max_seconds(growth.max_time).max_memory(growth.max_memory).solve()?;
    let (code, reason) = say_end(&relaxed, growth.json);
    match code {
        Code::Done => Ok(Code::Done),
        _ => Err(Failure::new(code, reason)),
    }
}

/// Says what came of it, and by which command it goes on; the exit code and the reason.
fn say_end(relaxed: &Relaxed, json: bool) -> (Code, String) {
    let (folder, (code, reason)) = (relaxed.folder.display(), relaxed.outcome());
    if json {
        output::json(&End {
            event: "relaxation",
            folder: folder.to_string(),
            end: &relaxed.book.end,
        });
    }
    if code == Code::Done {
        note(format_args!("{folder}: {reason}; the path is in {folder}/path.csv"));
        if let Some(level) = relaxed.book.levels.last().and_then(|level| level.folder.as_ref()) {
            note(format_args!("{folder}: to look at it: `roadmill view {folder}/{level}`"));
        }
        return (code, reason);
    }
    let mut reason = reason;
    if relaxed.goes_on() {
        reason = format!("{reason}; `roadmill resume {folder}` goes on");
    } else if let Some((level, name)) =
        relaxed.highest_solved().and_then(|level| Some((level, level.folder.as_ref()?)))
    {
        reason = format!(
            "{reason}; the highest level that is solved, {:.4}, is in {folder}/{name}",
            level.level
        );
    }
    (code, reason)
}

/// How a loop ended, for programs.
#[derive(Serialize)]
struct End<'a> {
    event: &'static str,
    folder: String,
    end: &'a Option<String>,
}

/// What a level came to, for programs.
#[derive(Serialize)]
struct LevelLine<'a> {
    event: &'static str,
    #[serde(flatten)]
    level: &'a BookLevel,
}

/// Tells people, or with `--json` programs, how the levels go.
struct TellingLevels {
    json: bool,
}

impl WatchLevels for TellingLevels {
    fn begins(&mut self, number: u32, attempt: &Attempt, folder: &Path) -> Box<dyn Watch> {
        let help = match attempt.guide.of() {
            None => String::new(),
            Some(of) => format!(", helped by {} of level {}", attempt.guide.name(), of + 1),
        };
        note(format_args!("level {number}: {:.4} of the constraints{help}", attempt.level));
        let _ = folder;
        Box::new(Telling::new(self.json))
    }

    fn came_to(&mut self, level: &BookLevel, run: Option<&Ended>) {
        if self.json {
            if let Some(summary) = run.and_then(Ended::summary) {
                output::json(summary);
            }
            output::json(&LevelLine { event: "level", level });
            return;
        }
        let BookLevel { number, level: at, outcome, why, built, .. } = level;
        let nodes = built.as_ref().map_or_else(String::new, |built| {
            let seconds = run.and_then(Ended::summary).map(|summary| summary.cpu_seconds);
            let seconds = seconds.map_or_else(String::new, |s| format!(", {s:.1} CPU s"));
            format!(", {} nodes{seconds}", built.nodes)
        });
        let why = why.as_ref().map_or_else(String::new, |why| format!(": {why}"));
        line(format_args!("level {number} at {at:.4}: {outcome}{nodes}{why}"));
    }
}

/// Recomputes the levels of a loop, and the decisions between them.
pub(super) fn verify(arguments: &VerifyArguments, selection: Selection) -> Result<Code, Failure> {
    if arguments.parent.is_some() || !arguments.sets.is_empty() {
        let option = if arguments.parent.is_some() { "--parent" } else { "--set" };
        return Err(Failure::usage(format!(
            "{option}: found, but {} is a relaxation; the run of one of its levels expected beside it",
            arguments.run.display()
        )));
    }
    let workers = workers(&arguments.crew)?;
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let verification = RelaxationVerification::new(&arguments.run, selection);
    let verified = verification.workers(&workers).signals(&signals).check()?;
    for (name, level) in verified.levels.iter().flatten() {
        line(format_args!(
            "{name}: {} of {} sets and {} judgements recomputed: all as recorded",
            level.sets, level.sets_recorded, level.judgements
        ));
    }
    let count = verified.levels.len();
    let plural = if count == 1 { "" } else { "s" };
    let end = if verified.has_ended { ", and so does the end" } else { "" };
    line(format_args!("{count} level{plural}: each follows from those before it{end}"));
    Ok(Code::Done)
}
