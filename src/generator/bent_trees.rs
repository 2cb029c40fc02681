//! What the trees from both ends of a query have in common whose blocked extensions are got on along what blocks them:
//! [`RetractionTrees`](super::RetractionTrees), [`ContactTrees`](super::ContactTrees) and [`SlidingTrees`](super::SlidingTrees). They differ in how a
//! blocked extension is got on, and in nothing else.

use super::ATTEMPTS_MAX;
use super::end_trees::{calibrated, grow_or_draw, step_of};
use super::growth::{Complaints, GrowingSet};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The settings of trees whose blocked extensions are got on along what blocks them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct BentTrees {
    /// The most by which a straight extension moves, in the space's metric. If none is given, a twentieth of the largest distance in the
    /// space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// How many motions are tried to get a blocked extension on, in all sets but the first; what each of the methods does with them it says
    /// itself. With 0, and `nearby` 0, [`RetractionTrees`](super::RetractionTrees) and [`SlidingTrees`](super::SlidingTrees) are
    /// [`EndTrees`](super::EndTrees).
    #[serde(default = "default_trials")]
    pub trials: u32,
    /// Which share of the configurations that trees are extended toward is drawn from the box around the tree's nodes and a
    /// step more, in all sets but the first; the others are drawn from the whole space. A tree in a trap is else mostly drawn to what lies
    /// outside.
    #[serde(default = "default_nearby")]
    pub nearby: f64,
    /// The most extensions tried for one milestone before the rest of the set is drawn uniformly.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

pub(super) fn default_trials() -> u32 {
    12
}

pub(super) fn default_nearby() -> f64 {
    0.5
}

pub(super) fn default_attempts() -> u64 {
    1000
}

impl Default for BentTrees {
    fn default() -> BentTrees {
        BentTrees {
            step: None,
            trials: default_trials(),
            nearby: default_nearby(),
            attempts: default_attempts(),
        }
    }
}

impl BentTrees {
    /// Makes a set of `count` milestones: the first set of a strategy extends straight only and draws from the whole space, every later one gets
    /// blocked extensions on as `way` sets it up.
    ///
    /// # Errors
    /// [`GaveUp`] where the problem has no query or the settings are not sound, which is refused in a problem file but can still come in bytes, and
    /// where nothing can be drawn.
    pub(super) fn generate<'a>(
        &self,
        (cx, seed, count): (&'a Context, &Seed, usize),
        frozen: Option<&'a Roadmap>,
        scratch: &'a mut Scratch,
        way: impl FnOnce(GrowingSet<'a>) -> GrowingSet<'a>,
    ) -> Result<Increment, GaveUp> {
        let Some(query) = cx.query.as_ref().filter(|_| self.complaint().is_none()) else {
            return Err(GaveUp { attempts: 0 });
        };
        let limits = (step_of(self.step, cx), self.attempts);
        let set = GrowingSet::new(cx, seed, scratch, frozen, count, limits);
        let set = match seed.ordinal() {
            Ordinal(0) => set,
            _ => way(set.with_bending(self.trials, self.nearby)),
        };
        grow_or_draw(set, seed, query, count)
    }

    /// Finds the step, if none is given.
    pub(super) fn calibrate(&mut self, cx: &Context) {
        self.step = calibrated(self.step, cx);
    }

    /// What is wrong with the settings.
    pub(super) fn complaint(&self) -> Option<Complaint> {
        Complaints::of_step(self.step)
            .or_else(|| Complaints::of_bending(self.trials, self.nearby))
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }
}
