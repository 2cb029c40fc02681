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

/// A multi-directional rapidly-exploring random graph from the query's start, or without a query from the model's native
/// configuration (S. K. Nath, *Multi-directional rapidly
/// exploring random graph (mRRG) for motion planning*, thesis, Texas A&M University, 2013, §4.1, Algorithms 2 to 4).
///
/// It grows as [`Rrg`](super::Rrg) does, and wherever a node q_near could be extended toward the random configuration, it is
/// extended in `directions` − 1 further directions, which are dispersed: of `trials` configurations drawn uniformly for each
/// that one is taken whose direction from q_near has the greatest least angle to the directions from q_near of the nodes
/// that are adjacent to it. Every new node is tried with its nearest neighbours in the graph. With one direction it is
/// RRG, and without neighbours RRT besides (the thesis' Lemma 1).
///
/// Where the thesis is silent or says two things:
///
/// - Algorithm 3 never sets `MAX_ANGLE` and `MIN_ANGLE` before it compares them. Here `MIN_ANGLE` begins above every angle and
///   `MAX_ANGLE` below every one, so that the first try is the best so far, whatever its angle; a later one replaces it only
///   if its least angle is greater.
/// - The text of §4.1 calls CONN_NEIGHBORS with q_near, Algorithm 2 with q_new. It is done with q_new: q_near has been
///   tried with its neighbours when it was new, RRG tries the new node, and the caption of Figure 4 says *"a q_new is
///   identified … and connected to its nearest neighbors"*.
/// - The neighbours that Algorithm 5 finds may be q_new itself, which Algorithm 4 passes over, so that one less is tried.
///   Here they are found in the graph as it was before, as by Karaman and Frazzoli.
/// - STEER is not defined. Here it gives the configuration at a distance of `step` on the shortest motion, valid or not, or
///   the end of the motion if that is nearer.
/// - CALCULATE_ANGLE is not defined. Here it is the angle in the space's metric of the two
///   [displacements](crate::space::Space::displacement), in which angles turn the short way and rotations are rotation
///   vectors, [each by its weight](crate::space::Direction::angle). A difference of coordinates would know none of this.
/// - `maxTrial` has no value. The default is 3, that of the program of the same group.
/// - Growth toward the goal does not occur; `goal_bias = 0` is the thesis' method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Mrrg {
    /// The most by which an extension moves, in the space's metric (the thesis: Δq). If none is given, a fifth of the largest
    /// distance in the space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The probability that an extension goes toward the query's goal, as long as no node lies there.
    #[serde(default = "default_goal_bias")]
    pub goal_bias: f64,
    /// Which nodes each new one is tried with; 0 of them in a tree.
    #[serde(default)]
    pub neighbors: GraphNeighbors,
    /// In how many directions a node is extended (the thesis: m, of which 3 was best for robots and 7 for proteins).
    #[serde(default = "default_directions")]
    pub directions: u32,
    /// How many configurations are drawn for each direction after the first (the thesis: maxTrial).
    #[serde(default = "default_trials")]
    pub trials: u32,
    /// The most extensions of nodes tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

fn default_directions() -> u32 {
    3
}

fn default_trials() -> u32 {
    3
}

/// The most directions, and the most configurations drawn for one.
const DIRECTIONS_MAX: u32 = 1000;

impl Default for Mrrg {
    fn default() -> Mrrg {
        Mrrg {
            step: None,
            goal_bias: default_goal_bias(),
            neighbors: GraphNeighbors::default(),
            directions: default_directions(),
            trials: default_trials(),
            attempts: default_attempts(),
        }
    }
}

impl Generator for Mrrg {
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
        let Mrrg { directions, trials, .. } = *self;
        let neighbors = NeighborSearch::of(&self.neighbors);
        grow_from_root(set, seed, self.goal_bias, &Exploration { neighbors, directions, trials })
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        self.step = calibrated(self.step, &cx.space);
    }

    fn complaint(&self) -> Option<Complaint> {
        let of_directions = |key, count: u32| {
            let is_sound = (1..=DIRECTIONS_MAX).contains(&count);
            (!is_sound).then(|| Complaint::new(key, count, "1 to 1000"))
        };
        Complaints::of_step(self.step)
            .or_else(|| Complaints::of_goal_bias(self.goal_bias))
            .or_else(|| self.neighbors.complaint().filter(|_| !self.neighbors.is_none()))
            .or_else(|| of_directions("directions", self.directions))
            .or_else(|| of_directions("trials", self.trials))
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_root(cx)?;
        self.neighbors.suits(cx)
    }
}
