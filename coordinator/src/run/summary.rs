use super::{SUMMARY_JSON, Stopped};
use crate::dispatch::{Audited, Machine, Machines};
use crate::files::open_in_run;
use crate::output::Plain;
use roadmill::Ends;
use roadmill::evaluate::{Bound, CutEdge, EvaluatorKind, Verdict};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Tally};
use rustix::fs::OFlags;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;
use std::io::{BufReader, Read};
use std::path::Path;

/// What a build came to.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// For programs that read several kinds of objects: always `summary`.
    pub event: &'static str,
    /// The problem's name.
    pub problem: String,
    /// The base seed.
    pub seed: u64,
    /// The run folder.
    pub run: String,
    /// Sets folded.
    pub sets: u64,
    /// Nodes.
    pub nodes: usize,
    /// Edges.
    pub edges: usize,
    /// Connected components.
    pub components: usize,
    /// The evaluators' last values.
    pub evaluators: Vec<EvaluatorValue>,
    /// Why it stopped, in one word.
    pub stop: String,
    /// Why it stopped.
    pub reason: String,
    /// CPU seconds of all processes.
    pub cpu_seconds: f64,
    /// The same of all calls that grew this run, this one included; `None` where one of them was killed, or was of a version that
    /// did not keep the sum.
    pub run_cpu_seconds: Option<f64>,
    /// Those of the coordinator alone (with `--threads`: of the one process).
    pub coordinator_cpu_seconds: f64,
    /// What these went into; with `--threads` it is not told apart from the work itself.
    pub coordinator_cpu: Option<CoordinatorCpu>,
    /// Seconds from start to end.
    pub wall_seconds: f64,
    /// Of these, those that went into the ledger: encoding, hashing, writing and syncing.
    pub ledger_seconds: f64,
    /// What each machine did, where agents of several did the work.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machines: Vec<Machine>,
    /// Outcomes that two machines made and that were compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub audited: Option<Audited>,
    /// Digest of the roadmap.
    pub digest: String,
}

/// The last value of an evaluator.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EvaluatorValue {
    /// Its name.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// What the value is compared with.
    pub threshold: f64,
    /// Whether that is the least or the largest value that would do.
    pub bound: Bound,
    /// Whether it does.
    pub satisfied: bool,
    /// Further numbers by name.
    pub measures: BTreeMap<&'static str, f64>,
    /// Of a query: edges left out because they failed the finer check.
    pub dropped_edges: Option<u64>,
    /// Of a solved query: the sum of the costs of the path's edges, of most models its length in the space's metric.
    pub path_length: Option<f64>,
    /// Of a solved query with several goals: the number of the one that the path ends at, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal: Option<usize>,
    /// Of a max-flow or a flow ratio: the edges of a least cut.
    pub cut: Option<Vec<CutEdge>>,
}

impl EvaluatorValue {
    /// The values of the problem's evaluators, and of those of which they are made; none before the
    /// first judgement.
    pub fn all(problem: &Problem, verdicts: &[Verdict]) -> Vec<EvaluatorValue> {
        let mut values = Vec::new();
        Self::collect(problem.query(), problem.evaluators(), verdicts, &mut values);
        values
    }

    fn collect(
        query: Option<&Ends>,
        evaluators: &[EvaluatorKind],
        verdicts: &[Verdict],
        values: &mut Vec<EvaluatorValue>,
    ) {
        for (evaluator, verdict) in evaluators.iter().zip(verdicts) {
            let answer = verdict.answer.as_ref();
            let names = evaluator.method().measures();
            values.push(EvaluatorValue {
                name: evaluator.method().name(),
                value: verdict.value,
                threshold: verdict.threshold,
                bound: verdict.bound,
                satisfied: verdict.satisfied,
                measures: names.iter().copied().zip(verdict.measures.iter().copied()).collect(),
                dropped_edges: answer.map(|answer| answer.dropped_edges),
                path_length: answer.and_then(|answer| answer.path.as_ref()).map(|path| path.length),
                goal: answer
                    .and_then(|answer| answer.path.as_ref())
                    .and_then(|path| query?.goal_number(path.configs.iter())),
                cut: verdict.cut.clone(),
            });
            Self::collect(query, evaluator.method().parts(), &verdict.parts, values);
        }
    }
}

