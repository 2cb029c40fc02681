//! Shortest routes through a roadmap.

use super::Edge;
use crate::numbers::NodeId;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// A graph prepared for searching: the neighbours of each node, in the order of the edges.
#[derive(Debug)]
pub struct Graph {
    /// Per node the index of its first arc, and at the end the number of arcs.
    start: Vec<u32>,
    /// Node by node, the arcs that lead away from it.
    arcs: Vec<Arc>,
    /// Per edge its weight.
    weights: Vec<f64>,
    /// Of directed edges: weights from the higher node to the lower, and peaks.
    back: Vec<f64>,
    peaks: Vec<f64>,
}

/// An edge in one of its two directions, seen from the node where it begins.
#[derive(Clone, Copy, Debug, Default)]
struct Arc {
    to: NodeId,
    /// Index of the edge.
    edge: u32,
}

/// How a search has reached a node so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reached {
    /// What a way there comes to.
    pub value: f64,
    /// The node before it on that way.
    pub before: NodeId,
    /// Index of the edge from there; [`u32::MAX`] at the beginning.
    pub edge: u32,
}

/// A route: nodes and the edges between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// The nodes, from one end to the other.
    pub nodes: Vec<NodeId>,
    /// Index of the edge that leads to each node but the first.
    pub edges: Vec<u32>,
    /// Sum of the edges' weights.
    pub length: f64,
}

impl Graph {
    /// The graph of `nodes` nodes with these edges, each of which can be walked in both directions. Either all
    /// of them or none have directed costs.
    pub fn new(nodes: usize, edges: &[Edge]) -> Graph {
        Graph::of(nodes, || edges.iter().copied())
    }

    /// [`Graph::new`] of edges that are gone through several times, instead of standing in a row.
    pub(crate) fn of<I: Iterator<Item = Edge>>(nodes: usize, edges: impl Fn() -> I) -> Graph {
        let mut start = vec![0u32; nodes + 1];
        for edge in edges() {
            start[edge.low.index() + 1] += 1;
            start[edge.high.index() + 1] += 1;
        }
        for node in 0..nodes {
            start[node + 1] += start[node];
        }
        let mut next = start.clone();
        let mut arcs = vec![Arc::default(); start[nodes] as usize];
        for (index, edge) in edges().enumerate() {
            for (from, to) in [(edge.low, edge.high), (edge.high, edge.low)] {
                arcs[next[from.index()] as usize] = Arc { to, edge: index as u32 };
                next[from.index()] += 1;
            }
        }
        let directed = || edges().filter_map(|edge| edge.cost.directed());
        Graph {
            start,
            arcs,
            weights: edges().map(|edge| edge.weight()).collect(),
            back: directed().map(|cost| cost.backward).collect(),
            peaks: directed().map(|cost| cost.peak).collect(),
        }
    }

    /// A shortest route from `from` to `to` that avoids the edges in `without`; of several, the
    /// one that Dijkstra's algorithm finds when ties go to the lower node id.
    pub fn shortest(&self, from: NodeId, to: NodeId, without: &BTreeSet<u32>) -> Option<Route> {
        self.shortest_where(from, to, |_, edge| !without.contains(&edge))
    }

    /// [`Graph::shortest`] among the routes each of whose arcs is allowed, by the node that it leads to and its edge.
    pub(crate) fn shortest_where(
        &self,
        from: NodeId,
        to: NodeId,
        is_allowed: impl Fn(NodeId, u32) -> bool,
    ) -> Option<Route> {
        let through = |length: f64, from: NodeId, to: NodeId, edge: u32| {
            is_allowed(to, edge).then(|| length + self.weight(from, to, edge))
        };
        self.search(from, to, 0.0, through).map(|(_, route)| route)
    }

    /// Of directed edges: the least energy that a way from `from` to `to` has to reach, the least over all ways
    /// of the highest peak of an edge, and a shortest route among those that do not exceed it. The edges in
    /// `without` are avoided. `start` is the energy at `from`, which no way is below.
    pub fn lowest_barrier(
        &self,
        from: NodeId,
        to: NodeId,
        start: f64,
        without: &BTreeSet<u32>,
    ) -> Option<(f64, Route)> {
        self.lowest_barrier_where(from, to, start, |_, edge| !without.contains(&edge))
    }

