use super::{Outcome, Replica, Setup, Task};
use crate::connect::JoinInput;
use crate::digest::Digest;
use crate::model::Scratch;
use crate::numbers::{EvaluatorIndex, Ordinal, StrategyIndex};
use crate::problem::Problem;
use crate::roadmap::Roadmap;
use crate::seed::Seed;
use crate::wire;
use std::sync::Arc;

/// The most nodes of an increment.
const NODES: u32 = 4;

/// Digest of a small increment that no build contains: processes in which it differs must not
/// work on one roadmap.
pub fn canary(setup: &Setup) -> Digest {
    let small = small(setup);
    let strategy = StrategyIndex(0);
    // A strategy that grows finds no node to grow from.
    let frozen = setup.grows(strategy).then(|| Arc::new(Roadmap::new(&setup.cx.space)));
    let task = Task::Generate { strategy, ordinal: Ordinal(u64::MAX), frozen };
    let outcome: Outcome = task.run_by(&small, &setup.cx, &mut Scratch::new());
    Digest::of(&wire::encode(&outcome))
}

/// Digest of one job of every kind: a small set of each strategy, each joined to those before it, and what every
/// evaluator says of the roadmap that they make. It takes longer than [`canary`] and tells more, as it should of
/// machines that need not be alike.
pub fn canaries(setup: &Setup) -> Digest {
    let small = small(setup);
    let mut replica = Replica::new(setup);
    let mut scratch = Scratch::new();
    let mut all = Vec::new();
    for index in 0..small.strategies.len() as u32 {
        let strategy = StrategyIndex(index);
        let ordinal = Ordinal(u64::MAX);
        let frozen = setup.grows(strategy).then(|| replica.roadmap().clone());
        let made =
            Task::Generate { strategy, ordinal, frozen }.run_by(&small, &setup.cx, &mut scratch);
        all.extend(wire::encode(&made));
        // One that found nothing is joined to nothing.
        let Outcome::Increment(Ok(increment)) = made else { continue };
        replica.publish(setup, Arc::new(increment));
        let label = small.strategies[strategy.index()].label();
        let input = JoinInput {
            roadmap: replica.roadmap().clone(),
            increments: replica.increments().to_vec(),
            seed: Seed::of_set(setup.cx.base_seed, label, ordinal),
        };
        let joined = Task::Join { strategy, input }.run_by(&small, &setup.cx, &mut scratch);
        all.extend(wire::encode(&joined));
        if let Outcome::Joined(joined) = joined {
            replica.fold(setup, std::iter::once(&joined.edges[..]));
        }
    }
    for evaluator in (0..small.evaluators.len() as u32).map(EvaluatorIndex) {
        let roadmap = replica.roadmap().clone();
        let verdict = Task::Evaluate { evaluator, roadmap }.run_by(&small, &setup.cx, &mut scratch);
        all.extend(wire::encode(&verdict));
    }
    Digest::of(&all)
}

/// The same problem with sets of a few nodes.
fn small(setup: &Setup) -> Problem {
    let mut problem = setup.problem.clone();
    for strategy in &mut problem.strategies {
        strategy.nodes = strategy.nodes.min(NODES);
    }
    problem
}
