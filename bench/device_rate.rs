//! Collision answers at the rate of a haptic device: Table III of O. B. Bayazit, *Solving motion planning problems by iterative
//! relaxation of constraints* (dissertation, 2003).
//!
//! ```text
//! cargo bench --bench device_rate -- [--crossing S] [--swing SHARE] SCENE,PATH …
//! ```
//!
//! SCENE is a problem, PATH a path as `roadmill query` writes it. In place of a hand the robot is moved along the path at a constant speed in the
//! metric, by which the largest distance in the space takes S seconds (default 10), and is asked about every millisecond. Once as the path is, and once pushed
//! into the obstacles: the base swings across the path along x, y and z, at 0.5, 0.7 and 1.1 Hz, by SHARE of the largest distance (default 0.01).
//!
//! *Live*: a `Follower` is asked at 1 kHz of wall time. An answer is new where an exact one has come since the question before,
//! which the dissertation calls *real*, and heuristic elsewhere. *Waiting* is the time from the question about a configuration until a question gets its exact
//! answer. *Late by*: the `Projection` alone is told each exact answer so many milliseconds after the question, one after the
//! other, as with the collision tests of 2003; this reads no clock.
//!
//! *Wrong* is the share of heuristic answers other than the model's; of these, *missed* is a collision said to be free.

#[path = "support/mod.rs"]
mod support;

use roadmill::device_rate::{Answer, Exact, Follower, Projection, Rule};
use roadmill::generator::{GeneratorKind, HintPath, Hints};
use roadmill::math;
use roadmill::model::Scratch;
use roadmill::problem::{Problem, StrategySpec};
use roadmill::space::Space;
use std::path::Path;
use std::time::{Duration, Instant};
use support::{arguments_with, cpu_seconds};

/// How late exact answers come in milliseconds: the waiting times of Table III.
const LATE: [usize; 2] = [71, 99];
const TICK: Duration = Duration::from_millis(1);

fn main() {
    let (arguments, words) = arguments_with(1.0, 60.0, &["--crossing", "--swing"]);
    let word = |at: usize, default: &str| -> f64 {
        words[at].as_deref().unwrap_or(default).parse().expect("a number")
    };
    let (crossing, swing) = (word(0, "10"), word(1, "0.01"));
    println!(
        "| scene | motion | questions, colliding | exact answers | rule | heuristic | wrong | missed | waiting ms | exact ms | answer 99 % ms | answer most ms |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for words in &arguments.scenes {
        let (scene, path) = words.split_once(',').unwrap_or_else(|| panic!("{words}: SCENE,PATH"));
        let problem = Problem::load(Path::new(scene)).unwrap_or_else(|error| panic!("{error}"));
        let path = configurations(&problem, path);
        for (name, swing) in [("the path", 0.0), ("swinging", swing)] {
            rows(&problem, name, &motion(&problem.space(), &path, crossing, swing));
        }
    }
}

/// The configurations of a path in a file.
fn configurations(problem: &Problem, path: &str) -> Vec<Vec<f64>> {
    let path = std::path::absolute(path).expect("a path").to_string_lossy().into_owned();
    let generator = GeneratorKind::Hints(Hints::new(HintPath::of_file(path)));
    let strategies = vec![StrategySpec::generated("hints", generator)];
    let read = problem.to_builder().strategies(strategies).default_schedule().build();
    let read = read.unwrap_or_else(|error| panic!("{error}"));
    let GeneratorKind::Hints(hints) = read.strategies()[0].generator() else { unreachable!() };
    hints.all_paths().next().expect("it has one").configurations().to_vec()
}

/// The configurations on the way, a millisecond apart.
fn motion(space: &Space, path: &[Vec<f64>], crossing: f64, swing: f64) -> Vec<Vec<f64>> {
    let step = space.diameter() / (1000.0 * crossing);
    let mut motion: Vec<Vec<f64>> = Vec::new();
    for leg in path.windows(2) {
        let parts = (space.distance(&leg[0], &leg[1]) / step).ceil().max(1.0) as u32;
        for part in 0..parts {
            let mut q = leg[0].clone();
            space.interpolate(&leg[0], &leg[1], f64::from(part) / f64::from(parts), &mut q);
            let seconds = motion.len() as f64 / 1000.0;
            for (axis, frequency) in (0..space.translations()).zip([0.5, 0.7, 1.1]) {
                q[axis] += swing * space.diameter() * math::sin(math::TURN * frequency * seconds);
            }
            space.canonicalize(&mut q).expect("it lies between two configurations");
            motion.push(q);
        }
    }
    motion
}

