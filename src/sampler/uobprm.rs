use super::{GaveUp, Sampler, collect, collides, default_attempts, no_length, obstructed, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Uniform obstacle-based sampling: milestones spread evenly over the surfaces of C-obstacles (H.-Y. Yeh,
/// S. Thomas, D. Eppstein, N. M. Amato, *UOBPRM: A uniformly distributed obstacle-based PRM*, 2012;
/// H.-Y. Yeh's dissertation, 2016, §4.1).
///
/// Draws segments of a fixed length, their starts and directions uniform, and checks the configurations along each at
/// every step. Where one of two neighbours is free and the other collides, the free one becomes a milestone: it is
/// within a step of the surface. A segment may give several milestones; those that a set no longer needs are dropped.
/// A configuration out of bounds is taken as colliding if `bounds` says so, and else as neither free nor colliding.
/// Segments start within the bounds widened by their length (§4.1.1), or surfaces near the bounds would be hit less
/// often.
///
/// Corners and slivers of obstacles thinner than a step may lie between two steps and are hit less often, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
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
}

impl Uobprm {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(length: f64, step: f64) -> Uobprm {
        Uobprm { length, step, bounds: false, attempts: default_attempts() }
    }
}

/// The most steps of a segment.
const STEPS_MAX: f64 = 1e6;

impl Sampler for Uobprm {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let wide = cx.space.widened(self.length);
        let steps = (self.length / self.step) as u32;
        let mut start = vec![0.0; cx.space.len()];
        let mut last = start.clone();
        let mut found: VecDeque<Vec<f64>> = VecDeque::new();
        collect(count, self.attempts, out, |q| {
            if found.is_empty() {
                wide.sample_uniform(&mut stream, &mut start);
                let direction = cx.space.direction(&mut stream);
                let mut before = None;
                let mut kept = false;
                for i in 0..=steps {
                    cx.space.along(&start, &direction, f64::from(i) * self.step, q);
                    let now = collides(cx.model.validity(q, scratch), self.bounds);
                    match (before, now) {
                        // A free configuration between two that collide is a milestone once, not twice.
                        (Some(false), Some(true)) if !kept => found.push_back(last.clone()),
                        (Some(true), Some(false)) => found.push_back(q.to_vec()),
                        _ => {}
                    }
                    kept = (before, now) == (Some(true), Some(false));
                    before = now;
                    last.copy_from_slice(q);
                }
            }
            found.pop_front().is_some_and(|milestone| {
                q.copy_from_slice(&milestone);
                true
            })
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        let lengths = no_length("length", self.length).or_else(|| no_length("step", self.step));
        if lengths.is_some() {
            return lengths;
        }
        if !(self.length / STEPS_MAX..=self.length).contains(&self.step) {
            return Some(Complaint::new(
                "step",
                self.step,
                "a millionth of the length up to the length",
            ));
        }
        zero("attempts", self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        obstructed(cx, self.bounds)
    }
}
