use super::{GaveUp, Sampler};
use crate::context::Context;
use crate::methods::Complaint;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use crate::validity::{Scratch, State};
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
    /// Whether to be out of bounds is to collide, so that milestones also come to lie near the bounds.
    #[serde(default)]
    pub bounds: bool,
    /// The most pairs drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

fn default_attempts() -> u64 {
    1_000_000
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
        let mut near = vec![0.0; cx.space.len()];
        let mut far = near.clone();
        for _ in 0..count {
            let mut attempts = 0;
            let milestone = loop {
                if attempts == self.attempts {
                    return Err(GaveUp { attempts });
                }
                attempts += 1;
                cx.space.sample_uniform(&mut stream, &mut near);
                let distance = (self.deviation * stream.normal()).abs();
                cx.space.step(&near, distance, &mut stream, &mut far);
                let states = [&near, &far].map(|q| cx.validity.state(q, scratch));
                let collides = |state| match state {
                    State::Free => false,
                    State::Colliding => true,
                    State::OutOfBounds => self.bounds,
                };
                match states {
                    [State::Free, other] if collides(other) => break &near,
                    [other, State::Free] if collides(other) => break &far,
                    _ => {}
                }
            };
            out.push(milestone);
        }
        Ok(())
    }

    fn complaint(&self) -> Option<Complaint> {
        // Written so that NaN fails it.
        if !(self.deviation > 0.0 && self.deviation <= crate::scene::LENGTH_MAX) {
            return Some(("deviation", self.deviation.to_string(), "a positive length"));
        }
        (self.attempts == 0).then(|| ("attempts", "0".to_owned(), "at least 1"))
    }
}
