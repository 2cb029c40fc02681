use super::ways::{config_in, end_ids, first_failed};
use super::{Answer, Attachment, EndError, Path, accepted, reach};
use crate::context::Context;
use crate::model::Scratch;
use crate::roadmap::bidirectional::{self, Buffers, Extended};
use crate::roadmap::{Graph, Roadmap};
use std::collections::BTreeSet;
use std::sync::{Mutex, OnceLock};

/// A roadmap that many queries are asked of. What queries have in common, the graph of the roadmap's edges, is made once, when
/// the first one needs it, and routes are searched from both ends. Answers are those of [`solve`](super::solve) and
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
    /// Buffers that no search uses at present.
    buffers: Mutex<Vec<Buffers>>,
}

impl PreparedRoadmap {
    /// Prepares a roadmap, which never changes any more.
    pub fn new(roadmap: Roadmap) -> PreparedRoadmap {
        PreparedRoadmap { roadmap, graph: OnceLock::new(), buffers: Mutex::default() }
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
        let extended = Extended::new(graph, &more);
        let mut buffers = self.taken_buffers().unwrap_or_else(|| Buffers::new(graph.nodes()));
        let mut failed = BTreeSet::new();
        while let Some(route) =
            bidirectional::shortest(&extended, (from, to), &failed, &mut buffers)
        {
            match first_failed(cx, &route, (edge, &config), &mut passed, scratch) {
                Some(index) => _ = failed.insert(index),
                None => {
                    answer.path = Some(Path::along(cx, &route, edge, &config));
                    break;
                }
            }
        }
        answer.dropped_edges = failed.len() as u64;
        self.give_back(buffers);
        answer
    }

    fn taken_buffers(&self) -> Option<Buffers> {
        self.buffers.lock().ok()?.pop()
    }

    fn give_back(&self, buffers: Buffers) {
        // After a panic elsewhere they are made anew.
        if let Ok(mut free) = self.buffers.lock() {
            free.push(buffers);
        }
    }
}
