//! Motions decided per CPU-second: at all times (`swept`), at discrete steps (`sampled`), and the same
//! steps one by one.
//!
//! ```text
//! cargo bench -p roadmill --bench edges -- SCENE…
//! ROADMILL_DATA=FOLDER cargo bench -p roadmill --bench edges
//! ```
//!
//! With `--swept` it measures those alone, for profilers. Without scenes it takes the eight in the folder that `ROADMILL_DATA` names. Motions: pairs of 10 nearest
//! among 2000 valid uniform configurations. CPU time of one thread, the three in turn, medians of three.
//! Of the motions that are free at 16 times finer steps `refused` is the share that `swept` does not
//! accept; `missed` counts those that it accepts although they are not free there.

mod support;

use roadmill::Context;
use roadmill::problem::Problem;
use roadmill::validity::{Edges, Scratch, State};
use std::path::{Path, PathBuf};
use support::{cpu_seconds, median, pairs};

const ROUNDS: usize = 3;
const NEIGHBORS: usize = 10;
const FINER: u32 = 16;
const SCENES: [&str; 8] = [
    "ompl/cubicles.cfg",
    "ompl/Easy.cfg",
    "ompl/Twistycool.cfg",
    "ompl/alpha-1.5.cfg",
    "ompl/bugtrap.cfg",
    "parasol/SerialWalls/serial.env",
    "parasol/flange_1.0/flange.env",
    "parasol/alpha1.6/alpha.env",
];

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let alone = words.iter().any(|word| word == "--swept");
    let scenes = words.iter().filter(|word| !word.starts_with("--"));
    let mut scenes: Vec<PathBuf> = scenes.map(PathBuf::from).collect();
    if scenes.is_empty() {
        let Some(data) = std::env::var_os("ROADMILL_DATA") else {
            println!("edges: skipped, neither scenes nor ROADMILL_DATA given");
            return;
        };
        scenes = SCENES.map(|scene| Path::new(&data).join("scenes").join(scene)).to_vec();
    }
    println!(
        "| scene | motions | free | swept/s | sampled/s | step by step/s | ratio | refused | missed |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for scene in scenes {
        measure(&scene, alone);
    }
}

/// Decides the motion between two configurations.
type Verdict<'a> = dyn Fn(&[f64], &[f64], &mut Scratch) -> bool + 'a;

fn measure(path: &Path, alone: bool) {
    let mut problem = Problem::load(path).unwrap_or_else(|error| panic!("{error}"));
    let [swept, sampled] = [Edges::Swept, Edges::Sampled].map(|edges| {
        problem.edges = edges;
        problem.context()
    });
    let (configs, pairs) = pairs(&swept, NEIGHBORS);
    let decide = |verdict: &Verdict| -> (f64, Vec<bool>) {
        let (scratch, begun) = (&mut Scratch::new(), cpu_seconds());
        let each = pairs.iter().map(|(a, b)| verdict(configs.get(*a), configs.get(*b), scratch));
        let verdicts = each.collect();
        (cpu_seconds() - begun, verdicts)
    };
    if alone {
        let count = |_| decide(&|a, b, scratch| swept.validity.motion(a, b, 1, scratch)).0;
        let mut times: Vec<f64> = (0..20).map(count).collect();
        println!("| {} | {:.0} |", problem.name, pairs.len() as f64 / median(&mut times));
        return;
    }
    let mut seconds = [const { Vec::new() }; 3];
    let (mut free, mut sampled_free, mut stepped) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let (time, verdicts) = decide(&|a, b, scratch| swept.validity.motion(a, b, 1, scratch));
        seconds[0].push(time);
        free = verdicts;
        let (time, verdicts) = decide(&|a, b, scratch| sampled.validity.motion(a, b, 1, scratch));
        seconds[1].push(time);
        sampled_free = verdicts;
        let (time, verdicts) = decide(&|a, b, scratch| step_by_step(&sampled, a, b, 1, scratch));
        seconds[2].push(time);
        stepped = verdicts;
    }
    assert_eq!(sampled_free, stepped, "sampled motions are what their steps are");
    let (_, finer) = decide(&|a, b, scratch| step_by_step(&sampled, a, b, FINER, scratch));
    let count = |which: &dyn Fn(bool, bool) -> bool| {
        free.iter().zip(&finer).filter(|(swept, finer)| which(**swept, **finer)).count()
    };
    let refused = count(&|swept, finer| finer && !swept);
    let missed = count(&|swept, finer| swept && !finer);
    let rates = seconds.each_mut().map(|seconds| pairs.len() as f64 / median(seconds));
    let share = |count: usize, of: usize| 100.0 * count as f64 / of as f64;
    println!(
        "| {} | {} | {:.1} % | {:.0} | {:.0} | {:.0} | {:.1} | {:.2} % | {missed} |",
        problem.name,
        pairs.len(),
        share(count(&|swept, _| swept), pairs.len()),
        rates[0],
        rates[1],
        rates[2],
        rates[0] / rates[2],
        share(refused, count(&|_, finer| finer)),
    );
}

/// Every step from its configuration alone, halving the gaps between them.
fn step_by_step(
    cx: &Context,
    a: &[f64],
    b: &[f64],
    refinement: u32,
    scratch: &mut Scratch,
) -> bool {
    let steps = cx.validity.steps(a, b, refinement);
    let mut q = vec![0.0; a.len()];
    let mut stride = steps.next_power_of_two();
    while stride > 1 {
        stride /= 2;
        for i in (stride..steps).step_by(2 * stride as usize) {
            cx.space.interpolate(a, b, i as f64 / steps as f64, &mut q);
            if cx.validity.state(&q, scratch) != State::Free {
                return false;
            }
        }
    }
    true
}
