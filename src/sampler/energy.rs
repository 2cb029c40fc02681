use super::{GaveUp, Sampler, collect, default_attempts, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Sampling by energy: configurations drawn uniformly and kept by chance, the lower their energy the more often
/// (A. P. Singh, J.-C. Latombe, D. L. Brutlag, *A motion planning approach to flexible ligand binding*, 1999; G. Song,
/// N. M. Amato, *Using motion planning to study protein folding pathways*, 2002, keep a conformation of energy E
/// with probability 1 below E_min, (E_max − E) / (E_max − E_min) between, and 0 above E_max).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Energy {
    /// Up to this energy every valid configuration is kept.
    pub always: f64,
    /// From this energy on none is.
    pub never: f64,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Energy {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(always: f64, never: f64) -> Energy {
        Energy { always, never, attempts: default_attempts() }
    }
}

impl Sampler for Energy {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let mut chance = seed.stream(Purpose::Accepting);
        collect(count, self.attempts, out, |q| {
            cx.space.sample_uniform(&mut stream, q);
            // Drawn for every configuration, so that no energy shifts the numbers of later ones.
            let drawn = chance.unit();
            let Some(energy) = cx.model.energy(q, scratch) else { return false };
            let share = (self.never - energy) / (self.never - self.always);
            drawn < share && cx.model.is_valid(q, scratch)
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        if !(self.always.is_finite() && self.never.is_finite() && self.always < self.never) {
            let found = format!("{} beside always = {}", self.never, self.always);
            return Some(Complaint::new("never", found, "a finite energy above that of always"));
        }
        zero("attempts", self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        // A model has an energy everywhere or nowhere.
        let mut middle = vec![0.0; cx.space.len()];
        cx.space.of_cube(&vec![0.5; cx.space.cube_dimensions()], &mut middle);
        match cx.model.energy(&middle, &mut Scratch::new()) {
            Some(_) => Ok(()),
            None => Err("sampling by energy found, a model with energies expected".to_owned()),
        }
    }
}