    /// [`Graph::lowest_barrier`] among the routes each of whose arcs is allowed, by the node that it leads to and its edge.
    pub(crate) fn lowest_barrier_where(
        &self,
        from: NodeId,
        to: NodeId,
        start: f64,
        is_allowed: impl Fn(NodeId, u32) -> bool,
    ) -> Option<(f64, Route)> {
        let peak = |to: NodeId, edge: u32| {
            is_allowed(to, edge).then(|| self.peaks.get(edge as usize).copied()).flatten()
        };
        let highest =
            |barrier: f64, _: NodeId, to: NodeId, edge: u32| Some(barrier.max(peak(to, edge)?));
        let (barrier, _) = self.search(from, to, start, highest)?;
        let through = |length: f64, from: NodeId, to: NodeId, edge: u32| {
            (peak(to, edge)? <= barrier).then(|| length + self.weight(from, to, edge))
        };
        self.search(from, to, 0.0, through).map(|(_, route)| (barrier, route))
    }

    /// The least over all ways from `from` to `to` of the largest weight on the way, in its direction, weights below `least`
    /// counting as that; `least` where the two are the same node.
    pub(crate) fn least_largest_weight(&self, from: NodeId, to: NodeId, least: f64) -> Option<f64> {
        let largest = |largest: f64, from: NodeId, to: NodeId, edge: u32| {
            Some(largest.max(self.weight(from, to, edge)))
        };
        self.search(from, to, least, largest).map(|(largest, _)| largest)
    }

    /// The edges that lead away from a node, each with the node at its other end, in the order of the edges.
    pub(crate) fn arcs_from(&self, node: NodeId) -> impl Iterator<Item = (NodeId, u32)> {
        let range = self.start[node.index()] as usize..self.start[node.index() + 1] as usize;
        self.arcs[range].iter().map(|arc| (arc.to, arc.edge))
    }

    /// The number of nodes.
    pub(crate) fn nodes(&self) -> usize {
        self.start.len() - 1
    }

    /// The number of edges.
    pub(super) fn edges(&self) -> u32 {
        self.weights.len() as u32
    }

    /// The highest energy on an edge; below every energy where edges have none.
    pub(crate) fn peak(&self, edge: u32) -> f64 {
        self.peaks.get(edge as usize).copied().unwrap_or(f64::NEG_INFINITY)
    }

    /// Dijkstra's algorithm: the route from `from` to `to` whose value is least, and that value. It is `start`
    /// at the beginning; `through` gives it after one more edge, from one node to another, where that may be
    /// taken, and never makes it less.
    fn search(
        &self,
        from: NodeId,
        to: NodeId,
        start: f64,
        through: impl Fn(f64, NodeId, NodeId, u32) -> Option<f64>,
    ) -> Option<(f64, Route)> {
        let mut best: Vec<Option<Reached>> = vec![None; self.nodes()];
        let mut is_final = vec![false; best.len()];
        let mut open = BinaryHeap::new();
        open.push(Reverse((in_order(start), from)));
        best[from.index()] = Some(Reached { value: start, before: from, edge: u32::MAX });
        while let Some(Reverse((_, node))) = open.pop() {
            if std::mem::replace(&mut is_final[node.index()], true) {
                continue;
            }
            let Some(Reached { value, .. }) = best[node.index()] else {
                unreachable!("it was opened")
            };
            if node == to {
                let reached = |node: NodeId| best[node.index()].expect("settled");
                let weight = |from, to, edge| self.weight(from, to, edge);
                return Some((value, traced(from, to, reached, weight)));
            }
            for (next, edge) in self.arcs_from(node) {
                let Some(through) = through(value, node, next, edge) else { continue };
                let best = &mut best[next.index()];
                if best.is_none_or(|known| through < known.value) {
                    *best = Some(Reached { value: through, before: node, edge });
                    open.push(Reverse((in_order(through), next)));
                }
            }
        }
        None
    }

    /// What an edge costs from one of its ends to the other.
    pub(crate) fn weight(&self, from: NodeId, to: NodeId, edge: u32) -> f64 {
        let weights = if from < to || self.back.is_empty() { &self.weights } else { &self.back };
        weights[edge as usize]
    }
}

