//! Shortest routes in a large graph, directed toward their end by landmarks.
//!
//! The distances of all nodes from a few nodes, the landmarks, bound the distance of any two by the triangle inequality, which
//! knows of obstacles what the configuration space's metric does not (ALT: A. V. Goldberg, C. Harrelson, *Computing the shortest
//! path: A\* search meets graph theory*, SODA 2005). Landmarks are chosen each farthest from those before. The route is the one
//! that [`Graph::shortest`] gives, to the bit.

use super::bidirectional::Extended;
use super::search::{Reached, in_order, traced};
use super::{Edge, Graph, Route};
use crate::numbers::NodeId;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// How many landmarks there are. More of them bound better and take longer to make.
const COUNT: usize = 12;
/// As of a search from both ends: how much longer, relative to the shortest, a way may seem and still be looked at.
const MARGIN: f64 = 1e-5;
/// Bounds are differences of distances in single precision, so they are lowered by this share of the largest distance: a rounding
/// of either, and as much again.
const ROUNDING: f64 = 4.0 * (f32::EPSILON as f64);

/// Distances from landmarks to all nodes of a graph whose edges cost the same in both directions.
#[derive(Debug)]
pub(crate) struct Landmarks {
    /// Node by node, the distances from all landmarks; infinite where there is no way.
    distances: Vec<f32>,
    /// By how much bounds are lowered.
    slack: f32,
}

/// What is known of a route's end, landmark by landmark: its least distance over the nodes that it is attached to, and the
/// largest of what these nodes' distances are more than the edges to them.
struct End {
    least: [f32; COUNT],
    largest: [f32; COUNT],
}

impl Landmarks {
    /// Chooses landmarks in the connected component of `first` and measures all distances from them.
    pub fn new(graph: &Graph, first: NodeId) -> Landmarks {
        let nodes = graph.nodes();
        let mut distances = vec![f32::INFINITY; nodes * COUNT];
        let farthest = |from: &[f64]| {
            let reached = (0..nodes).filter(|node| from[*node] < f64::INFINITY);
            let far = reached.max_by(|a, b| from[*a].total_cmp(&from[*b]).then(b.cmp(a)));
            NodeId(far.unwrap_or(first.index()) as u32)
        };
        let mut landmark = farthest(&distances_from(graph, first));
        let mut nearest = vec![f64::INFINITY; nodes];
        let mut largest = 0.0f64;
        for index in 0..COUNT {
            let from = distances_from(graph, landmark);
            for (node, distance) in from.iter().enumerate() {
                distances[node * COUNT + index] = *distance as f32;
                nearest[node] = nearest[node].min(*distance);
                if *distance < f64::INFINITY {
                    largest = largest.max(*distance);
                }
            }
            landmark = farthest(&nearest);
        }
        Landmarks { distances, slack: (largest * ROUNDING) as f32 }
    }

    fn of(&self, node: NodeId) -> &[f32] {
        &self.distances[node.index() * COUNT..][..COUNT]
    }

    /// What bounds the distances to `to`, which these edges attach to the graph.
    fn end(&self, to: NodeId, edges: &[Edge]) -> End {
        let mut end = End { least: [f32::INFINITY; COUNT], largest: [f32::NEG_INFINITY; COUNT] };
        for edge in edges {
            let node = match (edge.low == to, edge.high == to) {
                (true, _) => edge.high,
                (_, true) => edge.low,
                _ => continue,
            };
            let weight = edge.weight() as f32;
            for (index, distance) in self.of(node).iter().enumerate() {
                end.least[index] = end.least[index].min(distance + weight);
                end.largest[index] = end.largest[index].max(distance - weight);
            }
        }
        end
    }

    /// A number that no way from a node of the graph to the end is shorter than.
    ///
    /// A way of length *D* leaves the graph at a node *a* by an edge of weight *w*. With *d* for distances from a landmark in the
    /// graph, *d*(node) + *D* ≥ *d*(*a*) + *w*, and *D* ≥ *d*(node) − *d*(*a*) + *w*.
    fn bound(&self, node: NodeId, end: &End) -> f64 {
        let mut bound = 0.0f32;
        for (index, distance) in self.of(node).iter().enumerate() {
            // Where there is no way from a landmark the differences are no numbers, which `max` passes over, or tell nothing.
            let beyond = end.least[index] - distance;
            let before = distance - end.largest[index];
            if distance.is_finite() && beyond.is_finite() {
                bound = bound.max(beyond);
            }
            if distance.is_finite() && before.is_finite() {
                bound = bound.max(before);
            }
        }
        f64::from((bound - self.slack).max(0.0)) * (1.0 - MARGIN)
    }
}

/// The lengths of shortest ways from a node to all nodes; infinite where there is none.
fn distances_from(graph: &Graph, from: NodeId) -> Vec<f64> {
    let mut distances = vec![f64::INFINITY; graph.nodes()];
    let mut open = BinaryHeap::new();
    distances[from.index()] = 0.0;
    open.push(Reverse((in_order(0.0), from)));
    while let Some(Reverse((key, node))) = open.pop() {
        let value = distances[node.index()];
        if key != in_order(value) {
            continue;
        }
        for (next, edge) in graph.arcs_from(node) {
            let through = value + graph.weight(node, next, edge);
            if through < distances[next.index()] {
                distances[next.index()] = through;
                open.push(Reverse((in_order(through), next)));
            }
        }
    }
    distances
}

/// What searches write into, for many searches of one graph.
#[derive(Debug)]
pub(crate) struct Values {
    /// Per node the length of the shortest way to it that is known.
    values: Vec<f64>,
    touched: Vec<NodeId>,
    /// Nodes by the length of a way through them at least, then by their number, with the length of the way to them.
    open: BinaryHeap<Reverse<(u64, NodeId, u64)>>,
}

