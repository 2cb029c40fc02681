//! What the evaluators of flows share: a roadmap with sources and sinks attached to it, as a network.

use super::network::Network;
use super::verdict::CutEdge;
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::query::{Attachment, attach, attach_for_good};
use crate::roadmap::{Edge, Graph, Roadmap};

/// The largest capacity as a whole number.
const SCALE: f64 = (1u64 << 32) as f64;

/// A roadmap's edges, and those that attach sources and sinks to it. The ids of the sources follow those of the roadmap's
/// nodes, then come those of the sinks. In a model with energies they are attached to all nodes that were once their
/// nearest, otherwise to those that are now.
pub(super) struct Attached {
    /// The number of nodes, the sources and the sinks included.
    nodes: usize,
    /// The edges.
    pub edges: Vec<Edge>,
    /// The sources.
    pub sources: Vec<NodeId>,
    /// The sinks.
    pub sinks: Vec<NodeId>,
}

/// A maximum flow, in the unit of capacities, with the minimum cut nearest to where it comes from.
pub(super) struct Flow {
    /// The value in whole numbers, see [`Capacities`].
    pub whole: u64,
    /// The value.
    pub value: f64,
    /// The edges of the cut.
    pub cut: Vec<CutEdge>,
}

/// Capacities 1/w, weights below `least` raised to it, rounded to whole multiples of 2⁻³² of the largest one, 1/`least`.
#[derive(Clone, Copy)]
pub(super) struct Capacities {
    /// The least weight that an edge counts with.
    pub least: f64,
}

impl Capacities {
    /// The capacity of an edge of this weight, as a whole number.
    pub fn whole(self, weight: f64) -> u64 {
        (self.least / weight.max(self.least) * SCALE).round() as u64
    }

    /// A capacity in the unit of 1/weight.
    pub fn real(self, whole: u64) -> f64 {
        whole as f64 / SCALE / self.least
    }
}

/// What is wrong with the least weight that edges count with, where one is given.
pub(super) fn complaint_of_least_weight(least: Option<f64>) -> Option<Complaint> {
    let least = least.filter(|least| !(1e-30..=1e30).contains(least))?;
    Some(Complaint::new("least_weight", least, "1e-30 to 1e30"))
}

impl Attached {
    /// Attaches the start of the problem's query as the source and its goal as the sink.
    pub fn of_query(
        cx: &Context,
        roadmap: &Roadmap,
        attachment: &Attachment,
        scratch: &mut Scratch,
    ) -> Attached {
        let query = cx.query.as_ref().expect("a checked problem has the query");
        let ends = [&query.start, &query.goal].map(std::slice::from_ref);
        Attached::of(cx, roadmap, ends, attachment, scratch)
    }

    /// Attaches sources and sinks.
    pub fn of(
        cx: &Context,
        roadmap: &Roadmap,
        [from, to]: [&[Vec<f64>]; 2],
        attachment: &Attachment,
        scratch: &mut Scratch,
    ) -> Attached {
        let nodes = roadmap.configs().len();
        let mut edges: Vec<Edge> = roadmap.edges().iter().collect();
        let attach = if edges.iter().any(|edge| edge.cost.directed().is_some()) {
            attach_for_good
        } else {
            attach
        };
        for (index, q) in from.iter().chain(to).enumerate() {
            let id = NodeId((nodes + index) as u32);
            edges.extend(attach(cx, roadmap, q, id, attachment, scratch));
        }
        let ids = |first: usize, count: usize| {
            (first..first + count).map(|id| NodeId(id as u32)).collect::<Vec<_>>()
        };
        let sources = ids(nodes, from.len());
        let sinks = ids(nodes + from.len(), to.len());
        Attached { nodes: nodes + from.len() + to.len(), edges, sources, sinks }
    }

    /// The edges as a graph.
    pub fn graph(&self) -> Graph {
        Graph::new(self.nodes, &self.edges)
    }

    /// The maximum flow from the sources to the sinks, or with `back` from the sinks to the sources, each edge carrying in
    /// either direction what its cost in that direction allows.
    pub fn flow(&self, capacities: Capacities, back: bool) -> Flow {
        let mut network = Network::new(self.nodes, 2 * self.edges.len());
        for edge in &self.edges {
            network.add(edge.low, edge.high, capacities.whole(edge.cost.forward()));
            network.add(edge.high, edge.low, capacities.whole(edge.cost.backward()));
        }
        let (from, to) =
            if back { (&self.sinks, &self.sources) } else { (&self.sources, &self.sinks) };
        let (whole, near) = network.flow(from, to);

        let severed = |from, to, weight| {
            let capacity = capacities.real(capacities.whole(weight));
            CutEdge { from, to, capacity }
        };
        let mut cut = Vec::new();
        for edge in &self.edges {
            let (there, back) = (edge.cost.forward(), edge.cost.backward());
            cut.extend(match [edge.low, edge.high].map(|node| near[node.index()]) {
                [true, false] => Some(severed(edge.low, edge.high, there)),
                [false, true] => Some(severed(edge.high, edge.low, back)),
                _ => None,
            });
        }
        Flow { whole, value: capacities.real(whole), cut }
    }

    /// How many ways from the sources to the sinks there are, no two of which have an edge in common, among the edges that
    /// are allowed (K. Menger, 1927: the maximum flow where every edge carries 1).
    pub fn disjoint(&self, is_allowed: impl Fn(&Edge) -> bool) -> u64 {
        let mut network = Network::new(self.nodes, 2 * self.edges.len());
        for edge in self.edges.iter().filter(|edge| is_allowed(edge)) {
            network.add(edge.low, edge.high, 1);
            network.add(edge.high, edge.low, 1);
        }
        network.flow(&self.sources, &self.sinks).0
    }
}
