//! Samplers compared: what each costs until a problem's criteria are met.
//!
//! ```text
//! cargo bench --bench samplers -- [--seeds N] [--seconds S] problems/cage.toml \
//!     'uniform = {}' 'bridge = { deviation = 0.5 }'
//! ```
//!
//! Words with `=` are samplers as a problem file names them; the others are problems, built with each of the
//! samplers in the place of their strategies' own, with seeds 1 to N (default 5), until all their criteria
//! are met or S CPU seconds (default 30) have gone by. Prints in how many builds they were met, the nodes of
//! every build, and the medians over all builds, met or not, of what was asked for: motions, configurations.
//! Before, what one of 1000 milestones costs: configurations and clearances asked for, CPU microseconds.

mod support;

use roadmill::Context;
use roadmill::img::Setup;
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::roadmap::Configs;
use roadmill::sampler::SamplerKind;
use roadmill::seed::Seed;
use std::path::Path;
use std::sync::Arc;
use support::{Solved, arguments, cpu_seconds, median, method, solve};

fn main() {
    let arguments = arguments(5.0, 30.0);
    let (samplers, problems): (Vec<&String>, Vec<&String>) =
        arguments.scenes.iter().partition(|word| word.contains('='));
    println!(
        "| problem | sampler | asked each | µs each | solved | nodes | motions | configurations |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for path in problems {
        let loaded = Problem::load(Path::new(path)).unwrap_or_else(|error| panic!("{error}"));
        for text in &samplers {
            let sampler: SamplerKind = method(text);
            let cost = cost(&loaded.context(), &sampler);
            let builder = loaded.to_builder();
            let problem = builder.change_strategies(|s| s.sampler(sampler.clone())).build();
            let problem = problem.unwrap_or_else(|error| panic!("{error}"));
            let builds: Vec<Solved> = (1..=arguments.seeds)
                .map(|seed| {
                    let setup = Setup::new(problem.clone().with_seed(seed));
                    solve(&Arc::new(setup), arguments.seconds)
                })
                .collect();
            let solved = builds.iter().filter(|build| build.satisfied).count();
            let nodes: Vec<String> = builds.iter().map(|build| build.nodes.to_string()).collect();
            let middle = |of: fn(&Solved) -> u64| {
                median(&mut builds.iter().map(|build| of(build) as f64).collect::<Vec<f64>>())
            };
            println!(
                "| {} | `{text}` | {cost} | {solved} of {} | {} | {} | {} |",
                problem.name(),
                arguments.seeds,
                nodes.join(" "),
                middle(|build| build.asked.motions),
                middle(|build| build.asked.configurations)
            );
        }
    }
}

/// What one of 1000 milestones costs: configurations asked for, CPU microseconds.
fn cost(cx: &Context, sampler: &SamplerKind) -> String {
    let method = sampler.method();
    assert_eq!((method.complaint(), method.suits(cx)), (None, Ok(())));
    let (mut scratch, mut configs) = (Scratch::new(), Configs::new(cx.space().len()));
    let begun = cpu_seconds();
    let seed = Seed::of_set(1, "cost", Ordinal(0));
    let done = method.sample(cx, &seed, 1000, &mut scratch, &mut configs);
    let micros = (cpu_seconds() - begun) * 1e3;
    done.unwrap_or_else(|error| panic!("{sampler:?}: {error}"));
    format!("{:.1} | {micros:.1}", scratch.take_asked().configurations as f64 / 1e3)
}
