//! Whether verdicts on whole motions are right, by what others say of the same motions step by step.
//!
//! ```text
//! ROADMILL_PEER=PEER cargo bench --bench check -- [--edges N] SCENE …
//! ```
//!
//! Of N motions (default 100 000) two fifths are pairs of near uniform milestones, two fifths of near
//! Gaussian ones, and a fifth pairs of any two of either. Rigid meshes are judged by FCL (PEER is built
//! as `bench/race.rs` says), all else by every pair of bodies, tested by parry. They look at the steps
//! of the resolution, and at 16 times as many. Both sides take meshes as surfaces.
//!
//! Columns: what is free at the finer steps; `differ`: `sampled` verdicts that are not those of the
//! steps; `missed`: motions that `swept` accepts though they are blocked at the steps, at the finer
//! ones; `refused`: motions that it does not accept though they are free at the finer steps, and their
//! share of all those. Of every one of these the nearest approach is sought, by halving time wherever the
//! distance does not show that the robot keeps away; `near` counts those that come within the tolerance
//! (r/2¹⁷, of linkages twice that), `at most` is the largest such distance in tolerances, and the last
//! column the largest that FCL finds at the same configurations.

mod support;

use roadmill::Context;
use roadmill::model::Scratch;
use roadmill::model::bodies::BodyValidity;
use roadmill::model::bodies::validity::{MotionChecking, TOLERANCE};
use roadmill::problem::Problem;
use roadmill::roadmap::Configs;
use std::path::Path;
use support::brute::Brute;
use support::edges::with_edges;
use support::peer::{empty, pairs_text, run, scene_text, suits, surfaces, verdicts};
use support::{cpu_seconds, lists, sample};

/// How much finer motions are looked at than the resolution asks for.
const FINER: u64 = 16;
/// Of pairs of near milestones there are at least so many per milestone.
const PAIRS_PER_NODE: usize = 5;
/// Distances looked at for one approach.
const LOOKS_MAX: usize = 1_000_000;

fn main() {
    let (mut edges, mut scenes) = (100_000, Vec::new());
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        if word == "--edges" {
            let number = words.next().and_then(|word| word.parse().ok());
            edges = number.expect("a number after --edges");
        } else {
            scenes.push(word);
        }
    }
    println!(
        "| scene | judge | motions | steps | free | differ | missed | refused | share | near | at most | FCL's |"
    );
    println!("|{}", " --- |".repeat(12));
    for scene in scenes {
        check(Path::new(&scene), edges);
    }
}

/// Whoever else judges.
enum Judge {
    Peer { peer: String, folder: tempfile::TempDir },
    Brute(Box<Brute>),
}

/// Motions by their ends.
type Motions = Vec<(Vec<f64>, Vec<f64>)>;

fn check(path: &Path, count: usize) {
    let mut problem = Problem::load(path).unwrap_or_else(|error| panic!("{error}"));
    let judge = if suits(&problem) {
        let Ok(peer) = std::env::var("ROADMILL_PEER") else {
            println!("| {} | skipped, ROADMILL_PEER is not set |", problem.name());
            return;
        };
        problem = surfaces(path);
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("scene"), scene_text(&problem)).expect("a file");
        Judge::Peer { peer, folder }
    } else {
        problem = empty(&problem);
        Judge::Brute(Box::new(Brute::new(&problem)))
    };
    let [swept, sampled] = [MotionChecking::Swept, MotionChecking::Sampled]
        .map(|edges| with_edges(&problem, edges).context());
    let motions = motions(&problem, &swept, count);
    let scratch = &mut Scratch::new();
    let mut decide = |cx: &Context| -> Vec<bool> {
        motions.iter().map(|(a, b)| cx.model().motion(a, b, 1, scratch).is_some()).collect()
    };
    let (accepted, at_steps) = (decide(&swept), decide(&sampled));
    let coarse = judge.free(&swept, &motions, 1);
    let finer = judge.free(&swept, &motions, FINER);

    let count = |of: &dyn Fn(usize) -> bool| (0..motions.len()).filter(|i| of(*i)).count();
    let free = count(&|i| finer[i]);
    let missed = [&coarse, &finer].map(|free| count(&|i| accepted[i] && !free[i]));
    let refused: Vec<usize> = (0..motions.len()).filter(|i| finer[*i] && !accepted[*i]).collect();
    // The links of a pair may both move.
    let moving =
        if problem.model().bodies().expect("bodies").robot().links.len() == 1 { 1.0 } else { 2.0 };
    let tolerance =
        moving * problem.model().bodies().expect("bodies").resolution() / TOLERANCE as f64;
    let approaches: Vec<_> = refused
        .iter()
        .filter_map(|i| {
            let (a, b) = &motions[*i];
            let fastest = moving
                * problem.model().bodies().expect("bodies").resolution()
                * BodyValidity::of(swept.model()).expect("bodies").steps(a, b, 1) as f64;
            let apart = |q: &[f64]| judge.apart(&swept, q, scratch);
            nearest_approach(&swept, (a, b), fastest, tolerance, apart)
        })
        .collect();
    let farthest = approaches.iter().fold(0.0f64, |most, (distance, _)| most.max(*distance));
    let there: Vec<Vec<f64>> = approaches.into_iter().map(|(_, q)| q).collect();
    let steps: u64 = motions
        .iter()
        .map(|(a, b)| BodyValidity::of(swept.model()).expect("bodies").steps(a, b, 1))
        .sum();
    println!(
        "| {} | {} | {} | {:.1} | {:.1} % | {} | {}, {} | {} | {:.3} % | {} | {:.2} | {} |",
        problem.name(),
        judge.name(),
        motions.len(),
        steps as f64 / motions.len() as f64,
        100.0 * free as f64 / motions.len() as f64,
        count(&|i| at_steps[i] != coarse[i]),
        missed[0],
        missed[1],
        refused.len(),
        100.0 * refused.len() as f64 / free as f64,
        there.len(),
        farthest / tolerance,
        judge.farthest(&there).map_or("–".to_owned(), |far| format!("{:.2}", far / tolerance)),
    );
    eprintln!("{}: {:.0} CPU s of this process", problem.name(), cpu_seconds());
}

