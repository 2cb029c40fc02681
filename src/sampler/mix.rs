use super::{GaveUp, Sampler, SamplerKind};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use crate::wire::decode_nested;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Several samplers in one set: each milestone is drawn by one of them, chosen with a probability
/// proportional to its weight (as D. Hsu, T. Jiang, J. Reif, Z. Sun 2003 mix the bridge test with uniform
/// sampling).
///
/// First all choices are drawn, from a stream of their own. Then one sampler after the other draws as many milestones
/// as it was chosen for, with a seed of its own that follows from the set's. A mix gives up when one of its samplers
/// does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode)]
#[serde(transparent)]
pub struct Mix(pub Vec<Share>);

/// One of the samplers of a [`Mix`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// Its weight.
    #[serde(default = "default_weight")]
    pub weight: f64,
    /// The sampler.
    pub sampler: SamplerKind,
}

impl Share {
    /// A share of weight 1.
    pub fn new(sampler: SamplerKind) -> Share {
        Share { weight: default_weight(), sampler }
    }
}

fn default_weight() -> f64 {
    1.0
}

decode_nested!(Mix { 0 });

impl Mix {
    /// How many of `count` milestones each sampler is to draw.
    pub(super) fn counts(&self, seed: &Seed, count: usize) -> Vec<usize> {
        let mut stream = seed.stream(Purpose::Accepting);
        let whole: f64 = self.0.iter().map(|share| share.weight).sum();
        let mut counts = vec![0; self.0.len()];
        for _ in 0..count {
            let mut rest = stream.unit() * whole;
            let chosen = self.0.iter().position(|share| {
                rest -= share.weight;
                rest < 0.0
            });
            counts[chosen.unwrap_or(self.0.len() - 1)] += 1;
        }
        counts
    }

    fn methods(&self) -> impl Iterator<Item = &dyn Sampler> {
        self.0.iter().map(|share| share.sampler.method())
    }
}

impl Sampler for Mix {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let counts = self.counts(seed, count);
        for (index, (sampler, count)) in self.methods().zip(counts).enumerate() {
            sampler.sample(cx, &seed.part(index as u64), count, scratch, out)?;
        }
        Ok(())
    }

    fn reads_query(&self) -> bool {
        self.methods().any(Sampler::reads_query)
    }

    fn calibrate(&mut self, cx: &Context, seed: &Seed) {
        for (index, share) in self.0.iter_mut().enumerate() {
            share.sampler.method_mut().calibrate(cx, &seed.part(index as u64));
        }
    }

    fn is_within(&self, brackets: u32) -> bool {
        // { mix = [{ sampler = …
        brackets.checked_sub(3).is_some_and(|rest| self.methods().all(|each| each.is_within(rest)))
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.0.is_empty() {
            return Some(Complaint::new("mix", "[]", "at least one sampler"));
        }
        // Written so that NaN fails it; a sum of finite weights could overflow.
        let sound = |share: &&Share| share.weight > 0.0 && share.weight <= 1e9;
        if let Some(share) = self.0.iter().find(|share| !sound(share)) {
            return Some(Complaint::new("weight", share.weight, "more than 0, at most 1e9"));
        }
        self.methods().find_map(Sampler::complaint)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.methods().try_for_each(|sampler| sampler.suits(cx))
    }
}
