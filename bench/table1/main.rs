//! The experiment of TR05-007 §4.2 and its Table 1.
//!
//! ```text
//! cargo bench --bench table1 -- [--seeds N] [--n N --k K] [--out FOLDER] [--set 'KEY = VALUE'] … [ENVIRONMENT …] [STRATEGY …]
//! ```
//!
//! One build for each environment and each strategy (default: all of `environments.rs`) and each of the seeds
//! 1 to N (default 30). A build serves all three evaluators: after every round those that have not been
//! satisfied yet are asked, and the roadmap is measured as it is when one first is. It ends when all have
//! been, or at the cap; then what is missing is measured on the last roadmap, and counted as capped.
//! Coverage and connectivity share 100 uniform samples, drawn anew for every seed. The independent tests are
//! 100 configurations, the same for all builds of an environment, in equal parts from every strategy. Sets
//! have n nodes, rounds k sets; without `--n` and `--k` both n = 50, k = 5 and n = 50, k = 1 are run.
//!
//! `--set` changes what `choices.rs` lists, for example `--set 'nodes = 20000'` or
//! `--set 'planners = ["straight-line"]'`. FOLDER (default: in the target folder) gets `runs.csv`, a line per
//! build and evaluator, and `table1.svg`. Builds that are in `runs.csv` are not run again.

#[path = "../support/mod.rs"]
mod support;

mod choices;
mod environments;
mod picture;
mod report;
mod runs;

use choices::Choices;
use environments::{ENVIRONMENTS, Environment, STRATEGIES};
use roadmill::evaluate::{EvaluatorKind, Query, Samples};
use roadmill::img::{Setup, Stop};
use roadmill::numbers::StrategyIndex;
use runs::{Measured, Run};
use std::path::PathBuf;
use std::sync::Arc;
use support::noting::note;

struct Arguments {
    seeds: u64,
    shapes: Vec<[u32; 2]>,
    out: PathBuf,
    choices: Choices,
    environments: Vec<&'static Environment>,
    strategies: Vec<&'static str>,
}

fn arguments() -> Arguments {
    let (mut seeds, mut shape, mut sets) = (30, [None; 2], String::new());
    let mut out = PathBuf::from(concat!(env!("CARGO_TARGET_TMPDIR"), "/table1"));
    let (mut environments, mut strategies) = (Vec::new(), Vec::new());
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("a value after {word} expected"));
        let number = |text: String| {
            text.parse().unwrap_or_else(|_| panic!("{text} found; a number expected"))
        };
        match word.as_str() {
            "--seeds" => seeds = number(value()),
            "--n" => shape[0] = Some(number(value()) as u32),
            "--k" => shape[1] = Some(number(value()) as u32),
            "--out" => out = PathBuf::from(value()),
            "--set" => sets = sets + &value() + "\n",
            name => match STRATEGIES.into_iter().find(|known| *known == name) {
                Some(strategy) => strategies.push(strategy),
                None => environments.push(environment_of(name)),
            },
        }
    }
    if environments.is_empty() {
        environments = ENVIRONMENTS.iter().collect();
    }
    if strategies.is_empty() {
        strategies = STRATEGIES.into();
    }
    let shapes = match shape {
        [None, None] => vec![[50, 5], [50, 1]],
        [n, k] => vec![[n.unwrap_or(50), k.unwrap_or(5)]],
    };
    let choices = toml::from_str(&sets).unwrap_or_else(|error| panic!("--set: {error}"));
    Arguments { seeds, shapes, out, choices, environments, strategies }
}

fn environment_of(name: &str) -> &'static Environment {
    let found = ENVIRONMENTS.iter().find(|environment| environment.name == name);
    found.unwrap_or_else(|| panic!("{name} found; an environment or a strategy expected"))
}

fn main() {
    let Arguments { seeds, shapes, out, choices, environments, strategies } = arguments();
    std::fs::create_dir_all(&out).unwrap_or_else(|error| panic!("{}: {error}", out.display()));
    let is_available = |name: &&str| choices.sampler(&ENVIRONMENTS[0], name).is_some();
    let available: Vec<&str> = STRATEGIES.into_iter().filter(is_available).collect();
    choices.settle(&out, &available);
    let path = out.join("runs.csv");
    let mut runs = runs::load(&path);
    let experiments: Vec<Experiment> =
        environments.iter().map(|environment| Experiment::new(environment, &choices)).collect();
    for seed in 1..=seeds {
        for experiment in &experiments {
            for [n, k] in &shapes {
                for strategy in available.iter().filter(|name| strategies.contains(name)) {
                    let environment = experiment.environment.name.to_owned();
                    let run =
                        Run { environment, n: *n, k: *k, strategy: (*strategy).to_owned(), seed };
                    if runs.iter().all(|measured| measured.run != run) {
                        let measured = experiment.measure(run);
                        runs::append(&path, &measured);
                        runs.push(measured);
                    }
                }
            }
        }
    }
    runs.retain(|measured| {
        measured.run.seed <= seeds && strategies.contains(&&*measured.run.strategy)
    });
    for shape in &shapes {
        report::table(&environments, *shape, &runs, &choices);
    }
    let picture = picture::draw(&environments, &shapes, &runs);
    std::fs::write(out.join("table1.svg"), picture).expect("the picture can be written");
    println!("\nThe runs are in {}.", out.display());
}

/// What the builds of an environment have in common.
struct Experiment<'a> {
    environment: &'a Environment,
    choices: &'a Choices,
    tests: Samples,
}

impl Experiment<'_> {
    fn new<'a>(environment: &'a Environment, choices: &'a Choices) -> Experiment<'a> {
        let tests =
            choices.hundred(environment, &choices.problem(environment).context(), (0, "tests"));
        Experiment { environment, choices, tests }
    }

    fn measure(&self, run: Run) -> Measured {
        let mut problem = self.choices.problem(self.environment);
        problem.seed = run.seed;
        problem.sets_per_round = run.k;
        let strategy = self.choices.strategy(self.environment, &run.strategy, run.n);
        problem.strategies = vec![strategy.expect("a strategy that is available")];
        problem.schedule = vec![StrategyIndex(0)];
        let setup = Arc::new(Setup::new(problem));

        let how = self.choices.attaching();
        let samples = self.choices.hundred(self.environment, &setup.cx, (run.seed, "samples"));
        let query = Query { neighbors: how.neighbors, planners: how.planners.clone() };
        let criteria = [
            EvaluatorKind::Query(query),
            how.coverage(samples.clone(), 95.0),
            how.connectivity(samples, 75.0),
        ];
        let tests = Some((&self.tests, &how));
        let (noted, stop) = note(&setup, &criteria, tests, self.choices.cap(), &mut |_| ());
        if let Stop::GaveUp { gave_up, .. } = stop {
            eprintln!("{run:?}: {gave_up}");
        }
        Measured { run, noted: noted.try_into().expect("one per criterion") }
    }
}
