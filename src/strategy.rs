use crate::connect::{AmongKind, WithinKind};
use crate::context::Context;
use crate::roadmap::{Configs, Increment};
use crate::sampler::{GaveUp, SamplerKind};
use crate::seed::Seed;
use crate::validity::Scratch;
use bincode::{Decode, Encode};

/// How the node sets of one label are made and joined to the roadmap.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Strategy {
    /// Its name, unique in the problem: part of the seed of each of its sets.
    pub label: String,
    /// Milestones per set (TR05-007: *n*).
    pub nodes: u32,
    /// How milestones are sampled.
    pub sampler: SamplerKind,
    /// How the milestones of a set are connected with one another.
    pub within: WithinKind,
    /// How a set is connected with what came before it.
    pub among: AmongKind,
}

impl Strategy {
    /// Makes the set `ordinal` of this strategy: a pure function of the problem, the base seed,
    /// the label and the ordinal.
    ///
    /// # Errors
    /// When the sampler gives up.
    pub fn generate(
        &self,
        cx: &Context,
        ordinal: u64,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        scratch.take_asked();
        let seed = Seed::of_set(cx.base_seed, &self.label, ordinal);
        let mut configs = Configs::new(cx.space.len());
        let sampler = self.sampler.method();
        sampler.sample(cx, &seed, self.nodes as usize, scratch, &mut configs)?;
        let edges = self.within.method().connect(cx, &seed, &configs, scratch);
        Ok(Increment { configs, edges, asked: scratch.take_asked() })
    }
}
