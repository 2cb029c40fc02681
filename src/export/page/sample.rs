//! Which nodes and edges of a roadmap a page holds.

use crate::numbers::NodeId;
use crate::roadmap::{Forest, Roadmap};
use std::collections::{BTreeMap, BTreeSet};

/// The most edges of a page.
pub(super) const EDGES_MAX: usize = 100_000;
/// The most nodes of a page, where their numbers have room for so many.
pub(super) const NODES_MAX: usize = 50_000;
/// The most rounds at which a page can stop.
pub(super) const STOPS_MAX: usize = 1000;

/// A part of a roadmap, small enough for a page.
pub(super) struct Sample {
    /// The nodes, ascending.
    pub nodes: Vec<NodeId>,
    /// The edges, in the roadmap's order: the two ends as positions in `nodes`.
    pub edges: Vec<[u32; 2]>,
    /// Whether all nodes are there. Then the edges connect what the roadmap connects, at the end of every round.
    pub is_whole: bool,
    /// Rounds, ascending, the last among them: of all, or evenly of more than [`STOPS_MAX`].
    pub stops: Vec<Stop>,
}

/// How far a roadmap, and the sample of it, goes at the end of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stop {
    /// The number of rounds until then.
    pub rounds: usize,
    /// Number of sets.
    pub sets: u64,
    /// Number of nodes of the roadmap.
    pub nodes: usize,
    /// Number of edges of the roadmap.
    pub edges: usize,
    /// Number of connected components of the roadmap.
    pub components: usize,
    /// Number of nodes of the sample.
    pub shown_nodes: usize,
    /// Number of edges of the sample.
    pub shown_edges: usize,
}

impl Sample {
    /// The part of a roadmap with at most `nodes_max` nodes and `edges_max` edges.
    ///
    /// If there is room for all nodes, all are taken, the edges that first joined two components, and others evenly. If not,
    /// edges are taken evenly, their ends, and further nodes evenly.
    pub fn of(roadmap: &Roadmap, nodes_max: usize, edges_max: usize) -> Sample {
        let count = roadmap.configs().len();
        let (joining, stops) = growth(roadmap);
        let is_whole = count <= nodes_max;
        let (nodes, chosen): (Vec<NodeId>, Vec<usize>) = if is_whole {
            let chosen = with_joining(&joining, edges_max.max(count));
            (roadmap.nodes().collect(), chosen)
        } else {
            let chosen = evenly(joining.len(), edges_max.min(nodes_max / 2));
            let edges = chosen.iter().map(|index| roadmap.edges().get(*index));
            let mut nodes: BTreeSet<NodeId> =
                edges.flat_map(|edge| [edge.low, edge.high]).collect();
            let others = evenly(count, nodes_max - nodes.len());
            nodes.extend(others.into_iter().map(|index| NodeId(index as u32)));
            (nodes.into_iter().collect(), chosen)
        };
        let place: BTreeMap<NodeId, u32> =
            nodes.iter().enumerate().map(|(place, node)| (*node, place as u32)).collect();
        let ends = |index: &usize| {
            let edge = roadmap.edges().get(*index);
            [edge.low, edge.high].map(|node| place[&node])
        };
        let edges = chosen.iter().map(ends).collect();
        let shown = |stop: Stop| Stop {
            shown_nodes: nodes.partition_point(|node| node.index() < stop.nodes),
            shown_edges: chosen.partition_point(|index| *index < stop.edges),
            ..stop
        };
        let stops = stops.into_iter().map(shown).collect();
        Sample { nodes, edges, is_whole, stops }
    }
}

