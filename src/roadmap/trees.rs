//! Trees of best routes: from one node to all others, or from all others to one.

use super::search::in_order;
use super::{Graph, Route};
use crate::numbers::NodeId;
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Which of two routes is the better one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rank {
    /// The one that costs less.
    Cost,
    /// The one whose highest peak is lower; of two alike, the one that costs less. For models with energies.
    Barrier,
}

/// What a route comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Value {
    /// Its highest peak; below every energy where it has no edge, or edges have no peaks.
    pub peak: f64,
    /// The sum of its weights.
    pub cost: f64,
}

impl Value {
    /// The value of a route without edges.
    pub const NOTHING: Value = Value { peak: f64::NEG_INFINITY, cost: 0.0 };

    /// The value of one route followed by another.
    pub fn then(self, next: Value) -> Value {
        Value { peak: self.peak.max(next.peak), cost: self.cost + next.cost }
    }

    /// Integers in the order in which values are ranked, the best first.
    pub fn key(self, rank: Rank) -> [u64; 2] {
        match rank {
            Rank::Cost => [in_order(self.cost), 0],
            Rank::Barrier => [in_order(self.peak), in_order(self.cost)],
        }
    }
}

/// The best routes between one node, the root, and all nodes that it can reach.
pub(crate) struct Tree {
    root: NodeId,
    /// Whether routes lead to the root, instead of away from it.
    leads_to_root: bool,
    labels: Vec<Option<Label>>,
}

/// The route between a node and the root.
#[derive(Clone, Copy)]
struct Label {
    value: Value,
    /// The next node on the way to the root, and the index of the edge; [`u32::MAX`] at the root.
    next: NodeId,
    edge: u32,
}

impl Graph {
    /// Dijkstra's algorithm without an end: the best routes from `root`, or with `leads_to_root` those to it, in the
    /// direction in which they are walked. Each edge weighs as much as `weigh` makes of its weight; `None` forbids it. Of
    /// equally good routes, the one found first when nodes are settled in the order of their ids.
    ///
    /// By [`Rank::Barrier`] the peaks are the least there are. The costs are those of routes each of whose beginnings,
    /// seen from the root, has the least peak there is; where that is below the peak of the whole, a route that costs less
    /// may exist.
    pub(crate) fn tree(
        &self,
        root: NodeId,
        leads_to_root: bool,
        rank: Rank,
        weigh: impl Fn(u32, f64) -> Option<f64>,
    ) -> Tree {
        let mut labels: Vec<Option<Label>> = vec![None; self.nodes()];
        let mut is_final = vec![false; self.nodes()];
        let mut open = BinaryHeap::new();
        labels[root.index()] = Some(Label { value: Value::NOTHING, next: root, edge: u32::MAX });
        open.push(Reverse((Value::NOTHING.key(rank), root)));
        while let Some(Reverse((_, node))) = open.pop() {
            if std::mem::replace(&mut is_final[node.index()], true) {
                continue;
            }
            let Some(Label { value, .. }) = labels[node.index()] else {
                unreachable!("it was opened")
            };
            for (other, edge) in self.arcs_from(node) {
                let (from, to) = if leads_to_root { (other, node) } else { (node, other) };
                let Some(weight) = weigh(edge, self.weight(from, to, edge)) else { continue };
                let value = value.then(Value { peak: self.peak(edge), cost: weight });
                let label = &mut labels[other.index()];
                let is_better = |known: Label| value.key(rank) < known.value.key(rank);
                if label.is_none_or(is_better) && !is_final[other.index()] {
                    *label = Some(Label { value, next: node, edge });
                    open.push(Reverse((value.key(rank), other)));
                }
            }
        }
        Tree { root, leads_to_root, labels }
    }
}

impl Tree {
    /// What the route between `node` and the root comes to; `None` if there is none.
    pub fn value(&self, node: NodeId) -> Option<Value> {
        self.labels[node.index()].map(|label| label.value)
    }

