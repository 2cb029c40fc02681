//! Shortest routes through a roadmap.

use super::Edge;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// A graph prepared for searching: the neighbours of each node, in the order of the edges.
#[derive(Debug)]
pub struct Graph {
    /// Per node the index of its first arc, and at the end the number of arcs.
    start: Vec<u32>,
    /// Node by node, the neighbours and the edges that lead to them.
    arcs: Vec<(u32, u32)>,
    /// Per edge its weight.
    weights: Vec<f64>,
}

/// A route: nodes and the edges between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// The nodes, from one end to the other.
    pub nodes: Vec<u32>,
    /// Index of the edge that leads to each node but the first.
    pub edges: Vec<u32>,
    /// Sum of the edges' weights.
    pub length: f64,
}

impl Graph {
    /// The undirected graph of `nodes` nodes with these edges.
    pub fn new(nodes: usize, edges: &[Edge]) -> Graph {
        let mut start = vec![0u32; nodes + 1];
        for edge in edges {
            start[edge.low as usize + 1] += 1;
            start[edge.high as usize + 1] += 1;
        }
        for node in 0..nodes {
            start[node + 1] += start[node];
        }
        let mut next = start.clone();
        let mut arcs = vec![(0, 0); 2 * edges.len()];
        for (index, edge) in edges.iter().enumerate() {
            for (from, to) in [(edge.low, edge.high), (edge.high, edge.low)] {
                arcs[next[from as usize] as usize] = (to, index as u32);
                next[from as usize] += 1;
            }
        }
        Graph { start, arcs, weights: edges.iter().map(|edge| edge.weight).collect() }
    }

    /// A shortest route from `from` to `to` that avoids the edges in `without`; of several, the
    /// one that Dijkstra's algorithm finds when ties go to the lower node id.
    pub fn shortest(&self, from: u32, to: u32, without: &BTreeSet<u32>) -> Option<Route> {
        let mut best: Vec<Option<(f64, u32, u32)>> = vec![None; self.start.len() - 1];
        let mut settled = vec![false; best.len()];
        let mut open = BinaryHeap::new();
        // Lengths are not negative, so that their bits, as integers, are in the same order.
        open.push(Reverse((0f64.to_bits(), from)));
        best[from as usize] = Some((0.0, from, u32::MAX));
        while let Some(Reverse((bits, node))) = open.pop() {
            if std::mem::replace(&mut settled[node as usize], true) {
                continue;
            }
            if node == to {
                return Some(self.trace(from, to, &best));
            }
            let length = f64::from_bits(bits);
            let range = self.start[node as usize] as usize..self.start[node as usize + 1] as usize;
            for (next, edge) in &self.arcs[range] {
                if without.contains(edge) {
                    continue;
                }
                let through = length + self.weights[*edge as usize];
                if best[*next as usize].is_none_or(|(known, _, _)| through < known) {
                    best[*next as usize] = Some((through, node, *edge));
                    open.push(Reverse((through.to_bits(), *next)));
                }
            }
        }
        None
    }

    fn trace(&self, from: u32, to: u32, best: &[Option<(f64, u32, u32)>]) -> Route {
        let length = best[to as usize].map_or(0.0, |(length, _, _)| length);
        let (mut nodes, mut edges, mut node) = (vec![to], Vec::new(), to);
        while node != from {
            let Some((_, before, edge)) = best[node as usize] else { unreachable!("settled") };
            nodes.push(before);
            edges.push(edge);
            node = before;
        }
        nodes.reverse();
        edges.reverse();
        Route { nodes, edges, length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(low: u32, high: u32, weight: f64) -> Edge {
        Edge { low, high, planner: 0, weight }
    }

    #[test]
    fn the_shortest_route_is_found_and_dropped_edges_avoided() {
        let edges = [edge(0, 1, 1.0), edge(1, 3, 1.0), edge(0, 2, 0.5), edge(2, 3, 2.0)];
        let graph = Graph::new(5, &edges);
        let mut without = BTreeSet::new();
        let route = graph.shortest(0, 3, &without).unwrap();
        assert_eq!((route.nodes, route.edges, route.length), (vec![0, 1, 3], vec![0, 1], 2.0));
        without.insert(1);
        assert_eq!(graph.shortest(0, 3, &without).unwrap().nodes, [0, 2, 3]);
        without.insert(3);
        assert_eq!(graph.shortest(0, 3, &without), None);
        assert_eq!(graph.shortest(0, 4, &BTreeSet::new()), None);
        assert_eq!(graph.shortest(4, 4, &BTreeSet::new()).unwrap().nodes, [4]);
    }
}
