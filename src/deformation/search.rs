//! The search for a path whose edges can all be deformed.

use super::edge::{DeformedMotion, Unfinished, deform_motion, joined};
use super::robot::Shapes;
use super::{DeformableRobot, DeformedPath, DeformingAnswer, NoDeformedPath, Refusal, RemovedEdge};
use crate::cancel::Cancel;
use crate::numbers::NodeId;
use crate::roadmap::{Graph, Route};
use crate::space::Configs;
use std::collections::{BTreeMap, BTreeSet};

/// What is known of the edges that were tried, by their indices.
type Tried = BTreeMap<u32, Result<DeformedMotion, Refusal>>;

/// A search that goes on until a path can be deformed.
pub(super) struct Search<'a> {
    shapes: Shapes<'a>,
    tried: Tried,
    deformed: u64,
    removed: Vec<RemovedEdge>,
    searches: u64,
    cancel: &'a Cancel,
}

/// A path that was deformed, and the sum of its edges' weights.
pub(super) type Found = (DeformedPath, f64);

impl<'a> Search<'a> {
    pub fn new(robot: DeformableRobot<'a>, cancel: &'a Cancel) -> Search<'a> {
        let (shapes, tried, removed) = (Shapes::new(robot), Tried::new(), Vec::new());
        Search { shapes, tried, deformed: 0, removed, searches: 0, cancel }
    }

    /// Whether the robot can be deformed at both ends.
    pub fn ends(&mut self, [start, goal]: [&[f64]; 2]) -> Result<(), NoDeformedPath> {
        if self.cancel.is_cancelled() {
            return Err(NoDeformedPath::Cancelled);
        }
        let ends: [(_, fn(Refusal) -> _); 2] =
            [(start, NoDeformedPath::Start), (goal, NoDeformedPath::Goal)];
        for (end, refused) in ends {
            let found = self.shapes.at_end(end);
            if self.cancel.is_cancelled() {
                return Err(NoDeformedPath::Cancelled);
            }
            found.map_err(refused)?;
        }
        Ok(())
    }

    /// A path from one node of a graph to another whose edges can all be deformed. `motion` gives an edge's configurations from its lower end
    /// to its higher one.
    pub fn path(
        &mut self,
        graph: &Graph,
        [from, to]: [NodeId; 2],
        motion: &dyn Fn(u32) -> Configs,
    ) -> Result<Found, NoDeformedPath> {
        let is_refused = |(index, tried): (&u32, &Result<_, _>)| tried.is_err().then_some(*index);
        let mut failed: BTreeSet<u32> = self.tried.iter().filter_map(is_refused).collect();
        let mut is_joined = false;
        loop {
            self.searches += 1;
            let Some(route) = graph.shortest(from, to, &failed) else {
                is_joined |= graph.shortest(from, to, &BTreeSet::new()).is_some();
                return Err(if is_joined {
                    NoDeformedPath::Refused
                } else {
                    NoDeformedPath::Apart
                });
            };
            is_joined = true;
            match self.first_refused(graph, &route, motion)? {
                Some(index) => failed.insert(index),
                None => return Ok((self.joined(&route), route.length)),
            };
        }
    }

    /// The first edge of a route, from the heaviest down, along which the robot cannot be deformed.
    fn first_refused(
        &mut self,
        graph: &Graph,
        route: &Route,
        motion: &dyn Fn(u32) -> Configs,
    ) -> Result<Option<u32>, NoDeformedPath> {
        for (weight, ends, index) in from_the_heaviest(graph, route) {
            if self.tried.contains_key(&index) {
                continue;
            }
            let deformed = match deform_motion(&motion(index), &mut self.shapes, self.cancel) {
                Ok(deformed) => {
                    self.deformed += 1;
                    Ok(deformed)
                }
                Err(Unfinished::Cancelled) => return Err(NoDeformedPath::Cancelled),
                Err(Unfinished::Refused(refusal)) => {
                    self.removed.push(RemovedEdge { ends, weight, refusal });
                    Err(refusal)
                }
            };
            let is_refused = deformed.is_err();
            self.tried.insert(index, deformed);
            if is_refused {
                return Ok(Some(index));
            }
        }
        Ok(None)
    }

    /// The path along a route whose edges are all deformed.
    fn joined(&mut self, route: &Route) -> DeformedPath {
        let steps = route.edges.iter().zip(&route.nodes).zip(route.nodes.iter().skip(1));
        let motions: Vec<(&DeformedMotion, bool)> = steps
            .filter_map(|((index, from), to)| {
                let deformed = self.tried.get(index)?.as_ref().ok()?;
                Some((deformed, from < to))
            })
            .collect();
        joined(&motions, &self.shapes.robot)
    }

    /// The path along given configurations.
    pub fn along(&mut self, configs: &Configs) -> Result<Found, NoDeformedPath> {
        let Some(last) = configs.len().checked_sub(1) else { return Err(NoDeformedPath::Apart) };
        self.ends([configs.get(0), configs.get(last)])?;
        let mut motions = Vec::new();
        for index in 0..last.max(1) {
            let mut leg = Configs::new(configs.dofs());
            (index..=(index + 1).min(last)).for_each(|index| leg.push(configs.get(index)));
            match deform_motion(&leg, &mut self.shapes, self.cancel) {
                Ok(deformed) => {
                    self.deformed += 1;
                    motions.push(deformed);
                }
                Err(Unfinished::Cancelled) => return Err(NoDeformedPath::Cancelled),
                Err(Unfinished::Refused(refusal)) => {
                    let ends = [index, index + 1].map(|index| NodeId(index as u32));
                    self.removed.push(RemovedEdge { ends, weight: 0.0, refusal });
                    return Err(NoDeformedPath::Refused);
                }
            }
        }
        let motions: Vec<_> = motions.iter().map(|motion| (motion, true)).collect();
        Ok((joined(&motions, &self.shapes.robot), 0.0))
    }

    /// Forgets what was found of the edges from this index on.
    pub fn forget_edges_from(&mut self, count: usize) {
        self.tried.retain(|index, _| (*index as usize) < count);
    }

    /// What the search came to.
    pub fn answer(self, found: Result<Found, NoDeformedPath>) -> DeformingAnswer {
        let (path, weight) = match found {
            Ok((path, weight)) => (Ok(path), weight),
            Err(no) => (Err(no), 0.0),
        };
        DeformingAnswer {
            deformed_edges: self.deformed,
            path,
            weight,
            removed: self.removed,
            searches: self.searches,
            deformations: self.shapes.took,
        }
    }
}

/// The edges of a route from the heaviest to the lightest, of edges of one weight that nearer to the beginning first: weight, ends as they are
/// walked, and index.
fn from_the_heaviest(graph: &Graph, route: &Route) -> Vec<(f64, [NodeId; 2], u32)> {
    let steps = route.edges.iter().zip(&route.nodes).zip(route.nodes.iter().skip(1));
    let mut edges: Vec<_> = steps
        .map(|((index, from), to)| (graph.weight(*from, *to, *index), [*from, *to], *index))
        .collect();
    edges.sort_by(|a, b| b.0.total_cmp(&a.0));
    edges
}
