use crate::connect::{AmongKind, UntilJoined, WithinKind};
use crate::generator::{GeneratorKind, LocalTrees, Sample, SlidingTrees};
use crate::sampler::SamplerKind;
use crate::source::{Misfit, Reader};
use crate::strategy::Strategy;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

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

/// From how many nodes of the roadmap on there are trees at gaps in a problem that names no strategies: most queries are solved by fewer, and those that are not
/// lose little by it.
const GAPS_AFTER: u64 = 4000;

fn default_nodes() -> u64 {
    50
}

/// What stands in no file.
fn placeless<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
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

    /// Reads a strategy from a line: the name of a sampler or of a generator, with its usual settings, or
    /// `LABEL = { … }` with a table as it stands under `[[strategies]]`.
    ///
    /// # Errors
    /// Says what was found and what is expected.
    pub fn parse(text: &str) -> Result<StrategySpec, String> {
        let text = text.trim();
        let Some((label, table)) = text.split_once('=') else {
            return StrategySpec::named(text);
        };
        let label = label.trim();
        // As a document of its own, the table's keys are at the top.
        let document = format!("it = {}", table.trim());
        let mut document = DeTable::parse(&document)
            .map_err(|error| format!("{text}: {}", error.message()))?
            .into_inner();
        let Some(DeValue::Table(mut keys)) = document.remove("it").map(Spanned::into_inner) else {
            return Err(format!("{text}: LABEL = {{ sampler = … }} expected"));
        };
        keys.insert(placeless("label".into()), placeless(DeValue::String(label.into())));
        StrategySpec::of_table(&keys).map_err(|misfit| format!("{text}: {}", misfit.message()))
    }

    fn of_table(keys: &DeTable) -> Result<StrategySpec, Misfit> {
        StrategySpec::deserialize(Reader::of_table(keys, 0..0))
    }

    /// The strategy that is a sampler or a generator of this name with its usual settings.
    fn named(name: &str) -> Result<StrategySpec, String> {
        let with = |role: &str| {
            let settings = placeless(DeValue::Table(DeTable::new()));
            let method = DeTable::from_iter([(placeless(name.into()), settings)]);
            let keys = DeTable::from_iter([
                (placeless("label".into()), placeless(DeValue::String(name.into()))),
                (placeless(role.into()), placeless(DeValue::Table(method))),
            ]);
            StrategySpec::of_table(&keys)
        };
        let of_sampler = match with("sampler") {
            Ok(spec) => return Ok(spec),
            Err(misfit) => misfit.message().to_owned(),
        };
        let of_generator = match with("generator") {
            Ok(spec) => return Ok(spec),
            Err(misfit) => misfit.message().to_owned(),
        };
        // What is known but lacks a setting says so; what neither role knows is told with both lists.
        let is_unknown = |message: &str| message.starts_with("unknown variant");
        match (is_unknown(&of_sampler), is_unknown(&of_generator)) {
            (false, _) => Err(format!(
                "{name}: {of_sampler}; LABEL = {{ sampler = {{ {name} = {{ … }} }} }} says it"
            )),
            (true, false) => Err(format!(
                "{name}: {of_generator}; LABEL = {{ generator = {{ {name} = {{ … }} }} }} says it"
            )),
            (true, true) => {
                Err(format!("{name}: a sampler: {of_sampler}; a generator: {of_generator}"))
            }
        }
    }

    /// The label.
    pub fn name(&self) -> &str {
        &self.label
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
        let trees = GeneratorKind::SlidingTrees(SlidingTrees::default());
        StrategySpec::generated("trees", trees)
            .among(AmongKind::UntilJoined(UntilJoined::default()))
    }

    /// The third strategy of a problem with a query that names none, where the robot and the obstacles have gaps: trees from
    /// places where a gap of the one is at a gap of the others.
    pub(super) fn from_gaps() -> StrategySpec {
        let trees =
            GeneratorKind::LocalTrees(LocalTrees { after: GAPS_AFTER, ..LocalTrees::default() });
        StrategySpec::generated("gaps", trees).among(AmongKind::UntilJoined(UntilJoined::default()))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_a_name_or_a_label_with_a_table() {
        let uniform = StrategySpec::parse("uniform").expect("a sampler");
        assert_eq!(uniform, StrategySpec::uniform());
        let trees = StrategySpec::parse(" rrt-connect ").expect("a generator");
        assert_eq!((trees.name(), trees.sampler.is_none()), ("rrt-connect", true));
        let near = StrategySpec::parse("near = { sampler = { uniform = {} }, nodes = 7 }");
        assert_eq!(near, Ok(StrategySpec::uniform().label("near").nodes(7)));
        for (text, expected) in [
            ("unifrm", "unknown variant `unifrm`"),
            ("a = 3", "LABEL = { sampler = … } expected"),
            ("a = { sampler = { uniform = {} }, node = 7 }", "unknown field `node`"),
            ("a = { sampler", "a = { sampler: "),
        ] {
            let error = StrategySpec::parse(text).expect_err(text);
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
