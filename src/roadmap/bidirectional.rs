//! Shortest routes between two nodes of a large graph, by a search from both ends.
//!
//! Dijkstra's algorithm from one end settles all nodes that are nearer than the other end. Two searches that meet halfway
//! settle far fewer: in a space of *d* dimensions about one in 2^(*d* − 1) (I. Pohl, *Bi-directional search*, Machine
//! Intelligence 6, 1971). The route is the one that [`Graph::shortest`] gives, to the bit: the two searches only find out
//! which nodes can lie on a shortest route, and the one from the beginning then goes on among these.

use super::search::{Reached, in_order, traced};
use super::{Edge, Graph, Route};
use crate::numbers::NodeId;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// By how much, relative to the shortest length that is known, a way may seem longer and still be looked at. Sums of
/// lengths in different orders differ by rounding: at most by 2^-53 for every edge of a way, and a way has less than 2^32
/// edges, which makes 5e-7. The two sums of a way and the two of the way that it is compared with are six such errors at
/// the most, 3e-6.
const MARGIN: f64 = 1e-5;

/// A graph, and some edges more that come after its own in number and in order.
pub(crate) struct Extended<'a> {
    graph: &'a Graph,
    edges: &'a [Edge],
    /// The arcs of these edges, by the node where they begin, then by their edge.
    arcs: Vec<(NodeId, NodeId, u32)>,
}

impl<'a> Extended<'a> {
    /// The graph with these edges between its nodes.
    pub fn new(graph: &'a Graph, edges: &'a [Edge]) -> Extended<'a> {
        let first = graph.edges();
        let both = |(index, edge): (usize, &Edge)| {
            let index = first + index as u32;
            [(edge.low, edge.high, index), (edge.high, edge.low, index)]
        };
        let mut arcs: Vec<_> = edges.iter().enumerate().flat_map(both).collect();
        arcs.sort_by_key(|(from, _, edge)| (*from, *edge));
        Extended { graph, edges, arcs }
    }

    /// The edges that lead away from a node, each with the node at its other end, in the order of the edges.
    pub fn arcs_from(&self, node: NodeId) -> impl Iterator<Item = (NodeId, u32)> {
        let first = self.arcs.partition_point(|(from, _, _)| *from < node);
        let more = self.arcs[first..].iter().take_while(move |(from, _, _)| *from == node);
        self.graph.arcs_from(node).chain(more.map(|(_, to, edge)| (*to, *edge)))
    }

    /// What an edge costs from one of its ends to the other.
    pub fn weight(&self, from: NodeId, to: NodeId, edge: u32) -> f64 {
        match edge.checked_sub(self.graph.edges()) {
            None => self.graph.weight(from, to, edge),
            Some(index) => {
                let cost = self.edges[index as usize].cost;
                if from < to { cost.forward() } else { cost.backward() }
            }
        }
    }
}

/// What searches write into: made once, used for many searches of one graph, whose number of nodes it has the size of.
#[derive(Debug)]
pub(crate) struct Buffers {
    /// From the beginning of the route.
    forward: Side,
    /// From its end, against the direction of the arcs.
    backward: Side,
}

/// One of the two searches.
#[derive(Debug)]
struct Side {
    /// Per node how it was reached so far; not at all where the value is infinite.
    reached: Vec<Reached>,
    is_final: Vec<bool>,
    /// The nodes that were reached.
    touched: Vec<NodeId>,
    open: BinaryHeap<Reverse<(u64, NodeId)>>,
}

const UNREACHED: Reached = Reached { value: f64::INFINITY, before: NodeId(0), edge: u32::MAX };

impl Buffers {
    /// Buffers for searches of a graph with so many nodes.
    pub fn new(nodes: usize) -> Buffers {
        Buffers { forward: Side::new(nodes), backward: Side::new(nodes) }
    }
}

impl Side {
    fn new(nodes: usize) -> Side {
        Side {
            reached: vec![UNREACHED; nodes],
            is_final: vec![false; nodes],
            touched: Vec::new(),
            open: BinaryHeap::new(),
        }
    }

    /// Forgets what was found before, and begins at a node.
    fn begin(&mut self, at: NodeId) {
        for node in self.touched.drain(..) {
            self.reached[node.index()] = UNREACHED;
            self.is_final[node.index()] = false;
        }
        self.open.clear();
        self.offer(at, Reached { value: 0.0, ..UNREACHED });
    }

    fn value(&self, node: NodeId) -> f64 {
        self.reached[node.index()].value
    }

    fn is_final(&self, node: NodeId) -> bool {
        self.is_final[node.index()]
    }

    /// Takes a way to a node if it is shorter than those before; whether it is.
    fn offer(&mut self, node: NodeId, way: Reached) -> bool {
        let known = &mut self.reached[node.index()];
        if way.value >= known.value {
            return false;
        }
        if known.value == f64::INFINITY {
            self.touched.push(node);
        }
        *known = way;
        self.open.push(Reverse((in_order(way.value), node)));
        true
    }

    /// The node that is settled next, left where it is.
    fn next(&mut self) -> Option<NodeId> {
        while let Some(Reverse((_, node))) = self.open.peek() {
            if !self.is_final(*node) {
                return Some(*node);
            }
            self.open.pop();
        }
        None
    }

