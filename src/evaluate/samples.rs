//! The configurations by which coverage and connectivity judge a roadmap.

use super::Verdict;
use crate::context::Context;
use crate::local;
use crate::methods::{BRACKETS_OF_SETTINGS, Complaint};
use crate::model::{Asked, Scratch};
use crate::numbers::NodeId;
use crate::query::Attachment;
use crate::roadmap::{Configs, Roadmap};
use crate::sampler::SamplerKind;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

const SAMPLES_MAX: u32 = 1_000_000;
/// The most configurations drawn for one valid sample.
const ATTEMPTS_MAX: u32 = 1_000_000;

pub(super) fn default_samples() -> Samples {
    Samples::Random(100)
}

/// Where the samples come from. Samples are valid, the same in every round, and never become nodes of the roadmap or
/// connect parts of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Samples {
    /// That many samples, drawn uniformly among the valid configurations.
    Random(u32),
    /// The configurations of a list.
    Listed(Vec<Vec<f64>>),
    /// Samples drawn by several samplers: TR05-007 §4.2 expects *"improvement … when a mixture of
    /// configurations generated using different sampling strategies are used"*.
    Drawn(Vec<Drawn>),
}

/// Samples of one sampler.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Drawn {
    /// The sampler.
    pub sampler: SamplerKind,
    /// How many samples it draws.
    pub count: u32,
}

impl Samples {
    /// Whether a criterion with these samples, as a problem file writes it, has at most so many brackets within one
    /// another.
    pub(super) fn is_within(&self, brackets: u32) -> bool {
        let Samples::Drawn(parts) = self else { return brackets >= BRACKETS_OF_SETTINGS };
        // { coverage = { samples = { drawn = [{ sampler = …
        let rest = brackets.checked_sub(5);
        rest.is_some_and(|rest| parts.iter().all(|part| part.sampler.method().is_within(rest)))
    }

    pub(super) fn complaint(&self) -> Option<Complaint> {
        match self {
            Samples::Random(count) if !(2..=SAMPLES_MAX).contains(count) => {
                Some(Complaint::new("samples.random", count, "2 to 1000000"))
            }
            Samples::Listed(list) if list.len() < 2 => {
                Some(Complaint::new("samples.listed", list.len(), "at least 2 configurations"))
            }
            Samples::Drawn(parts) if parts.iter().any(|part| part.count == 0) => {
                Some(Complaint::new("samples.drawn: count", "0", "at least 1"))
            }
            Samples::Drawn(_) if !(2..=SAMPLES_MAX as usize).contains(&self.count()) => {
                Some(Complaint::new("samples.drawn", self.count(), "2 to 1000000 together"))
            }
            Samples::Drawn(parts) => {
                parts.iter().find_map(|part| part.sampler.method().complaint())
            }
            Samples::Random(_) | Samples::Listed(_) => None,
        }
    }

    /// Checks listed samples and brings them into stored form; checks whether samplers suit the problem.
    pub(super) fn accept(&mut self, cx: &Context) -> Result<(), String> {
        if let Samples::Drawn(parts) = self {
            for (index, part) in parts.iter().enumerate() {
                let suits = part.sampler.method().suits(cx);
                suits.map_err(|error| format!("samples.drawn[{index}]: {error}"))?;
            }
        }
        let Samples::Listed(list) = self else { return Ok(()) };
        for (index, q) in list.iter_mut().enumerate() {
            cx.accept(q).map_err(|error| format!("samples.listed[{index}]: {error}"))?;
        }
        Ok(())
    }

    fn configs(&self, cx: &Context, path: &str, scratch: &mut Scratch) -> Configs {
        let mut configs = Configs::new(cx.space.len());
        match self {
            Samples::Listed(list) => list.iter().for_each(|q| configs.push(q)),
            Samples::Drawn(parts) => {
                for (index, Drawn { sampler, count }) in parts.iter().enumerate() {
                    let seed = Seed::of_evaluator(cx.base_seed, path).part(index as u64);
                    // Samples that a sampler gave up looking for count as unreached.
                    let _ =
                        sampler.method().sample(cx, &seed, *count as usize, scratch, &mut configs);
                }
            }
            Samples::Random(count) => {
                let seed = Seed::of_evaluator(cx.base_seed, path);
                let mut stream = seed.stream(Purpose::Sampling);
                let mut q = vec![0.0; cx.space.len()];
                for _ in 0..*count {
                    // Where hardly any configuration is valid fewer samples are found; the others count as unreached.
                    for _ in 0..ATTEMPTS_MAX {
                        cx.space.sample_uniform(&mut stream, &mut q);
                        if cx.model.is_valid(&q, scratch) {
                            configs.push(&q);
                            break;
                        }
                    }
                }
            }
        }
        configs
    }

    fn count(&self) -> usize {
        match self {
            Samples::Random(count) => *count as usize,
            Samples::Listed(list) => list.len(),
            Samples::Drawn(parts) => parts.iter().map(|part| part.count as usize).sum(),
        }
    }

    /// Per sample the names of the components that it can be connected to. Each sample tries its nearest nodes, except
    /// those of components that it has reached already.
    pub(super) fn reached(
        &self,
        cx: &Context,
        path: &str,
        roadmap: &Roadmap,
        attachment: &Attachment,
        scratch: &mut Scratch,
    ) -> Vec<BTreeSet<NodeId>> {
        let configs = roadmap.configs();
        let mut reached = vec![BTreeSet::new(); self.count()];
        for (components, q) in reached.iter_mut().zip(self.configs(cx, path, scratch).iter()) {
            for neighbor in roadmap.k_nearest(&cx.space, q, attachment.neighbors as usize) {
                let node = NodeId(neighbor.id);
                let name = roadmap.components().of_node(node).name;
                let ends = (configs.get(node.index()), q);
                let planners = &attachment.planners;
                if !components.contains(&name)
                    && local::connect(cx, planners, ends, 1, scratch).is_some()
                {
                    components.insert(name);
                }
            }
        }
        reached
    }
}

/// The verdict on the share `part / whole`, which must be at least `threshold`.
pub(super) fn share(part: usize, whole: usize, threshold: f64, asked: Asked) -> Verdict {
    let value = if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
    Verdict::at_least(threshold, value, asked)
}

/// What is wrong with the settings that coverage and connectivity share.
pub(super) fn complaint(
    samples: &Samples,
    percent: f64,
    attachment: &Attachment,
) -> Option<Complaint> {
    if !(percent > 0.0 && percent <= 100.0) {
        return Some(Complaint::new("percent", percent, "more than 0, at most 100"));
    }
    samples.complaint().or_else(|| attachment.complaint())
}
