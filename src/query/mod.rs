//! Queries: attaching two configurations to a roadmap and finding a path between them, through the roadmap or by the
//! direct motion.
//!
//! ```
//! use roadmill::{Build, model::Scratch, problem::Problem, query};
//!
//! let problem = Problem::load("problems/maze.toml".as_ref())?;
//! let built = Build::new(problem).run()?;
//! // The way back, through the same roadmap, then made shorter.
//! let answer = built.query(&[14.9, 9.0, 0.0], &[1.1, 1.0, 0.0])?;
//! let path = answer.path.expect("whoever came can go back");
//! let short = query::shorten(built.context(), &path, 100, &mut Scratch::new());
//! assert!(short.length < path.length);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod attach;
mod clearest;
mod direct;
mod goals;
mod path;
mod prepared;
mod shorten;
mod ways;

pub(crate) use attach::{attach, attach_for_good, once_nearest};
pub use clearest::{ClearPath, Clearest, clearest};
pub use goals::solve_any;
pub use path::Path;
pub use prepared::PreparedRoadmap;
pub use shorten::{shorten, shorten_within};
pub(crate) use ways::Ways;

use crate::context::Context;
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::{Edge, Extent, Graph, Roadmap, Route};
use bincode::{Decode, Encode};
use std::collections::BTreeSet;
use ways::end_ids;

/// A path's edges are checked this many times finer than the problem's resolution before it is
/// given out.
pub const PATH_REFINEMENT: u32 = 20;

/// How a configuration is attached to a roadmap.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// How many nearest nodes are tried.
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    pub planners: Vec<Planner>,
}

impl Default for Attachment {
    fn default() -> Attachment {
        Attachment { neighbors: 10, planners: vec![Planner::StraightLine] }
    }
}

impl Attachment {
    /// What is wrong with it.
    pub fn complaint(&self) -> Option<Complaint> {
        if self.neighbors == 0 {
            return Some(Complaint::new("neighbors", "0", "at least 1"));
        }
        local::complaint(&self.planners)
    }
}

/// What a query came to.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Answer {
    /// Nodes that start and goal could be connected to; zero for both where the direct motion was the answer before
    /// the roadmap was looked at.
    pub attached: [u32; 2],
    /// Whether the two are joined, by the direct motion or by a connected component that both reach.
    pub connected: bool,
    /// A path whose every edge passed the finer check.
    pub path: Option<Path>,
    /// Edges that failed the finer check and were left out.
    pub dropped_edges: u64,
}

impl Answer {
    /// Why there is no path, for people; only for answers that have none.
    pub fn why_no_path(&self) -> &'static str {
        let [start, goal] = self.attached;
        match (start, goal, self.connected) {
            (0, _, _) => "the start connects to no node of the roadmap",
            (_, 0, _) => "the goal connects to no node of the roadmap",
            (_, _, false) => "start and goal connect to different components",
            (_, _, true) => "every path between them has an edge that fails the finer check",
        }
    }

    /// The answer as long as there is no path: how many nodes either end is attached to, and whether the two are joined.
    fn without_path(roadmap: &Roadmap, attached: &AttachedEdges, direct: Option<Edge>) -> Answer {
        let reached = |edges: &[Edge]| -> BTreeSet<NodeId> {
            edges.iter().map(|edge| roadmap.components().of_node(edge.low).name).collect()
        };
        let [from_start, from_goal] = attached;
        Answer {
            attached: [from_start.len() as u32, from_goal.len() as u32],
            connected: direct.is_some() || !reached(from_start).is_disjoint(&reached(from_goal)),
            path: None,
            dropped_edges: 0,
        }
    }
}

