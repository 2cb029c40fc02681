//! How many nodes and CPU seconds it takes to solve scenes at their default settings.
//!
//! ```text
//! cargo bench --bench scenes -- [--seeds N] [--seconds S] SCENE …
//! ```
//!
//! Builds every scene with seeds 1 to N (default 5) in this thread, until all its criteria are met or S
//! CPU seconds (default 300) have gone by, and prints one line per scene: in how many builds the
//! criteria were met, then nodes and CPU seconds as median (least–most) over all builds, met or not.

mod support;

use roadmill::img::Setup;
use roadmill::problem::Problem;
use std::path::Path;
use std::sync::Arc;
use support::{arguments, median, solve};

fn main() {
    let arguments = arguments(5.0, 300.0);
    let seeds = arguments.seeds;
    println!("| scene | solved | nodes | CPU s |");
    println!("| --- | --- | --- | --- |");
    for scene in &arguments.scenes {
        let (mut satisfied, mut nodes, mut times) = (0, Vec::new(), Vec::new());
        let mut problem = Problem::load(Path::new(scene)).unwrap_or_else(|error| panic!("{error}"));
        for seed in 1..=seeds {
            problem.seed = seed;
            let solved = solve(&Arc::new(Setup::new(problem.clone())), arguments.seconds);
            satisfied += u64::from(solved.satisfied);
            nodes.push(solved.nodes as f64);
            times.push(solved.seconds);
        }
        let name = &problem.name;
        println!(
            "| {name} | {satisfied} of {seeds} | {} | {} |",
            spread(nodes, 0),
            spread(times, 2)
        );
    }
}

fn spread(mut values: Vec<f64>, digits: usize) -> String {
    let middle = median(&mut values);
    let (least, most) = (values[0], values[values.len() - 1]);
    format!("{middle:.digits$} ({least:.digits$}–{most:.digits$})")
}
