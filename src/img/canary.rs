use super::{Outcome, Setup, Task};
use crate::digest::Digest;
use crate::model::Scratch;
use crate::numbers::{Ordinal, StrategyIndex};
use crate::roadmap::Roadmap;
use std::sync::Arc;

/// The most nodes of the increment.
const NODES: u32 = 4;

/// Digest of a small increment that no build contains: processes in which it differs must not
/// work on one roadmap.
pub fn canary(setup: &Setup) -> Digest {
    let mut problem = setup.problem.clone();
    for strategy in &mut problem.strategies {
        strategy.nodes = strategy.nodes.min(NODES);
    }
    let small = Setup { problem, cx: setup.problem.context(), plan: setup.plan.clone() };
    let strategy = StrategyIndex(0);
    // A strategy that grows finds no node to grow from.
    let frozen = setup.grows(strategy).then(|| Arc::new(Roadmap::new(&setup.cx.space)));
    let task = Task::Generate { strategy, ordinal: Ordinal(u64::MAX), frozen };
    let outcome: Outcome = task.run(&small, &mut Scratch::new());
    Digest::of(&crate::wire::encode(&outcome))
}
