use super::gaussian::draw_pair;
use super::{GaveUp, Sampler, collect, collides, default_attempts, no_length, obstructed, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The bridge test: milestones in narrow passages (D. Hsu, T. Jiang, J. Reif, Z. Sun, *The bridge test for
/// sampling narrow passages with probabilistic roadmap planners*, 2003; TR05-007 §4.1).
///
/// Draws a configuration uniformly and a second one at distance d = |N(0, σ)| in the space's metric, in a
/// uniform direction. If both collide and the middle of the shortest motion between them is free, the
/// middle is kept. A configuration out of bounds counts as colliding only if `bounds` says so; else the
/// pair is dropped. The paper mixes these milestones with uniform ones ([`Mix`](super::Mix)), since they
/// lie in passages only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Bridge {
    /// σ, a length in the space's metric: about the width of the passages.
    pub deviation: f64,
    /// Whether being out of bounds is to collide, so that the ends of bridges may lie beyond the bounds.
    #[serde(default)]
    pub bounds: bool,
    /// The most pairs drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Bridge {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(deviation: f64) -> Bridge {
        Bridge { deviation, bounds: false, attempts: default_attempts() }
    }
}

impl Sampler for Bridge {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let (mut near, mut far) = (vec![0.0; cx.space.len()], vec![0.0; cx.space.len()]);
        collect(count, self.attempts, out, |middle| {
            draw_pair(cx, self.deviation, &mut stream, &mut near, &mut far);
            let mut pier = |q| collides(cx.model.validity(q, scratch), self.bounds) == Some(true);
            if !(pier(&near) && pier(&far)) {
                return false;
            }
            cx.space.interpolate(&near, &far, 0.5, middle);
            cx.space.canonicalize(middle).is_ok() && cx.model.is_valid(middle, scratch)
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        no_length("deviation", self.deviation).or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        obstructed(cx, self.bounds)
    }
}
