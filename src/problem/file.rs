//! The problem file as it is written, before anything is checked, but for the tables of its model.

use crate::connect::{AmongKind, WithinKind};
use crate::evaluate::EvaluatorKind;
use crate::generator::{GeneratorKind, Sample};
use crate::sampler::SamplerKind;
use crate::schedule::Adaptive;
use serde::Deserialize;

/// The keys of a problem file that every model has.
pub(super) const KEYS: [&str; 7] =
    ["name", "seed", "query", "img", "strategies", "evaluators", "limits"];

#[derive(Deserialize)]
pub(super) struct File {
    pub name: Option<String>,
    pub seed: Option<u64>,
    pub query: Option<QueryTable>,
    #[serde(default)]
    pub img: ImgTable,
    #[serde(default)]
    pub strategies: Vec<StrategyTable>,
    pub evaluators: Option<Vec<EvaluatorKind>>,
    #[serde(default)]
    pub limits: LimitsTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QueryTable {
    pub start: Vec<f64>,
    pub goal: Vec<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImgTable {
    pub sets_per_round: Option<u64>,
    pub schedule: Option<ScheduleTable>,
}

/// Labels over and over, or a policy.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected an array of labels, or { adaptive = { rounds = … } }")]
pub(super) enum ScheduleTable {
    Labels(Vec<String>),
    Policy(PolicyTable),
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum PolicyTable {
    Adaptive(Adaptive),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StrategyTable {
    pub label: String,
    #[serde(default = "default_nodes")]
    pub nodes: u64,
    pub sampler: Option<SamplerKind>,
    pub within: Option<WithinKind>,
    pub generator: Option<GeneratorKind>,
    #[serde(default)]
    pub among: AmongKind,
}

fn default_nodes() -> u64 {
    50
}

impl StrategyTable {
    /// The strategy of a problem that names none.
    pub fn uniform() -> StrategyTable {
        StrategyTable {
            label: "uniform".to_owned(),
            nodes: default_nodes(),
            sampler: Some(SamplerKind::default()),
            within: None,
            generator: None,
            among: AmongKind::default(),
        }
    }

    /// What makes the sets: as `generator` says, or a sampler and a connection within sets, which stand in the
    /// table itself. Otherwise which key is wrong, and how.
    pub fn generator(&self) -> Result<GeneratorKind, (&'static str, &'static str)> {
        match (&self.generator, &self.sampler) {
            (Some(_), Some(_)) => {
                Err(("sampler", "given beside generator; one of the two expected"))
            }
            (Some(_), None) if self.within.is_some() => {
                Err(("within", "given beside generator, which says it; one of the two expected"))
            }
            (Some(generator), None) => Ok(generator.clone()),
            (None, Some(sampler)) => {
                let within = self.within.clone().unwrap_or_default();
                Ok(GeneratorKind::Sample(Sample { sampler: sampler.clone(), within }))
            }
            (None, None) => Err(("label", "a strategy without `sampler` or `generator` found")),
        }
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LimitsTable {
    pub nodes: Option<u64>,
    pub sets: Option<u64>,
    pub seconds: Option<f64>,
}
