//! Candidates for alternative routes: over each node by the best route to it and the best route from it.

use super::k_best::value;
use crate::cancel::Cancel;
use crate::numbers::NodeId;
use crate::query::Ways;
use crate::roadmap::{Rank, Route};
use std::collections::BTreeSet;

/// A route that shares more than this part of its length with one before is passed over. I. Abraham, D. Delling,
/// A. V. Goldberg & R. F. Werneck, *Alternative routes in road networks*, ACM J. Exp. Algorithmics 18 (2013), §2, take
/// the same for the part shared with the best route.
const SHARED_MAX: f64 = 0.8;

/// Routes over one node each (*single via paths*, Abraham et al. 2013, §4): for every node v the best route from the start to
/// v, followed by the best one from v to the goal, from two runs of Dijkstra's algorithm; the best first, ties by v.
///
/// A route that visits a node twice is passed over. Cut there, the route would be that over the other node: the part before
/// is the best route to it, the part behind the best one from it. So nothing is lost.
pub(super) struct ViaNodes {
    candidates: Vec<([u64; 2], NodeId)>,
    trees: [crate::roadmap::Tree; 2],
    next: usize,
}

impl ViaNodes {
    /// The candidates, without edges that have failed the finer check so far.
    pub fn of(ways: &Ways, rank: Rank) -> ViaNodes {
        let [from, to] = ways.ends();
        let weigh = |edge: u32, weight: f64| (!ways.failed.contains(&edge)).then_some(weight);
        let trees =
            [ways.graph.tree(from, false, rank, weigh), ways.graph.tree(to, true, rank, weigh)];
        let over = |node: NodeId| {
            let whole = trees[0].value(node)?.then(trees[1].value(node)?);
            Some((whole.key(rank), node))
        };
        let mut candidates: Vec<_> = NodeId::each(NodeId(0)..to.next()).filter_map(over).collect();
        candidates.sort_unstable();
        ViaNodes { candidates, trees, next: 0 }
    }

    /// The next best route that visits no node twice and is not too much like one that was tried, and what it comes to. `None`
    /// where there is none, or once `cancel` says so: many candidates may have to be passed over.
    pub fn next(&mut self, ways: &Ways, tried: &Tried, cancel: &Cancel) -> Option<Route> {
        self.next_over(ways, tried, cancel, |_| true)
    }

    /// The same, over nodes that are wanted alone.
    pub fn next_over(
        &mut self,
        ways: &Ways,
        tried: &Tried,
        cancel: &Cancel,
        mut is_wanted: impl FnMut(NodeId) -> bool,
    ) -> Option<Route> {
        while let Some((_, node)) =
            self.candidates.get(self.next).filter(|_| !cancel.is_cancelled())
        {
            self.next += 1;
            if !is_wanted(*node) {
                continue;
            }
            let [Some(mut route), Some(rest)] = [0, 1].map(|i| self.trees[i].route(*node)) else {
                continue;
            };
            route.nodes.extend(&rest.nodes[1..]);
            route.edges.extend(&rest.edges);
            let visited: BTreeSet<NodeId> = route.nodes.iter().copied().collect();
            if visited.len() == route.nodes.len() && tried.share(ways, &route) <= SHARED_MAX {
                route.length = value(ways, route.nodes[0], &route.nodes[1..], &route.edges).cost;
                return Some(route);
            }
        }
        None
    }
}

/// Routes that were tried, and which of them go along each edge.
#[derive(Default)]
pub(super) struct Tried {
    /// Pairs of an edge and a route that goes along it.
    along: BTreeSet<(u32, u32)>,
    count: u32,
}

impl Tried {
    /// Adds a route.
    pub fn add(&mut self, route: &Route) {
        self.along.extend(route.edges.iter().map(|edge| (*edge, self.count)));
        self.count += 1;
    }

    /// How many routes go along an edge.
    pub fn uses(&self, edge: u32) -> usize {
        self.along.range((edge, 0)..=(edge, u32::MAX)).count()
    }

    /// The largest part of a route's length, in the space's metric, that it shares with one of the routes; 0 for a route
    /// without length as long as there are none, and 1 from then on.
    fn share(&self, ways: &Ways, route: &Route) -> f64 {
        let (mut whole, mut shared) = (0.0, vec![0.0f64; self.count as usize]);
        for index in &route.edges {
            let edge = &ways.edges[*index as usize];
            let length = ways.cx.space.distance(ways.config(edge.low), ways.config(edge.high));
            whole += length;
            for (_, other) in self.along.range((*index, 0)..=(*index, u32::MAX)) {
                shared[*other as usize] += length;
            }
        }
        let most = shared.into_iter().fold(0.0, f64::max);
        match whole > 0.0 {
            true => most / whole,
            false => f64::from(u8::from(self.count > 0)),
        }
    }
}
