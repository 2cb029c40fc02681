use super::{GaveUp, Sampler, collect, collides, default_attempts, no_length, obstructed, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Gaussian sampling: milestones near obstacles (V. Boor, M. H. Overmars, A. F. van der Stappen, *The
/// Gaussian sampling strategy for probabilistic roadmap planners*, 1999; TR05-007 §4.1).
///
/// Draws a configuration uniformly and a second one at distance d = |N(0, σ)| in the space's metric, in a
/// uniform direction ([`Space::step`](crate::space::Space::step)). If one of the two is free and the
/// other collides, the free one is kept. A configuration out of bounds counts as colliding only if
/// `bounds` says so; else the pair is dropped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Gaussian {
    /// σ, a length in the space's metric.
    pub deviation: f64,
    /// Whether being out of bounds is to collide, so that milestones also come to lie near the bounds.
    #[serde(default)]
    pub bounds: bool,
    /// The most pairs drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Gaussian {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(deviation: f64) -> Gaussian {
        Gaussian { deviation, bounds: false, attempts: default_attempts() }
    }
}

impl Sampler for Gaussian {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let mut far = vec![0.0; cx.space.len()];
        collect(count, self.attempts, out, |near| {
            draw_pair(cx, self.deviation, &mut stream, near, &mut far);
            let states =
                [&*near, &far].map(|q| collides(cx.model.validity(q, scratch), self.bounds));
            if states == [Some(true), Some(false)] {
                near.copy_from_slice(&far);
            }
            matches!(states, [Some(a), Some(b)] if a != b)
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        no_length("deviation", self.deviation).or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        obstructed(cx, self.bounds)
    }
}

/// Draws `near` uniformly and `far` at distance |N(0, `deviation`)| from it, in a uniform direction.
pub(super) fn draw_pair(
    cx: &Context,
    deviation: f64,
    stream: &mut Stream,
    near: &mut [f64],
    far: &mut [f64],
) {
    cx.space.sample_uniform(stream, near);
    let distance = (deviation * stream.normal()).abs();
    cx.space.step(near, distance, stream, far);
}
