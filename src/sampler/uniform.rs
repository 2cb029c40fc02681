use super::{GaveUp, Sampler};
use crate::context::Context;
use crate::methods::Complaint;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use crate::validity::Scratch;
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

fn default_attempts() -> u64 {
    1_000_000
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
        let mut q = vec![0.0; cx.space.len()];
        for _ in 0..count {
            let mut attempts = 0;
            loop {
                if attempts == self.attempts {
                    return Err(GaveUp { attempts });
                }
                attempts += 1;
                cx.space.sample_uniform(&mut stream, &mut q);
                if cx.validity.valid(&q, scratch) {
                    break;
                }
            }
            out.push(&q);
        }
        Ok(())
    }

    fn complaint(&self) -> Option<Complaint> {
        (self.attempts == 0).then(|| ("attempts", "0".to_owned(), "at least 1"))
    }
}
