use super::ways::{config_in, end_ids, first_failed};
use super::{Answer, Attachment, EndError, Path, accepted, reach};
use crate::context::Context;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::bidirectional::{self, Buffers, Extended};
use crate::roadmap::landmarks::{self, Landmarks, Values};
use crate::roadmap::{Edge, Graph, Roadmap, Route};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, OnceLock};

/// Roadmaps with fewer nodes are searched without landmarks, which would save little.
const LANDMARKS_NODES: usize = if cfg!(test) { 40 } else { 20_000 };
/// Landmarks are made once so many routes were searched, which together took about as long as making them.
const LANDMARKS_SEARCHES: u32 = if cfg!(test) { 2 } else { 32 };

/// A roadmap that many queries are asked of. What queries have in common, the graph of the roadmap's edges, is made once, when
/// the first one needs it. Routes are searched from both ends, and, after some tens of queries of a large roadmap whose edges cost
/// their lengths, toward the goal by landmarks, whose distances from all nodes are measured then. Answers are those of [`solve`](super::solve) and
/// [`ask`](super::ask), to the bit, after far less work where the roadmap is large.
///
/// ```
/// use roadmill::query::PreparedRoadmap;
/// use roadmill::{Build, model::Scratch, problem::Problem, query};
///
/// let problem = Problem::load("problems/maze.toml".as_ref())?;
/// let attachment = problem.attachment();
/// let built = Build::new(problem).run()?;
/// let ends: (&[f64], &[f64]) = (&[14.9, 9.0, 0.0], &[1.1, 1.0, 0.0]);
/// let roadmap = PreparedRoadmap::new(built.roadmap().clone());
/// let answer = roadmap.ask(built.context(), ends, &attachment, &mut Scratch::new())?;
/// assert_eq!(answer, built.query(ends.0, ends.1)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct PreparedRoadmap {
    roadmap: Roadmap,
    /// The roadmap's edges; its nodes are the roadmap's, and two for the ends of a query.
    graph: OnceLock<Graph>,
    landmarks: OnceLock<Landmarks>,
    /// Number of routes that were searched.
    searches: AtomicU32,
    /// Buffers that no search uses at present.
    buffers: Mutex<Vec<Buffers>>,
    values: Mutex<Vec<Values>>,
}

impl PreparedRoadmap {
    /// Prepares a roadmap, which never changes any more.
    pub fn new(roadmap: Roadmap) -> PreparedRoadmap {
        PreparedRoadmap {
            roadmap,
            graph: OnceLock::new(),
            landmarks: OnceLock::new(),
            searches: AtomicU32::new(0),
            buffers: Mutex::default(),
            values: Mutex::default(),
        }
    }

    /// The roadmap.
    pub fn roadmap(&self) -> &Roadmap {
        &self.roadmap
    }

    /// What [`ask`](super::ask) answers of this roadmap.
    ///
    /// # Errors
    /// When `start` or `goal` is no valid configuration.
    pub fn ask(
        &self,
        cx: &Context,
        ends: (&[f64], &[f64]),
        attachment: &Attachment,
        scratch: &mut Scratch,
    ) -> Result<Answer, EndError> {
        let [start, goal] = accepted(cx, ends)?;
        Ok(self.solve(cx, (&start, &goal), attachment, scratch))
    }

    /// What [`solve`](super::solve) answers of this roadmap.
    pub fn solve(
        &self,
        cx: &Context,
        (start, goal): (&[f64], &[f64]),
        attachment: &Attachment,
        scratch: &mut Scratch,
    ) -> Answer {
        let (roadmap, ends) = (&self.roadmap, [start, goal]);
        let (attached, direct) = match reach(cx, roadmap, ends, attachment, scratch) {
            Ok(reached) => reached,
            Err(answer) => return *answer,
        };
        let mut answer = Answer::without_path(roadmap, &attached, direct);
        if !answer.connected {
            return answer;
        }
        let [from, to] = end_ids(roadmap);
        let own = roadmap.edges().len() as u32;
        let mut more = attached.concat();
        let mut passed = direct.iter().map(|_| own + more.len() as u32).collect();
        more.extend(direct);
        let edge = |index: u32| match index.checked_sub(own) {
            None => roadmap.edges().get(index as usize),
            Some(index) => more[index as usize],
        };
        let config = config_in(roadmap, ends);
        let graph = self.graph.get_or_init(|| Graph::of(to.index() + 1, || roadmap.edges().iter()));
        let mut failed = BTreeSet::new();
        while let Some(route) = self.route(graph, &more, (from, to), &failed) {
            match first_failed(cx, &route, (edge, &config), &mut passed, scratch) {
                Some(index) => _ = failed.insert(index),
                None => {
                    answer.path = Some(Path::along(cx, &route, edge, &config));
                    break;
                }
            }
        }
        answer.dropped_edges = failed.len() as u64;
        answer
    }

    /// The shortest route through the roadmap's graph and the edges that attach the two ends, by edges that have not failed.
    fn route(
        &self,
        graph: &Graph,
        more: &[Edge],
        ends: (NodeId, NodeId),
        failed: &BTreeSet<u32>,
    ) -> Option<Route> {
        let extended = Extended::new(graph, more);
        if let Some(landmarks) = self.landmarks(graph) {
            let mut values = taken(&self.values).unwrap_or_else(|| Values::new(graph.nodes()));
            let found =
                landmarks::shortest((&extended, more), landmarks, ends, failed, &mut values);
            give_back(&self.values, values);
            if let Ok(route) = found {
                return route;
            }
        }
        let mut buffers = taken(&self.buffers).unwrap_or_else(|| Buffers::new(graph.nodes()));
        let route = bidirectional::shortest(&extended, ends, failed, &mut buffers);
        give_back(&self.buffers, buffers);
        route
    }

    /// The landmarks, where it is time for them: they need edges that cost the same in both directions.
    fn landmarks(&self, graph: &Graph) -> Option<&Landmarks> {
        let roadmap = &self.roadmap;
        if roadmap.configs().len() < LANDMARKS_NODES || roadmap.edges().is_directed() {
            return None;
        }
        if self.searches.fetch_add(1, Ordering::Relaxed) < LANDMARKS_SEARCHES {
            return None;
        }
        // The largest component is where most routes are.
        let members = |name: NodeId| roadmap.components().of_node(name).members.len();
        let names = roadmap.components().iter().map(|component| component.name);
        let first = names.max_by_key(|name| (members(*name), std::cmp::Reverse(*name)))?;
        Some(self.landmarks.get_or_init(|| Landmarks::new(graph, first)))
    }
}

/// What no search uses at present, if there is any.
fn taken<T>(free: &Mutex<Vec<T>>) -> Option<T> {
    free.lock().ok()?.pop()
}

fn give_back<T>(free: &Mutex<Vec<T>>, it: T) {
    // After a panic elsewhere they are made anew.
    if let Ok(mut free) = free.lock() {
        free.push(it);
    }
}
