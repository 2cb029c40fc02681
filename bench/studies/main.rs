//! Studies of what TR05-007 leaves open, one at a time.
//!
//! ```text
//! cargo bench --bench studies -- combinations|rounds|schedule [--seeds N] [--nodes N] [--out FOLDER] [ENVIRONMENT …] [STRATEGY …]
//! ```
//!
//! - `combinations` (§5): criteria combined: at what size each stops, and what the roadmap is then worth.
//! - `rounds` (§3.2, §5): expansion and information gain over the rounds of one build, as `rounds.svg`.
//! - `schedule` (§3.1): a schedule that adapts beside equal shares.
//!
//! Environments and samplers are those of `bench/table1`. The strategies (default: all) make sets in turn, one
//! each in a round, and the tests are drawn from them. Builds have seeds 1 to N (default 5) and end at so many
//! nodes (default 30000). Whether coverage and connectivity gain by samples from several
//! strategies (§4.2) is a question to `bench/table1`, ways of merging (§5) are compared by `bench/merging.rs`.

#[path = "../table1/choices.rs"]
mod choices;
mod combinations;
#[path = "../table1/environments.rs"]
mod environments;
mod rounds;
mod schedule;
#[path = "../support/mod.rs"]
mod support;

use choices::Choices;
use environments::{ENVIRONMENTS, Environment, STRATEGIES};
use roadmill::numbers::StrategyIndex;
use roadmill::problem::Problem;
use std::path::PathBuf;

/// What a study is asked for.
#[allow(missing_docs)]
pub struct Study {
    pub seeds: u64,
    pub choices: Choices,
    pub out: PathBuf,
    pub environments: Vec<&'static Environment>,
}

impl Study {
    /// The problem with all strategies in turn: a round has one set of each.
    pub fn problem(&self, environment: &Environment, seed: u64) -> Problem {
        let mut problem = self.choices.problem(environment);
        problem.seed = seed;
        let labels = self.choices.tests.iter();
        let strategies = labels.map(|label| self.choices.strategy(environment, label, 50));
        problem.strategies = strategies.map(|each| each.expect("a sampler")).collect();
        problem.schedule = (0..problem.strategies.len() as u32).map(StrategyIndex).collect();
        problem.sets_per_round = problem.schedule.len() as u32;
        problem
    }
}

fn main() {
    let mut study = Study {
        seeds: 5,
        choices: Choices { nodes: 30_000, ..Choices::default() },
        out: PathBuf::from(env!("CARGO_TARGET_TMPDIR")),
        environments: Vec::new(),
    };
    let mut strategies = Vec::new();
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    let name = words.next().unwrap_or_default();
    while let Some(word) = words.next() {
        let mut number = || words.next().and_then(|word| word.parse().ok()).expect("a number");
        match word.as_str() {
            "--seeds" => study.seeds = number(),
            "--nodes" => study.choices.nodes = number(),
            "--out" => study.out = PathBuf::from(words.next().expect("a folder after --out")),
            other if STRATEGIES.contains(&other) => strategies.push(word),
            other => {
                let found = ENVIRONMENTS.iter().find(|environment| environment.name == other);
                study.environments.push(found.unwrap_or_else(|| panic!("{other}: no environment")));
            }
        }
    }
    if study.environments.is_empty() {
        study.environments = ENVIRONMENTS.iter().collect();
    }
    if !strategies.is_empty() {
        study.choices.tests = strategies;
    }
    match &*name {
        "combinations" => combinations::run(&study),
        "rounds" => rounds::run(&study),
        "schedule" => schedule::run(&study),
        _ => panic!("`{name}` found; combinations, rounds or schedule expected"),
    }
}
