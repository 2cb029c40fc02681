use super::bent_trees::BentTrees;
use super::growth::needs_query;
use super::{Generator, Reads};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Trees from both ends of the query as [`EndTrees`](super::EndTrees) grows them, whose blocked extensions are bent aside, so that they get on along
/// obstacles and through narrow passages.
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(transparent)]
pub struct RetractionTrees(pub BentTrees);

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
        self.0.generate((cx, seed, count), frozen, scratch, |set| set)
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        self.0.calibrate(cx);
    }

    fn complaint(&self) -> Option<Complaint> {
        self.0.complaint()
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_query(cx)
    }
}
