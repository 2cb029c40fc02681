//! What the ledger costs: its share of a build, and the time until a large one is open for resuming.
//!
//! ```text
//! cargo bench -p roadmill-coordinator --bench ledger [-- SECONDS NODES]
//! ```
//!
//! First the cage without its query is built for SECONDS (default 60) with a worker per core. The
//! program itself adds up the wall time that goes into encoding, hashing, writing and syncing, and its
//! summary says it. Then a ledger of NODES nodes (default 1 000 000) in sets of 50, with 10 edges to a
//! node and 6 joining edges to a set, is made, and opened as `resume` opens it: every hash is checked,
//! every set decoded and folded, and the roadmap's digest compared after every round.

#[path = "support/cage.rs"]
mod cage;

use cage::cage;
use roadmill::img::{Executor, Joined, Round, RoundSet, Setup, Threads};
use roadmill::model::Asked;
use roadmill::numbers::{NodeId, Ordinal, RoundNumber, SetNumber, StrategyIndex};
use roadmill::problem::Problem;
use roadmill::roadmap::{Configs, Edge, Increment, Roadmap};
use roadmill::seed::{Purpose, Seed, Stream};
use roadmill_coordinator::run::{Ledger, LedgerWriter, Replay, RunLock, Scan, Told};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::Instant;

const SET_NODES: u32 = 50;
const EDGES_PER_NODE: u32 = 10;
const JOINS_PER_SET: u32 = 6;
const SETS_PER_ROUND: u64 = 5;

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|word| word.parse::<u64>().ok());
    let seconds = numbers.next().unwrap_or(60);
    let nodes = numbers.next().unwrap_or(1_000_000);
    let folder = tempfile::tempdir().expect("a temporary folder");
    share_of_a_build(folder.path(), seconds);
    opening(folder.path(), nodes);
}

fn share_of_a_build(folder: &Path, seconds: u64) {
    let problem = cage(folder, 4_000_000, SET_NODES);
    let out = folder.join("run");
    let done = Command::new(env!("CARGO_BIN_EXE_roadmill"))
        .arg("build")
        .arg(&problem)
        .args(["--max-time", &format!("{seconds}s"), "--json", "--out"])
        .arg(&out)
        .stdout(Stdio::null())
        .status()
        .expect("roadmill starts");
    assert!(done.success());
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let number = |key: &str| summary[key].as_f64().expect("a number");
    let (wall, ledger) = (number("wall_seconds"), number("ledger_seconds"));
    let bytes = std::fs::metadata(out.join("ledger")).expect("a ledger").len();
    println!("build      {wall:.1} s, {} nodes, ledger of {bytes} bytes", summary["nodes"]);
    println!("ledger     {ledger:.3} s, {:.2} % of the build", 100.0 * ledger / wall);
}

fn opening(folder: &Path, nodes: u64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../problems/walls.toml");
    let problem = Problem::load(&path).expect("it ships");
    let problem = problem.to_builder().sets_per_round(SETS_PER_ROUND).build();
    let problem = problem.expect("it ships");
    let run = folder.join("large");
    std::fs::create_dir(&run).expect("a folder");
    let begun = Instant::now();
    make(&run, &problem, nodes);
    let bytes = std::fs::metadata(run.join("ledger")).expect("a ledger").len();
    println!("made       {nodes} nodes, {bytes} bytes, in {:.2} s", begun.elapsed().as_secs_f64());

    let begun = Instant::now();
    let scan = Scan::read(&run).expect("whole");
    println!("hashes     {:.2} s", begun.elapsed().as_secs_f64());
    let mut executor = Threads::new(Arc::new(Setup::new(problem.clone())), 1);
    let mut replay = Replay::new(&scan, &problem).expect("whole");
    while let Some(told) = replay.read().expect("whole") {
        if let Told::Round(round, digest) = told {
            executor.restore(&round);
            replay.check(executor.tally(), digest).expect("the same roadmap");
        }
    }
    println!("to resume  {:.2} s, hashes included", begun.elapsed().as_secs_f64());
    let edges = executor.tally().edges();
    drop(executor);
    let begun = Instant::now();
    let ledger = Ledger::read(&run).expect("whole");
    assert_eq!(ledger.roadmap.edges().len(), edges);
    println!("to query   {:.2} s, {edges} edges", begun.elapsed().as_secs_f64());
}

/// Writes a ledger as large as asked for. What it holds looks like sets; no seed gives it.
fn make(run: &Path, problem: &Problem, nodes: u64) {
    let lock = RunLock::take(run, || false).expect("free");
    let mut ledger = LedgerWriter::begin(run, problem, lock).expect("it can be written");
    let space = problem.space();
    let mut roadmap = Roadmap::new(&space);
    let mut stream = Seed::of_set(1, "bench", Ordinal(0)).stream(Purpose::Sampling);
    for index in 0..nodes / (u64::from(SET_NODES) * SETS_PER_ROUND) {
        let mut first = roadmap.configs().len() as u32;
        let numbers = index * SETS_PER_ROUND..(index + 1) * SETS_PER_ROUND;
        let sets: Vec<RoundSet> = numbers
            .map(|number| {
                let increment = Arc::new(increment(&space, &mut stream));
                let joined = joined(first, &mut stream);
                first += SET_NODES;
                let (number, ordinal) = (SetNumber(number), Ordinal(number));
                RoundSet { number, strategy: StrategyIndex(0), ordinal, increment, joined }
            })
            .collect();
        let folded = sets.iter().map(|set| (&*set.increment, &set.joined.edges[..]));
        roadmap.fold_round(&space, folded);
        ledger
            .round(&Round { number: RoundNumber(index), sets }, problem, roadmap.tally())
            .expect("it can be written");
    }
}

fn increment(space: &roadmill::space::Space, stream: &mut Stream) -> Increment {
    let mut configs = Configs::new(space.len());
    for _ in 0..SET_NODES {
        let mut q: Vec<f64> = (0..space.len()).map(|_| 0.1 + stream.unit()).collect();
        space.canonicalize(&mut q).expect("it can be stored");
        configs.push(&q);
    }
    let below = |count: u32, stream: &mut Stream| (stream.unit() * f64::from(count)) as u32;
    let edge = |index: u32, stream: &mut Stream| {
        let low = index % (SET_NODES - 1);
        let high = low + 1 + below(SET_NODES - 1 - low, stream);
        Edge::metric(NodeId(low), NodeId(high), 0, stream.unit())
    };
    let edges = (0..SET_NODES * EDGES_PER_NODE).map(|index| edge(index, stream)).collect();
    Increment { configs, edges, ..Increment::empty(0) }
}

/// Edges from a set to what came before it.
fn joined(first: u32, stream: &mut Stream) -> Joined {
    let mut edges = Vec::new();
    for index in 0..JOINS_PER_SET.min(first) {
        let low = (stream.unit() * f64::from(first)) as u32;
        edges.push(Edge::metric(NodeId(low), NodeId(first + index), 0, stream.unit()));
    }
    Joined { edges, asked: Asked::default() }
}
