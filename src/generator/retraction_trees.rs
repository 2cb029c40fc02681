use super::end_trees::{calibrated, grow_or_draw, step_of};
use super::growth::{Complaints, GrowingSet, needs_query};
use super::{ATTEMPTS_MAX, Generator, Reads};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

const TRIALS_MAX: u32 = 1000;

/// Trees from both ends of the query as [`EndTrees`](super::EndTrees) grows them, whose blocked extensions are bent aside, so that they get on along
/// obstacles and through narrow passages: a problem with a query that names no strategies has this one beside uniform
/// sampling.
///
/// An extension from the node q_near toward q_rand goes by a step, as there. If that motion is blocked, configurations are tried that a
/// valid straight motion from q_near of at most one and a half times that length leads to, each nearer to q_rand than the last that was found;
/// the last becomes the new node if by it the extension comes nearer to q_rand by at least a twentieth of its length.
/// The first set extends straight only, and draws from the whole space: it costs least where a query is solved in the open, and others follow.
///
/// After L. Zhang, D. Manocha, *An efficient retraction-based RRT planner*, ICRA 2008, which retracts q_rand to the nearest
/// configuration in contact by the geometry of the contact, and S. Rodriguez, X. Tang, J.-M. Lien, N. M. Amato, *An obstacle-based
/// rapidly-exploring random tree*, ICRA 2006, which extends along obstacles in random directions. What is tried here is
/// drawn at random, as there, and kept if it comes nearer to q_rand, so that nothing needs to be known of the contact.
///
/// A part of the configurations q_rand is drawn from the box around the tree (`nearby`), for what a tree in a trap sees most of lies outside:
/// that is the flaw which A. Yershova, L. Jaillet, T. Siméon and S. M. LaValle (*Dynamic-domain RRTs*, ICRA 2005) mend by a radius for every node
/// that was blocked before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct RetractionTrees {
    /// The most by which a straight extension moves, in the space's metric. If none is given, a twentieth of the largest distance in the
    /// space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The most motions tried to bend a blocked extension aside, in all sets but the first; with 0, and `nearby` 0, the method is
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

fn default_trials() -> u32 {
    12
}

fn default_nearby() -> f64 {
    0.5
}

fn default_attempts() -> u64 {
    1000
}

impl Default for RetractionTrees {
    fn default() -> RetractionTrees {
        RetractionTrees {
            step: None,
            trials: default_trials(),
            nearby: default_nearby(),
            attempts: default_attempts(),
        }
    }
}

impl Generator for RetractionTrees {
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
        let Some(query) = cx.query.as_ref().filter(|_| self.complaint().is_none()) else {
            return Err(GaveUp { attempts: 0 });
        };
        let limits = (step_of(self.step, cx), self.attempts);
        let set = GrowingSet::new(cx, seed, scratch, frozen, count, limits);
        let is_first = seed.ordinal() == Ordinal(0);
        let set = if is_first { set } else { set.with_bending(self.trials, self.nearby) };
        grow_or_draw(set, seed, query, count)
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        self.step = calibrated(self.step, cx);
    }

    fn complaint(&self) -> Option<Complaint> {
        let of_trials =
            (self.trials > TRIALS_MAX).then(|| Complaint::new("trials", self.trials, "0 to 1000"));
        let is_share = (0.0..1.0).contains(&self.nearby);
        let of_nearby =
            (!is_share).then(|| Complaint::new("nearby", self.nearby, "at least 0, less than 1"));
        Complaints::of_step(self.step)
            .or(of_trials)
            .or(of_nearby)
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_query(cx)
    }
}