/// For every edge whether it joined two components, and the ends of rounds at which a page can stop.
fn growth(roadmap: &Roadmap) -> (Vec<bool>, Vec<Stop>) {
    let rounds = roadmap.rounds();
    let mut forest = Forest::default();
    forest.grow(roadmap.configs().len() as u32);
    let (mut joining, mut joined) = (Vec::with_capacity(roadmap.edges().len()), 0);
    let mut edges = roadmap.edges().iter();
    let mut stops = Vec::new();
    for index in evenly(rounds.len(), STOPS_MAX) {
        let round = rounds[index];
        for edge in edges.by_ref().take(round.edges - joining.len()) {
            let [low, high] = forest.unite(edge.low, edge.high);
            joining.push(low != high);
            joined += usize::from(low != high);
        }
        stops.push(Stop {
            rounds: index + 1,
            sets: round.sets,
            nodes: round.nodes,
            edges: round.edges,
            components: round.nodes - joined,
            shown_nodes: 0,
            shown_edges: 0,
        });
    }
    (joining, stops)
}

/// The edges that joined components, and of the others as many, evenly, as there is room for; ascending.
fn with_joining(joining: &[bool], edges_max: usize) -> Vec<usize> {
    let (mut chosen, others): (Vec<usize>, Vec<usize>) =
        (0..joining.len()).partition(|index| joining[*index]);
    let room = edges_max.saturating_sub(chosen.len());
    chosen.extend(evenly(others.len(), room).into_iter().map(|place| others[place]));
    chosen.sort_unstable();
    chosen
}

/// All numbers below `count`, or `most` of them, evenly, the last among them; ascending.
fn evenly(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (1..=most).map(|i| (i as u128 * count as u128 / most as u128) as usize - 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::img::{Setup, build};
    use crate::problem::Problem;
    use std::path::Path;
    use std::sync::Arc;

    fn maze() -> Roadmap {
        let text = include_str!("../../../problems/maze.toml");
        let problem = Problem::parse(Path::new("maze.toml"), text).expect("it is sound");
        build(&Arc::new(Setup::new(problem))).roadmap
    }

    #[test]
    fn numbers_are_taken_evenly_with_the_last() {
        assert_eq!(evenly(3, 5), [0, 1, 2]);
        assert_eq!(evenly(10, 5), [1, 3, 5, 7, 9]);
        assert_eq!((evenly(7, 1), evenly(7, 0), evenly(0, 4)), (vec![6], vec![], vec![]));
    }

    /// A sample of all nodes connects at every stop what the roadmap connects, with however few edges.
    #[test]
    fn a_thinned_roadmap_is_connected_as_the_whole_one() {
        let roadmap = maze();
        for edges_max in [0, roadmap.configs().len() + 10, usize::MAX] {
            let sample = Sample::of(&roadmap, NODES_MAX, edges_max);
            assert!(sample.is_whole && sample.nodes.len() == roadmap.configs().len());
            assert!(sample.edges.len() <= edges_max.max(roadmap.configs().len()));
            assert_eq!(sample.stops.len(), roadmap.rounds().len());
            for stop in &sample.stops {
                let mut forest = Forest::default();
                forest.grow(stop.shown_nodes as u32);
                let joined = sample.edges[..stop.shown_edges].iter().filter(|[a, b]| {
                    let [low, high] = forest.unite(NodeId(*a), NodeId(*b));
                    low != high
                });
                assert_eq!(stop.shown_nodes - joined.count(), stop.components);
            }
            let last = sample.stops.last().expect("there are rounds");
            assert_eq!(last.components, roadmap.components().count());
            assert_eq!((last.nodes, last.edges), (roadmap.configs().len(), roadmap.edges().len()));
        }
    }

    #[test]
    fn a_sample_of_some_nodes_has_edges_of_the_roadmap_between_them() {
        let roadmap = maze();
        let sample = Sample::of(&roadmap, 60, 1000);
        assert!(!sample.is_whole && sample.nodes.len() <= 60 && sample.edges.len() == 30);
        let all: BTreeSet<[NodeId; 2]> =
            roadmap.edges().iter().map(|edge| [edge.low, edge.high]).collect();
        for ends in &sample.edges {
            assert!(all.contains(&ends.map(|place| sample.nodes[place as usize])));
        }
        let last = sample.stops.last().expect("there are rounds");
        assert_eq!((last.shown_nodes, last.shown_edges), (sample.nodes.len(), 30));
    }
}
