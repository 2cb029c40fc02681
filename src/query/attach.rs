//! Attaching configurations to a roadmap.

use super::Attachment;
use crate::context::Context;
use crate::local;
use crate::model::Scratch;
use crate::neighbor::{Best, Neighbor};
use crate::numbers::NodeId;
use crate::roadmap::{Edge, Extent, Roadmap};
use std::collections::BTreeSet;

/// The edges by which `q`, as node `id`, attaches to its nearest nodes, nearest first. Each is
/// tried from the node, whose id is lower, to `q`.
pub(crate) fn attach(
    cx: &Context,
    roadmap: &Roadmap,
    q: &[f64],
    id: NodeId,
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Vec<Edge> {
    let near = roadmap.k_nearest(&cx.space, q, attachment.neighbors as usize);
    to_nodes(cx, roadmap, q, id, near.iter().map(|near| NodeId(near.id)), attachment, scratch)
}

/// The same, to all nodes that were among the nearest at the end of some round, in the order of their ids. What is
/// attached stays attached while the roadmap grows, so that no barrier rises and no flow falls.
pub(crate) fn attach_for_good(
    cx: &Context,
    roadmap: &Roadmap,
    q: &[f64],
    id: NodeId,
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Vec<Edge> {
    let near = once_nearest(cx, roadmap, q, attachment, roadmap.rounds());
    to_nodes(cx, roadmap, q, id, near.into_iter(), attachment, scratch)
}

/// The nodes that were among the nearest to `q` at the end of one of the first `rounds` of the roadmap.
pub(crate) fn once_nearest(
    cx: &Context,
    roadmap: &Roadmap,
    q: &[f64],
    attachment: &Attachment,
    rounds: &[Extent],
) -> BTreeSet<NodeId> {
    let mut best = Best::new(attachment.neighbors as usize);
    let (mut near, mut next) = (BTreeSet::new(), 0);
    for extent in rounds {
        for node in next..extent.nodes {
            let config = roadmap.configs().get(node);
            if let Some(distance) = cx.space.distance_unless_above(q, config, best.bound()) {
                best.offer(Neighbor { distance, id: node as u32 });
            }
        }
        next = extent.nodes;
        near.extend(best.clone().into_items().into_iter().map(|near| NodeId(near.id)));
    }
    near
}

fn to_nodes(
    cx: &Context,
    roadmap: &Roadmap,
    q: &[f64],
    id: NodeId,
    nodes: impl Iterator<Item = NodeId>,
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Vec<Edge> {
    let configs = roadmap.configs();
    let planners = &attachment.planners;
    let joined = nodes.filter_map(|node| {
        let ends = [(node, configs.get(node.index())), (id, q)];
        local::edge(cx, planners, ends, 1, scratch)
    });
    joined.collect()
}
