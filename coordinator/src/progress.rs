//! Telling people and programs how far a build is.

use crate::dispatch::Machine;
use crate::output;
use crate::run::EvaluatorValue;
use crate::work::Status;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

const TERMINAL_PAUSE: Duration = Duration::from_millis(200);
const JSON_PAUSE: Duration = Duration::from_secs(1);
/// Without a terminal a line now and then, less and less often.
const FIRST_LINE: Duration = Duration::from_secs(2);
const LINE_PAUSE_MAX: Duration = Duration::from_secs(60);

/// How far a build is: what the line of progress says, as the JSON object of an event `progress`.
#[derive(Debug, Serialize)]
pub struct Report {
    event: &'static str,
    seconds: f64,
    sets_generated: u64,
    sets_joined: u64,
    rounds: u64,
    nodes: u64,
    edges: usize,
    components: usize,
    nodes_per_second: f64,
    evaluators: Vec<EvaluatorValue>,
    workers_alive: usize,
    workers_wanted: usize,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    machines: Vec<Machine>,
}

impl Report {
    /// What a build's status comes to, so many seconds after the build began.
    pub fn of(status: &Status, seconds: f64) -> Report {
        let Status { problem, progress, tally, .. } = status;
        Report {
            event: "progress",
            seconds,
            sets_generated: progress.sets_generated,
            sets_joined: progress.sets_joined,
            rounds: progress.rounds,
            nodes: progress.nodes,
            edges: tally.edges(),
            components: tally.components(),
            nodes_per_second: progress.nodes as f64 / seconds.max(1e-9),
            evaluators: EvaluatorValue::all(problem, &progress.verdicts),
            workers_alive: status.workers_alive,
            workers_wanted: status.workers_wanted,
            machines: status.machines.to_vec(),
        }
    }
}

/// What decides when the build ends comes first: a narrow terminal cuts the rest of the line off.
impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.0} s: ", self.seconds)?;
        for evaluator in &self.evaluators {
            write!(f, "{evaluator}; ")?;
        }
        let Report { nodes, edges, components, sets_generated, sets_joined, .. } = self;
        write!(f, "{nodes} nodes, {edges} edges, {components} components; ")?;
        write!(f, "{sets_generated} sets generated, {sets_joined} joined; ")?;
        write!(f, "{:.0} nodes/s; ", self.nodes_per_second)?;
        if self.machines.is_empty() {
            return write!(f, "{} of {} workers", self.workers_alive, self.workers_wanted);
        }
        let ready = self.machines.iter().filter(|machine| machine.state == "ready").count();
        let wanted = self.machines.len();
        write!(f, "{} workers of {ready} of {wanted} machines", self.workers_alive)
    }
}

enum Kind {
    Terminal(ProgressBar),
    Lines(Duration),
    Json,
}

/// Where reports go: a line that renews itself on a terminal, plain lines on standard error
/// elsewhere, or JSON objects on standard output.
pub struct Reporter {
    kind: Kind,
    begun: Instant,
    next: Instant,
}

impl Reporter {
    /// Chooses by the command line and what standard error is.
    pub fn new(json: bool) -> Reporter {
        let begun = Instant::now();
        let (kind, pause) = if json {
            (Kind::Json, JSON_PAUSE)
        } else if std::io::stderr().is_terminal() {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            bar.set_style(ProgressStyle::with_template("{wide_msg}").expect("a valid template"));
            (Kind::Terminal(bar), TERMINAL_PAUSE)
        } else {
            (Kind::Lines(FIRST_LINE), FIRST_LINE)
        };
        Reporter { kind, begun, next: begun + pause }
    }

    /// Seconds since the beginning.
    pub fn seconds(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Reports if it is time.
    pub fn report(&mut self, status: &Status) {
        let now = Instant::now();
        if now < self.next {
            return;
        }
        let report = Report::of(status, self.seconds());
        let pause = match &mut self.kind {
            Kind::Terminal(bar) => {
                bar.set_message(report.to_string());
                bar.tick();
                TERMINAL_PAUSE
            }
            Kind::Lines(pause) => {
                output::note(&report);
                *pause = (*pause * 2).min(LINE_PAUSE_MAX);
                *pause
            }
            Kind::Json => {
                output::json(&report);
                JSON_PAUSE
            }
        };
        self.next = now + pause;
    }

    /// Clears the terminal's line.
    pub fn finish(&self) {
        if let Kind::Terminal(bar) = &self.kind {
            bar.finish_and_clear();
        }
    }
}