/// What came of the answers of one replay after the first exact one.
#[derive(Default)]
struct Count {
    new: usize,
    heuristic: usize,
    wrong: usize,
    missed: usize,
}

impl Count {
    fn note(&mut self, answer: &Answer, collides: bool) {
        self.heuristic += 1;
        self.wrong += usize::from(answer.collides != collides);
        self.missed += usize::from(collides && !answer.collides);
    }

    fn print(&self, ways: &str, times: &str) {
        let share = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
        println!(
            "{ways} {:.1} % | {:.2} % | {:.2} % | {times} |",
            share(self.heuristic, self.heuristic + self.new),
            share(self.wrong, self.heuristic),
            share(self.missed, self.heuristic)
        );
    }
}

/// The lines of one motion.
fn rows(problem: &Problem, name: &str, motion: &[Vec<f64>]) {
    let model = problem.model().description().prepare();
    let scratch = &mut Scratch::new();
    let begun = cpu_seconds();
    let exact: Vec<Exact> = motion.iter().map(|q| Exact::at(&*model, q, scratch)).collect();
    let each = 1000.0 * (cpu_seconds() - begun) / motion.len() as f64;
    let colliding = exact.iter().filter(|exact| exact.collides()).count();
    let share = 100.0 * colliding as f64 / motion.len() as f64;
    let scene = format!("| {} | {name} | {}, {share:.0} % |", problem.name(), motion.len());
    for (rule, said) in [(Rule::Translation, "translation"), (Rule::NearestPoint, "nearest point")]
    {
        for late in LATE {
            let mut projection = Projection::new(problem.space().clone(), rule);
            let (mut count, mut asked) = (Count::default(), 0);
            for (tick, q) in motion.iter().enumerate() {
                let is_new = tick >= asked + late;
                if is_new {
                    projection.learn(exact[asked].clone());
                    asked = tick;
                    count.new += 1;
                }
                let answer = projection.ask(q).expect("a configuration");
                if !is_new && projection.last().is_some() {
                    count.note(&answer, exact[tick].collides());
                }
            }
            let ways = format!("{scene} late by {late} ms | {said} |");
            count.print(&ways, &format!("{late} | {each:.3} | – | –"));
        }
        live(problem, rule, motion, &exact, (&format!("{scene} live | {said} |"), each));
    }
}

/// The replay at 1 kHz of wall time.
fn live(problem: &Problem, rule: Rule, motion: &[Vec<f64>], exact: &[Exact], said: (&str, f64)) {
    let model = problem.model().description().prepare();
    let mut follower = Follower::start(model, rule).expect("a thread can be started");
    let (mut count, mut waits, mut times) = (Count::default(), Vec::new(), Vec::new());
    let mut asked: Vec<Instant> = Vec::new();
    // Whose exact answer is the last that was noted.
    let mut last: Option<usize> = None;
    let begun = Instant::now();
    for (tick, q) in motion.iter().enumerate() {
        let due = begun + TICK * tick as u32;
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
        let now = Instant::now();
        asked.push(now);
        let answer = follower.ask(q).expect("a configuration");
        times.push(now.elapsed().as_secs_f64() * 1000.0);
        let first = last.map_or(0, |last| last + 1);
        let new = follower.last_exact().and_then(|noted| {
            (first..tick).rev().find(|earlier| motion[*earlier][..] == *noted.q())
        });
        match new {
            Some(new) => {
                waits.push((now - asked[new]).as_secs_f64() * 1000.0);
                last = Some(new);
                count.new += 1;
            }
            None if last.is_some() => count.note(&answer, exact[tick].collides()),
            None => {}
        }
    }
    times.sort_by(f64::total_cmp);
    let mean = waits.iter().sum::<f64>() / waits.len().max(1) as f64;
    let (slow, most) = (times[times.len() * 99 / 100], times[times.len() - 1]);
    let measured = format!("{mean:.2} | {:.3} | {slow:.3} | {most:.3}", said.1);
    count.print(said.0, &measured);
}
