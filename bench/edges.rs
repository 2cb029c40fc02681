//! Motions decided per CPU-second: at all times (`swept`), at discrete steps (`sampled`), and the same
//! steps one by one.
//!
//! ```text
//! cargo bench -p roadmill --bench edges -- SCENE…
//! ROADMILL_DATA=FOLDER cargo bench -p roadmill --bench edges -- [--lists uniform,gaussian,dense] [--swept]
//! cargo bench -p roadmill --features counts --bench edges -- --counts SCENE…
//! ```
//!
//! Without scenes it takes the eight in the folder that `ROADMILL_DATA` names. Motions are those of the lists
//! (`bench/support/lists.rs`), of the first if nothing is said. With `--swept` it measures those alone, for
//! profilers. With `--counts` it counts the steps that each motion takes ([`Work`]) and times those apart that the
//! ball around the robot settles, those that are blocked and those that are free. CPU time of one thread, the three in turn, medians of three.
//! Of the motions that are free at 16 times finer steps `refused` is the share that `swept` does not
//! accept; `missed` counts those that it accepts although they are not free there.

mod support;

use roadmill::Context;
use roadmill::model::bodies::BodyValidity;
use roadmill::model::bodies::validity::{BodyScratch, MotionChecking, Work};
use roadmill::model::{Scratch, Validity};
use roadmill::problem::Problem;
use roadmill::roadmap::Configs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use support::edges::with_edges;
use support::lists::List;
use support::{cpu_seconds, median};

#[derive(Clone, Copy, PartialEq)]
enum Mode {
    All,
    /// Swept motions alone.
    Swept,
    /// What they are made of.
    Counts,
}

const ROUNDS: usize = 3;
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
    let (mut mode, mut lists, mut scenes) = (Mode::All, vec![List::Uniform], Vec::new());
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        match word.as_str() {
            "--swept" => mode = Mode::Swept,
            "--counts" => mode = Mode::Counts,
            "--lists" => lists = List::named(&words.next().unwrap_or_default()),
            _ => scenes.push(PathBuf::from(word)),
        }
    }
    if scenes.is_empty() {
        let Some(data) = std::env::var_os("ROADMILL_DATA") else {
            println!("edges: skipped, neither scenes nor ROADMILL_DATA given");
            return;
        };
        scenes = SCENES.map(|scene| Path::new(&data).join("scenes").join(scene)).to_vec();
    }
    let head = match mode {
        Mode::Counts => {
            if !cfg!(feature = "counts") {
                panic!("--counts takes --features counts");
            }
            "| scene | list | settled | motions | balls | placed | boxes | batches | looks | pairs | advances | ns |"
        }
        Mode::Swept => "| scene | list | motions | | swept/s |",
        Mode::All => {
            "| scene | list | motions | free | swept/s | sampled/s | step by step/s | ratio | refused | missed |"
        }
    };
    println!("{head}\n|{}", " --- |".repeat(head.matches('|').count() - 1));
    for scene in scenes {
        lists.iter().for_each(|list| measure(&scene, *list, mode));
    }
}

/// Decides the motion between two configurations.
type Verdict<'a> = dyn Fn(&[f64], &[f64], &mut Scratch) -> bool + 'a;

