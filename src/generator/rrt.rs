use super::growth::{
    Complaints, Exploration, GrowingSet, calibrated, default_attempts, default_goal_bias,
    grow_from_root, needs_root, step_of,
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

/// A rapidly-exploring random tree from the query's start, or without a query from the model's native configuration (S. M. LaValle, J. J. Kuffner, *Rapidly-exploring random trees:
/// progress and prospects*, WAFR 2000; S. K. Nath, *Multi-directional rapidly exploring random
/// graph (mRRG) for motion planning*, thesis, Texas A&M University, 2013, Algorithm 1).
///
/// A configuration q_rand is drawn uniformly, valid or not, or is the query's goal with the probability `goal_bias` as
/// long as no node lies there. The tree's node q_near that is nearest to it, ties by id, is extended: q_new lies on the
/// shortest motion from q_near to q_rand, at a distance of `step` or at q_rand if that is nearer. If the whole motion from
/// q_near to q_new is valid, q_new becomes a milestone with an edge to q_near; otherwise nothing comes of it.
///
/// The tree is the connected component of the roadmap at the start of the round that contains the start, and what the set has
/// added to it. In rounds of one set it is the tree of the thesis whatever the number of `nodes` in a set, if the
/// connection among sets adds no edges within a component, as `until-joined` does not, and if `goal_bias` is 0, of
/// which the thesis says nothing. Sets of one round extend the same tree side by side, each without the nodes of the others.
///
/// The first set makes the start a milestone where no node lies there. Other sets of its round grow from the start as well,
/// but the edges of what they grow first would lead to a node that they do not know: the connection among sets joins it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Rrt {
    /// The most by which an extension moves, in the space's metric (the thesis: δ). If none is given, a fifth of the largest
    /// distance in the space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The probability that an extension goes toward the query's goal, as long as no node lies there.
    #[serde(default = "default_goal_bias")]
    pub goal_bias: f64,
    /// The most extensions tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Default for Rrt {
    fn default() -> Rrt {
        Rrt { step: None, goal_bias: default_goal_bias(), attempts: default_attempts() }
    }
}

const TREE: Exploration = Exploration { neighbors: None, directions: 1, trials: 1 };

impl Generator for Rrt {
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
        grow_from_root(set, seed, self.goal_bias, &TREE)
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
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_root(cx)
    }
}
