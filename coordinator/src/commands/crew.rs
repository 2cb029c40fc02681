//! What `build`, `resume` and `verify` share: who does the work, and what is said meanwhile.

use crate::agent::Place;
use crate::cli::{AgentsArguments, CrewArguments};
use crate::dispatch::AgentOptions;
use crate::exit::{Code, Failure};
use crate::output::{self, Plain, note};
use crate::progress::Reporter;
use crate::run::summary_in;
use crate::work::{Begun, Ended, Growth, Status, Torn, WORKERS_MAX, Watch, Workers};
use roadmill::model::ModelKind;
use roadmill::problem::Problem;
use roadmill::survey::Survey;
use std::fs::File;
use std::io::Read;
use std::time::Duration;

/// After so many seconds without a set it is said what is in the way.
const PATIENCE: f64 = 5.0;
/// How many configurations are drawn for that.
pub(super) const DRAWS: usize = 1000;

/// Who does the jobs, as the command line says.
pub(super) fn workers(crew: &CrewArguments) -> Result<Workers, Failure> {
    let AgentsArguments { agents, agent_command, agent_wait, audit } = &crew.agents;
    if let Some(names) = agents {
        let workers = crew.workers.map(|workers| checked("--workers", Some(workers)));
        let options = AgentOptions {
            workers: workers.transpose()?,
            wait: Duration::try_from_secs_f64(*agent_wait).unwrap_or(Duration::MAX),
            audit: audit.unwrap_or(0.0),
            audit_key: audit_key()?,
        };
        let places = Place::list(names, agent_command)?;
        let first = places.first().map(Place::name);
        if options.audit > 0.0 && places.iter().all(|place| Some(place.name()) == first) {
            return Err(Failure::usage(
                "--audit: one machine found, two or more expected, to be compared",
            ));
        }
        return Ok(Workers::agents(places, options));
    }
    let count = count(crew)?;
    Ok(match crew.threads {
        Some(_) => Workers::threads(count),
        None => Workers::own_processes(count),
    })
}

/// Bytes that nobody else knows.
fn audit_key() -> Result<[u8; 32], Failure> {
    let mut key = [0; 32];
    let read = File::open("/dev/urandom").and_then(|mut file| file.read_exact(&mut key));
    read.map(|()| key).map_err(|error| Failure::system(format!("/dev/urandom: {error}")))
}

/// How many workers or threads the command line asks for; one for each processor if it does not say.
pub(super) fn count(crew: &CrewArguments) -> Result<usize, Failure> {
    match crew.threads {
        Some(_) => checked("--threads", crew.threads),
        None => checked("--workers", crew.workers),
    }
}

/// A number of workers that an option gives; one for each processor if it does not.
pub(super) fn checked(option: &str, workers: Option<usize>) -> Result<usize, Failure> {
    let workers = workers.unwrap_or_else(Workers::available);
    if (1..=WORKERS_MAX).contains(&workers) {
        Ok(workers)
    } else {
        Err(Failure::usage(format!("{option}: {workers} found, 1 to {WORKERS_MAX} expected")))
    }
}

/// Grows a roadmap and says how it goes and what came of it; the exit code.
pub(super) fn grow(growth: Growth, json: bool) -> Result<Code, Failure> {
    let ended = growth.watch(Telling::new(json)).grow()?;
    let Some(summary) = ended.summary() else { return say_finished(&ended, json) };
    if ended.stopped().gave_up() {
        say_survey(ended.problem());
    }
    if json {
        output::json(summary);
    } else {
        output::lines(summary);
    }
    match ended.outcome() {
        (Code::Done, _) => {
            say_way_on(&ended);
            if !json {
                say_look(&ended);
            }
            Ok(Code::Done)
        }
        (code, reason) => Err(Failure::new(code, with_way_on(reason, &ended))),
    }
}

/// Says how a build goes on that has ended as was asked for.
fn say_way_on(ended: &Ended) {
    if let Some(way) = ended.way_on() {
        note(format_args!("{}: {way}", Plain(ended.problem().name())));
    }
}

/// Says how much of the space is valid and what is mostly in the way, and what might suit.
fn say_survey(problem: &Problem) {
    let name = Plain(problem.name());
    let survey = Survey::new(&problem.context(), DRAWS);
    note(format_args!("{name}: {survey}"));
    if let Some(advice) = survey.advice() {
        note(format_args!("{name}: {advice}"));
    }
}

