use super::grow::{Growth, limit, workers};
use crate::cli::{GrowthArguments, ResumeArguments};
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::run::ledger::LEDGER;
use crate::run::{LedgerWriter, Ledgers, RunFolder, RunLock, Scan, SetFiles, Stopped};
use crate::signals::Signals;
use roadmill::BITS_VERSION;
use roadmill::model::SceneOptions;
use roadmill::problem::Problem;
use roadmill_workers::channel::private_umask;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

/// Goes on with a build.
pub fn resume(arguments: &ResumeArguments) -> Result<Code, Failure> {
    let cpu = CpuClock::start();
    private_umask();
    let workers = workers(&arguments.growth.crew)?;
    let with = arguments.with.as_deref().map(load_changed).transpose()?;
    let run = &arguments.run;
    if !run.join(LEDGER).is_file() {
        return Err(Failure::usage(format!("{}: no run here", run.display())));
    }
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let lock = RunLock::take(run, || signals.came())?;
    let change = Change::Chapter { with: with.as_ref(), accept_bits: arguments.accept_bits };
    go_on(run, lock, change, &arguments.growth, workers, signals, cpu)
}

/// Reads the problem by which a build goes on.
fn load_changed(file: &Path) -> Result<Problem, Failure> {
    Problem::load_with(file, &SceneOptions::default(), &Ledgers).map_err(Failure::usage)
}

/// What a build that goes on may change.
pub(super) enum Change<'a> {
    /// Nothing: it must be that of this problem, of which sets may be imported.
    None(&'a Problem, SetFiles),
    /// Criteria, limits and the schedule; a chapter is opened for it.
    Chapter { with: Option<&'a Problem>, accept_bits: bool },
}

impl Change<'_> {
    /// The problem that the build goes on with.
    fn apply(
        &self,
        scan: &Scan,
        present: &Problem,
        arguments: &GrowthArguments,
    ) -> Result<Problem, String> {
        match self {
            Change::None(problem, _) => {
                let mut problem = (*problem).clone();
                let known = &scan.chapter().sources;
                for file in problem.sources.iter().skip(1) {
                    let was = known.iter().find(|known| known.path == file.path);
                    if let Some(was) = was.filter(|was| was.digest != file.digest) {
                        let (now, then) = (file.digest, was.digest);
                        return Err(format!("{} has changed: {now}, {then} expected", file.path));
                    }
                }
                // A limit of time is one of this process.
                problem.limits.seconds = present.limits.seconds;
                let next = present.continued(&problem, scan.rounds())?;
                match difference(present, &next) {
                    None => Ok(next),
                    Some(what) => Err(format!(
                        "{what} not those of the run; `resume --with` opens a chapter for others"
                    )),
                }
            }
            Change::Chapter { with, .. } => {
                let mut next = match with {
                    Some(with) => present.continued(with, scan.rounds())?,
                    None => present.clone(),
                };
                limit(&mut next, arguments).map_err(|failure| failure.message)?;
                Ok(next)
            }
        }
    }

    fn accepts_bits(&self) -> bool {
        matches!(self, Change::Chapter { accept_bits: true, .. })
    }
}

/// What of a chapter differs; names, notes and files do not make one.
fn difference(present: &Problem, next: &Problem) -> Option<&'static str> {
    let parts = [
        ("the strategies are", present.strategies == next.strategies),
        ("the schedule and the sets per round are", present.earlier == next.earlier),
        ("the ends of the query are", present.query == next.query),
        ("the criteria are", present.evaluators == next.evaluators),
        ("the limits are", present.limits == next.limits),
        // Of a chapter without rounds these differ alone.
        ("the schedule is", present.schedule == next.schedule),
        ("the policy of the schedule is", present.adaptive == next.adaptive),
        ("the sets per round are", present.sets_per_round == next.sets_per_round),
    ];
    parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
}

/// Goes on with the build in the folder `run`, which `lock` holds.
pub(super) fn go_on(
    run: &Path,
    lock: RunLock,
    change: Change,
    arguments: &GrowthArguments,
    workers: usize,
    signals: Arc<Signals>,
    cpu: CpuClock,
) -> Result<Code, Failure> {
    let mut scan = Scan::read(run)?;
    let refuse = |why: String| Failure::usage(format!("{}: cannot go on: {why}", run.display()));
    let bits = scan.chapter().bits_version;
    if bits != BITS_VERSION && !change.accepts_bits() {
        return Err(refuse(format!(
            "its sets have bits of version {bits} (roadmill {}), this roadmill {} makes version \
             {BITS_VERSION}; --accept-bits of `resume` opens a chapter with them",
            scan.chapter().program,
            env!("CARGO_PKG_VERSION"),
        )));
    }
    let present = scan.problem()?;
    let problem = change.apply(&scan, &present, arguments).map_err(refuse)?;
    let is_chapter = bits != BITS_VERSION || difference(&present, &problem).is_some();
    if let Some(stopped) = scan.stopped.as_ref().filter(|stopped| stopped.is_final() && !is_chapter)
    {
        return say_finished(&scan, stopped, &problem, arguments.json);
    }
    let (mut ledger, torn) = LedgerWriter::resume(&scan, &present, lock)?;
    if is_chapter {
        ledger.chapter(scan.rounds(), &problem)?;
        scan.verdicts = None;
    }
    if !arguments.json {
        let name = &problem.name;
        let nodes = scan.last_round.as_ref().map_or(0, |end| end.nodes);
        let chapter = if is_chapter { ", in a new chapter" } else { "" };
        let rounds = scan.rounds();
        eprintln!(
            "{name}: goes on after {rounds} rounds and {nodes} nodes{chapter}, run folder {}",
            run.display()
        );
        if let Some(path) = torn {
            let (bytes, path) = (scan.torn_bytes, path.display());
            eprintln!("{name}: {bytes} bytes of an unfinished round were moved to {path}");
        }
    }
    let imports = match change {
        Change::None(_, imports) => imports,
        Change::Chapter { .. } => SetFiles::default(),
    };
    let (folder, past) = (RunFolder::of(run), Some(scan));
    Growth { problem, folder, ledger, past, imports, arguments, workers, signals, cpu }.grow()
}

/// Says that there is nothing to do, and ends as the build did.
fn say_finished(
    scan: &Scan,
    stopped: &Stopped,
    problem: &Problem,
    json: bool,
) -> Result<Code, Failure> {
    let run = scan.folder().display();
    let summary = std::fs::read_to_string(scan.folder().join("summary.json")).ok();
    let summary = summary.and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok());
    let line = match (json, summary, &scan.last_round) {
        (true, Some(summary), _) => Some(summary.to_string()),
        (false, _, Some(end)) => Some(format!("digest {}", end.roadmap)),
        _ => None,
    };
    if let Some(line) = line {
        // Whoever closes the pipe does not want it.
        let _ = writeln!(std::io::stdout(), "{line}");
    }
    let ended = format!("{run}: the build has ended before");
    match stopped.outcome(problem) {
        (Code::Done, reason) => {
            eprintln!("{ended}: {reason}");
            Ok(Code::Done)
        }
        (code, reason) => Err(Failure::new(code, format!("{ended}: {reason}"))),
    }
}
