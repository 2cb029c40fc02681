use super::{GaveUp, Sampler, collect, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// How far the middles of two gaps may be apart, as a share of the sum of their widths.
const FARTHEST: f64 = 0.75;

/// Milestones at which a gap of the robot is at a gap of the obstacles (after X. Zhang, R. Belfer, P. G. Kry, E. Vouga, *C-space tunnel discovery for puzzle
/// path planning*, ACM Transactions on Graphics 39, 2020).
///
/// A pair of gaps is drawn, and a configuration; then the robot's base is moved so that the middles of the two gaps come to within three quarters of the sum of the gaps' widths of each other, at
/// a distance drawn uniformly, in a uniform direction. If the configuration is valid it is kept. Tubes as thick as a gap then stand one within the
/// other's gap, as they do in the passages by which two hooks or open rings come apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Gaps {
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

fn default_attempts() -> u64 {
    20_000
}

impl Default for Gaps {
    fn default() -> Gaps {
        Gaps { attempts: default_attempts() }
    }
}

impl Sampler for Gaps {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let Some(gaps) = cx.model.gaps() else { return Err(GaveUp { attempts: 0 }) };
        let mut stream = seed.stream(Purpose::Sampling);
        collect(count, self.attempts, out, |q| {
            cx.space.sample_uniform(&mut stream, q);
            let pair = stream.below(gaps.pairs() as u64) as usize;
            let farthest = FARTHEST * gaps.widths(pair).iter().sum::<f64>();
            let way = [stream.normal(), stream.normal(), stream.normal()];
            let length = way.iter().map(|part| part * part).sum::<f64>().sqrt();
            let apart = farthest * stream.unit() / length.max(f64::MIN_POSITIVE);
            gaps.align(pair, way.map(|part| part * apart), q);
            cx.space.canonicalize(q).is_ok() && cx.model.is_valid(q, scratch)
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        zero("attempts", self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        match cx.model.gaps() {
            Some(_) => Ok(()),
            None => Err("a sampler at gaps found, but the robot or the obstacles have none, or the base is not moved in all directions".to_owned()),
        }
    }
}
