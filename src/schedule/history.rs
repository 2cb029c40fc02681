use super::Yield;
use crate::roadmap::{Forest, Round};

/// What the strategies' sets came to in every round, from the rounds alone.
#[derive(Clone, Debug)]
pub(super) struct History {
    forest: Forest,
    yields: Vec<Vec<Yield>>,
    strategies: usize,
}

impl History {
    pub fn new(strategies: usize) -> History {
        History { forest: Forest::default(), yields: Vec::new(), strategies }
    }

    /// Takes in the next round.
    pub fn observe(&mut self, round: &Round) {
        let before = self.forest.len();
        for set in &round.sets {
            let first = self.forest.len();
            self.forest.grow(set.increment.configs.len() as u32);
            for edge in &set.increment.edges {
                let edge = edge.shifted(first);
                self.forest.unite(edge.low, edge.high);
            }
            for edge in set.increment.root_edges_from(first) {
                self.forest.unite(edge.low, edge.high);
            }
        }
        let mut yields = vec![Yield::default(); self.strategies];
        for set in &round.sets {
            let total = &mut yields[set.strategy.index()];
            total.sets += 1;
            for asked in [set.increment.asked, set.joined.asked] {
                total.effort += asked.configurations + asked.motions;
            }
            for edge in &set.joined.edges {
                let [low, high] = self.forest.unite(edge.low, edge.high);
                // Its lowest node says whether a component was there before.
                total.united += u64::from(low != high && high.0 < before);
            }
        }
        self.yields.push(yields);
    }

    /// Per round and strategy.
    pub fn yields(&self) -> &[Vec<Yield>] {
        &self.yields
    }
}
