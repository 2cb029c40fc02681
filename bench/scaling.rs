//! How well two workers use two cores, and what the coordinator costs.
//!
//! ```text
//! cargo bench -p roadmill-coordinator --bench scaling [-- [NODES [SET]]]
//! cargo bench -p roadmill-coordinator --bench scaling -- memory [judged] [NODES [SET]]
//! ```
//!
//! The cage without its query is built up to NODES nodes (default 300 000) in sets of SET (default 50),
//! five times in turn: by one build with two workers, then by two independent builds with one worker
//! each, side by side. The machine slows two busy cores down alike in both, so the ratio
//!
//! ```text
//! mean time of the two builds side by side / (2 × time of the build with two workers)
//! ```
//!
//! is the share of the speed-up of two independent builds that two workers of one build reach. The last
//! columns say what the coordinator took, of all CPU time and per set, and what for.
//!
//! With *memory* it is built with 1, 2 and 4 workers. Per build: the most bytes that all processes held at
//! once, and what that is per node beyond a build of a tenth. *Judged* by an evaluator, so that workers keep edges.

#[path = "support/cage.rs"]
mod cage;
#[path = "support/memory.rs"]
mod memory;

use cage::cage;
use memory::peak_bytes;
use std::path::Path;
use std::process::{Child, Command, Stdio};

const ROUNDS: usize = 5;

/// Never satisfied.
const JUDGED: &str = "[[evaluators]]\nall = [{ coverage = {} }, { not = { coverage = {} } }]\n";

/// Of a run: what its summary says.
struct Run {
    wall: f64,
    cpu: f64,
    coordinator: f64,
    /// What the coordinator's seconds went into, by name.
    parts: serde_json::Value,
    sets: f64,
    digest: String,
}

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|word| word.parse::<u64>().ok());
    let nodes = numbers.next().unwrap_or(300_000);
    let set = numbers.next().unwrap_or(50);
    let folder = tempfile::tempdir().expect("a temporary folder");
    if std::env::args().any(|word| word == "memory") {
        hold(folder.path(), nodes, set);
    } else {
        scale(folder.path(), nodes, set);
    }
}

/// Memory by number of workers.
fn hold(folder: &Path, nodes: u64, set: u64) {
    println!("workers      bytes  per node  times one worker's");
    let mut one = None;
    for workers in [1, 2, 4] {
        let peak = |name: &str, nodes| {
            let out = folder.join(format!("{name}{workers}"));
            let problem = cage(folder, nodes, set);
            if std::env::args().any(|word| word == "judged") {
                let mut text = std::fs::read_to_string(&problem).expect("it was written");
                text.push_str(JUDGED);
                std::fs::write(&problem, text).expect("a problem can be written");
            }
            let mut child = start(&problem, workers, &out);
            let peak = peak_bytes(&mut child);
            finish(child, &out);
            peak
        };
        let (small, large) = (peak("small", nodes / 10), peak("large", nodes));
        let roadmap = large.saturating_sub(small) as f64;
        let times = roadmap / *one.get_or_insert(roadmap);
        println!("{workers:7} {large:10}  {:8.0}  {times:.2}", roadmap / (0.9 * nodes as f64));
    }
}

fn scale(folder: &Path, nodes: u64, set: u64) {
    let problem = cage(folder, nodes, set);
    let (mut ratios, mut shares) = (Vec::new(), Vec::new());
    println!(
        "round  2 workers  side by side (mean)  share of speed-up  CPU     coordinator; per set"
    );
    for round in 0..ROUNDS {
        let out = |name: &str| folder.join(format!("{name}{round}"));
        let both = finish(start(&problem, 2, &out("both")), &out("both"));
        let (left, right) = (start(&problem, 1, &out("left")), start(&problem, 1, &out("right")));
        let (left, right) = (finish(left, &out("left")), finish(right, &out("right")));
        assert!(both.digest == left.digest && both.digest == right.digest, "the same bits");
        let beside = (left.wall + right.wall) / 2.0;
        ratios.push(beside / (2.0 * both.wall));
        shares.push(100.0 * both.coordinator / both.cpu);
        println!(
            "{:5}  {:7.2} s  {beside:18.2} s  {:17.3}  {:5.1} s  {:.2} s = {:.2} %; {:.0} µs {}",
            round + 1,
            both.wall,
            ratios[round],
            both.cpu,
            both.coordinator,
            shares[round],
            both.coordinator * 1e6 / both.sets,
            both.parts,
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
    let status = child.wait().expect("it can be waited for");
    // 3: the limit came before what no roadmap satisfies.
    assert!(matches!(status.code(), Some(0 | 3)), "{status}");
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let number = |key: &str| summary[key].as_f64().expect("a number");
    Run {
        wall: number("wall_seconds"),
        cpu: number("cpu_seconds"),
        coordinator: number("coordinator_cpu_seconds"),
        parts: summary["coordinator_cpu"].clone(),
        sets: number("sets"),
        digest: summary["digest"].to_string(),
    }
}
