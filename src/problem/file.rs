//! What a problem asks for, before anything is checked, but for its model: the tables of a problem file, or what a
//! program gives a [`ProblemBuilder`](super::ProblemBuilder).

use super::goals::GoalsSpec;
use super::{ConfigurationSpec, StrategySpec};
use crate::evaluate::EvaluatorKind;
use crate::relaxation::Settings;
use crate::schedule::Adaptive;
use serde::Deserialize;

/// The keys of a problem file that every model has.
pub(super) const KEYS: [&str; 8] =
    ["name", "seed", "query", "img", "strategies", "evaluators", "limits", "relaxation"];

#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub(super) struct File {
    pub name: Option<String>,
    pub seed: Option<u64>,
    pub query: Option<QueryTable>,
    #[serde(default)]
    pub img: ImgTable,
    #[serde(default)]
    pub strategies: Vec<StrategySpec>,
    pub evaluators: Option<Vec<EvaluatorKind>>,
    #[serde(default)]
    pub limits: LimitsTable,
    pub relaxation: Option<Settings>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QueryTable {
    pub start: ConfigurationSpec,
    pub goal: GoalsSpec,
}

#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImgTable {
    pub sets_per_round: Option<u64>,
    pub schedule: Option<ScheduleTable>,
}

/// Labels over and over, or a policy.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected an array of labels, or { adaptive = { rounds = … } }")]
pub(super) enum ScheduleTable {
    Labels(Vec<String>),
    Policy(PolicyTable),
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum PolicyTable {
    Adaptive(Adaptive),
}

#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LimitsTable {
    pub nodes: Option<u64>,
    pub sets: Option<u64>,
    pub seconds: Option<f64>,
}
