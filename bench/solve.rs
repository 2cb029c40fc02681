//! How soon scenes are solved, beside OMPL's PRM: the same surfaces, metric resolution and query.
//!
//! ```text
//! ROADMILL_PEER=PEER cargo bench --bench solve -- [--seeds N] [--seconds S] SCENE …
//! ```
//!
//! PEER is `bench/peers/race.cpp`, built as `bench/race.rs` says. Builds every scene at default settings
//! with seeds 1 to N (default 20), each for at most S CPU seconds (default 60), ours and OMPL's in turn.
//! Prints a line of CSV for each: scene, program, seed, solved or not, nodes, CPU seconds; then a table
//! of the medians. A build that is not solved counts with the seconds that it took.

mod support;

use roadmill::img::Setup;
use std::path::Path;
use std::sync::Arc;
use support::peer::{run, scene_text, surfaces};
use support::{arguments, median, solve};

fn main() {
    let arguments = arguments(20.0, 60.0);
    let Ok(peer) = std::env::var("ROADMILL_PEER") else {
        println!("solve: skipped, ROADMILL_PEER does not name the built bench/peers/race.cpp");
        return;
    };
    let mut table = String::new();
    println!("scene,program,seed,solved,nodes,cpu_seconds");
    for scene in &arguments.scenes {
        let mut problem = surfaces(Path::new(scene));
        let name = problem.name.clone();
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(file("scene"), scene_text(&problem)).expect("the scene can be written");
        let ends = problem.query.as_ref().expect("a scene with a query");
        let values: Vec<_> = ends.start.iter().chain(&ends.goal).map(f64::to_string).collect();
        std::fs::write(file("query"), values.join(" ")).expect("the query can be written");

        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for seed in 1..=arguments.seeds {
            problem.seed = seed;
            let solved = solve(&Arc::new(Setup::new(problem.clone())), arguments.seconds);
            println!(
                "{name},roadmill,{seed},{},{},{:.4}",
                u8::from(solved.satisfied),
                solved.nodes,
                solved.seconds
            );
            ours.push(solved.seconds);
            let limit = arguments.seconds.to_string();
            let found =
                run(&peer, &["solve", &file("scene"), &file("query"), &seed.to_string(), &limit]);
            println!("{name},ompl,{seed},{},{},{:.4}", found[2], found[1], found[0]);
            theirs.push(found[0]);
        }
        let (ours, theirs) = (median(&mut ours), median(&mut theirs));
        table += &format!("| {name} | {ours:.2} | {theirs:.2} | {:.1} |\n", theirs / ours);
    }
    println!("\n| scene | CPU s, median | OMPL | ratio |\n| --- | --- | --- | --- |\n{table}");
}
