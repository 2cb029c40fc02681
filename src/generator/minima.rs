use super::Generator;
use crate::connect::WithinKind;
use crate::context::Context;
use crate::descent::DescentKind;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Configs, Increment, Roadmap};
use crate::sampler::{GaveUp, SamplerKind};
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Milestones drawn by a sampler, each followed by the local minimum of the energy below it (O. B. Bayazit, PhD thesis, 2003, chapter V
/// E: *"all local minimum nodes are added to the roadmap (with the previously generated nodes)"*).
///
/// Milestones with an even number, counted from 0, are as drawn; each other one is the minimum to which a descent from the one before
/// it leads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Minima {
    /// How milestones are sampled.
    pub sampler: SamplerKind,
    /// How the energy falls from there.
    #[serde(default)]
    pub descent: DescentKind,
    /// How the milestones of a set are connected with one another.
    #[serde(default)]
    pub within: WithinKind,
}

impl Minima {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(sampler: SamplerKind) -> Minima {
        Minima { sampler, descent: DescentKind::default(), within: WithinKind::default() }
    }
}

impl Generator for Minima {
    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        _frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let mut drawn = Configs::new(cx.space.len());
        self.sampler.method().sample(cx, seed, count.div_ceil(2), scratch, &mut drawn)?;
        // A seed of its own: what the sampler draws does not change with the descent.
        let mut stream = seed.part(0).stream(Purpose::Sampling);
        let mut configs = Configs::new(cx.space.len());
        let mut lowest = vec![0.0; cx.space.len()];
        for q in drawn.iter() {
            configs.push(q);
            if configs.len() < count {
                lowest.copy_from_slice(q);
                self.descent.method().descend(cx, &mut stream, &mut lowest, scratch);
                // A configuration is stored as it is read: what a descent leaves is in stored form but for rounding.
                configs.push(&lowest);
            }
        }
        let edges = self.within.method().connect(cx, seed, &configs, scratch);
        Ok(Increment { configs, edges, ..Increment::empty(cx.space.len()) })
    }

    fn reads_query(&self) -> bool {
        self.sampler.method().reads_query()
    }

    fn calibrate(&mut self, cx: &Context, seed: &Seed) {
        self.sampler.method_mut().calibrate(cx, seed);
    }

    fn complaint(&self) -> Option<Complaint> {
        let sampler = self.sampler.method().complaint();
        let descent = || self.descent.method().complaint();
        sampler.or_else(descent).or_else(|| self.within.method().complaint())
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.sampler.method().suits(cx)?;
        self.descent.method().suits(cx)?;
        self.within.method().suits(cx)
    }
}
