//! What the paper leaves open or this program does otherwise, to be changed one by one.

use super::environments::{Environment, STRATEGIES};
use crate::support::noting::{Attaching, Cap, listed};
use roadmill::Context;
use roadmill::connect::{AmongKind, ComponentPairs, Nearest, WithinKind};
use roadmill::evaluate::Samples;
use roadmill::local::{Planner, RotateAt};
use roadmill::problem::{Problem, StrategySpec};
use roadmill::sampler::SamplerKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The defaults are the paper's, where it has any.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Choices {
    /// A build ends with the round that reaches so many nodes, or so many CPU seconds.
    pub nodes: u64,
    pub seconds: f64,
    /// How many nearest nodes samples, tests, start and goal are attached to.
    pub neighbors: u32,
    /// Within sets, among them and for attaching; `among` has its own if it is given.
    pub planners: Vec<Planner>,
    pub among: Option<AmongKind>,
    /// The strategies that the evaluators' 100 samples and the 100 tests are drawn from, in equal parts.
    pub samples: Vec<String>,
    pub tests: Vec<String>,
    /// Problems to be taken for an environment instead of its own.
    pub scenes: BTreeMap<String, PathBuf>,
    /// Samplers to be used in the place of a strategy's.
    pub samplers: BTreeMap<String, SamplerKind>,
}

impl Default for Choices {
    fn default() -> Choices {
        Choices {
            nodes: 100_000,
            seconds: 60.0,
            neighbors: 10,
            planners: vec![Planner::StraightLine, Planner::RotateAt(RotateAt { percent: 50 })],
            among: None,
            samples: vec!["uniform".to_owned()],
            tests: STRATEGIES.map(str::to_owned).into(),
            scenes: BTreeMap::new(),
            samplers: BTreeMap::new(),
        }
    }
}

impl Choices {
    pub fn cap(&self) -> Cap {
        Cap { nodes: self.nodes, seconds: self.seconds }
    }

    pub fn attaching(&self) -> Attaching {
        Attaching { neighbors: self.neighbors, planners: self.planners.clone() }
    }

    pub fn problem(&self, environment: &Environment) -> Problem {
        let path = self.scenes.get(environment.name).cloned().unwrap_or_else(|| environment.path());
        Problem::load(&path).unwrap_or_else(|error| panic!("{error}"))
    }

    /// `None` if the program has no sampler of that name.
    pub fn sampler(&self, environment: &Environment, strategy: &str) -> Option<SamplerKind> {
        let sampler =
            self.samplers.get(strategy).cloned().or_else(|| environment.sampler(strategy))?;
        assert_eq!(sampler.method().complaint(), None, "{strategy}");
        Some(sampler)
    }

    /// 100 configurations; `label` is `samples` or `tests`.
    pub fn hundred(&self, environment: &Environment, cx: &Context, of: (u64, &str)) -> Samples {
        let names = if of.1 == "tests" { &self.tests } else { &self.samples };
        let samplers: Vec<SamplerKind> =
            names.iter().filter_map(|name| self.sampler(environment, name)).collect();
        let share = 100 / samplers.len().max(1);
        listed(cx, of, &samplers.iter().map(|sampler| (sampler, share)).collect::<Vec<_>>())
    }

    /// `None` as of [`Choices::sampler`].
    pub fn strategy(
        &self,
        environment: &Environment,
        label: &str,
        nodes: u32,
    ) -> Option<StrategySpec> {
        let planners = self.planners.clone();
        let pairs = ComponentPairs { planners: planners.clone(), ..ComponentPairs::default() };
        let within = WithinKind::Nearest(Nearest { planners, ..Nearest::default() });
        let strategy = StrategySpec::sampled(label, self.sampler(environment, label)?);
        let among = self.among.clone().unwrap_or(AmongKind::ComponentPairs(pairs));
        Some(strategy.nodes(nodes.into()).within(within).among(among))
    }

    /// Runs measured with other choices, or against other tests, must not stand in one file.
    pub fn settle(&self, folder: &Path, available: &[&str]) {
        let choices = toml::to_string(self).expect("choices are a table");
        let text = format!("# strategies: {}\n{choices}", available.join(" "));
        let path = folder.join("choices.toml");
        match std::fs::read_to_string(&path) {
            Ok(other) => assert_eq!(other, text, "{}: another --out expected", path.display()),
            Err(_) => std::fs::write(&path, text).expect("the choices can be written"),
        }
    }
}