    /// Settles a node that [`Side::next`] gave: offers all ways that go on from it by one arc, whose weight `weight` gives
    /// by the node that the arc leads to and by its edge, where it may be taken. `found` is told of each that is taken.
    fn settle(
        &mut self,
        graph: &Extended,
        node: NodeId,
        weight: impl Fn(NodeId, u32) -> Option<f64>,
        mut found: impl FnMut(NodeId, f64),
    ) {
        self.is_final[node.index()] = true;
        let value = self.value(node);
        for (next, edge) in graph.arcs_from(node) {
            let Some(weight) = weight(next, edge) else { continue };
            let way = Reached { value: value + weight, before: node, edge };
            if self.offer(next, way) {
                found(next, way.value);
            }
        }
    }
}

/// The route that [`Graph::shortest`] gives in the graph with all these edges, avoiding those in `without`.
///
/// Let *U* be the shortest length known of a way. Both searches go on until the next nodes of the two are together more
/// than *U* away from their ends. A node on a shortest route is then settled from one of the ends: otherwise its two
/// distances would be more than *U* together. So the search from the beginning may leave out nodes that are not settled
/// from the end, and those through which a way is longer than *U*, and still comes to the same value at every node of the
/// route, by the same edge. Of several edges that give the same value at a node the first counts that is tried, here as
/// there, since all of them are on shortest routes, and nodes are settled in the same order.
pub(crate) fn shortest(
    graph: &Extended,
    (from, to): (NodeId, NodeId),
    without: &BTreeSet<u32>,
    buffers: &mut Buffers,
) -> Option<Route> {
    let Buffers { forward, backward } = buffers;
    forward.begin(from);
    backward.begin(to);
    let weight = |from: NodeId, to: NodeId, edge: u32| {
        (!without.contains(&edge)).then(|| graph.weight(from, to, edge))
    };
    let trace = |forward: &Side| {
        let reached = |node: NodeId| forward.reached[node.index()];
        traced(from, to, reached, |from, to, edge| graph.weight(from, to, edge))
    };
    if from == to {
        return Some(trace(forward));
    }
    let mut known = f64::INFINITY;
    while let (Some(first), Some(last)) = (forward.next(), backward.next()) {
        if forward.value(first) + backward.value(last) > known * (1.0 + MARGIN) {
            break;
        }
        if first == to {
            return Some(trace(forward));
        }
        if forward.open.len() <= backward.open.len() {
            let away = |next, edge| weight(first, next, edge);
            let found = |node, value| known = known.min(value + backward.value(node));
            forward.settle(graph, first, away, found);
        } else {
            let toward = |next, edge| weight(next, last, edge);
            let found = |node, value| known = known.min(value + forward.value(node));
            backward.settle(graph, last, toward, found);
        }
    }
    while let Some(node) = forward.next() {
        if node == to {
            return Some(trace(forward));
        }
        let whole = forward.value(node) + backward.value(node);
        if backward.is_final(node) && whole <= known * (1.0 + MARGIN) {
            forward.settle(graph, node, |next, edge| weight(node, next, edge), |_, _| ());
        } else {
            // On no shortest route.
            forward.is_final[node.index()] = true;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Directed;
    use crate::roadmap::EdgeCost;
    use proptest::prelude::*;

    const NODES: u32 = 24;

    /// An edge between two nodes whose weights are small integers, often zero, so that many ways are equally long.
    fn edge(is_directed: bool) -> impl Strategy<Value = Edge> {
        (0..NODES, 0..NODES, 0..4u8, 0..4u8).prop_filter_map(
            "two nodes",
            move |(a, b, there, back)| {
                let (low, high) = (NodeId(a.min(b)), NodeId(a.max(b)));
                let [forward, backward] = [there, back].map(f64::from);
                let cost = match is_directed {
                    true => EdgeCost::Directed(Directed { forward, backward, peak: 0.0 }),
                    // Not all of them are exact, so that sums depend on their order.
                    false => EdgeCost::Metric(forward * 0.1),
                };
                (a != b).then_some(Edge { low, high, planner: 0, cost })
            },
        )
    }

    fn edges(is_directed: bool, most: usize) -> impl Strategy<Value = Vec<Edge>> {
        proptest::collection::vec(edge(is_directed), 0..most)
    }

    fn graphs() -> impl Strategy<Value = (Vec<Edge>, Vec<Edge>)> {
        any::<bool>().prop_flat_map(|directed| (edges(directed, 80), edges(directed, 8)))
    }

    proptest! {
        #[test]
        fn the_route_is_that_of_a_search_from_one_end(
            (own, more) in graphs(),
            queries in proptest::collection::vec((0..NODES, 0..NODES), 1..8),
            without in proptest::collection::btree_set(0..88u32, 0..12),
        ) {
            let whole: Vec<Edge> = own.iter().chain(&more).copied().collect();
            let one_sided = Graph::new(NODES as usize, &whole);
            let graph = Graph::new(NODES as usize, &own);
            let graph = Extended::new(&graph, &more);
            // The same buffers for all, so that what one search leaves behind could mislead the next.
            let mut buffers = Buffers::new(NODES as usize);
            for (from, to) in queries {
                let ends = (NodeId(from), NodeId(to));
                let expected = one_sided.shortest(ends.0, ends.1, &without);
                prop_assert_eq!(shortest(&graph, ends, &without, &mut buffers), expected);
            }
        }
    }
}
