use super::{GaveUp, Sampler, collect, default_attempts, no_length, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{Scratch, Validity};
use crate::push::{Push, Search, retract};
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The step and the reach of a problem that names none, as shares of the largest distance in the space.
const STEP_SHARE: f64 = 0.01;
const REACH_SHARE: f64 = 0.1;

/// Milestones near contact: configurations drawn uniformly; one that collides is moved along the normals of its contacts until nothing touches (L. Zhang, D. Manocha, *An
/// efficient retraction-based RRT planner*, ICRA 2008, and their earlier planner with retraction, which samples so).
///
/// Where most of the space collides, as around narrow passages, nearly every draw becomes a milestone, and it lies at the border of an obstacle, so also in
/// passages: the share of milestones in a passage is about that of the configurations that collide beside it. Draws that are valid are kept as
/// they are, unless `free` is false.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Retraction {
    /// How far a configuration moves at a time, at most twice this, in the space's metric. If none is given, a hundredth of the largest distance in the space,
    /// found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The farthest that a colliding configuration is moved, in the space's metric. If none is given, a tenth of the largest distance in the space.
    #[serde(default)]
    pub reach: Option<f64>,
    /// Whether draws that are valid are kept.
    #[serde(default = "default_free")]
    pub free: bool,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

fn default_free() -> bool {
    true
}

impl Default for Retraction {
    fn default() -> Retraction {
        Retraction { step: None, reach: None, free: default_free(), attempts: default_attempts() }
    }
}

impl Sampler for Retraction {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let diameter = cx.space.diameter();
        let step = self.step.unwrap_or(STEP_SHARE * diameter);
        let reach = self.reach.unwrap_or(REACH_SHARE * diameter);
        let stream = seed.stream(Purpose::Sampling);
        let mut search = Search { cx, scratch, stream, step, reach, effort: 0 };
        collect(count, self.attempts, out, |q| {
            cx.space.sample_uniform(&mut search.stream, q);
            match cx.model.validity(q, search.scratch) {
                Validity::Valid => self.free,
                Validity::OutOfBounds => false,
                Validity::Invalid => match retract(q, &mut search) {
                    Some(retracted) => {
                        q.copy_from_slice(&retracted);
                        true
                    }
                    None => false,
                },
            }
        })
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        let of = |share: f64| Some(share * cx.space.diameter()).filter(|length| *length > 0.0);
        self.step = self.step.or_else(|| of(STEP_SHARE));
        self.reach = self.reach.or_else(|| of(REACH_SHARE));
    }

    fn complaint(&self) -> Option<Complaint> {
        let of = |key, length: Option<f64>| length.and_then(|length| no_length(key, length));
        of("step", self.step)
            .or_else(|| of("reach", self.reach))
            .or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        Push::Retraction.suits(cx)
    }
}
