use super::candidates::{CandidatePair, CandidatePairs};
use super::component_pairs::{default_components, default_pairs};
use super::{Among, JoinInput, default_neighbors, default_planners};
use crate::context::Context;
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Edge;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// First the nearest nodes of every new node, then, for components that these have not joined, the closest pairs
/// of nodes: the default.
///
/// The report's rule ([`ComponentPairs`](super::ComponentPairs)) chooses components by their centres. That fails
/// where components are large and winding, as in a house of many rooms: the centre says nothing of where
/// a component is. Nearest nodes ([`NearestNodes`](super::NearestNodes)) fail where all near nodes are
/// on the other side of a wall. Together they join what either joins:
///
/// 1. Each new node and its `neighbors` nearest old ones, closest pairs first. A pair is tried while its two components
///    are not joined; the `cycles` nearest of each node are tried in any case, so that the roadmap gets ways around.
/// 2. Each new component, by its smallest node id, and the `components` components of the roadmap whose centres are
///    nearest, then as many of the round's earlier sets: while the two are not joined, their `pairs` closest
///    pairs of nodes. A component of at most three nodes that step 1 has joined to anything is passed over: where
///    sets fall into many such components, as in narrow mazes, half of the time would go into motions between closest
///    pairs, which are long and mostly blocked.
///
/// What counts as joined is what this increment's own edges join, directly or by way of others, since a join's
/// inputs are frozen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct NodesAndComponents {
    /// How many nearest nodes of each new one.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
    /// How many of these are tried even where they close a cycle.
    #[serde(default = "default_cycles")]
    pub cycles: u32,
    /// How many nearest components of each new one.
    #[serde(default = "default_components")]
    pub components: u32,
    /// How many closest pairs of nodes of each pair of components.
    #[serde(default = "default_pairs")]
    pub pairs: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

/// The most nodes of a component that looks at no components once its nearest nodes have joined it to the roadmap.
pub const SMALL: usize = 3;

fn default_cycles() -> u32 {
    1
}

impl Default for NodesAndComponents {
    fn default() -> NodesAndComponents {
        NodesAndComponents {
            neighbors: default_neighbors(),
            cycles: default_cycles(),
            components: default_components(),
            pairs: default_pairs(),
            planners: default_planners(),
        }
    }
}

impl Among for NodesAndComponents {
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge> {
        let Some(candidates) = CandidatePairs::new(input) else { return Vec::new() };
        let mut joined = candidates.joined();
        let mut tried = BTreeSet::new();
        let mut edges = Vec::new();
        let mut attempt = |pair: CandidatePair, scratch: &mut Scratch| {
            let fresh = tried.insert((pair.new, pair.old));
            let edge =
                fresh.then(|| candidates.connect(cx, &self.planners, pair, scratch)).flatten();
            edges.extend(edge);
            edge.is_some()
        };
        for (pair, rank) in by_nodes(&candidates, cx, self.neighbors, scratch) {
            let sides = candidates.components(pair);
            if (rank < self.cycles || !joined.same(sides)) && attempt(pair, scratch) {
                joined.unite(sides);
            }
        }
        for component in candidates.new_components() {
            let count = self.components as usize;
            let own = candidates.new.first + component.name.0;
            // What is united is named by its smallest node id, so that a smaller name is that of something older.
            if component.members.len() <= SMALL && joined.root(own) < candidates.new.first {
                continue;
            }
            for old in candidates.nearest_components(cx, component, count) {
                let sides = [old, own];
                if joined.same(sides) {
                    continue;
                }
                let mut pairs =
                    candidates.closest_pairs(cx, component, old, self.pairs as usize).into_iter();
                if pairs.any(|pair| attempt(pair, scratch)) {
                    joined.unite(sides);
                }
            }
        }
        edges
    }

    fn complaint(&self) -> Option<Complaint> {
        let counts =
            [("neighbors", self.neighbors), ("components", self.components), ("pairs", self.pairs)];
        match counts.into_iter().find(|(_, count)| *count == 0) {
            Some((key, _)) => Some(Complaint::new(key, 0, "at least 1")),
            None => local::complaint(&self.planners),
        }
    }
}

/// The pairs of each new node with its nearest old ones, closest first, each with the number of old nodes that are
/// nearer to the new node.
fn by_nodes(
    candidates: &CandidatePairs,
    cx: &Context,
    neighbors: u32,
    scratch: &mut Scratch,
) -> Vec<(CandidatePair, u32)> {
    let mut ranked: Vec<(CandidatePair, u32)> = Vec::new();
    for pair in candidates.nearest(cx, neighbors, scratch) {
        let rank =
            ranked.last().filter(|(last, _)| last.new == pair.new).map_or(0, |(_, rank)| rank + 1);
        ranked.push((pair, rank));
    }
    ranked.sort_by(|(a, _), (b, _)| a.closest_first(b));
    ranked
}
