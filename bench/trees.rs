//! What trees that grow from a query's ends are worth: nodes and CPU time until solved, beside the defaults.
//!
//! ```text
//! cargo bench --bench trees -- [--seeds N] [--seconds S] [--generators NAME,…] [--shares SHARE,…] [PROBLEM …]
//! ```
//!
//! Every problem (default: walls, maze3d, hook and cage) is built in this thread with seeds 1 to N (default 5), until its
//! query is solved or S CPU seconds (default 60) have gone by: at its own settings, and with one strategy alone for each
//! of the generators (default `rrt-connect`; `rrt`, `rrg`, `mrrg` and `tree` are the others) and each step, as a share of
//! the space's diameter (default 0.2, which is the default of the generators). `tree` is joined by the default connection among sets, the
//! others, whose sets are joined as they grow, by `until-joined`. All other settings are the defaults. Medians over the
//! builds, and in brackets the least and the most; one that is not solved counts with what it had come to.

#[path = "support/mod.rs"]
mod support;

use roadmill::connect::{AmongKind, UntilJoined};
use roadmill::generator::GeneratorKind;
use roadmill::img::Setup;
use roadmill::problem::{Problem, StrategySpec};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use support::{Solved, arguments_with, median, method, solve};

fn main() {
    let (arguments, words) = arguments_with(5.0, 60.0, &["--generators", "--shares"]);
    let list = |word: usize, default: &str| -> Vec<String> {
        let text = words[word].as_deref().unwrap_or(default);
        text.split(',').map(str::to_owned).collect()
    };
    let (generators, shares) = (list(0, "rrt-connect"), list(1, "0.2"));
    let mut problems: Vec<PathBuf> = arguments.scenes.iter().map(PathBuf::from).collect();
    if problems.is_empty() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
        problems
            .extend(["walls", "maze3d", "hook", "cage"].map(|n| folder.join(format!("{n}.toml"))));
    }
    println!("| problem | sets | step | solved | nodes | CPU s |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for path in &problems {
        let problem = Problem::load(path).unwrap_or_else(|error| panic!("{error}"));
        let row = |name: &str, share: &str, change: &dyn Fn(&Problem) -> Problem| {
            let built: Vec<Solved> = (1..=arguments.seeds)
                .map(|seed| {
                    let problem = change(&problem.clone().with_seed(seed));
                    solve(&Arc::new(Setup::new(problem)), arguments.seconds)
                })
                .collect();
            let of = |of: &dyn Fn(&Solved) -> f64| {
                let mut values: Vec<f64> = built.iter().map(of).collect();
                (median(&mut values), values[0], values[values.len() - 1])
            };
            let nodes = of(&|solved| solved.nodes as f64);
            let seconds = of(&|solved| solved.seconds);
            println!(
                "| {} | {name} | {share} | {} of {} | {} ({}–{}) | {:.2} ({:.2}–{:.2}) |",
                problem.name(),
                built.iter().filter(|solved| solved.satisfied).count(),
                arguments.seeds,
                nodes.0,
                nodes.1,
                nodes.2,
                seconds.0,
                seconds.1,
                seconds.2,
            );
        };
        row("its own", "", &Problem::clone);
        for generator in &generators {
            for share in &shares {
                row(generator, share, &|problem| alone(problem, generator, share));
            }
        }
    }
}

/// The problem with one strategy, whose steps are a share of the space's diameter.
fn alone(problem: &Problem, generator: &str, share: &str) -> Problem {
    let share: f64 = share.parse().expect("a share is a number");
    let step = share * problem.space().diameter();
    let kind: GeneratorKind = method(&format!("{generator} = {{ step = {step:?} }}"));
    let strategy = StrategySpec::generated(generator, kind);
    let strategy = match generator {
        "tree" => strategy,
        _ => strategy.among(AmongKind::UntilJoined(UntilJoined::default())),
    };
    let problem = problem.to_builder().strategies(vec![strategy]).default_schedule().build();
    problem.unwrap_or_else(|error| panic!("{error}"))
}