impl fmt::Display for EvaluatorValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = if self.bound == Bound::AtMost { "of at most" } else { "of" };
        let [value, threshold] = compared(self.value, self.threshold);
        write!(f, "{} {value} {of} {threshold}", self.name)?;
        for (name, value) in &self.measures {
            write!(f, ", {name} {value:.3}")?;
        }
        if let Some(cut) = &self.cut {
            write!(f, ", a least cut severs {} edges", cut.len())?;
        }
        if let Some(length) = self.path_length {
            write!(f, ", path of length {length:.3}")?;
        }
        if let Some(goal) = self.goal {
            write!(f, " to goal {goal}")?;
        }
        if let Some(dropped @ 1..) = self.dropped_edges {
            write!(f, ", {dropped} edges failed the finer check")?;
        }
        Ok(())
    }
}

/// A value and the threshold that it is compared with, in as many decimals as it takes to tell the two apart where
/// they differ, three at least: what is not met never looks as if it were.
fn compared(value: f64, threshold: f64) -> [String; 2] {
    let rounded = |decimals: usize| [value, threshold].map(|it| format!("{it:.decimals$}"));
    let told_apart = |[value, threshold]: &[String; 2]| value != threshold;
    let shortest = (3..=17).map(rounded).find(told_apart);
    match shortest {
        _ if value == threshold => rounded(3),
        Some(texts) => texts,
        // The digits that give a number back to the bit.
        None => [value, threshold].map(|it| format!("{it:e}")),
    }
}

/// What the coordinator's CPU seconds went into.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CoordinatorCpu {
    /// Messages: waiting for them, reading, checking, decoding and sending them.
    pub messages: f64,
    /// Publishing and folding sets, the roadmap's digest included.
    pub fold: f64,
    /// The ledger: encoding, hashing, writing and syncing.
    pub ledger: f64,
    /// Starting and ending, deciding what comes next, telling how far the build is.
    pub rest: f64,
}

/// CPU and wall seconds of a build.
#[derive(Debug, Clone, Copy)]
pub struct Times {
    /// CPU seconds of all processes.
    pub cpu_seconds: f64,
    /// Those of all calls that grew this run, where they are known.
    pub run_cpu_seconds: Option<f64>,
    /// Those of the coordinator alone.
    pub coordinator_cpu_seconds: f64,
    /// What these went into.
    pub coordinator_cpu: Option<CoordinatorCpu>,
    /// Seconds from start to end.
    pub wall_seconds: f64,
    /// Of these, those that went into the ledger.
    pub ledger_seconds: f64,
}

impl Summary {
    /// Sums a build up.
    pub fn new(
        problem: &Problem,
        run: &Path,
        tally: &Tally,
        verdicts: &[Verdict],
        stopped: &Stopped,
        times: Times,
    ) -> Summary {
        Summary {
            event: "summary",
            problem: problem.name().to_owned(),
            seed: problem.seed(),
            run: run.display().to_string(),
            sets: tally.sets(),
            nodes: tally.nodes(),
            edges: tally.edges(),
            components: tally.components(),
            evaluators: EvaluatorValue::all(problem, verdicts),
            stop: stopped.word.clone(),
            reason: stopped.reason.clone(),
            cpu_seconds: times.cpu_seconds,
            run_cpu_seconds: times.run_cpu_seconds,
            coordinator_cpu_seconds: times.coordinator_cpu_seconds,
            coordinator_cpu: times.coordinator_cpu,
            wall_seconds: times.wall_seconds,
            ledger_seconds: times.ledger_seconds,
            machines: Vec::new(),
            audited: None,
            digest: tally.digest().to_string(),
        }
    }

