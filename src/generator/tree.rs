use super::growth::{
    Complaints, Exploration, GrowingSet, GrowingTree, calibrated, default_attempts, explore,
    step_of,
};
use super::{ATTEMPTS_MAX, Generator};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Configs, Increment, Roadmap};
use crate::sampler::{GaveUp, SamplerKind};
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// A tree of its own for every set, of which the connection among sets makes one roadmap (E. Plaku, K. E. Bekris,
/// B. Y. Chen, A. M. Ladd, L. E. Kavraki, *Sampling-based roadmap of trees for parallel motion planning*, IEEE Trans. Robotics
/// 21, 2005, §II: *"the roadmap nodes are trees"*).
///
/// A root is drawn by `sampler`, and a rapidly-exploring random tree of as many nodes as a set has is grown from it as
/// [`Rrt`](super::Rrt) grows its own, with no goal. It reads no roadmap, so trees can be grown ahead of
/// their rounds, side by side, and apart from a build.
///
/// Which trees are joined, and how, is the connection's among sets. The paper tries for each tree some whose centres are
/// nearest, the closest pairs of their nodes first, as `component-pairs` does, and some that are random, which there is no
/// connection for. Where no motion between two of the closest nodes is valid, it grows two trees toward each other;
/// here [`RrtConnect`](super::RrtConnect), in a strategy of its own, does this for the two trees that contain the
/// query's ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Tree {
    /// What draws the root.
    #[serde(default)]
    pub sampler: SamplerKind,
    /// The most by which an extension moves, in the space's metric. If none is given, a fifth of the largest distance in the
    /// space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The most extensions tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Default for Tree {
    fn default() -> Tree {
        Tree { sampler: SamplerKind::default(), step: None, attempts: default_attempts() }
    }
}

/// Which part of the set's seed draws the root; another grows the tree.
const ROOT: u64 = 0;
const GROWTH: u64 = 1;

impl Generator for Tree {
    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        _frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        // What is refused in a problem file can still come in bytes.
        if self.complaint().is_some() {
            return Err(GaveUp { attempts: 0 });
        }
        let mut root = Configs::new(cx.space.len());
        self.sampler.method().sample(cx, &seed.part(ROOT), 1, scratch, &mut root)?;
        let limits = (step_of(self.step, &cx.space), self.attempts);
        let mut set = GrowingSet::new(cx, &seed.part(GROWTH), scratch, None, count, limits);
        let mut tree = GrowingTree::empty();
        let root = set.add(root.get(0));
        tree.add(&set, root);
        let plain = Exploration { neighbors: None, directions: 1, trials: 1 };
        explore(&mut set, &mut tree, None, &plain)?;
        Ok(set.made)
    }

    fn reads_query(&self) -> bool {
        self.sampler.method().reads_query()
    }

    fn calibrate(&mut self, cx: &Context, seed: &Seed) {
        self.sampler.method_mut().calibrate(cx, seed);
        self.step = calibrated(self.step, &cx.space);
    }

    fn complaint(&self) -> Option<Complaint> {
        let of_sampler = self.sampler.method().complaint();
        of_sampler
            .or_else(|| Complaints::of_step(self.step))
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.sampler.method().suits(cx)
    }
}