impl Values {
    /// For searches of a graph with so many nodes.
    pub fn new(nodes: usize) -> Values {
        Values { values: vec![f64::INFINITY; nodes], touched: Vec::new(), open: BinaryHeap::new() }
    }

    fn clear(&mut self) {
        for node in self.touched.drain(..) {
            self.values[node.index()] = f64::INFINITY;
        }
        self.open.clear();
    }

    /// Takes a way to a node if it is shorter than those before.
    fn offer(&mut self, node: NodeId, value: f64, bound: impl FnOnce() -> f64) {
        let known = &mut self.values[node.index()];
        if value < *known {
            if *known == f64::INFINITY {
                self.touched.push(node);
            }
            *known = value;
            self.open.push(Reverse((in_order(value + bound()), node, in_order(value))));
        }
    }
}

/// The route that [`Graph::shortest`] gives in the graph with all these edges, avoiding those in `without`. `ends` are the last two
/// nodes of the graph, which only `more`, the edges beside the graph's own, attach to it. `Err` where an edge is too short beside the
/// route for its weight to count in a sum: then ties are broken by the order of a search that this one does not have.
///
/// A search by lengths and bounds goes on until all nodes are looked at through which a way may be as short as the shortest, with
/// a margin for rounding. The lengths of ways to them are then those of Dijkstra's algorithm, which takes nodes in the order of
/// their lengths, then of their numbers, and keeps of equally long ways to a node the one that it finds first. So from the end
/// back each node is reached from the first in this order from which the way is not longer, by the first of its edges.
pub(crate) fn shortest(
    (graph, more): (&Extended, &[Edge]),
    landmarks: &Landmarks,
    (from, to): (NodeId, NodeId),
    without: &BTreeSet<u32>,
    values: &mut Values,
) -> Result<Option<Route>, TooShort> {
    values.clear();
    let end = landmarks.end(to, more);
    let bound =
        |node: NodeId| if node == to || node == from { 0.0 } else { landmarks.bound(node, &end) };
    values.offer(from, 0.0, || 0.0);
    let mut shortest = f64::INFINITY;
    while let Some(Reverse((key, node, value))) = values.open.pop() {
        if key > in_order(shortest * (1.0 + MARGIN)) {
            break;
        }
        let known = values.values[node.index()];
        if value != in_order(known) {
            continue;
        }
        if node == to {
            shortest = known;
            continue;
        }
        for (next, edge) in graph.arcs_from(node) {
            if without.contains(&edge) {
                continue;
            }
            let through = known + graph.weight(node, next, edge);
            if through == known {
                return Err(TooShort);
            }
            values.offer(next, through, || bound(next));
        }
    }
    if shortest == f64::INFINITY {
        return Ok(None);
    }
    let value = |node: NodeId| values.values[node.index()];
    let before = |node: NodeId| {
        let arcs = graph.arcs_from(node).filter(|(_, edge)| !without.contains(edge));
        let ways = arcs.filter(|(before, edge)| {
            value(*before) + graph.weight(*before, node, *edge) == value(node)
        });
        let first = ways.min_by_key(|(before, edge)| (in_order(value(*before)), *before, *edge));
        let (before, edge) = first.expect("the node was reached");
        Reached { value: value(node), before, edge }
    };
    Ok(Some(traced(from, to, before, |from, to, edge| graph.weight(from, to, edge))))
}

/// An edge's weight does not count beside the length of a way.
#[derive(Debug, PartialEq)]
pub(crate) struct TooShort;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roadmap::bidirectional::{self, Buffers};
    use proptest::prelude::*;

    const NODES: u32 = 24;

    /// Edges between nodes below `NODES`; many ways are equally long.
    fn edges() -> impl Strategy<Value = Vec<Edge>> {
        let edge = (0..NODES, 0..NODES, 0..5u8).prop_filter_map("two nodes", |(a, b, weight)| {
            let (low, high) = (NodeId(a.min(b)), NodeId(a.max(b)));
            // Now and then none, which is too short.
            (a != b)
                .then(|| Edge::metric(low, high, 0, f64::from(weight + u8::from(a % 4 != 0)) * 0.1))
        });
        proptest::collection::vec(edge, 0..80)
    }

    /// Edges that attach the two ends to nodes.
    fn attached() -> impl Strategy<Value = Vec<Edge>> {
        let edge = (0..NODES, 0..2u32, 1..9u8).prop_map(|(node, end, weight)| {
            Edge::metric(NodeId(node), NodeId(NODES + end), 0, f64::from(weight) * 0.1)
        });
        proptest::collection::vec(edge, 0..12)
    }

    proptest! {
        #[test]
        fn the_route_is_that_of_a_search_from_one_end(
            own in edges(),
            several in proptest::collection::vec(attached(), 1..5),
            without in proptest::collection::btree_set(0..90u32, 0..12),
        ) {
            let nodes = NODES as usize + 2;
            let graph = Graph::new(nodes, &own);
            let landmarks = Landmarks::new(&graph, NodeId(0));
            let (mut values, mut buffers) = (Values::new(nodes), Buffers::new(nodes));
            let ends = (NodeId(NODES), NodeId(NODES + 1));
            for more in several {
                let whole: Vec<Edge> = own.iter().chain(&more).copied().collect();
                let expected = Graph::new(nodes, &whole).shortest(ends.0, ends.1, &without);
                let extended = Extended::new(&graph, &more);
                let found = shortest((&extended, &more), &landmarks, ends, &without, &mut values);
                match found {
                    Ok(found) => prop_assert_eq!(found, expected),
                    Err(TooShort) => prop_assert_eq!(
                        bidirectional::shortest(&extended, ends, &without, &mut buffers),
                        expected
                    ),
                }
            }
        }
    }
}
