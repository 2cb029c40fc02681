use crate::context::Context;
use crate::local::Planner;
use crate::numbers::NodeId;
use crate::roadmap::{Configs, Edge, Route};
use crate::space::Space;
use bincode::{Decode, Encode};

/// A path: configurations to be joined by [`Space::interpolate`](crate::space::Space::interpolate).
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Path {
    /// The configurations, from start to goal: one alone where these are the same.
    pub configs: Configs,
    /// Sum of its edges' costs in the direction of the path: of most models its length in the space's metric.
    pub length: f64,
}

impl Path {
    /// The path along a route, whose edges `edge` gives by their indices: each edge's own motion, turned around where it is walked from its
    /// higher end. Where one configuration follows itself, since an end of the query is a node, say, or a motion turns
    /// where it begins, it stands once.
    pub(crate) fn along<'a>(
        cx: &Context,
        route: &Route,
        edge: impl Fn(u32) -> Edge,
        config: impl Fn(NodeId) -> &'a [f64],
    ) -> Path {
        let mut configs = Configs::new(cx.space.len());
        let mut push = |q: &[f64]| match cx.tries_direct_motion {
            true => configs.push_if_new(q),
            false => configs.push(q),
        };
        push(config(route.nodes[0]));
        for (node, index) in route.nodes.iter().zip(&route.edges) {
            let edge = edge(*index);
            let planner = Planner::from_tag(edge.planner).expect("edges carry known planners");
            let motion = planner.motion(cx, config(edge.low), config(edge.high));
            let forwards = *node == edge.low;
            for i in 1..motion.len() {
                let index = if forwards { i } else { motion.len() - 1 - i };
                push(motion.get(index));
            }
        }
        Path { configs, length: route.length }
    }

    /// Lengths from the start to each of the configurations, along the path.
    pub fn lengths(&self, space: &Space) -> Vec<f64> {
        let mut lengths = vec![0.0];
        for i in 1..self.configs.len() {
            let step = space.distance(self.configs.get(i - 1), self.configs.get(i));
            lengths.push(lengths[i - 1] + step);
        }
        lengths
    }

    /// `count` configurations evenly along the path by length, both ends included. They are meant for display: they
    /// are not in stored form, so that a quaternion's sign does not jump from one to the next.
    ///
    /// # Panics
    /// If fewer than two are asked for.
    pub fn sampled(&self, space: &Space, count: usize) -> Configs {
        assert!(count >= 2, "both ends are included");
        let lengths = self.lengths(space);
        if lengths.len() == 1 {
            let mut sampled = Configs::new(space.len());
            (0..count).for_each(|_| sampled.push(self.configs.get(0)));
            return sampled;
        }
        let whole = lengths[lengths.len() - 1];
        let mut sampled = Configs::new(space.len());
        let mut q = vec![0.0; space.len()];
        for i in 0..count {
            let at = whole * (i as f64 / (count - 1) as f64);
            let OnPath { leg, t } = on_path(&lengths, at);
            space.interpolate(self.configs.get(leg), self.configs.get(leg + 1), t, &mut q);
            sampled.push(&q);
        }
        sampled
    }
}

/// The configurations of a path, from start to goal.
impl<'a> IntoIterator for &'a Path {
    type Item = &'a [f64];
    type IntoIter = Box<dyn Iterator<Item = &'a [f64]> + 'a>;

    fn into_iter(self) -> Self::IntoIter {
        Box::new(self.configs.iter())
    }
}

/// A point on a path.
#[derive(Clone, Copy)]
pub(super) struct OnPath {
    /// The leg that holds it: the motion from this configuration of the path to the next.
    pub leg: usize,
    /// How far along the leg it is, as a fraction.
    pub t: f64,
}

/// The point at `at`, a length from the path's start. `lengths` are those of [`Path::lengths`], of a path of at least
/// two configurations.
pub(super) fn on_path(lengths: &[f64], at: f64) -> OnPath {
    let after = lengths.partition_point(|length| *length <= at).clamp(1, lengths.len() - 1);
    let (from, to) = (lengths[after - 1], lengths[after]);
    let t = if to > from { ((at - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
    OnPath { leg: after - 1, t }
}
