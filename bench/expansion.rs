//! What the expansion step (Kavraki, Švestka, Latombe, Overmars 1996) is worth: nodes and CPU time until solved, with and
//! without it.
//!
//! ```text
//! cargo bench --bench expansion [-- --seeds N] [--seconds S] [PROBLEM …]
//! ```
//!
//! Every problem (default: maze3d, hook and, where `ROADMILL_DATA` is set, Twistycool) is built in this thread with seeds 1
//! to N (default 10), until its query is solved or S CPU seconds (default 60) have gone by: once with uniform sets of
//! 50 nodes alone, and once with every second set grown by an expansion step of as many nodes. A step is a
//! 200th of the space's diameter; all other settings are the defaults. Medians over the builds; one that is not solved counts with
//! what it had come to.

#[path = "support/mod.rs"]
mod support;

use roadmill::generator::GeneratorKind;
use roadmill::img::Setup;
use roadmill::problem::{Problem, StrategySpec};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use support::{Solved, median, solve};

const NODES: u64 = 50;

fn main() {
    let (mut seeds, mut seconds) = (10, 60.0);
    let mut problems: Vec<PathBuf> = Vec::new();
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        let mut number = || words.next().and_then(|word| word.parse().ok()).expect("a number");
        match &*word {
            "--seeds" => seeds = number() as u64,
            "--seconds" => seconds = number(),
            _ => problems.push(PathBuf::from(word)),
        }
    }
    if problems.is_empty() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
        problems.extend(["maze3d.toml", "hook.toml"].map(|name| folder.join(name)));
        match std::env::var_os("ROADMILL_DATA") {
            Some(data) => problems.push(Path::new(&data).join("scenes/ompl/Twistycool.cfg")),
            None => eprintln!("Twistycool is left out: ROADMILL_DATA is not set"),
        }
    }
    println!("| problem | sets | solved | nodes | CPU s |");
    println!("| --- | --- | --- | --- | --- |");
    for path in &problems {
        let problem = Problem::load(path).unwrap_or_else(|error| panic!("{error}"));
        for with in [false, true] {
            let built: Vec<Solved> = (1..=seeds)
                .map(|seed| solve(&Arc::new(Setup::new(changed(&problem, with, seed))), seconds))
                .collect();
            let middle = |of: &dyn Fn(&Solved) -> f64| {
                median(&mut built.iter().map(of).collect::<Vec<f64>>())
            };
            println!(
                "| {} | {} | {} of {seeds} | {} | {:.2} |",
                problem.name(),
                if with { "uniform, expansion" } else { "uniform" },
                built.iter().filter(|solved| solved.satisfied).count(),
                middle(&|solved| solved.nodes as f64),
                middle(&|solved| solved.seconds),
            );
        }
    }
}

/// The problem with uniform sets, or with uniform and expanding sets in turn.
fn changed(problem: &Problem, with: bool, seed: u64) -> Problem {
    let step = problem.space().diameter() / 200.0;
    let uniform = StrategySpec::from(&problem.strategies()[0])
        .nodes(NODES)
        .generator(kind("sample = { sampler = { uniform = {} } }"));
    let growing = uniform
        .clone()
        .label("expansion")
        .generator(kind(&format!("expansion-step = {{ step = {step:?} }}")));
    let strategies = if with { vec![uniform, growing] } else { vec![uniform] };
    let builder = problem.to_builder().seed(seed).most_nodes(1_000_000).sets_per_round(4);
    let problem = builder.strategies(strategies).default_schedule().build();
    problem.unwrap_or_else(|error| panic!("{error}"))
}

/// A generator as a problem file names it.
fn kind(text: &str) -> GeneratorKind {
    toml::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}
