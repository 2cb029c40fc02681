use super::Round;
use crate::schedule::Yield;

/// What the strategies' sets came to in every round, from the rounds alone.
#[derive(Clone, Debug)]
pub(super) struct History {
    /// Per node another of its component, with a lower id but for the lowest one.
    lower: Vec<u32>,
    yields: Vec<Vec<Yield>>,
    strategies: usize,
}

impl History {
    pub fn new(strategies: usize) -> History {
        History { lower: Vec::new(), yields: Vec::new(), strategies }
    }

    /// Takes in the next round.
    pub fn observe(&mut self, round: &Round) {
        let before = self.lower.len() as u32;
        for set in &round.sets {
            let first = self.lower.len() as u32;
            self.lower.extend(first..first + set.increment.configs.len() as u32);
            for edge in &set.increment.edges {
                let edge = edge.shifted(first);
                self.unite(edge.low, edge.high);
            }
        }
        let mut yields = vec![Yield::default(); self.strategies];
        for set in &round.sets {
            let total = &mut yields[set.strategy as usize];
            total.sets += 1;
            for asked in [set.increment.asked, set.joined.asked] {
                total.cost += asked.configurations + asked.motions;
            }
            for edge in &set.joined.edges {
                let [low, high] = self.unite(edge.low, edge.high);
                // Its lowest node says whether a component was there before.
                total.united += u64::from(low != high && high < before);
            }
        }
        self.yields.push(yields);
    }

    /// Per round and strategy.
    pub fn yields(&self) -> &[Vec<Yield>] {
        &self.yields
    }

    /// Unites the components of two nodes; what their lowest nodes were, the lower one first.
    fn unite(&mut self, a: u32, b: u32) -> [u32; 2] {
        let (a, b) = (self.lowest(a), self.lowest(b));
        let (low, high) = (a.min(b), a.max(b));
        self.lower[high as usize] = low;
        [low, high]
    }

    fn lowest(&mut self, mut node: u32) -> u32 {
        while self.lower[node as usize] != node {
            let next = self.lower[node as usize];
            self.lower[node as usize] = self.lower[next as usize];
            node = next;
        }
        node
    }
}
