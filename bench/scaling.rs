//! How well two workers use two cores, and what the coordinator costs.
//!
//! ```text
//! cargo bench -p roadmill-coordinator --bench scaling [-- [--rounds N] [--sampler SAMPLER] [NODES [SET]] [SCENE]]
//! cargo bench -p roadmill-coordinator --bench scaling -- memory [judged] [NODES [SET]] [SCENE]
//! cargo bench -p roadmill-coordinator --bench scaling -- agents [--rounds N] [--sampler SAMPLER] [NODES [SET]] [SCENE]
//! ```
//!
//! The cage, or SCENE with SAMPLER (`'obprm = { step = 2 }'`), without its query is built up to NODES nodes
//! (default 300 000) in sets of SET (default 50), N times (default 5) in turn: by one build with two workers, then by two independent builds with one worker
//! each, side by side. The machine slows two busy cores down alike in both, so the ratio
//!
//! ```text
//! mean time of the two builds side by side / (2 × time of the build with two workers)
//! ```
//!
//! is the share of the speed-up of two independent builds that two workers of one build reach. The last
//! columns say what the coordinator took, of all CPU time and per set, and what for. At the end: what a set
//! costs the coordinator and what it costs the workers; the first over the sum of both is the coordinator's
//! share, and how long a worker must be busy with a set of this size for that to be under 1 %.
//!
//! With *agents* it is built by two workers, and in turn by two agents of one worker each, over plain pipes on this
//! machine: the time of the first over that of the second is the share of the speed-up that is left.
//!
//! With *memory* it is built with 1, 2 and 4 workers. Per build: the most bytes that all processes held at
//! once, and what that is per node beyond a build of a tenth. *Judged* by an evaluator, so that workers keep edges.

#[path = "support/cage.rs"]
mod cage;
#[path = "support/memory.rs"]
mod memory;

use cage::{cage, endless};
use memory::peak_bytes;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

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

/// What is to be built.
struct Arguments {
    rounds: usize,
    memory: bool,
    agents: bool,
    is_judged: bool,
    nodes: u64,
    set: u32,
    sampler: Option<String>,
    scene: Option<String>,
}

impl Arguments {
    fn read() -> Arguments {
        let (mut rounds, mut memory, mut agents, mut is_judged) = (5, false, false, false);
        let (mut sampler, mut scene) = (None, None);
        let mut numbers = Vec::new();
        let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
        while let Some(word) = words.next() {
            let mut next = || words.next().unwrap_or_else(|| panic!("something after {word}"));
            match (word.as_str(), word.parse()) {
                ("--rounds", _) => rounds = next().parse().expect("a number of rounds"),
                ("--sampler", _) => sampler = Some(next()),
                ("memory", _) => memory = true,
                ("agents", _) => agents = true,
                ("judged", _) => is_judged = true,
                (_, Ok(number)) => numbers.push(number),
                _ => scene = Some(word),
            }
        }
        let nodes = numbers.first().copied().unwrap_or(300_000);
        let set = numbers.get(1).map_or(50, |set| *set as u32);
        Arguments { rounds, memory, agents, is_judged, nodes, set, sampler, scene }
    }

    /// The problem with so many nodes.
    fn problem(&self, folder: &Path, nodes: u64) -> PathBuf {
        match &self.scene {
            None if self.sampler.is_none() => cage(folder, nodes, self.set),
            None => panic!("--sampler: a scene expected too"),
            Some(scene) => {
                let size = (nodes, self.set);
                endless(folder, Path::new(scene), size, self.sampler.as_deref())
            }
        }
    }
}

fn main() {
    let arguments = Arguments::read();
    let folder = tempfile::tempdir().expect("a temporary folder");
    if arguments.memory {
        hold(folder.path(), &arguments);
    } else if arguments.agents {
        reach(folder.path(), &arguments);
    } else {
        scale(folder.path(), &arguments);
    }
}

/// Memory by number of workers.
fn hold(folder: &Path, arguments: &Arguments) {
    let nodes = arguments.nodes;
    println!("workers      bytes  per node  times one worker's");
    let mut one = None;
    for workers in [1, 2, 4] {
        let peak = |name: &str, nodes| {
            let out = folder.join(format!("{name}{workers}"));
            let problem = arguments.problem(folder, nodes);
            if arguments.is_judged {
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

fn scale(folder: &Path, arguments: &Arguments) {
    let problem = arguments.problem(folder, arguments.nodes);
    let (mut ratios, mut shares) = (Vec::new(), Vec::new());
    let (mut costs, mut works) = (Vec::new(), Vec::new());
    println!(
        "round  2 workers  side by side (mean)  share of speed-up  CPU     coordinator; per set"
    );
    for round in 0..arguments.rounds {
        let out = |name: &str| folder.join(format!("{name}{round}"));
        let both = finish(start(&problem, 2, &out("both")), &out("both"));
        let (left, right) = (start(&problem, 1, &out("left")), start(&problem, 1, &out("right")));
        let (left, right) = (finish(left, &out("left")), finish(right, &out("right")));
        assert!(both.digest == left.digest && both.digest == right.digest, "the same bits");
        let beside = (left.wall + right.wall) / 2.0;
        ratios.push(beside / (2.0 * both.wall));
        shares.push(100.0 * both.coordinator / both.cpu);
        costs.push(both.coordinator * 1e6 / both.sets);
        works.push((both.cpu - both.coordinator) * 1e6 / both.sets);
        println!(
            "{:5}  {:7.2} s  {beside:18.2} s  {:17.3}  {:5.1} s  {:.2} s = {:.2} %; {:.0} µs {}",
            round + 1,
            both.wall,
            ratios[round],
            both.cpu,
            both.coordinator,
            shares[round],
            costs[round],
            both.parts,
        );
    }
    println!("median share of speed-up {:.3}", median(&mut ratios));
    println!("median coordinator share of CPU {:.2} %", median(&mut shares));
    let (cost, work) = (median(&mut costs), median(&mut works));
    println!(
        "per set: {cost:.0} µs of the coordinator, {work:.0} µs of workers; under 1 % from {:.0} µs on",
        99.0 * cost
    );
}

/// Two agents beside two workers.
fn reach(folder: &Path, arguments: &Arguments) {
    let problem = arguments.problem(folder, arguments.nodes);
    let agent = format!("{} agent", env!("CARGO_BIN_EXE_roadmill"));
    let mut ratios = Vec::new();
    println!("round  2 workers  2 agents  ratio");
    for round in 0..arguments.rounds {
        let out = |name: &str| folder.join(format!("{name}{round}"));
        let workers = finish(start(&problem, 2, &out("workers")), &out("workers"));
        let agents = ["--agents", "a,b", "--agent-command", &agent];
        let agents = start_with(&problem, 1, &out("agents"), &agents);
        let agents = finish(agents, &out("agents"));
        assert!(workers.digest == agents.digest, "the same bits");
        ratios.push(workers.wall / agents.wall);
        println!(
            "{:5}  {:7.2} s  {:6.2} s  {:.3}",
            round + 1,
            workers.wall,
            agents.wall,
            ratios[round]
        );
    }
    println!("median {:.3}", median(&mut ratios));
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn start(problem: &Path, workers: usize, out: &Path) -> Child {
    start_with(problem, workers, out, &[])
}

fn start_with(problem: &Path, workers: usize, out: &Path, options: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_roadmill"))
        .arg("build")
        .arg(problem)
        .args(["--workers", &workers.to_string(), "--json", "--out"])
        .arg(out)
        .args(options)
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
