//! Whether a recorded stop is the one that the build had to come to.

use crate::run::Stopped;
use crate::run::ledger::RoundEnd;
use roadmill::evaluate::Verdict;
use roadmill::img::{Setup, Stop};
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::roadmap::Roadmap;

/// Words for ends that have a cause outside of the build, which nobody can recompute: time, memory, signals, workers.
const CAUSED_FROM_OUTSIDE: [&str; 7] = [
    "deadly-job",
    "contradiction",
    "nonsense",
    "time-limit",
    "memory-limit",
    "interrupted",
    "workers-lost",
];

/// How a build stood when it stopped.
pub(super) struct Standing<'a> {
    /// The problem as it then was, made ready for work.
    pub setup: &'a Setup,
    /// The last round, if there was any.
    pub last_round: Option<&'a RoundEnd>,
    /// The verdicts on it, as recorded.
    pub verdicts: &'a [Verdict],
    /// The roadmap.
    pub roadmap: &'a Roadmap,
}

impl Standing<'_> {
    /// In what a recorded stop differs from what is recomputed.
    pub fn difference(&self, stopped: &Stopped) -> Option<String> {
        let problem = self.setup.problem();
        let found = match &*stopped.word {
            word if CAUSED_FROM_OUTSIDE.contains(&word) => return None,
            "gave-up" => return self.gave_up(stopped),
            "satisfied" | "node-limit" | "set-limit" => self.decided(problem),
            word => return Some(format!("the stop {word:?} is none that a build comes to")),
        };
        match found.map(|stop| Stopped::new(&stop, problem)) {
            Some(found) if found.is_recorded_as(stopped) => None,
            Some(found) => Some(differ(&stopped.reason, &found.reason)),
            None => Some(differ(&stopped.reason, "no reason to stop")),
        }
    }

    /// Why the build stops after its last round, if its verdicts or a limit say so.
    fn decided(&self, problem: &Problem) -> Option<Stop> {
        let (nodes, sets) = self.last_round.map_or((0, 0), |end| (end.nodes, end.sets));
        if !self.verdicts.is_empty() && self.verdicts.iter().all(|verdict| verdict.satisfied) {
            Some(Stop::Satisfied)
        } else if nodes >= problem.limits().nodes {
            Some(Stop::NodeLimit)
        } else if sets >= problem.limits().sets {
            Some(Stop::SetLimit)
        } else {
            None
        }
    }

    /// Generates the set again of which it is recorded that its generator gave up.
    fn gave_up(&self, stopped: &Stopped) -> Option<String> {
        let named = self.setup.problem().strategies().iter().find_map(|strategy| {
            let start = format!("set {}:", strategy.label());
            let (ordinal, _) = stopped.reason.strip_prefix(&start)?.split_once(": ")?;
            let name = format!("{start}{ordinal}: ");
            Some((strategy, Ordinal(ordinal.parse().ok()?), name))
        });
        let Some((strategy, ordinal, name)) = named else {
            return Some(differ(&stopped.reason, "no set of the problem"));
        };
        let roadmap = strategy.generator().grows().then_some(self.roadmap);
        match strategy.generate(self.setup.context(), ordinal, roadmap, &mut Scratch::new()) {
            Err(gave_up) if stopped.reason == format!("{name}{gave_up}") => None,
            Err(gave_up) => Some(differ(&stopped.reason, &format!("{name}{gave_up}"))),
            Ok(_) => Some(differ(&stopped.reason, &format!("{name}it can be made"))),
        }
    }
}

fn differ(recorded: &str, found: &str) -> String {
    format!("the stop: recorded and recomputed differ: {recorded:?} and {found:?}")
}
