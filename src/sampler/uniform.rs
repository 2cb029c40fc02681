use super::{GaveUp, Sampler, collect, default_attempts, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Uniform random sampling: configurations drawn uniformly from the space, the valid ones kept
/// (L. E. Kavraki, P. Švestka, J.-C. Latombe, M. H. Overmars, *Probabilistic roadmaps for path
/// planning in high-dimensional configuration spaces*, 1996, §III-A; TR05-007 §4.1: *"samples are
/// created by picking random values for all degrees of freedom"*).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Uniform {
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Default for Uniform {
    fn default() -> Uniform {
        Uniform { attempts: default_attempts() }
    }
}

impl Sampler for Uniform {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        collect(count, self.attempts, out, |q| {
            cx.space.sample_uniform(&mut stream, q);
            cx.model.is_valid(q, scratch)
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        zero("attempts", self.attempts)
    }
}
