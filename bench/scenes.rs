//! What it takes to solve scenes, at their default settings or with another sampler or joins.
//!
//! ```text
//! cargo bench --bench scenes -- [--seeds N] [--seconds S] [--sampler 'bridge = { deviation = 0.5 }'] \
//!     [--among 'until-joined = {}'] [--sets-per-round K] SCENE …
//! ```
//!
//! Builds every scene with seeds 1 to N (default 5) in this thread, until all its criteria are met or S
//! CPU seconds (default 300) have gone by, whatever its limits, and prints one line per scene: in how many builds the
//! criteria were met, then nodes, configurations and motions asked for, and CPU seconds as median
//! (least–most) over all builds, met or not.

mod support;

use roadmill::img::Setup;
use roadmill::problem::Problem;
use std::path::Path;
use std::sync::Arc;
use support::{Solved, arguments, median, solve};

fn main() {
    let arguments = arguments(5.0, 300.0);
    let seeds = arguments.seeds;
    println!("| scene | solved | nodes | configurations | motions | CPU s |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for scene in &arguments.scenes {
        let problem = Problem::load(Path::new(scene)).unwrap_or_else(|error| panic!("{error}"));
        let most = u64::from(u32::MAX / 2);
        let mut builder = problem.to_builder().most_nodes(most).most_sets(most);
        if let Some(sets) = arguments.sets_per_round {
            builder = builder.sets_per_round(sets);
        }
        let builder = builder.change_strategies(|mut strategy| {
            if let Some(sampler) = &arguments.sampler {
                strategy = strategy.sampler(sampler.clone());
            }
            match &arguments.among {
                Some(among) => strategy.among(among.clone()),
                None => strategy,
            }
        });
        let problem = builder.build().unwrap_or_else(|error| panic!("{error}"));
        let builds: Vec<Solved> = (1..=seeds)
            .map(|seed| {
                let setup = Setup::new(problem.clone().with_seed(seed));
                solve(&Arc::new(setup), arguments.seconds)
            })
            .collect();
        let solved = builds.iter().filter(|build| build.satisfied).count();
        let spread = |digits: usize, of: fn(&Solved) -> f64| {
            let mut values: Vec<f64> = builds.iter().map(of).collect();
            let middle = median(&mut values);
            let (least, most) = (values[0], values[values.len() - 1]);
            format!("{middle:.digits$} ({least:.digits$}–{most:.digits$})")
        };
        println!(
            "| {} | {solved} of {seeds} | {} | {} | {} | {} |",
            problem.name(),
            spread(0, |build| build.nodes as f64),
            spread(0, |build| build.asked.configurations as f64),
            spread(0, |build| build.asked.motions as f64),
            spread(2, |build| build.seconds)
        );
    }
}