/// The route from `from` to `to` by the ways in which a search has reached the nodes; `weight` is what an edge costs from one
/// node to another.
pub(super) fn traced(
    from: NodeId,
    to: NodeId,
    reached: impl Fn(NodeId) -> Reached,
    weight: impl Fn(NodeId, NodeId, u32) -> f64,
) -> Route {
    let (mut nodes, mut edges, mut node) = (vec![to], Vec::new(), to);
    while node != from {
        let Reached { before, edge, .. } = reached(node);
        nodes.push(before);
        edges.push(edge);
        node = before;
    }
    nodes.reverse();
    edges.reverse();
    let ends = nodes.iter().zip(nodes.iter().skip(1));
    let weights = ends.zip(&edges).map(|((from, to), edge)| weight(*from, *to, *edge));
    Route { length: weights.fold(0.0, |length, weight| length + weight), nodes, edges }
}

/// The bits of a number, changed so that they are in the order of the numbers.
pub(super) fn in_order(value: f64) -> u64 {
    let bits = value.to_bits();
    if value.is_sign_negative() { !bits } else { bits | 1 << 63 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Directed;
    use crate::roadmap::EdgeCost;

    fn edge(low: u32, high: u32, weight: f64) -> Edge {
        Edge::metric(NodeId(low), NodeId(high), 0, weight)
    }

    /// The nodes of a route as bare integers.
    fn ids(route: &Route) -> Vec<u32> {
        route.nodes.iter().map(|node| node.0).collect()
    }

    #[test]
    fn the_lowest_barrier_is_the_least_highest_peak_and_costs_depend_on_the_direction() {
        // Energies −5, −3, −4, −8; from 0 to 3 over 1 with a peak of −1, or over 2 with one of −2.
        let energies = [-5.0, -3.0, -4.0, -8.0];
        let directed = |low: u32, high: u32, peak: f64| {
            let [forward, backward] = [low, high].map(|node| peak - energies[node as usize]);
            let cost = EdgeCost::Directed(Directed { forward, backward, peak });
            Edge { low: NodeId(low), high: NodeId(high), planner: 0, cost }
        };
        let edges = [
            directed(0, 1, -3.0),
            directed(1, 3, -1.0),
            directed(0, 2, -2.0),
            directed(2, 3, -2.0),
        ];
        let graph = Graph::new(5, &edges);
        let none = BTreeSet::new();
        let (barrier, route) = graph.lowest_barrier(NodeId(0), NodeId(3), -5.0, &none).unwrap();
        assert_eq!((barrier, ids(&route), route.length), (-2.0, vec![0, 2, 3], 3.0 + 2.0));
        let (barrier, route) = graph.lowest_barrier(NodeId(3), NodeId(0), -8.0, &none).unwrap();
        assert_eq!((barrier, ids(&route), route.length), (-2.0, vec![3, 2, 0], 6.0 + 2.0));
        // By the sum of the climbs the way over 1 is the shorter one.
        assert_eq!(graph.shortest(NodeId(0), NodeId(3), &none).unwrap().length, 4.0);
        let (barrier, route) =
            graph.lowest_barrier(NodeId(0), NodeId(3), -5.0, &BTreeSet::from([3])).unwrap();
        assert_eq!((barrier, ids(&route)), (-1.0, vec![0, 1, 3]));
        assert_eq!(graph.lowest_barrier(NodeId(0), NodeId(4), -5.0, &none), None);
        assert_eq!(graph.lowest_barrier(NodeId(4), NodeId(4), 7.0, &none).unwrap().0, 7.0);
    }

    #[test]
    fn the_shortest_route_is_found_and_dropped_edges_avoided() {
        let edges = [edge(0, 1, 1.0), edge(1, 3, 1.0), edge(0, 2, 0.5), edge(2, 3, 2.0)];
        let graph = Graph::new(5, &edges);
        let mut without = BTreeSet::new();
        let route = graph.shortest(NodeId(0), NodeId(3), &without).unwrap();
        assert_eq!((ids(&route), route.edges, route.length), (vec![0, 1, 3], vec![0, 1], 2.0));
        without.insert(1);
        assert_eq!(ids(&graph.shortest(NodeId(0), NodeId(3), &without).unwrap()), [0, 2, 3]);
        without.insert(3);
        assert_eq!(graph.shortest(NodeId(0), NodeId(3), &without), None);
        assert_eq!(graph.shortest(NodeId(0), NodeId(4), &BTreeSet::new()), None);
        assert_eq!(ids(&graph.shortest(NodeId(4), NodeId(4), &BTreeSet::new()).unwrap()), [4]);
    }
}
