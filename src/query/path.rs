use crate::context::Context;
use crate::local::Planner;
use crate::roadmap::{Configs, Edge, Route};
use bincode::{Decode, Encode};

/// A path: configurations to be joined by [`Space::interpolate`](crate::space::Space::interpolate).
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Path {
    /// The configurations, from start to goal.
    pub configs: Configs,
    /// Length in the space's metric.
    pub length: f64,
}

impl Path {
    /// The path along a route: each edge's own motion, turned around where it is walked from its
    /// higher end.
    pub(super) fn along<'a>(
        cx: &Context,
        route: &Route,
        edges: &[Edge],
        config: impl Fn(u32) -> &'a [f64],
    ) -> Path {
        let mut configs = Configs::new(cx.space.len());
        configs.push(config(route.nodes[0]));
        for (node, edge) in route.nodes.iter().zip(&route.edges) {
            let edge = &edges[*edge as usize];
            let planner = Planner::from_tag(edge.planner).expect("edges carry known planners");
            let motion = planner.motion(cx, config(edge.low), config(edge.high));
            let forwards = *node == edge.low;
            for i in 1..motion.len() {
                let index = if forwards { i } else { motion.len() - 1 - i };
                configs.push(motion.get(index));
            }
        }
        Path { configs, length: route.length }
    }
}
