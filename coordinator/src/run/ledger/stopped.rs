use crate::exit::Code;
use bincode::{Decode, Encode};
use roadmill::img::{Cut, Job, Stop};
use roadmill::numbers::{Ordinal, StrategyIndex};
use roadmill::problem::Problem;
use std::path::Path;

/// How a build ended, as the ledger keeps it.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Stopped {
    /// One word for programs: `satisfied`, `node-limit`, …
    pub word: String,
    /// The same for people.
    pub reason: String,
}

impl Stopped {
    /// Puts a stop into words.
    pub fn new(stop: &Stop, problem: &Problem) -> Stopped {
        let label = |strategy: StrategyIndex| problem.strategies()[strategy.index()].label();
        let (word, reason) = match stop {
            Stop::Satisfied => ("satisfied", "all criteria are met".to_owned()),
            Stop::NodeLimit => ("node-limit", limit_of(problem.limits().nodes, "node")),
            Stop::SetLimit => ("set-limit", limit_of(problem.limits().sets, "set")),
            Stop::GaveUp { strategy, ordinal, gave_up } => {
                ("gave-up", format!("set {}:{ordinal}: {gave_up}", label(*strategy)))
            }
            Stop::Deadly(job) => {
                ("deadly-job", format!("{} killed its workers", name(*job, problem)))
            }
            Stop::Contradiction(job, by) => {
                let by = if by.is_empty() { String::new() } else { format!(": {by}") };
                (
                    "contradiction",
                    format!("{} gave two different outcomes{by}", name(*job, problem)),
                )
            }
            Stop::Nonsense(job) => {
                ("nonsense", format!("{} gave an outcome that it cannot have", name(*job, problem)))
            }
            Stop::Cut(Cut::Time) => ("time-limit", "the limit of time is reached".to_owned()),
            Stop::Cut(Cut::Memory(bytes)) => {
                ("memory-limit", format!("the limit of {bytes} bytes of memory is reached"))
            }
            Stop::Cut(Cut::Interrupted) => ("interrupted", "a signal came".to_owned()),
            Stop::Cut(Cut::WorkersLost(why)) => ("workers-lost", why.clone()),
        };
        Stopped { word: word.to_owned(), reason }
    }

    /// Whether a stop that is recorded is this one. Earlier versions wrote "1 nodes".
    pub fn is_recorded_as(&self, recorded: &Stopped) -> bool {
        let is_of_limit = matches!(&*self.word, "node-limit" | "set-limit");
        let earlier = || self.reason.replace("limit of 1 node is", "limit of 1 nodes is");
        let earlier = || earlier().replace("limit of 1 set is", "limit of 1 sets is");
        let is_same = self.reason == recorded.reason || is_of_limit && earlier() == recorded.reason;
        self.word == recorded.word && is_same
    }

    /// Whether the build would stop again at once: its problem must change for it to go on.
    pub fn is_final(&self) -> bool {
        matches!(&*self.word, "satisfied" | "node-limit" | "set-limit" | "gave-up")
    }

    /// Whether a sampler or a generator found no milestone.
    pub fn gave_up(&self) -> bool {
        self.word == "gave-up"
    }

    /// The command by which the build in the folder `run` goes on, and the option that decides how far; `None` where
    /// it has met its criteria or something is broken.
    pub fn way_on(&self, run: &Path) -> Option<String> {
        let how = match &*self.word {
            "node-limit" => "goes on with --max-nodes N and a larger N",
            "set-limit" => "goes on with --max-sets N and a larger N",
            "memory-limit" => "goes on; --max-memory SIZE says up to where",
            "time-limit" => "goes on; --max-time TIME says for how long",
            "gave-up" => "goes on with --with PROBLEM and a strategy that finds milestones",
            "interrupted" | "workers-lost" => "goes on",
            _ => return None,
        };
        Some(format!("`roadmill resume {}` {how}", run.display()))
    }

    /// What a build that ends so ends with, and what it says if that is no success.
    pub fn outcome(&self, problem: &Problem) -> (Code, String) {
        let code = match &*self.word {
            "satisfied" => Code::Done,
            // Without criteria the limit is what was asked for. There is a roadmap: no limit ends a build before its
            // first round is complete.
            "node-limit" | "set-limit" | "time-limit" | "memory-limit" => {
                if problem.evaluators().is_empty() {
                    Code::Done
                } else {
                    let reason = format!("{} before all criteria are met", self.reason);
                    return (Code::NoSuccess, reason);
                }
            }
            "gave-up" => Code::NoSuccess,
            "deadly-job" | "workers-lost" => Code::WorkersLost,
            "interrupted" => Code::Interrupted,
            _ => Code::BrokenRun,
        };
        (code, self.reason.clone())
    }
}

fn limit_of(count: u64, what: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("the limit of {count} {what}{plural} is reached")
}

/// A job as people name it: by its set's label and ordinal.
pub fn name(job: Job, problem: &Problem) -> String {
    let set = |strategy: StrategyIndex, ordinal: Ordinal| {
        format!("{}:{ordinal}", problem.strategies()[strategy.index()].label())
    };
    match job {
        Job::Generate { strategy, ordinal, .. } => {
            format!("generating set {}", set(strategy, ordinal))
        }
        Job::Join { strategy, ordinal, .. } => format!("joining set {}", set(strategy, ordinal)),
        Job::Evaluate { round, evaluator } => {
            let evaluator = problem.evaluators()[evaluator.index()].method().name();
            format!("the {evaluator} evaluation after round {round}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular_and_what_earlier_versions_wrote_is_the_same_stop() {
        let stop = |word: &str, reason: &str| Stopped { word: word.into(), reason: reason.into() };
        assert_eq!(limit_of(1, "node"), "the limit of 1 node is reached");
        assert_eq!(limit_of(21, "set"), "the limit of 21 sets is reached");
        let now = stop("node-limit", &limit_of(1, "node"));
        assert!(now.is_recorded_as(&now));
        assert!(now.is_recorded_as(&stop("node-limit", "the limit of 1 nodes is reached")));
        assert!(!now.is_recorded_as(&stop("node-limit", "the limit of 2 nodes is reached")));
        assert!(!now.is_recorded_as(&stop("set-limit", "the limit of 1 node is reached")));
    }
}
