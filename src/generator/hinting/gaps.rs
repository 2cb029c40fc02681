use crate::context::Context;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::Roadmap;
use std::collections::BTreeMap;

/// A stretch of a path where the roadmap leaves it broken: from one hint to another, both of which have a valid configuration near them, of different
/// connected components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::generator) struct Gap {
    /// The first and the last hint, by their number along the path.
    pub hints: [usize; 2],
    /// The nodes of the roadmap at these hints, where there are any.
    pub nodes: [Option<NodeId>; 2],
}

impl Gap {
    /// Its hints, first and last included.
    pub fn of<'a>(&self, hints: &'a [Vec<f64>]) -> impl Iterator<Item = Vec<f64>> + use<'a> {
        hints[self.hints[0]..=self.hints[1]].iter().cloned()
    }
}

/// A hint that stands for a component of the roadmap: the node that is nearest to it, and the component's name.
#[derive(Clone, Copy)]
struct Stand {
    hint: usize,
    node: Option<NodeId>,
    component: u32,
}

/// Where a path is broken, in its order.
///
/// Either only valid hints count, each by the node of the roadmap at its place, so that a gap is a whole stretch that collides. Or
/// the nodes near colliding hints count, too, no farther away than the hints are from one another, so that a gap is what is
/// left of such a stretch. Valid hints that follow one another and of which the roadmap has none, since another set of the round makes them milestones, count as
/// joined.
pub(in crate::generator) fn broken(
    cx: &Context,
    hints: &[Vec<f64>],
    frozen: Option<&Roadmap>,
    only_valid: bool,
    scratch: &mut Scratch,
) -> Vec<Gap> {
    let mut stands: Vec<Stand> = Vec::new();
    for (hint, q) in hints.iter().enumerate() {
        let is_valid = cx.model.is_valid(q, scratch);
        if only_valid && !is_valid {
            continue;
        }
        let apart = |other: Option<&Vec<f64>>| other.map_or(0.0, |p| cx.space.distance(p, q));
        let before = hint.checked_sub(1).and_then(|before| hints.get(before));
        let near = apart(before).max(apart(hints.get(hint + 1)));
        let node = frozen.and_then(|roadmap| {
            let nearest = roadmap.k_nearest(&cx.space, q, 1).into_iter().next()?;
            (nearest.distance <= near).then_some((roadmap, NodeId(nearest.id)))
        });
        match node {
            Some((roadmap, node)) => {
                let component = roadmap.components().of_node(node).name.0;
                stands.push(Stand { hint, node: Some(node), component });
            }
            None if is_valid => {
                let before = stands.last().filter(|stand| stand.hint + 1 == hint);
                let component = match before {
                    Some(Stand { node: None, component, .. }) => *component,
                    // No node has this name.
                    _ => u32::MAX - hint as u32,
                };
                stands.push(Stand { hint, node: None, component });
            }
            None => {}
        }
    }
    between(&stands)
}

/// From each component on the way to the next, where the one is left for the last time.
fn between(stands: &[Stand]) -> Vec<Gap> {
    let mut gaps = Vec::new();
    let lasts: BTreeMap<_, usize> =
        stands.iter().enumerate().map(|(index, stand)| (stand.component, index)).collect();
    let mut at = 0;
    while at < stands.len() {
        let last = lasts.get(&stands[at].component).copied().unwrap_or(at);
        let Some(next) = stands.get(last + 1) else { break };
        let (from, to) = (stands[last], next);
        gaps.push(Gap { hints: [from.hint, to.hint], nodes: [from.node, to.node] });
        at = last + 1;
    }
    gaps
}
