use super::{GaveUp, Sampler, collect, default_attempts, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::scene::LENGTH_MAX;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Milestones about configurations that a user gives, in turn: a user's own idea of where a part or a ligand could be (O. B. Bayazit, PhD
/// thesis, 2003, chapter V D 3, takes them from a haptic device).
///
/// Milestone m of all sets of the strategy is about configuration m modulo their number. The first time around it is the configuration itself,
/// if that is valid; else, and later, one that is drawn uniformly from the ball about it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// The configurations.
    pub configurations: Vec<Vec<f64>>,
    /// The radius of the balls, in the metric of the space.
    #[serde(default = "default_radius")]
    pub radius: f64,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

fn default_radius() -> f64 {
    1.0
}

impl Given {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(configurations: Vec<Vec<f64>>) -> Given {
        Given { configurations, radius: default_radius(), attempts: default_attempts() }
    }
}

impl Sampler for Given {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let given = self.configurations.len() as u64;
        let first = seed.ordinal().0.saturating_mul(count as u64);
        // They were looked at when the problem was read; bytes from elsewhere may hold anything.
        let is_sound = |q: &Vec<f64>| q.len() == cx.space.len();
        if self.configurations.is_empty() || !self.configurations.iter().all(is_sound) {
            return Err(GaveUp { attempts: 0 });
        }
        for milestone in (first..).take(count) {
            let mut about = self.configurations[(milestone % given) as usize].clone();
            if cx.space.canonicalize(&mut about).is_err() {
                return Err(GaveUp { attempts: 0 });
            }
            if milestone < given && cx.model.is_valid(&about, scratch) {
                out.push(&about);
                continue;
            }
            collect(1, self.attempts, out, |q| {
                cx.space.step_within(&about, self.radius, &mut stream, q);
                cx.model.is_valid(q, scratch)
            })?;
        }
        Ok(())
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.configurations.is_empty() {
            return Some(Complaint::new("configurations", "[]", "at least one configuration"));
        }
        Complaint::of_length("radius", self.radius, LENGTH_MAX)
            .or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        for (number, q) in self.configurations.iter().enumerate() {
            cx.stored(&mut q.clone())
                .map_err(|message| format!("configurations[{number}]: {message}"))?;
        }
        Ok(())
    }
}