    /// Adds what the machines did.
    pub fn set_machines(&mut self, machines: Machines) {
        let Machines { machines, audited } = machines;
        (self.machines, self.audited) = (machines, audited);
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "problem     {} (seed {})", Plain(&self.problem), self.seed)?;
        writeln!(f, "run         {}", Plain(&self.run))?;
        writeln!(f, "sets        {}", self.sets)?;
        writeln!(f, "nodes       {}", self.nodes)?;
        writeln!(f, "edges       {}", self.edges)?;
        writeln!(f, "components  {}", self.components)?;
        for evaluator in &self.evaluators {
            writeln!(f, "evaluator   {evaluator}")?;
        }
        writeln!(f, "stopped     {}", Plain(&self.reason))?;
        let coordinator = self.coordinator_cpu_seconds;
        writeln!(
            f,
            "cpu         {:.2} s, {coordinator:.2} s of it the coordinator's",
            self.cpu_seconds
        )?;
        if let Some(whole) = self.run_cpu_seconds.filter(|whole| *whole > self.cpu_seconds) {
            writeln!(f, "cpu of run  {whole:.2} s, with what went into it before")?;
        }
        if let Some(CoordinatorCpu { messages, fold, ledger, rest }) = self.coordinator_cpu {
            write!(f, "coordinator {messages:.2} s for messages, {fold:.2} s for folding, ")?;
            writeln!(f, "{ledger:.2} s for the ledger, {rest:.2} s for the rest")?;
        }
        let ledger = self.ledger_seconds;
        writeln!(f, "wall        {:.2} s, {ledger:.2} s of it for the ledger", self.wall_seconds)?;
        for machine in &self.machines {
            writeln!(f, "machine     {machine}")?;
        }
        if let Some(audited) = self.audited {
            writeln!(f, "audit       {audited}")?;
        }
        write!(f, "digest {}", self.digest)
    }
}

/// The longest summary that is read, in bytes: the cut of a maximum flow has a line for each of its edges.
const SUMMARY_MAX: u64 = 1 << 30;

/// The CPU seconds that went into the run in a folder up to the end of its last call, as the summary of that call has them;
/// `None` where they are not known. `roadmap` is the digest of the run's roadmap: the summary of another roadmap is an older one.
pub fn run_cpu_seconds_in(folder: &Path, roadmap: Digest) -> Option<f64> {
    let summary = summary_in(folder)?;
    let is_of_it = summary["digest"].as_str() == Some(&roadmap.to_string());
    summary["run_cpu_seconds"].as_f64().filter(|_| is_of_it)
}

/// The summary in a run folder as an object; `None` where there is none, or none that can be read.
pub fn summary_in(folder: &Path) -> Option<serde_json::Value> {
    let file = open_in_run(&folder.join(SUMMARY_JSON), OFlags::RDONLY).ok()?;
    serde_json::from_reader(BufReader::new(file.take(SUMMARY_MAX))).ok()
}

#[cfg(test)]
mod tests {
    use super::compared;

    #[test]
    fn a_value_looks_like_its_threshold_only_where_it_is_the_same() {
        for (value, threshold, expected) in [
            (1.0, 1.0, ["1.000", "1.000"]),
            (0.25, 0.95, ["0.250", "0.950"]),
            (0.9995, 1.0, ["0.9995", "1.0000"]),
            (0.949_999_9, 0.95, ["0.9499999", "0.9500000"]),
            (1e-30, 2e-30, ["1e-30", "2e-30"]),
            (f64::INFINITY, -40.6, ["inf", "-40.600"]),
            (f64::INFINITY, f64::INFINITY, ["inf", "inf"]),
        ] {
            assert_eq!(compared(value, threshold), expected);
        }
    }
}