fn measure(path: &Path, list: List, mode: Mode) {
    let problem = Problem::load(path).unwrap_or_else(|error| panic!("{error}"));
    let [swept, sampled] = [MotionChecking::Swept, MotionChecking::Sampled]
        .map(|edges| with_edges(&problem, edges).context());
    let (configs, pairs) = list.draw(&problem, &swept);
    let decide = |verdict: &Verdict| -> (f64, Vec<bool>) {
        let (scratch, begun) = (&mut Scratch::new(), cpu_seconds());
        let each = pairs.iter().map(|(a, b)| verdict(configs.get(*a), configs.get(*b), scratch));
        let verdicts = each.collect();
        (cpu_seconds() - begun, verdicts)
    };
    if mode == Mode::Counts {
        return counted(&swept, &format!("{} | {}", problem.name(), list.name()), &configs, &pairs);
    }
    if mode == Mode::Swept {
        let count = |_| decide(&|a, b, scratch| swept.model().motion(a, b, 1, scratch).is_some()).0;
        let mut times: Vec<f64> = (0..20).map(count).collect();
        let rate = pairs.len() as f64 / median(&mut times);
        println!("| {} | {} | {} | | {rate:.0} |", problem.name(), list.name(), pairs.len());
        return;
    }
    let mut seconds = [const { Vec::new() }; 3];
    let (mut free, mut sampled_free, mut stepped) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let (time, verdicts) =
            decide(&|a, b, scratch| swept.model().motion(a, b, 1, scratch).is_some());
        seconds[0].push(time);
        free = verdicts;
        let (time, verdicts) =
            decide(&|a, b, scratch| sampled.model().motion(a, b, 1, scratch).is_some());
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
        "| {} | {} | {} | {:.1} % | {:.0} | {:.0} | {:.0} | {:.1} | {:.2} % | {missed} |",
        problem.name(),
        list.name(),
        pairs.len(),
        share(count(&|swept, _| swept), pairs.len()),
        rates[0],
        rates[1],
        rates[2],
        rates[0] / rates[2],
        share(refused, count(&|_, finer| finer)),
    );
}

/// What swept motions are made of, apart for those that the ball around the robot settles, those that are
/// blocked and those that are free.
fn counted(cx: &Context, name: &str, configs: &Configs, pairs: &[(usize, usize)]) {
    let scratch = &mut Scratch::new();
    let motion = |(a, b): &(usize, usize), scratch: &mut Scratch| {
        cx.model().motion(configs.get(*a), configs.get(*b), 1, scratch).is_some()
    };
    let mut classes: [Vec<(usize, usize)>; 3] = [const { Vec::new() }; 3];
    let mut work = [Work::default(); 3];
    for pair in pairs {
        let free = motion(pair, scratch);
        let steps = scratch.of_model::<BodyScratch>().take_work();
        let class = if steps.placed + steps.looks == 0 { 0 } else { 1 + usize::from(free) };
        classes[class].push(*pair);
        work[class] += steps;
    }
    for ((class, pairs), work) in ["ball", "blocked", "free"].iter().zip(&classes).zip(work) {
        let mut times: Vec<f64> = (0..ROUNDS)
            .map(|_| {
                let begun = cpu_seconds();
                pairs.iter().for_each(|pair| _ = black_box(motion(pair, scratch)));
                (cpu_seconds() - begun) * 1e9
            })
            .collect();
        let each = |count: f64| count / pairs.len().max(1) as f64;
        let Work { balls, placed, boxes, batches, looks, pairs: met, advances } = work;
        let counts = [balls, placed, boxes, batches, looks, met, advances];
        let counts = counts.map(|count| format!("{:.1}", each(count as f64))).join(" | ");
        println!(
            "| {name} | {class} | {} | {counts} | {:.0} |",
            pairs.len(),
            each(median(&mut times))
        );
    }
}

/// Every step from its configuration alone, halving the gaps between them.
fn step_by_step(
    cx: &Context,
    a: &[f64],
    b: &[f64],
    refinement: u32,
    scratch: &mut Scratch,
) -> bool {
    let steps = BodyValidity::of(cx.model()).expect("bodies").steps(a, b, refinement);
    let mut q = vec![0.0; a.len()];
    let mut stride = steps.next_power_of_two();
    while stride > 1 {
        stride /= 2;
        for i in (stride..steps).step_by(2 * stride as usize) {
            cx.space().interpolate(a, b, i as f64 / steps as f64, &mut q);
            if cx.model().validity(&q, scratch) != Validity::Valid {
                return false;
            }
        }
    }
    true
}
