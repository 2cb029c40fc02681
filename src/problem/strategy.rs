use crate::connect::{AmongKind, UntilJoined, WithinKind};
use crate::generator::{GeneratorKind, RetractionTrees, Sample};
use crate::sampler::SamplerKind;
use crate::strategy::Strategy;
use serde::Deserialize;

/// How the node sets of one label are made and joined to the roadmap, as a problem asks for it: one of
/// `[[strategies]]`. Nothing is checked before the problem is built.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrategySpec {
    pub(super) label: String,
    #[serde(default = "default_nodes")]
    pub(super) nodes: u64,
    pub(super) sampler: Option<SamplerKind>,
    pub(super) within: Option<WithinKind>,
    pub(super) generator: Option<GeneratorKind>,
    #[serde(default)]
    pub(super) among: AmongKind,
}

fn default_nodes() -> u64 {
    50
}

impl StrategySpec {
    /// Sets whose milestones a sampler draws, under a label that no other strategy of the problem has.
    pub fn sampled(label: impl Into<String>, sampler: SamplerKind) -> StrategySpec {
        StrategySpec { sampler: Some(sampler), ..StrategySpec::labelled(label.into()) }
    }

    /// Sets that a generator makes, under a label that no other strategy of the problem has.
    pub fn generated(label: impl Into<String>, generator: GeneratorKind) -> StrategySpec {
        StrategySpec { generator: Some(generator), ..StrategySpec::labelled(label.into()) }
    }

    fn labelled(label: String) -> StrategySpec {
        StrategySpec {
            label,
            nodes: default_nodes(),
            sampler: None,
            within: None,
            generator: None,
            among: AmongKind::default(),
        }
    }

    /// Milestones per set (TR05-007: *n*); 50 if nothing is said.
    pub fn nodes(self, nodes: u64) -> StrategySpec {
        StrategySpec { nodes, ..self }
    }

    /// The label.
    pub fn label(self, label: impl Into<String>) -> StrategySpec {
        StrategySpec { label: label.into(), ..self }
    }

    /// The sampler, instead of the generator or sampler given before.
    pub fn sampler(self, sampler: SamplerKind) -> StrategySpec {
        StrategySpec { sampler: Some(sampler), generator: None, ..self }
    }

    /// The generator, instead of all that says how sets are sampled.
    pub fn generator(self, generator: GeneratorKind) -> StrategySpec {
        StrategySpec { sampler: None, within: None, generator: Some(generator), ..self }
    }

    /// How the milestones of a sampled set are connected with one another.
    pub fn within(self, within: WithinKind) -> StrategySpec {
        StrategySpec { within: Some(within), ..self }
    }

    /// How a set is connected with what came before it.
    pub fn among(self, among: AmongKind) -> StrategySpec {
        StrategySpec { among, ..self }
    }

    /// The strategy of a problem that names none: uniform sampling.
    pub(super) fn uniform() -> StrategySpec {
        StrategySpec::sampled("uniform", SamplerKind::default())
    }

    /// The second strategy of a problem with a query that names none: trees from both ends. What they grow hangs at the ends
    /// already, so that it is joined to other components only.
    pub(super) fn from_both_ends() -> StrategySpec {
        let trees = GeneratorKind::RetractionTrees(RetractionTrees::default());
        StrategySpec::generated("rrt-connect", trees)
            .among(AmongKind::UntilJoined(UntilJoined::default()))
    }

    /// What makes the sets: as `generator` says, or a sampler and a connection within sets, which stand in the
    /// table itself. Otherwise which key is wrong, and how.
    pub(super) fn maker(&self) -> Result<GeneratorKind, (&'static str, &'static str)> {
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

/// What makes the same strategy again.
impl From<&Strategy> for StrategySpec {
    fn from(strategy: &Strategy) -> StrategySpec {
        let spec = StrategySpec::labelled(strategy.label.clone())
            .nodes(strategy.nodes.into())
            .among(strategy.among.clone());
        match strategy.generator.as_sample() {
            Some(Sample { sampler, within }) => {
                spec.sampler(sampler.clone()).within(within.clone())
            }
            None => spec.generator(strategy.generator.clone()),
        }
    }
}
