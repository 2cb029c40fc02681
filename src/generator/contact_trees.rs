use super::bent_trees::BentTrees;
use super::growth::{GrowingSet, needs_query};
use super::{Generator, Reads};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::push::Push;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Trees from both ends of the query as [`RetractionTrees`](super::RetractionTrees) grows them, whose blocked extensions are first retracted by the geometry of the contact: the
/// end of a blocked extension is moved along the normals of its contacts until nothing touches, and the tree is extended there, if that is nearer to where the
/// extension was to lead and the straight motion is valid (L. Zhang, D. Manocha, *An efficient retraction-based RRT planner*, ICRA 2008).
///
/// Where that leads nowhere, since the motion is blocked before its end, say, the extension is bent aside by trial, as there. The method is
/// defined for models that know contacts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(transparent)]
pub struct ContactTrees(pub BentTrees);

impl Generator for ContactTrees {
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
        self.0.generate((cx, seed, count), frozen, scratch, GrowingSet::with_retraction)
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
        needs_query(cx)?;
        Push::Retraction.suits(cx)
    }
}
