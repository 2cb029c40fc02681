use super::segments::obstacle_surface::{ObstacleSurface, starts_near_obstacles};
use super::segments::{self, Segments};
use super::{GaveUp, Sampler, default_attempts, obstructed, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::de::{Decode, Decoder};
use bincode::enc::{Encode, Encoder};
use bincode::error::{DecodeError, EncodeError};
use serde::{Deserialize, Serialize};

/// Uniform obstacle-based sampling: milestones spread evenly over the surfaces of C-obstacles (H.-Y. Yeh,
/// S. Thomas, D. Eppstein, N. M. Amato, *UOBPRM: A uniformly distributed obstacle-based PRM*, 2012;
/// H.-Y. Yeh's dissertation, 2016, §4.1).
///
/// Draws segments of a fixed length, their starts and directions uniform, and checks the configurations along each at
/// every step. Where one of two neighbours is free and the other collides, the free one becomes a milestone: it is
/// within a step of the surface. A segment may give several milestones; those that a set no longer needs are dropped.
/// A configuration out of bounds is taken as colliding if `bounds` says so, and else as neither free nor colliding.
/// Segments start within the bounds widened by their length (§4.1.1), or surfaces near the bounds would be hit less
/// often. With `adjusted_bounds` they start only from where they may come to an obstacle, which changes nothing of the
/// distribution and takes fewer segments where the obstacles fill a small part of the bounds.
///
/// Corners and slivers of obstacles thinner than a step may lie between two steps and are hit less often, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uobprm {
    /// Length of a segment in the space's metric.
    pub length: f64,
    /// Distance of neighbouring configurations on a segment.
    pub step: f64,
    /// Whether being out of bounds is to collide, so that milestones also come to lie at the bounds.
    #[serde(default)]
    pub bounds: bool,
    /// The most segments laid for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
    /// Whether segments start within the obstacles' box widened by the robot's reach and the length, as far as that lies within the
    /// bounds widened by the length. It makes no difference where links must not touch one another, nor where the bounds are to
    /// collide, since then surfaces are not only near obstacles.
    #[serde(default, skip_serializing_if = "is_false")]
    pub adjusted_bounds: bool,
}

fn is_false(flag: &bool) -> bool {
    !flag
}

impl Uobprm {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(length: f64, step: f64) -> Uobprm {
        let attempts = default_attempts();
        Uobprm { length, step, bounds: false, attempts, adjusted_bounds: false }
    }
}

/// Two flags in one byte: 1 for `bounds`, which once was all that stood there, 2 for `adjusted_bounds`.
impl Encode for Uobprm {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        self.length.encode(encoder)?;
        self.step.encode(encoder)?;
        (u8::from(self.bounds) | u8::from(self.adjusted_bounds) << 1).encode(encoder)?;
        self.attempts.encode(encoder)
    }
}

impl<Context> Decode<Context> for Uobprm {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Uobprm, DecodeError> {
        let (length, step) = (f64::decode(decoder)?, f64::decode(decoder)?);
        let flags = u8::decode(decoder)?;
        if flags > 3 {
            return Err(DecodeError::Other("flags of uobprm above 3"));
        }
        let attempts = u64::decode(decoder)?;
        let (bounds, adjusted_bounds) = (flags & 1 != 0, flags & 2 != 0);
        Ok(Uobprm { length, step, bounds, attempts, adjusted_bounds })
    }
}
bincode::impl_borrow_decode!(Uobprm);

impl Sampler for Uobprm {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let Uobprm { length, step, bounds, attempts, adjusted_bounds } = *self;
        let starts = match adjusted_bounds {
            true => starts_near_obstacles(cx, length, bounds),
            false => cx.space.widened(length),
        };
        let segments = Segments { space: &cx.space, starts, length, step, attempts };
        let mut target = ObstacleSurface::new(cx, bounds);
        segments.sample(&mut target, &mut seed.stream(Purpose::Sampling), count, scratch, out)
    }

    fn complaint(&self) -> Option<Complaint> {
        segments::complaint(self.length, self.step).or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        obstructed(cx, self.bounds)
    }
}