/// Says by which command people see what was built.
fn say_look(ended: &Ended) {
    let (name, run) = (Plain(ended.problem().name()), ended.run().folder().display());
    let model = ended.problem().model();
    let description = model.description();
    let look = match (description.figure(), description.molecule()) {
        _ if matches!(model, ModelKind::Docking(_)) => {
            format!("roadmill ligand poses {run} --page poses.html")
        }
        (Some(_), _) => format!("roadmill view {run}"),
        (None, Some(_)) => format!("roadmill report {run} --out report.html"),
        (None, None) => return,
    };
    note(format_args!("{name}: to look at it: `{look}`"));
}

/// Why a build ended, and how it goes on.
fn with_way_on(reason: String, ended: &Ended) -> String {
    match ended.way_on() {
        Some(way) => format!("{reason}; {way}"),
        None => reason,
    }
}

/// Says that there is nothing to do, and ends as the build did.
fn say_finished(ended: &Ended, json: bool) -> Result<Code, Failure> {
    let folder = ended.run().folder();
    let summary = summary_in(folder);
    match (json, summary, ended.rounds()) {
        (true, Some(summary), _) => output::json(&summary),
        (false, _, 1..) => output::line(format_args!("digest {}", ended.digest())),
        _ => true,
    };
    let before = format!("{}: the build has ended before", folder.display());
    match ended.outcome() {
        (Code::Done, reason) => {
            note(format_args!("{before}: {reason}"));
            say_way_on(ended);
            Ok(Code::Done)
        }
        (code, reason) => {
            let reason = with_way_on(format!("{before}: {reason}"), ended);
            Err(Failure::new(code, reason))
        }
    }
}

/// Tells people, or with `--json` programs, how a build goes.
pub(super) struct Telling {
    json: bool,
    /// From the beginning of the build on.
    reporter: Option<Reporter>,
    /// Whether it was said that the build's time is up.
    is_late: bool,
    /// Whether it was said why there are no milestones yet.
    is_surveyed: bool,
}

impl Telling {
    pub fn new(json: bool) -> Telling {
        Telling { json, reporter: None, is_late: false, is_surveyed: false }
    }
}

impl Watch for Telling {
    fn begun(&mut self, begun: &Begun) {
        if !self.json {
            say_begun(begun);
        }
        self.reporter = Some(Reporter::new(self.json));
    }

    fn progress(&mut self, status: &Status) {
        if let Some(reporter) = &mut self.reporter {
            reporter.report(status);
            let has_nothing = status.progress.sets_generated == 0 && reporter.seconds() > PATIENCE;
            if has_nothing && !std::mem::replace(&mut self.is_surveyed, true) {
                say_survey(status.problem);
            }
            let Status { problem, is_late, .. } = status;
            if *is_late && !std::mem::replace(&mut self.is_late, true) && !self.json {
                let name = Plain(problem.name());
                note(format_args!(
                    "{name}: the time is up; the build ends when its round is finished"
                ));
            }
        }
    }
}

/// Clears the terminal's line, whatever the build came to.
impl Drop for Telling {
    fn drop(&mut self) {
        if let Some(reporter) = &self.reporter {
            reporter.finish();
        }
    }
}

fn say_begun(begun: &Begun) {
    match begun {
        Begun::Anew { problem, folder, imported } => {
            let (name, seed) = (Plain(problem.name()), problem.seed());
            note(format_args!("{name}: seed {seed}, run folder {}", folder.display()));
            problem.notes().iter().for_each(|text| note(format_args!("{name}: {text}")));
            if *imported > 0 {
                note(format_args!("{name}: {imported} sets are imported when they are needed"));
            }
        }
        Begun::Again { problem, folder, rounds, nodes, is_chapter, torn } => {
            let (name, run) = (Plain(problem.name()), folder.display());
            let chapter = if *is_chapter { ", in a new chapter" } else { "" };
            note(format_args!(
                "{name}: goes on after {rounds} rounds and {nodes} nodes{chapter}, run folder {run}"
            ));
            if let Some(Torn { bytes, file }) = torn {
                let file = file.display();
                note(format_args!(
                    "{name}: {bytes} bytes of an unfinished round were moved to {file}"
                ));
            }
        }
    }
}
