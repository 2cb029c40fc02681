//! The shortest route of each class of routes in the plane.

use super::topology::{Crossing, Punctures, Word, append};
use crate::cancel::Cancel;
use crate::local::Planner;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::query::Ways;
use crate::roadmap::Route;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// A node, as it is reached by routes with one word of crossings.
struct State {
    node: NodeId,
    /// Number of the word.
    word: usize,
    /// Sum of the edges' weights on the best route there.
    length: f64,
    /// The state before it on that route, and the edge from there; none at the beginning.
    before: Option<(usize, u32)>,
}

/// Words, numbered in the order in which they first came.
#[derive(Default)]
struct Words {
    words: Vec<Word>,
    numbers: BTreeMap<Word, usize>,
}

impl Words {
    fn number(&mut self, word: Word) -> usize {
        let next = self.words.len();
        let number = *self.numbers.entry(word.clone()).or_insert(next);
        if number == next {
            self.words.push(word);
        }
        number
    }
}

/// The crossings on each edge from its lower to its higher node.
pub(super) struct EdgeCrossings(Vec<Vec<Crossing>>);

impl EdgeCrossings {
    /// Those of all edges; `point` is where the reference point is at a configuration.
    pub fn of(
        ways: &Ways,
        punctures: &Punctures,
        point: impl Fn(&[f64]) -> [f64; 2],
    ) -> EdgeCrossings {
        let of_edge = |edge: &crate::roadmap::Edge| {
            let planner = Planner::from_tag(edge.planner).expect("edges carry known planners");
            let (low, high) = (ways.config(edge.low), ways.config(edge.high));
            punctures.word(planner.motion(ways.cx, low, high).iter().map(&point))
        };
        EdgeCrossings(ways.edges.iter().map(of_edge).collect())
    }

    fn after(&self, word: &Word, edge: u32, forwards: bool) -> Word {
        let (mut word, crossings) = (word.clone(), &self.0[edge as usize]);
        match forwards {
            true => append(&mut word, crossings.iter().copied()),
            false => append(&mut word, crossings.iter().rev().map(|crossing| crossing.reversed())),
        }
        word
    }
}

/// What [`shortest_of_classes`] finds.
pub(super) struct Shortest {
    /// The routes, all of whose edges pass the finer check, in order of length.
    pub routes: Vec<Route>,
    /// Whether the next route has an edge that fails it, which is one of [`Ways::failed`] now.
    pub has_failed: bool,
}

/// The shortest route of each of the `count` classes whose shortest routes are the shortest; fewer where there are no more, where
/// one fails the finer check, or where `cancel` ends the search. Edges that have failed the finer check are left out.
///
/// It is Dijkstra's algorithm over pairs of a node and a word of crossings (S. Bhattacharya, M. Likhachev, V. Kumar 2012, who search such
/// a graph with A*). At every node no more than the `count` words whose routes are the shortest are followed. That loses nothing: two routes
/// to a node with different words, continued alike, end with different words, so whatever continues a later one has
/// `count` classes before it. Equal lengths go to the lower node, then to what came first.
pub(super) fn shortest_of_classes(
    ways: &mut Ways,
    crossings: &EdgeCrossings,
    count: usize,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Shortest {
    let [from, to] = ways.ends();
    let mut words = Words::default();
    let mut states =
        vec![State { node: from, word: words.number(Word::new()), length: 0.0, before: None }];
    let mut open = BinaryHeap::from([Reverse((0u64, from, 0usize))]);
    let mut settled: BTreeSet<(NodeId, usize)> = BTreeSet::new();
    let mut at_node = vec![0usize; to.index() + 1];
    let mut routes = Vec::new();
    while let Some(Reverse((_, node, index))) = open.pop().filter(|_| !cancel.is_cancelled()) {
        let State { word, length, .. } = states[index];
        if at_node[node.index()] == count || !settled.insert((node, word)) {
            continue;
        }
        at_node[node.index()] += 1;
        if node == to {
            let route = route(&states, index);
            if !ways.passes(&route, scratch) {
                return Shortest { routes, has_failed: true };
            }
            routes.push(route);
            continue;
        }
        for (next, edge) in ways.graph.arcs_from(node) {
            if at_node[next.index()] == count || ways.failed.contains(&edge) {
                continue;
            }
            let word = words.number(crossings.after(&words.words[word], edge, node < next));
            if settled.contains(&(next, word)) {
                continue;
            }
            let length = length + ways.graph.weight(node, next, edge);
            // Lengths are not negative, so their bits order as they do.
            open.push(Reverse((length.to_bits(), next, states.len())));
            states.push(State { node: next, word, length, before: Some((index, edge)) });
        }
    }
    Shortest { routes, has_failed: false }
}

fn route(states: &[State], last: usize) -> Route {
    let (mut nodes, mut edges, mut at) = (vec![states[last].node], Vec::new(), last);
    while let Some((before, edge)) = states[at].before {
        nodes.push(states[before].node);
        edges.push(edge);
        at = before;
    }
    nodes.reverse();
    edges.reverse();
    Route { nodes, edges, length: states[last].length }
}