/// Looks for a shortest path from `start` to `goal`, both valid, whose edges all pass a check at a
/// [`PATH_REFINEMENT`]th of the resolution.
///
/// First the direct motion is tried, by the attachment's local planners. Where that is straight and costs its length
/// nothing is shorter, and it is the answer, whatever the roadmap. Otherwise `start` and `goal` are attached to the
/// roadmap, and the direct motion, where there is one, is an edge like the others. Edges that fail the check are left
/// out and the search repeated; the roadmap itself stays as it is. What trying the direct motion takes is not counted,
/// so that the counts of a query whose ends do not see each other are those of the roadmap's part alone.
pub fn solve(
    cx: &Context,
    roadmap: &Roadmap,
    (start, goal): (&[f64], &[f64]),
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Answer {
    let ends = [start, goal];
    let (attached, direct) = match reach(cx, roadmap, ends, attachment, scratch) {
        Ok(reached) => reached,
        Err(answer) => return *answer,
    };
    let [from, to] = end_ids(roadmap);
    let search = Search { cx, roadmap, ends, attached, direct };
    let shortest = |graph: &Graph, failed: &BTreeSet<u32>| graph.shortest(from, to, failed);
    search.answer(shortest, scratch)
}

/// The edges that attach start and goal.
type AttachedEdges = [Vec<Edge>; 2];

/// The edges that attach two ends to a roadmap, and the direct motion between them, if there is one that has passed the finer
/// check; or the answer, where that motion is.
fn reach(
    cx: &Context,
    roadmap: &Roadmap,
    ends: [&[f64]; 2],
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Result<(AttachedEdges, Option<Edge>), Box<Answer>> {
    let [from, to] = end_ids(roadmap);
    let direct = direct::edge(cx, ends, from, attachment, scratch);
    if let Some(edge) = direct.filter(direct::is_shortest) {
        let path = Some(direct::path(cx, ends, edge));
        let answer = Answer { attached: [0, 0], connected: true, path, dropped_edges: 0 };
        return Err(Box::new(answer));
    }
    let from_start = attach(cx, roadmap, ends[0], from, attachment, scratch);
    let from_goal = attach(cx, roadmap, ends[1], to, attachment, scratch);
    Ok(([from_start, from_goal], direct))
}

/// Why a configuration cannot be the end of a query.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{end}: {reason}")]
pub struct EndError {
    /// Which end: `start` or `goal`.
    pub end: &'static str,
    /// What is wrong with the configuration.
    pub reason: String,
}

/// [`solve`] for configurations that come from outside: both are brought into stored form and checked first.
///
/// # Errors
/// When one of them is no valid configuration.
pub fn ask(
    cx: &Context,
    roadmap: &Roadmap,
    (start, goal): (&[f64], &[f64]),
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Result<Answer, EndError> {
    let [start, goal] = accepted(cx, (start, goal))?;
    Ok(solve(cx, roadmap, (&start, &goal), attachment, scratch))
}

/// The ends of a query that come from outside, brought into stored form and checked.
///
/// # Errors
/// When one of them is no valid configuration.
pub fn accepted(cx: &Context, (start, goal): (&[f64], &[f64])) -> Result<[Vec<f64>; 2], EndError> {
    let accept = |end, q: &[f64]| {
        let mut q = q.to_vec();
        cx.accept(&mut q).map_err(|reason| EndError { end, reason })?;
        Ok(q)
    };
    Ok([accept("start", start)?, accept("goal", goal)?])
}

/// The lowest barrier between `start` and `goal`, both valid, in a model with energies, and the shortest path, by the
/// edges' costs, that does not exceed it; infinity where there is no path. The ways are those through the roadmap, and
/// the direct motion. Edges are checked as [`solve`] does. The ends are attached to all nodes that were once their
/// nearest.
pub fn lowest_barrier(
    cx: &Context,
    roadmap: &Roadmap,
    (start, goal): (&[f64], &[f64]),
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> (f64, Answer) {
    let [from, to] = end_ids(roadmap);
    let ends = [start, goal];
    let direct = direct::edge(cx, ends, from, attachment, scratch);
    let from_start = attach_for_good(cx, roadmap, start, from, attachment, scratch);
    let from_goal = attach_for_good(cx, roadmap, goal, to, attachment, scratch);
    let energy = cx.model.energy(start, scratch).unwrap_or(f64::NEG_INFINITY);
    let search = Search { cx, roadmap, ends, attached: [from_start, from_goal], direct };
    let mut barrier = f64::INFINITY;
    let lowest = |graph: &Graph, failed: &BTreeSet<u32>| {
        let (found, route) = graph.lowest_barrier(from, to, energy, failed)?;
        barrier = found;
        Some(route)
    };
    let answer = search.answer(lowest, scratch);
    (if answer.path.is_some() { barrier } else { f64::INFINITY }, answer)
}

/// The value of [`lowest_barrier`] for the roadmap as it was when it went as far as `before`, the end of one of its rounds or
/// nothing, and for the roadmap as it is. Edges that attach the ends are found once for both.
pub(crate) fn lowest_barriers(
    cx: &Context,
    roadmap: &Roadmap,
    before: Extent,
    (start, goal): (&[f64], &[f64]),
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> [f64; 2] {
    let [from, to] = end_ids(roadmap);
    let ends = [start, goal];
    let direct = direct::edge(cx, ends, from, attachment, scratch);
    let now = [(start, from), (goal, to)]
        .map(|(q, id)| attach_for_good(cx, roadmap, q, id, attachment, scratch));
    let rounds = roadmap.rounds().iter().take_while(|extent| extent.nodes <= before.nodes).count();
    let then = [(start, &now[0]), (goal, &now[1])].map(|(q, edges)| {
        let near = once_nearest(cx, roadmap, q, attachment, &roadmap.rounds()[..rounds]);
        edges.iter().filter(|edge| near.contains(&edge.low)).copied().collect::<Vec<_>>()
    });
    let energy = cx.model.energy(start, scratch).unwrap_or(f64::NEG_INFINITY);
    [(before.edges, then), (roadmap.edges().len(), now)].map(|(count, attached)| {
        let edges = roadmap.edges().iter().take(count);
        let mut ways = Ways::of(cx, roadmap, ends, edges, attached, direct);
        while let Some((barrier, route)) = ways.graph.lowest_barrier(from, to, energy, &ways.failed)
        {
            if ways.passes(&route, scratch) {
                return barrier;
            }
        }
        f64::INFINITY
    })
}

/// A question to a roadmap: its ends, and the edges that attach them.
struct Search<'a> {
    cx: &'a Context,
    roadmap: &'a Roadmap,
    ends: [&'a [f64]; 2],
    attached: [Vec<Edge>; 2],
    /// The direct motion between the ends, which has passed the finer check.
    direct: Option<Edge>,
}

impl Search<'_> {
    /// The first route that `find` gives whose edges all pass the finer check. `find` is given the edges that have
    /// failed it.
    fn answer(
        self,
        mut find: impl FnMut(&Graph, &BTreeSet<u32>) -> Option<Route>,
        scratch: &mut Scratch,
    ) -> Answer {
        let Search { cx, roadmap, ends, attached, direct } = self;
        let mut answer = Answer::without_path(roadmap, &attached, direct);
        if !answer.connected {
            return answer;
        }
        let edges = roadmap.edges().iter();
        let mut ways = Ways::of(cx, roadmap, ends, edges, attached, direct);
        while let Some(route) = find(&ways.graph, &ways.failed) {
            if ways.passes(&route, scratch) {
                answer.path = Some(ways.path(&route));
                break;
            }
        }
        answer.dropped_edges = ways.failed.len() as u64;
        answer
    }
}

#[cfg(test)]
mod tests;
