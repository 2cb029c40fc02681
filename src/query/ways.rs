//! The ways between two configurations: a roadmap's edges, and those that attach the two ends to it.

use super::{Attachment, PATH_REFINEMENT, Path, attach, attach_for_good, direct};
use crate::context::Context;
use crate::local::{self, Planner};
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::{Edge, EdgeCost, Graph, Roadmap, Route};
use std::collections::BTreeSet;

/// The ids that start and goal have beside a roadmap's nodes while a path is looked for: those that follow.
pub(super) fn end_ids(roadmap: &Roadmap) -> [NodeId; 2] {
    let next = NodeId(roadmap.configs().len() as u32);
    [next, next.next()]
}

/// A roadmap with two configurations attached to it, as a graph; and which edges have passed the finer check that every
/// path passes before it is given out, at a [`PATH_REFINEMENT`]th of the resolution.
pub(crate) struct Ways<'a> {
    pub cx: &'a Context,
    roadmap: &'a Roadmap,
    ends: [&'a [f64]; 2],
    /// The edges of the roadmap, then those that attach the start and the goal, then the direct motion, if there is one.
    pub edges: Vec<Edge>,
    pub graph: Graph,
    passed: BTreeSet<u32>,
    /// Indices of the edges that have failed the finer check.
    pub failed: BTreeSet<u32>,
}

impl<'a> Ways<'a> {
    /// All ways from `start` to `goal`, both valid: through the roadmap, and the direct motion. In a model with energies
    /// the ends are attached to all nodes that were once their nearest, otherwise to those that are now.
    pub fn between(
        cx: &'a Context,
        roadmap: &'a Roadmap,
        ends: [&'a [f64]; 2],
        attachment: &Attachment,
        scratch: &mut Scratch,
    ) -> Ways<'a> {
        let [from, to] = end_ids(roadmap);
        let direct = direct::edge(cx, ends, from, attachment, scratch);
        let attach = match cx.model.energy(ends[0], scratch) {
            Some(_) => attach_for_good,
            None => attach,
        };
        let from_start = attach(cx, roadmap, ends[0], from, attachment, scratch);
        let from_goal = attach(cx, roadmap, ends[1], to, attachment, scratch);
        let edges = roadmap.edges().iter();
        Ways::of(cx, roadmap, ends, edges, [from_start, from_goal], direct)
    }

    /// The ways by edges that are known: some of the roadmap, and those that attach the start and the goal, under the
    /// ids of [`end_ids`]. The direct motion has passed the finer check.
    pub(crate) fn of(
        cx: &'a Context,
        roadmap: &'a Roadmap,
        ends: [&'a [f64]; 2],
        of_roadmap: impl Iterator<Item = Edge>,
        attached: [Vec<Edge>; 2],
        direct: Option<Edge>,
    ) -> Ways<'a> {
        let mut edges: Vec<Edge> = of_roadmap.collect();
        edges.extend(attached.into_iter().flatten());
        let passed = direct.iter().map(|_| edges.len() as u32).collect();
        edges.extend(direct);
        let graph = Graph::new(end_ids(roadmap)[1].index() + 1, &edges);
        Ways { cx, roadmap, ends, edges, graph, passed, failed: BTreeSet::new() }
    }

    /// Searches by other costs than the edges have: `cost` gives that of each by its index. All are directed, or none.
    pub(super) fn search_by(&mut self, cost: impl Fn(usize) -> EdgeCost) {
        let changed = |(index, edge): (usize, &Edge)| Edge { cost: cost(index), ..*edge };
        let edges: Vec<Edge> = self.edges.iter().enumerate().map(changed).collect();
        self.graph = Graph::new(self.graph.nodes(), &edges);
    }

    /// The ids of the start and of the goal.
    pub fn ends(&self) -> [NodeId; 2] {
        end_ids(self.roadmap)
    }

    /// The configuration of a node, or of one of the ends.
    pub fn config(&self, node: NodeId) -> &'a [f64] {
        config_in(self.roadmap, self.ends)(node)
    }

    /// Whether all edges of a route pass the finer check. The first that does not becomes one of [`Ways::failed`].
    pub fn passes(&mut self, route: &Route, scratch: &mut Scratch) -> bool {
        let (cx, roadmap, ends) = (self.cx, self.roadmap, self.ends);
        let edge = |index: u32| self.edges[index as usize];
        let failed =
            first_failed(cx, route, (edge, config_in(roadmap, ends)), &mut self.passed, scratch);
        self.failed.extend(failed);
        failed.is_none()
    }

    /// The path along a route.
    pub fn path(&self, route: &Route) -> Path {
        Path::along(self.cx, route, |index| self.edges[index as usize], |node| self.config(node))
    }
}

/// The configurations of a roadmap's nodes, and those of a start and a goal under the ids of [`end_ids`].
pub(super) fn config_in<'a>(
    roadmap: &'a Roadmap,
    ends: [&'a [f64]; 2],
) -> impl Fn(NodeId) -> &'a [f64] {
    let [from, to] = end_ids(roadmap);
    move |node| match node {
        node if node == from => ends[0],
        node if node == to => ends[1],
        node => roadmap.configs().get(node.index()),
    }
}

/// The index of the first edge of a route that fails the finer check. Edges are looked up by their indices, the configurations
/// of their ends by their nodes; those in `passed` have passed before, and what passes is added to them.
pub(super) fn first_failed<'a>(
    cx: &Context,
    route: &Route,
    (edge, config): (impl Fn(u32) -> Edge, impl Fn(NodeId) -> &'a [f64]),
    passed: &mut BTreeSet<u32>,
    scratch: &mut Scratch,
) -> Option<u32> {
    for index in &route.edges {
        if passed.contains(index) {
            continue;
        }
        let edge = edge(*index);
        let ends = (config(edge.low), config(edge.high));
        let planner = Planner::from_tag(edge.planner).into_iter().collect::<Vec<_>>();
        if local::connect(cx, &planner, ends, PATH_REFINEMENT, scratch).is_none() {
            return Some(*index);
        }
        passed.insert(*index);
    }
    None
}
