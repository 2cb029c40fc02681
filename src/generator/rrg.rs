use super::growth::{
    Complaints, Exploration, GraphNeighbors, GrowingSet, NeighborSearch, calibrated,
    default_attempts, default_goal_bias, grow_from_root, needs_root, step_of,
};
use super::{ATTEMPTS_MAX, Generator, Reads};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// A rapidly-exploring random graph from the query's start, or without a query from the model's native configuration (S. Karaman, E. Frazzoli, *Sampling-based algorithms for optimal
/// motion planning*, Int. J. Robotics Research 30, 2011, Algorithm 5, in the k-nearest form of §3.3.3).
///
/// It grows as [`Rrt`](super::Rrt) does, and every new node is tried with its nearest neighbours in the graph, too: the
/// `neighbors` nodes of the graph, as it was before, that are nearest to it, nearest first, ties by id. All whose motions are valid
/// become edges. The number can be `auto`: ⌊2e ln n⌋ in a graph of n nodes, which is enough for the shortest
/// paths in the graph to come near to the shortest there are. Another neighbour finder can be named, and a hop limit
/// ([`FoundNeighbors`](super::FoundNeighbors)).
///
/// The graph is the connected component of the roadmap at the start of the round that contains the start, and what the set has
/// added to it. Nodes of other components are left to the connection among sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Rrg {
    /// The most by which an extension moves, in the space's metric. If none is given, a fifth of the largest distance in the
    /// space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The probability that an extension goes toward the query's goal, as long as no node lies there.
    #[serde(default = "default_goal_bias")]
    pub goal_bias: f64,
    /// Which nodes each new one is tried with.
    #[serde(default)]
    pub neighbors: GraphNeighbors,
    /// The most extensions tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Default for Rrg {
    fn default() -> Rrg {
        Rrg {
            step: None,
            goal_bias: default_goal_bias(),
            neighbors: GraphNeighbors::default(),
            attempts: default_attempts(),
        }
    }
}

impl Generator for Rrg {
    fn reads(&self) -> Reads {
        Reads::Roadmap
    }

    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        // What is refused in a problem file can still come in bytes.
        if self.complaint().is_some() {
            return Err(GaveUp { attempts: 0 });
        }
        let limits = (step_of(self.step, &cx.space), self.attempts);
        let set = GrowingSet::new(cx, seed, scratch, frozen, count, limits);
        let neighbors = NeighborSearch::of(&self.neighbors);
        let graph = Exploration { neighbors, directions: 1, trials: 1 };
        grow_from_root(set, seed, self.goal_bias, &graph)
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        self.step = calibrated(self.step, &cx.space);
    }

    fn complaint(&self) -> Option<Complaint> {
        Complaints::of_step(self.step)
            .or_else(|| Complaints::of_goal_bias(self.goal_bias))
            .or_else(|| self.neighbors.complaint())
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_root(cx)?;
        self.neighbors.suits(cx)
    }
}
