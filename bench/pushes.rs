//! What each push makes of a coarse path: Table II of O. B. Bayazit, *Solving motion planning problems by iterative
//! relaxation of constraints* (dissertation, 2003).
//!
//! ```text
//! cargo bench --bench pushes -- [--seeds N] [--every K] SCENE,SCALE,PATH …
//! ```
//!
//! SCENE is a problem, whose robot is scaled by SCALE about the origin of its frame; PATH a path as `roadmill query` writes it, such as the solution of an easier version of the
//! problem. In place of a path that a person drew, every K-th configuration of it (default 10) is kept, with the first and the last. The path is sampled as
//! the generator `hints` samples it, and every colliding run is pushed in each way, with seeds 1 to N (default 3); sums over the seeds.
//!
//! *In the passage* is a configuration at which the robot reaches through the obstacles: it has a vertex in their bounding box, and vertices beyond both of
//! the box's largest sides. *Found* are
//! the configurations that a push gives after its filter; *hints* how many of the colliding ones have at least one; seconds are CPU seconds of this thread
//! per configuration found, filter included.

#[path = "support/mod.rs"]
mod support;

use roadmill::Context;
use roadmill::generator::{GeneratorKind, HintPath, Hints};
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::problem::{Problem, StrategySpec};
use roadmill::push::{Push, Pushed, Run, Search};
use roadmill::scene::Shape;
use roadmill::seed::{Purpose, Seed};
use std::collections::BTreeSet;
use std::path::Path;
use support::{arguments_with, cpu_seconds};

const PUSHES: [(&str, Push); 5] = [
    ("simple", Push::Simple),
    ("shortest", Push::Shortest),
    ("workspace", Push::Workspace),
    ("retraction", Push::Retraction),
    ("all", Push::All),
];

fn main() {
    let (arguments, words) = arguments_with(3.0, 60.0, &["--every"]);
    let every: usize = words[0].as_deref().unwrap_or("10").parse().expect("a number");
    println!(
        "| scene | robot | hints, colliding | push | found | in the passage | share | hints | s per configuration |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for words in &arguments.scenes {
        let [scene, scale, path] = words.split(',').collect::<Vec<_>>()[..] else {
            panic!("{words}: SCENE,SCALE,PATH")
        };
        let scale: f64 = scale.parse().expect("a number");
        row(scene, scale, path, every, arguments.seeds);
    }
}

/// The lines of one scene.
fn row(scene: &str, scale: f64, path: &str, every: usize, seeds: u64) {
    let problem = scaled(scene, scale);
    let coarse = coarse(&problem, path, every);
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let step = 0.01 * cx.space().diameter();
    let hints = sampled(&cx, &coarse, step);
    let is_valid: Vec<bool> = hints.iter().map(|q| cx.model().is_valid(q, scratch)).collect();
    let colliding = is_valid.iter().filter(|is_valid| !**is_valid).count();
    for (name, push) in PUSHES {
        let (mut found, mut seconds, mut pushed_hints) = (Vec::new(), 0.0, 0);
        for seed in 1..=seeds {
            let seed = Seed::of_set(seed, name, Ordinal(0));
            let begun = cpu_seconds();
            let of_seed = pushed(&cx, &hints, &is_valid, push, step, &seed);
            seconds += cpu_seconds() - begun;
            pushed_hints += of_seed.iter().map(|pushed| pushed.from).collect::<BTreeSet<_>>().len();
            found.extend(of_seed);
        }
        let inside = found.iter().filter(|pushed| is_in_passage(&problem, &pushed.q)).count();
        println!(
            "| {} | {scale} | {}, {colliding} | {name} | {} | {inside} | {:.0} % | {:.0} % | {:.4} |",
            problem.name(),
            hints.len(),
            found.len(),
            100.0 * inside as f64 / found.len().max(1) as f64,
            100.0 * pushed_hints as f64 / (colliding as f64 * seeds as f64).max(1.0),
            seconds / found.len().max(1) as f64,
        );
    }
}

/// A problem whose robot is scaled about the origin of its frame, by way of its files.
fn scaled(scene: &str, scale: f64) -> Problem {
    let problem = Problem::load(Path::new(scene)).unwrap_or_else(|error| panic!("{error}"));
    if scale == 1.0 {
        return problem;
    }
    let written = problem.to_toml("files");
    let folder = tempfile::tempdir().expect("a folder can be made");
    std::fs::create_dir(folder.path().join("files")).expect("it is empty");
    for (name, text) in &written.files {
        let is_robot = !name.starts_with("obstacle");
        let text = if is_robot { scaled_mesh(text, scale) } else { text.clone() };
        std::fs::write(folder.path().join("files").join(name), text).expect("it can be written");
    }
    let file = folder.path().join(format!("{}.toml", problem.name()));
    std::fs::write(&file, &written.text).expect("it can be written");
    Problem::load(&file).unwrap_or_else(|error| panic!("{error}"))
}

