//! How well two workers use two cores, and what the coordinator costs.
//!
//! ```text
//! cargo bench -p roadmill-coordinator --bench scaling [-- NODES]
//! ```
//!
//! The cage without its query is built up to NODES nodes (default 80 000, over 20 CPU seconds), five
//! times in turn: by one build with two workers, then by two independent builds with one worker
//! each, side by side. The machine slows two busy cores down alike in both, so the ratio
//!
//! ```text
//! mean time of the two builds side by side / (2 × time of the build with two workers)
//! ```
//!
//! is the share of the speed-up of two independent builds that two workers of one build reach.

#[path = "support/cage.rs"]
mod cage;

use cage::cage;
use std::path::Path;
use std::process::{Child, Command, Stdio};

const ROUNDS: usize = 5;

/// Of a run: what its summary says.
struct Run {
    wall: f64,
    cpu: f64,
    coordinator: f64,
    digest: String,
}

fn main() {
    let nodes = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(80_000u64);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let problem = cage(folder.path(), nodes);
    let (mut ratios, mut shares) = (Vec::new(), Vec::new());
    println!("round  2 workers  side by side (mean)  share of speed-up  CPU     coordinator");
    for round in 0..ROUNDS {
        let out = |name: &str| folder.path().join(format!("{name}{round}"));
        let both = finish(start(&problem, 2, &out("both")), &out("both"));
        let (left, right) = (start(&problem, 1, &out("left")), start(&problem, 1, &out("right")));
        let (left, right) = (finish(left, &out("left")), finish(right, &out("right")));
        assert!(both.digest == left.digest && both.digest == right.digest, "the same bits");
        let beside = (left.wall + right.wall) / 2.0;
        ratios.push(beside / (2.0 * both.wall));
        shares.push(100.0 * both.coordinator / both.cpu);
        println!(
            "{:5}  {:7.2} s  {beside:18.2} s  {:17.3}  {:5.1} s  {:.2} s = {:.2} %",
            round + 1,
            both.wall,
            ratios[round],
            both.cpu,
            both.coordinator,
            shares[round],
        );
    }
    println!("median share of speed-up {:.3}", median(&mut ratios));
    println!("median coordinator share of CPU {:.2} %", median(&mut shares));
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn start(problem: &Path, workers: usize, out: &Path) -> Child {
    Command::new(env!("CARGO_BIN_EXE_roadmill"))
        .arg("build")
        .arg(problem)
        .args(["--workers", &workers.to_string(), "--json", "--out"])
        .arg(out)
        .stdout(Stdio::null())
        .spawn()
        .expect("roadmill starts")
}

fn finish(mut child: Child, out: &Path) -> Run {
    assert!(child.wait().expect("it can be waited for").success());
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let number = |key: &str| summary[key].as_f64().expect("a number");
    Run {
        wall: number("wall_seconds"),
        cpu: number("cpu_seconds"),
        coordinator: number("coordinator_cpu_seconds"),
        digest: summary["digest"].to_string(),
    }
}
