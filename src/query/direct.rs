//! The direct motion between the ends of a query, which needs no roadmap.

use super::{Attachment, PATH_REFINEMENT, Path};
use crate::context::Context;
use crate::local::{self, Planner};
use crate::model::{Directed, Scratch};
use crate::numbers::NodeId;
use crate::roadmap::{Edge, EdgeCost, Route};

/// The edge from `start`, as node `id`, to `goal`, as the node after it, by the first of the attachment's planners
/// whose motion is valid [`PATH_REFINEMENT`] times finer than the problem asks for. Ends that are the same are joined
/// by a motion that stands still and costs nothing.
pub(super) fn edge(
    cx: &Context,
    [start, goal]: [&[f64]; 2],
    id: NodeId,
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Option<Edge> {
    if !cx.tries_direct_motion {
        return None;
    }
    scratch.uncounted(|scratch| {
        if start == goal {
            let at_rest = |peak| Directed { forward: 0.0, backward: 0.0, peak };
            let energy = cx.model.energy(start, scratch);
            let cost =
                energy.map_or(EdgeCost::Metric(0.0), |energy| EdgeCost::Directed(at_rest(energy)));
            return Some(Edge {
                low: id,
                high: id.next(),
                planner: Planner::StraightLine.tag(),
                cost,
            });
        }
        let nodes = [(id, start), (id.next(), goal)];
        local::edge(cx, &attachment.planners, nodes, PATH_REFINEMENT, scratch)
    })
}

/// Whether no way through any roadmap can be shorter: it is straight, and costs its length.
pub(super) fn is_shortest(edge: &Edge) -> bool {
    edge.planner == Planner::StraightLine.tag() && edge.cost.directed().is_none()
}

/// The path along the direct motion.
pub(super) fn path(cx: &Context, ends: [&[f64]; 2], edge: Edge) -> Path {
    let nodes = vec![edge.low, edge.high];
    let route = Route { nodes, edges: vec![0], length: edge.cost.forward() };
    Path::along(cx, &route, |_| edge, |node| ends[usize::from(node == edge.high)])
}
