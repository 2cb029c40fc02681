//! What it takes to solve scenes, at their default settings or with another sampler or joins.
//!
//! ```text
//! cargo bench --bench scenes -- [--seeds N] [--seconds S] [--sampler 'bridge = { deviation = 0.5 }'] \
//!     [--among 'until-joined = {}'] SCENE …
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
        let mut problem = Problem::load(Path::new(scene)).unwrap_or_else(|error| panic!("{error}"));
        problem.limits.nodes = u64::from(u32::MAX / 2);
        problem.limits.sets = problem.limits.nodes;
        for strategy in &mut problem.strategies {
            if let Some(sampler) = &arguments.sampler {
                strategy.generator.as_sample_mut().expect("it samples").sampler = sampler.clone();
            }
            strategy.among = arguments.among.clone().unwrap_or(strategy.among.clone());
        }
        let builds: Vec<Solved> = (1..=seeds)
            .map(|seed| {
                let setup = Setup::new(Problem { seed, ..problem.clone() });
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
            problem.name,
            spread(0, |build| build.nodes as f64),
            spread(0, |build| build.asked.configurations as f64),
            spread(0, |build| build.asked.motions as f64),
            spread(2, |build| build.seconds)
        );
    }
}
