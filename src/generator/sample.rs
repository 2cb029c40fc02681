use super::Generator;
use crate::connect::WithinKind;
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Configs, Increment, Roadmap};
use crate::sampler::{GaveUp, SamplerKind};
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Milestones drawn by a sampler, then connected with one another: the node sets of TR05-007, §3.1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Sample {
    /// How milestones are sampled.
    pub sampler: SamplerKind,
    /// How the milestones of a set are connected with one another.
    #[serde(default)]
    pub within: WithinKind,
}

impl Sample {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(sampler: SamplerKind) -> Sample {
        Sample { sampler, within: WithinKind::default() }
    }
}

impl Generator for Sample {
    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        _frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let mut configs = Configs::new(cx.space.len());
        self.sampler.method().sample(cx, seed, count, scratch, &mut configs)?;
        let edges = self.within.method().connect(cx, seed, &configs, scratch);
        Ok(Increment { configs, edges, ..Increment::empty(cx.space.len()) })
    }

    fn reads_query(&self) -> bool {
        self.sampler.method().reads_query()
    }

    fn calibrate(&mut self, cx: &Context, seed: &Seed) {
        self.sampler.method_mut().calibrate(cx, seed);
    }

    fn complaint(&self) -> Option<Complaint> {
        self.sampler.method().complaint().or_else(|| self.within.method().complaint())
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.sampler.method().suits(cx)?;
        self.within.method().suits(cx)
    }
}
