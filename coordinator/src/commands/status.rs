use crate::cli::StatusArguments;
use crate::dispatch::{Machine, Machines};
use crate::exit::{Code, Failure};
use crate::files::open_in_run;
use crate::output::{self, Plain};
use crate::run::{EvaluatorValue, Holder, MACHINES_JSON, Scan};
use crate::work::relaxing::is_relaxation;
use roadmill::problem::Problem;
use rustix::fs::OFlags;
use serde::Serialize;
use std::fmt;
use std::io::Read;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// The most bytes that are read of what the machines do.
const MACHINES_BYTES_MAX: u64 = 4 << 20;
const PAUSE: Duration = Duration::from_millis(500);

/// How far a build is, as its files tell.
#[derive(Serialize, PartialEq)]
struct Status {
    event: &'static str,
    run: String,
    problem: String,
    seed: u64,
    program: String,
    bits_version: u32,
    chapters: usize,
    rounds: u64,
    sets: u64,
    nodes: u64,
    edges: u64,
    components: u64,
    evaluators: Vec<EvaluatorValue>,
    /// `running`, `held` (on another host), `killed`, `failed`, or the word of a stop.
    state: String,
    reason: String,
    /// Of a build that has stopped: how it goes on, where it can.
    #[serde(skip)]
    way_on: Option<String>,
    ledger_bytes: u64,
    /// What each machine does, where agents of several do the work.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    machines: Vec<Machine>,
    digest: Option<String>,
}

/// Says how far a build is.
pub fn status(arguments: &StatusArguments) -> Result<Code, Failure> {
    if is_relaxation(&arguments.run) {
        return super::standing::status(arguments);
    }
    let mut scan = Scan::read(&arguments.run)?;
    let mut chapter = (scan.chapters.len(), scan.problem()?);
    let mut last = None;
    loop {
        let holder = Holder::read(&arguments.run);
        let status = Status::new(&scan, &chapter.1, holder);
        let is_over = !matches!(&*status.state, "running" | "held");
        if last.as_ref() != Some(&status) {
            let is_read = match (arguments.json, arguments.watch && !is_over) {
                (true, _) => output::json(&status),
                (false, true) => output::line(status.line()),
                (false, false) => output::lines(&status),
            };
            if !is_read {
                return Ok(Code::Done);
            }
        }
        last = Some(status);
        if !arguments.watch || is_over {
            return Ok(Code::Done);
        }
        sleep(PAUSE);
        scan.read_on()?;
        if chapter.0 != scan.chapters.len() {
            chapter = (scan.chapters.len(), scan.problem()?);
        }
    }
}

/// What the machines of a running build do; none where it has none, or has ended.
fn machines_in(folder: &Path) -> Vec<Machine> {
    let file = open_in_run(&folder.join(MACHINES_JSON), OFlags::RDONLY);
    let machines = file.ok().and_then(|file| {
        serde_json::from_reader::<_, Machines>(file.take(MACHINES_BYTES_MAX)).ok()
    });
    machines.unwrap_or_default().machines
}

impl Status {
    fn new(scan: &Scan, problem: &Problem, holder: Option<Holder>) -> Status {
        let lives = holder.as_ref().map(|holder| holder.lives());
        let (state, reason) = match (&scan.stopped, holder, lives) {
            (_, Some(holder), Some(Some(true))) => ("running".to_owned(), holder.to_string()),
            (_, Some(holder), Some(None)) => ("held".to_owned(), holder.to_string()),
            (Some(stopped), _, _) => (stopped.word.clone(), stopped.reason.clone()),
            (None, Some(_), _) => {
                ("killed".to_owned(), "nobody works on it; `resume` goes on".to_owned())
            }
            // Whoever held it has let go of it, so was not killed.
            (None, None, _) => (
                "failed".to_owned(),
                "it ended without an end in its ledger, as on a full disk; `resume` goes on"
                    .to_owned(),
            ),
        };
        let stopped = scan.stopped.as_ref().filter(|stopped| stopped.word == state);
        let way_on = stopped.and_then(|stopped| stopped.way_on(scan.folder()));
        let chapter = scan.chapter();
        let end = scan.last_round.as_ref();
        let count = |of: fn(&crate::run::ledger::RoundEnd) -> u64| end.map_or(0, of);
        let verdicts = scan.verdicts.as_ref().unwrap_or(&scan.last_verdicts);
        Status {
            event: "status",
            run: scan.folder().display().to_string(),
            problem: chapter.name.clone(),
            seed: chapter.seed,
            program: chapter.program.clone(),
            bits_version: chapter.bits_version,
            chapters: scan.chapters.len(),
            rounds: scan.rounds(),
            sets: count(|end| end.sets),
            nodes: count(|end| end.nodes),
            edges: count(|end| end.edges),
            components: count(|end| end.components),
            evaluators: EvaluatorValue::all(problem, verdicts),
            state,
            reason,
            way_on,
            ledger_bytes: scan.end.offset,
            machines: machines_in(scan.folder()),
            digest: end.map(|end| end.roadmap.to_string()),
        }
    }
}

impl Status {
    /// In one line.
    fn line(&self) -> String {
        let Status { rounds, sets, nodes, edges, components, state, .. } = self;
        let evaluators: Vec<_> = self.evaluators.iter().map(EvaluatorValue::to_string).collect();
        let evaluators = evaluators.join("; ");
        format!(
            "{}: {rounds} rounds, {sets} sets, {nodes} nodes, {edges} edges, {components} \
             components; {evaluators}",
            Plain(state)
        )
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "problem     {} (seed {})", Plain(&self.problem), self.seed)?;
        writeln!(f, "run         {}", Plain(&self.run))?;
        writeln!(f, "program     roadmill {}, bits {}", Plain(&self.program), self.bits_version)?;
        if self.chapters > 1 {
            writeln!(f, "chapters    {}", self.chapters)?;
        }
        let Status { rounds, sets, nodes, edges, components, .. } = self;
        writeln!(f, "rounds      {rounds}")?;
        writeln!(f, "sets        {sets}")?;
        writeln!(f, "nodes       {nodes}")?;
        writeln!(f, "edges       {edges}")?;
        writeln!(f, "components  {components}")?;
        for evaluator in &self.evaluators {
            writeln!(f, "evaluator   {evaluator}")?;
        }
        writeln!(f, "ledger      {} bytes", self.ledger_bytes)?;
        write!(f, "state       {}: {}", Plain(&self.state), Plain(&self.reason))?;
        if let Some(way) = &self.way_on {
            write!(f, "\nto go on    {}", Plain(way))?;
        }
        for machine in &self.machines {
            write!(f, "\nmachine     {machine}")?;
        }
        match &self.digest {
            Some(digest) => write!(f, "\ndigest {digest}"),
            None => Ok(()),
        }
    }
}
