use crate::cancel::Cancel;
use crate::context::Context;
use crate::local::{self, Planner};
use crate::model::{Model, SceneChange, Scratch};
use crate::neighbor::k_nearest_graph;
use crate::numbers::NodeId;
use crate::roadmap::{Configs, Edge};

/// The edges that a scene has since obstacles went: each of the nodes `configs` is tried with its `neighbors` nearest once
/// more, where the two have no edge among `edges` and a box around the robot along the motion meets what went. Pairs are
/// tried in ascending order, each from its lower id to its higher, by `planners` in their order until one succeeds.
///
/// Elsewhere nothing is tried: the robot's way is what it was. Where more than obstacles has changed, every such pair
/// is tried.
pub fn retried(
    cx: &Context,
    change: &SceneChange,
    (configs, edges): (&Configs, &[Edge]),
    neighbors: u32,
    planners: &[Planner],
    scratch: &mut Scratch,
) -> Vec<Edge> {
    retried_until(cx, change, (configs, edges), (neighbors, planners), &Cancel::new(), scratch)
}

/// [`retried`], of which the rest is left out once `cancel` says so.
pub(crate) fn retried_until(
    cx: &Context,
    change: &SceneChange,
    (configs, edges): (&Configs, &[Edge]),
    (neighbors, planners): (u32, &[Planner]),
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Vec<Edge> {
    let everywhere = change.beyond_obstacles.is_some();
    if change.removed.is_empty() && !everywhere {
        return Vec::new();
    }
    let among_removed = if everywhere { None } else { cx.model.among(&change.removed) };
    let mut joined: Vec<(u32, u32)> = edges.iter().map(|edge| (edge.low.0, edge.high.0)).collect();
    joined.sort_unstable();
    let pairs = k_nearest_graph(&cx.space, configs, neighbors as usize).into_iter();
    let new = pairs.filter(|pair| joined.binary_search(pair).is_err());
    let edge = |(low, high): (u32, u32)| {
        let ends = (configs.get(low as usize), configs.get(high as usize));
        let (planner, cost) = planners.iter().find_map(|planner| {
            let may_be_new = among_removed
                .as_deref()
                .is_none_or(|removed| meets(cx, removed, *planner, ends, scratch));
            may_be_new.then(|| local::connect(cx, &[*planner], ends, 1, scratch))?
        })?;
        let (low, high) = (NodeId(low), NodeId(high));
        Some(Edge { low, high, planner: planner.tag(), cost })
    };
    new.take_while(|_| !cancel.is_cancelled()).filter_map(edge).collect()
}

/// Whether an obstacle of `among` may have been in the way of a planner's motion.
fn meets(
    cx: &Context,
    among: &dyn Model,
    planner: Planner,
    (a, b): (&[f64], &[f64]),
    scratch: &mut Scratch,
) -> bool {
    if planner == Planner::StraightLine {
        return among.may_meet(a, b, scratch);
    }
    let motion = planner.motion(cx, a, b);
    (1..motion.len()).any(|i| among.may_meet(motion.get(i - 1), motion.get(i), scratch))
}