/// A Wavefront mesh with all vertices multiplied by a factor.
fn scaled_mesh(text: &str, factor: f64) -> String {
    let line = |line: &str| match line.strip_prefix("v ") {
        None => format!("{line}\n"),
        Some(numbers) => {
            let value = |word: &str| word.parse::<f64>().expect("a coordinate") * factor;
            let values: Vec<String> =
                numbers.split_whitespace().map(|word| value(word).to_string()).collect();
            format!("v {}\n", values.join(" "))
        }
    };
    text.lines().map(line).collect()
}

/// Every so many configurations of the path in a file, the first and the last among them.
fn coarse(problem: &Problem, path: &str, every: usize) -> Vec<Vec<f64>> {
    let path = std::path::absolute(path).expect("a path").to_string_lossy().into_owned();
    let generator = GeneratorKind::Hints(Hints::new(HintPath::of_file(path)));
    let strategies = vec![StrategySpec::generated("hints", generator)];
    let read = problem.to_builder().strategies(strategies).default_schedule().build();
    let read = read.unwrap_or_else(|error| panic!("{error}"));
    let GeneratorKind::Hints(hints) = read.strategies()[0].generator() else { unreachable!() };
    let all = hints.all_paths().next().expect("it has one").configurations();
    let last = all.len() - 1;
    let kept = all.iter().enumerate().filter(|(i, _)| i.is_multiple_of(every) || *i == last);
    kept.map(|(_, q)| q.clone()).collect()
}

/// The path sampled so that neighbours are no farther apart than a step.
fn sampled(cx: &Context, path: &[Vec<f64>], step: f64) -> Vec<Vec<f64>> {
    let mut sampled = vec![path[0].clone()];
    for leg in path.windows(2) {
        let parts = (cx.space().distance(&leg[0], &leg[1]) / step).ceil().max(1.0) as u32;
        for part in 1..=parts {
            let mut q = leg[0].clone();
            cx.space().interpolate(&leg[0], &leg[1], f64::from(part) / f64::from(parts), &mut q);
            cx.space().canonicalize(&mut q).expect("it lies between two configurations");
            sampled.push(q);
        }
    }
    sampled
}

/// What a push gives for all colliding runs; the hints are numbered along the path.
fn pushed(
    cx: &Context,
    hints: &[Vec<f64>],
    is_valid: &[bool],
    push: Push,
    step: f64,
    seed: &Seed,
) -> Vec<Pushed> {
    let (stream, scratch) = (seed.stream(Purpose::Sampling), &mut Scratch::new());
    let mut search = Search { cx, scratch, stream, step, reach: 8.0 * step, effort: 0 };
    let mut found = Vec::new();
    let mut hint = 0;
    while hint < hints.len() {
        if is_valid[hint] {
            hint += 1;
            continue;
        }
        let end = (hint..hints.len()).find(|next| is_valid[*next]).unwrap_or(hints.len());
        let run = Run {
            before: hint.checked_sub(1).map(|before| &hints[before][..]),
            colliding: &hints[hint..end],
            after: hints.get(end).map(|after| &after[..]),
        };
        let of_run = push.push(&run, &mut search).into_iter();
        found.extend(of_run.map(|pushed| Pushed { from: hint + pushed.from, ..pushed }));
        hint = end;
    }
    found
}

fn is_in_passage(problem: &Problem, q: &[f64]) -> bool {
    let bodies = problem.model().bodies().expect("a robot among obstacles");
    let points = |bodies: &[roadmill::scene::Body]| -> Vec<[f64; 3]> {
        let of = |body: &roadmill::scene::Body| match &body.shape {
            Shape::Mesh(mesh) => mesh.vertices.iter().map(|v| body.pose.apply(*v)).collect(),
            _ => vec![body.pose.translation],
        };
        bodies.iter().flat_map(of).collect()
    };
    let (robot, obstacles) = (points(&bodies.robot().bodies_at(q)), points(bodies.obstacles()));
    let sides = [0, 1, 2].map(|axis| {
        let low = obstacles.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let high = obstacles.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        [low, high]
    });
    let length = |axis: &usize| sides[*axis][1] - sides[*axis][0];
    let across = (0..3).min_by(|a, b| length(a).total_cmp(&length(b))).expect("there are three");
    let is_inside = |p: &[f64; 3]| (0..3).all(|i| (sides[i][0]..=sides[i][1]).contains(&p[i]));
    robot.iter().any(is_inside)
        && robot.iter().any(|p| p[across] < sides[across][0])
        && robot.iter().any(|p| p[across] > sides[across][1])
}