    /// The next node on the route between `node` and the root, seen from `node`, and the index of the edge between the two; `None` at
    /// the root, and where there is no route.
    pub fn next(&self, node: NodeId) -> Option<(NodeId, u32)> {
        let label = self.labels[node.index()].filter(|_| node != self.root)?;
        Some((label.next, label.edge))
    }

    /// The route between `node`, which the root can reach, and the root, in the direction in which it is walked.
    pub fn route(&self, node: NodeId) -> Option<Route> {
        let (mut nodes, mut edges, mut at) = (vec![node], Vec::new(), node);
        while at != self.root {
            let label = self.labels[at.index()]?;
            at = label.next;
            nodes.push(at);
            edges.push(label.edge);
        }
        if !self.leads_to_root {
            nodes.reverse();
            edges.reverse();
        }
        let length = self.value(node)?.cost;
        Some(Route { nodes, edges, length })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Directed;
    use crate::roadmap::{Edge, EdgeCost};
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    const NODES: u32 = 6;

    fn edges(drawn: &[(u32, u32, u8, u8, u8)]) -> Vec<Edge> {
        let ordered = drawn.iter().filter(|(a, b, ..)| a != b);
        let edge = |&(a, b, forward, backward, peak): &(u32, u32, u8, u8, u8)| {
            let [forward, backward, peak] = [forward, backward, peak].map(f64::from);
            let cost = EdgeCost::Directed(Directed { forward, backward, peak });
            Edge { low: NodeId(a.min(b)), high: NodeId(a.max(b)), planner: 0, cost }
        };
        ordered.map(edge).collect()
    }

    proptest! {
        #[test]
        fn trees_hold_what_single_searches_find(
            drawn in prop::collection::vec((0..NODES, 0..NODES, 0u8..9, 0u8..9, 0u8..5), 0..14),
        ) {
            let graph = Graph::new(NODES as usize, &edges(&drawn));
            let (none, root) = (BTreeSet::new(), NodeId(2));
            for leads_to_root in [false, true] {
                let by_cost = graph.tree(root, leads_to_root, Rank::Cost, |_, weight| Some(weight));
                let by_peak = graph.tree(root, leads_to_root, Rank::Barrier, |_, weight| Some(weight));
                for node in (0..NODES).map(NodeId) {
                    let (from, to) = if leads_to_root { (node, root) } else { (root, node) };
                    let single = graph.shortest(from, to, &none);
                    prop_assert_eq!(by_cost.value(node).map(|value| value.cost), single.map(|route| route.length));
                    let lowest = graph.lowest_barrier(from, to, f64::NEG_INFINITY, &none);
                    prop_assert_eq!(by_peak.value(node).map(|value| value.peak), lowest.as_ref().map(|found| found.0));
                    let (Some((_, lowest)), Some(route)) = (lowest, by_peak.route(node)) else { continue };
                    prop_assert!(route.length >= lowest.length);
                    prop_assert_eq!((route.nodes[0], route.nodes[route.nodes.len() - 1]), (from, to));
                    let steps = route.nodes.iter().zip(&route.nodes[1..]).zip(&route.edges);
                    let costs = steps.map(|((from, to), edge)| graph.weight(*from, *to, *edge));
                    prop_assert_eq!(costs.sum::<f64>(), route.length);
                }
            }
        }
    }

    #[test]
    fn edges_weigh_what_they_are_told_to() {
        let graph = Graph::new(3, &edges(&[(0, 1, 1, 1, 0), (1, 2, 1, 1, 0), (0, 2, 5, 5, 0)]));
        let length = |weigh: &dyn Fn(u32, f64) -> Option<f64>| {
            let tree = graph.tree(NodeId(0), false, Rank::Cost, weigh);
            tree.route(NodeId(2)).map(|route| (route.nodes.len(), route.length))
        };
        assert_eq!(length(&|_, weight| Some(weight)), Some((3, 2.0)));
        assert_eq!(length(&|edge, weight| (edge != 1).then_some(weight)), Some((2, 5.0)));
        assert_eq!(
            length(&|edge, weight| Some(if edge == 0 { 9.0 } else { weight })),
            Some((2, 5.0))
        );
        assert_eq!(length(&|edge, weight| (edge == 0).then_some(weight)), None);
    }
}
