//! Maximum flow, and the cut that bounds it.

use crate::numbers::NodeId;
use petgraph::algo::dinics;
use petgraph::graph::{DiGraph, NodeIndex};
use petgraph::visit::EdgeRef;

/// A capacity larger than any flow.
const UNBOUNDED: u64 = u64::MAX / 4;

/// A directed network with capacities in whole numbers.
pub(super) struct Network {
    graph: DiGraph<(), u64>,
}

impl Network {
    /// A network of that many nodes without arcs.
    pub fn new(nodes: usize, arcs: usize) -> Network {
        let mut graph = DiGraph::with_capacity(nodes + 2, arcs);
        (0..nodes + 2).for_each(|_| _ = graph.add_node(()));
        Network { graph }
    }

    /// Adds an arc.
    pub fn add(&mut self, from: NodeId, to: NodeId, capacity: u64) {
        self.graph.add_edge(NodeIndex::from(from.0), NodeIndex::from(to.0), capacity);
    }

    /// The value of a maximum flow from all of `sources` to all of `sinks`, and for each node whether it is on the
    /// sources' side of the minimum cut nearest to the sources: the nodes reachable from them in the residual network,
    /// which are the same for every maximum flow.
    pub fn flow(mut self, sources: &[NodeId], sinks: &[NodeId]) -> (u64, Vec<bool>) {
        let nodes = self.graph.node_count() - 2;
        let source = NodeId(nodes as u32);
        let sink = source.next();
        sources.iter().for_each(|from| self.add(source, *from, UNBOUNDED));
        sinks.iter().for_each(|to| self.add(*to, sink, UNBOUNDED));
        let (value, flows) =
            dinics(&self.graph, NodeIndex::from(source.0), NodeIndex::from(sink.0));

        let mut reached = vec![false; self.graph.node_count()];
        reached[source.index()] = true;
        let mut open = vec![NodeIndex::from(source.0)];
        while let Some(node) = open.pop() {
            let onward =
                self.graph.edges(node).filter(|arc| flows[arc.id().index()] < *arc.weight());
            let back = self.graph.edges_directed(node, petgraph::Incoming);
            let back = back.filter(|arc| flows[arc.id().index()] > 0).map(|arc| arc.source());
            for next in onward.map(|arc| arc.target()).chain(back) {
                if !std::mem::replace(&mut reached[next.index()], true) {
                    open.push(next);
                }
            }
        }
        reached.truncate(nodes);
        (value, reached)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const NODES: u32 = 7;

    /// The capacity of the cut between one side of the nodes and the others.
    fn capacity(arcs: &[(u32, u32, u64)], side: impl Fn(u32) -> bool) -> u64 {
        let severed = arcs.iter().filter(|(from, to, _)| side(*from) && !side(*to));
        severed.map(|(_, _, capacity)| capacity).sum()
    }

    proptest! {
        #[test]
        fn the_flow_is_the_least_of_all_cuts(
            arcs in proptest::collection::vec((0..NODES, 0..NODES, 0u64..20), 0..30),
            sources in 1u32..8, sinks in 1u32..8,
        ) {
            let mut network = Network::new(NODES as usize, arcs.len());
            arcs.iter().for_each(|(from, to, capacity)| network.add(NodeId(*from), NodeId(*to), *capacity));
            // Of the first three nodes and of the last three.
            let chosen = |from: u32, bits: u32| -> Vec<NodeId> {
                (0..3).filter(|i| bits >> i & 1 == 1).map(|i| NodeId(from + i)).collect()
            };
            let (sources, sinks) = (chosen(0, sources), chosen(4, sinks));
            let (flow, side) = network.flow(&sources, &sinks);

            let has = |set: u32, node: u32| set >> node & 1 == 1;
            let cuts = (0..1u32 << NODES).filter(|set| {
                sources.iter().all(|node| has(*set, node.0))
                    && !sinks.iter().any(|node| has(*set, node.0))
            });
            let cuts: Vec<(u64, u32)> =
                cuts.map(|set| (capacity(&arcs, |node| has(set, node)), set)).collect();
            let least = cuts.iter().map(|(capacity, _)| *capacity).min();
            prop_assert_eq!(Some(flow), least);
            prop_assert_eq!(capacity(&arcs, |node| side[node as usize]), flow);
            // Nearest to the sources: what all least cuts have in common.
            let common = cuts.iter().filter(|cut| cut.0 == flow).fold(u32::MAX, |all, cut| all & cut.1);
            for node in 0..NODES {
                prop_assert_eq!(side[node as usize], has(common, node));
            }
        }
    }
}
