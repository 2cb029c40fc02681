//! The pathways of a roadmap to the native conformation: a tree of the cheapest routes.

use super::Native;
use crate::context::Context;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::query::{Attachment, attach_for_good, once_nearest};
use crate::roadmap::{Edge, Extent, Graph, Rank, Roadmap, Route, Tree};

/// The cheapest routes from all nodes of a roadmap, as it was at the end of one of its rounds, to the native conformation.
pub(super) struct ToNative {
    /// All edges: the roadmap's, then those that attach the native conformation.
    pub edges: Vec<Edge>,
    tree: Tree,
    /// The id that the native conformation has.
    pub native: NodeId,
    /// Per node, those whose routes lead on to it, in the order of their ids.
    before: Vec<Vec<NodeId>>,
}

impl ToNative {
    /// The routes through the roadmap as it was when it went as far as `extent`, the end of a round, given the edges that attach the
    /// native conformation now.
    fn of(
        cx: &Context,
        roadmap: &Roadmap,
        extent: Extent,
        (native, attachment): (&Native, &Attachment),
        attached: &[Edge],
    ) -> ToNative {
        let id = id_of_native(roadmap);
        let rounds = roadmap.rounds();
        let rounds = &rounds[..rounds.partition_point(|round| round.nodes <= extent.nodes)];
        let near = once_nearest(cx, roadmap, &native.q, attachment, rounds);
        let mut edges: Vec<Edge> = roadmap.edges().iter().take(extent.edges).collect();
        edges.extend(attached.iter().filter(|edge| near.contains(&edge.low)));
        ToNative::by(edges, id)
    }

    /// The cheapest routes to node `native`, which has the highest id, by these edges.
    pub fn by(edges: Vec<Edge>, native: NodeId) -> ToNative {
        let graph = Graph::new(native.index() + 1, &edges);
        let tree = graph.tree(native, true, Rank::Cost, |_, weight| Some(weight));
        let mut before = vec![Vec::new(); native.index() + 1];
        for node in (0..native.0).map(NodeId) {
            if let Some((next, _)) = tree.next(node) {
                before[next.index()].push(node);
            }
        }
        ToNative { edges, tree, native, before }
    }

    /// The routes at the ends of several rounds. Edges that attach the native conformation are found once for all.
    pub fn at<const N: usize>(
        cx: &Context,
        roadmap: &Roadmap,
        extents: [Extent; N],
        of: (&Native, &Attachment),
        scratch: &mut Scratch,
    ) -> [ToNative; N] {
        let (native, attachment) = of;
        let id = id_of_native(roadmap);
        let attached = attach_for_good(cx, roadmap, &native.q, id, attachment, scratch);
        extents.map(|extent| ToNative::of(cx, roadmap, extent, of, &attached))
    }

    /// The nodes whose routes lead on to `node`.
    pub fn before(&self, node: NodeId) -> &[NodeId] {
        &self.before[node.index()]
    }

    /// The next node on the route from a node, and the edge that leads there.
    pub fn next(&self, node: NodeId) -> Option<(NodeId, &Edge)> {
        let (next, edge) = self.tree.next(node)?;
        Some((next, &self.edges[edge as usize]))
    }

    /// The route from a node to the native conformation.
    pub fn route(&self, node: NodeId) -> Option<Route> {
        self.tree.route(node)
    }

    /// What the route from a node costs.
    pub fn cost(&self, node: NodeId) -> Option<f64> {
        self.tree.value(node).map(|value| value.cost)
    }
}

/// The native conformation has the id that follows those of the roadmap's nodes.
fn id_of_native(roadmap: &Roadmap) -> NodeId {
    NodeId(roadmap.configs().len() as u32)
}
