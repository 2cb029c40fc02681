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

mod support;

use roadmill::img::Setup;
use roadmill::problem::Problem;
use roadmill::sampler::SamplerKind;
use std::path::Path;
use std::sync::Arc;
use support::{Solved, arguments, median, solve};

fn main() {
    let arguments = arguments(5.0, 30.0);
    let (samplers, problems): (Vec<&String>, Vec<&String>) =
        arguments.scenes.iter().partition(|word| word.contains('='));
    println!("| problem | sampler | solved | nodes | motions | configurations |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for path in problems {
        let mut problem = Problem::load(Path::new(path)).unwrap_or_else(|error| panic!("{error}"));
        for text in &samplers {
            let sampler: SamplerKind =
                toml::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            let method = sampler.method();
            assert_eq!((method.complaint(), method.suits(&problem.context())), (None, Ok(())));
            problem.strategies.iter_mut().for_each(|strategy| strategy.sampler = sampler.clone());
            let builds: Vec<Solved> = (1..=arguments.seeds)
                .map(|seed| {
                    let setup = Setup::new(Problem { seed, ..problem.clone() });
                    solve(&Arc::new(setup), arguments.seconds)
                })
                .collect();
            let solved = builds.iter().filter(|build| build.satisfied).count();
            let nodes: Vec<String> = builds.iter().map(|build| build.nodes.to_string()).collect();
            let middle = |of: fn(&Solved) -> u64| {
                median(&mut builds.iter().map(|build| of(build) as f64).collect::<Vec<f64>>())
            };
            println!(
                "| {} | `{text}` | {solved} of {} | {} | {} | {} |",
                problem.name,
                arguments.seeds,
                nodes.join(" "),
                middle(|build| build.asked.motions),
                middle(|build| build.asked.configurations)
            );
        }
    }
}
