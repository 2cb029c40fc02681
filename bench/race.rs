//! The race against OMPL 1.5 and FCL 0.7: the same meshes, pairs, steps, nodes and neighbours, one core.
//!
//! ```text
//! apt-get install libompl-dev libfcl-dev libeigen3-dev g++
//! g++ -O3 -march=x86-64 -std=c++17 bench/peers/race.cpp -I/usr/include/eigen3 -I/usr/include/ompl-1.5 \
//!     -o PEER -lompl -lfcl -lccd
//! ROADMILL_PEER=PEER cargo bench --bench race -- problems/cage.toml …
//! ```
//!
//! Two measures per scene, five rounds in turn, medians of CPU time. *Edges*: pairs of 10 nearest among
//! 2000 valid uniform configurations, decided by each side in the same number of steps; where verdicts
//! differ, the count says so. *Nodes*: one set of 5000 nodes with 10 neighbours, against
//! `PRM::growRoadmap`. OMPL and FCL know no solids and no bounds of bodies, so both sides race with
//! surfaces and with bounds that hold the reference point.

mod support;

use roadmill::Context;
use roadmill::connect::{Nearest, Within};
use roadmill::roadmap::Configs;
use roadmill::seed::Seed;
use roadmill::validity::Scratch;
use std::fmt::Write;
use std::path::Path;
use support::peer::{run, scene_text, surfaces};
use support::{cpu_seconds, median, pairs, sample};

const ROUNDS: usize = 5;
const NODES: usize = 5000;
const NEIGHBORS: usize = 10;

fn main() {
    let scenes: Vec<String> =
        std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let Ok(peer) = std::env::var("ROADMILL_PEER") else {
        println!("race: skipped, ROADMILL_PEER does not name the built bench/peers/race.cpp");
        return;
    };
    println!(
        "| scene | pairs | free | edges/s | FCL edges/s | ratio | differ | nodes/s | OMPL nodes/s | ratio |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for scene in scenes {
        race(Path::new(&scene), &peer);
    }
}

fn race(path: &Path, peer: &str) {
    let problem = surfaces(path);
    let cx = problem.context();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(file("scene"), scene_text(&problem)).expect("the scene can be written");
    let (configs, pairs) = pairs(&cx, NEIGHBORS);
    std::fs::write(file("pairs"), pairs_text(&cx, &configs, &pairs)).expect("pairs can be written");

    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    let (mut our_nodes, mut their_nodes) = (Vec::new(), Vec::new());
    let (mut verdicts, mut peer_verdicts) = (Vec::new(), Vec::new());
    for round in 0..ROUNDS {
        let begun = cpu_seconds();
        let scratch = &mut Scratch::new();
        verdicts = pairs
            .iter()
            .map(|(a, b)| cx.validity.motion(configs.get(*a), configs.get(*b), 1, scratch))
            .collect();
        ours.push(cpu_seconds() - begun);
        theirs.push(run(peer, &["edges", &file("scene"), &file("pairs"), &file("verdicts")])[0]);
        let text = std::fs::read_to_string(file("verdicts")).expect("verdicts");
        peer_verdicts = text.lines().map(|line| line == "1").collect();

        let begun = cpu_seconds();
        let set = sample(&cx, NODES, round as u64);
        let within = Nearest { neighbors: NEIGHBORS as u32, ..Nearest::default() };
        let seed = Seed::of_set(1, "race", round as u64);
        assert!(!within.connect(&cx, &seed, &set, &mut Scratch::new()).is_empty());
        our_nodes.push(cpu_seconds() - begun);
        let (nodes, k, seed) = (NODES.to_string(), NEIGHBORS.to_string(), (round + 1).to_string());
        their_nodes.push(run(peer, &["grow", &file("scene"), &nodes, &k, &seed])[0]);
    }
    let rate = |count: usize, seconds: &mut Vec<f64>| count as f64 / median(seconds);
    let differ =
        verdicts.iter().zip(&peer_verdicts).filter(|(ours, theirs)| ours != theirs).count();
    let free = verdicts.iter().filter(|free| **free).count();
    let (edges, peer_edges) = (rate(pairs.len(), &mut ours), rate(pairs.len(), &mut theirs));
    let (nodes, peer_nodes) = (rate(NODES, &mut our_nodes), rate(NODES, &mut their_nodes));
    println!(
        "| {} | {} | {:.1} % | {edges:.0} | {peer_edges:.0} | {:.2} | {differ} | {nodes:.0} | {peer_nodes:.0} | {:.2} |",
        problem.name,
        pairs.len(),
        100.0 * free as f64 / pairs.len() as f64,
        edges / peer_edges,
        nodes / peer_nodes,
    );
}

fn pairs_text(cx: &Context, configs: &Configs, pairs: &[(usize, usize)]) -> String {
    let mut text = String::new();
    for (a, b) in pairs {
        let (a, b) = (configs.get(*a), configs.get(*b));
        for value in a.iter().chain(b) {
            write!(text, "{value} ").expect("memory");
        }
        writeln!(text, "{}", cx.validity.steps(a, b, 1)).expect("memory");
    }
    text
}