fn motions(problem: &Problem, cx: &Context, count: usize) -> Motions {
    let near = 2 * count / 5;
    let nodes = near / PAIRS_PER_NODE + lists::NEIGHBORS;
    let sets = [sample(cx, nodes, u64::MAX), lists::near_obstacles(problem, cx, nodes)];
    let mut motions = Vec::new();
    let mut take = |configs: &Configs, pairs: Vec<(usize, usize)>, count: usize| {
        // Evenly among all, so that every milestone has some.
        for i in 0..count.min(pairs.len()) {
            let (a, b) = pairs[i * pairs.len() / count.min(pairs.len())];
            motions.push((configs.get(a).to_vec(), configs.get(b).to_vec()));
        }
    };
    for configs in &sets {
        take(configs, lists::nearest(cx, configs), near);
    }
    let mut both = Configs::new(cx.space().len());
    sets.iter().flat_map(Configs::iter).for_each(|q| both.push(q));
    take(&both, lists::any(&both, count - 2 * near), count - 2 * near);
    motions
}

impl Judge {
    fn name(&self) -> &'static str {
        match self {
            Judge::Peer { .. } => "FCL",
            Judge::Brute(_) => "all pairs",
        }
    }

    /// Which motions are free at so many times the steps of the resolution.
    fn free(&self, cx: &Context, motions: &Motions, finer: u64) -> Vec<bool> {
        let ends = motions.iter().map(|(a, b)| (&a[..], &b[..]));
        let steps = ends
            .clone()
            .map(|(a, b)| finer * BodyValidity::of(cx.model()).expect("bodies").steps(a, b, 1));
        match self {
            Judge::Peer { peer, folder } => {
                let [scene, pairs, out] = ["scene", "pairs", "verdicts"]
                    .map(|name| folder.path().join(name).display().to_string());
                std::fs::write(&pairs, pairs_text(ends, steps)).expect("a file");
                run(peer, &["edges", &scene, &pairs, &out]);
                verdicts(&out)
            }
            Judge::Brute(brute) => ends
                .zip(steps)
                .map(|((a, b), steps)| {
                    let mut q = a.to_vec();
                    let mut stride = steps.next_power_of_two();
                    while stride > 1 {
                        stride /= 2;
                        for i in (stride..steps).step_by(2 * stride as usize) {
                            cx.space().interpolate(a, b, i as f64 / steps as f64, &mut q);
                            if !brute.is_free(&q) {
                                return false;
                            }
                        }
                    }
                    true
                })
                .collect(),
        }
    }

    fn apart(&self, cx: &Context, q: &[f64], scratch: &mut Scratch) -> f64 {
        match self {
            Judge::Peer { .. } => {
                let clearance = cx.model().clearances().expect("bodies").clearance(q, scratch);
                clearance.map_or(f64::INFINITY, |clearance| clearance.distance)
            }
            Judge::Brute(brute) => brute.apart(q),
        }
    }

    /// The largest of FCL's distances at some configurations.
    fn farthest(&self, configs: &[Vec<f64>]) -> Option<f64> {
        let Judge::Peer { peer, folder } = self else { return None };
        let line = |q: &Vec<f64>| q.iter().map(|value| format!("{value} ")).collect::<String>();
        let text: Vec<String> = configs.iter().map(line).collect();
        let [scene, file] =
            ["scene", "configs"].map(|name| folder.path().join(name).display().to_string());
        std::fs::write(&file, text.join("\n")).expect("a file");
        run(peer, &["distance", &scene, &file]).into_iter().reduce(f64::max)
    }
}

/// A configuration of the motion within the tolerance of something, with its distance; `None` if the
/// motion keeps away from everything. No two points approach one another by more than `fastest` from one
/// end of the motion to the other.
fn nearest_approach(
    cx: &Context,
    (a, b): (&[f64], &[f64]),
    fastest: f64,
    tolerance: f64,
    mut apart: impl FnMut(&[f64]) -> f64,
) -> Option<(f64, Vec<f64>)> {
    let mut q = a.to_vec();
    let mut at = |t: f64, q: &mut Vec<f64>| {
        cx.space().interpolate(a, b, t, q);
        apart(q)
    };
    let mut open = vec![(0.0, 1.0)];
    let mut looks = 0;
    while let Some((from, to)) = open.pop() {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let distance = at(middle, &mut q);
        if distance <= tolerance {
            return Some((distance, q));
        }
        looks += 1;
        if distance - fastest * half <= tolerance && looks < LOOKS_MAX {
            open.extend([(from, middle), (middle, to)]);
        }
    }
    None
}
