use super::{GaveUp, Sampler, collect, collides, default_attempts, no_length, obstructed, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Obstacle-based sampling: milestones at the surfaces of C-obstacles (N. M. Amato, O. B. Bayazit,
/// L. K. Dale, C. Jones, D. Vallejo, *OBPRM: An obstacle-based PRM for 3D workspaces*, 1998;
/// TR05-007 §4.1: *"first generating a random colliding (resp., collision-free) sample and searching along
/// a random direction until the sample becomes collision-free (resp., in collision)"*).
///
/// Draws a configuration and a direction uniformly and walks along the direction in steps until a walk that began in
/// collision is free, or one that began free collides. Then the last step is bisected, always keeping the half with
/// one free and one colliding end, and its free end becomes the milestone: within step / 2^halvings of a colliding
/// configuration in the space's metric. A walk that gets out of bounds is dropped, unless `bounds` says that being
/// out of bounds is to collide.
///
/// The paper draws its colliding configurations obstacle by obstacle; here they are uniform among all. The
/// closer milestones come to the surface, the fewer motions between them are free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Obprm {
    /// Which configurations walks start from.
    #[serde(default)]
    pub start: Start,
    /// Length of a step in the space's metric. Obstacles thinner than a step may be passed unnoticed.
    pub step: f64,
    /// How many times the last step is halved.
    #[serde(default = "default_halvings")]
    pub halvings: u32,
    /// The most steps of one walk.
    #[serde(default = "default_steps")]
    pub steps: u32,
    /// Whether being out of bounds is to collide, so that milestones also come to lie at the bounds.
    #[serde(default)]
    pub bounds: bool,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Obprm {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(step: f64) -> Obprm {
        Obprm {
            start: Start::default(),
            step,
            halvings: default_halvings(),
            steps: default_steps(),
            bounds: false,
            attempts: default_attempts(),
        }
    }
}

/// Which configurations the walks of [`Obprm`] start from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Colliding ones: they walk out of the obstacles.
    Colliding,
    /// Free ones: they walk up to the obstacles.
    Free,
    /// Whatever is drawn.
    #[default]
    Either,
}

fn default_steps() -> u32 {
    1000
}

fn default_halvings() -> u32 {
    2
}

const HALVINGS_MAX: u32 = 30;

impl Obprm {
    /// Draws `start` and walks from it. Returns whether the walk has found a milestone, which is then in `q`.
    fn walk(
        &self,
        cx: &Context,
        stream: &mut Stream,
        scratch: &mut Scratch,
        start: &mut [f64],
        q: &mut [f64],
    ) -> bool {
        let mut side = |q: &[f64]| collides(cx.model.validity(q, scratch), self.bounds);
        cx.space.sample_uniform(stream, start);
        let Some(inside) = side(start) else { return false };
        if inside && self.start == Start::Free || !inside && self.start == Start::Colliding {
            return false;
        }
        let direction = cx.space.direction(stream);
        let mut at = |length: f64| {
            cx.space.along(start, &direction, length, q);
            (side(q), cx.space.within_bounds(q))
        };
        for step in 1..=self.steps {
            let (last, here) = (f64::from(step - 1) * self.step, f64::from(step) * self.step);
            match at(here) {
                (None, _) => return false,
                // Outside the intervals of the space, which are convex: the walk never comes back.
                (Some(collides), false) if collides == inside => return false,
                (Some(collides), true) if collides == inside => continue,
                (Some(_), _) => {}
            }
            let (mut free, mut hit) = if inside { (here, last) } else { (last, here) };
            for _ in 0..self.halvings {
                let middle = (free + hit) / 2.0;
                match at(middle).0 {
                    None => return false,
                    Some(true) => hit = middle,
                    Some(false) => free = middle,
                }
            }
            cx.space.along(start, &direction, free, q);
            return true;
        }
        false
    }
}

impl Sampler for Obprm {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let mut start = vec![0.0; cx.space.len()];
        collect(count, self.attempts, out, |q| self.walk(cx, &mut stream, scratch, &mut start, q))
    }

    fn complaint(&self) -> Option<Complaint> {
        if let Some(complaint) = no_length("step", self.step) {
            return Some(complaint);
        }
        if self.halvings > HALVINGS_MAX {
            return Some(Complaint::new("halvings", self.halvings, "0 to 30"));
        }
        zero("steps", self.steps).or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        obstructed(cx, self.bounds)
    }
}
