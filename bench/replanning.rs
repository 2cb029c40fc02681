//! How directions of growth pay off when an obstacle comes: the study of m in S. K. Nath's thesis (2013, §5.2.2, Figures 8 to 11).
//!
//! ```text
//! cargo bench --bench replanning -- [--nodes N | --before SECONDS] [--seeds N] [--seconds SECONDS]
//!     [--methods METHODS] [SCENE …]
//! ```
//!
//! In each scene whose name contains a SCENE (all if none is said) and for seeds 1 to N (default 10) every method (of `rrt,m1,m2,m3,m4,m5,m6,m7`, or of METHODS) grows a graph
//! from the start, without a criterion: of N nodes (default 500), so that runs can be repeated, or with `--before` for so many
//! CPU seconds, as the thesis does (Table 5.1). Then an obstacle comes (`neighbors/scenes.rs`), what it hits and what has
//! no connection to the start any longer is removed, and the rest grows until the query is solved; it is asked after each 20 nodes. `rrt` is a
//! tree, m = 1 an RRG. A seed that is not solved with 4500 nodes more than there were, or within SECONDS (default 20)
//! of CPU, counts as not solved and is left out of the means.
//!
//! Milliseconds of CPU of one thread, mean ± standard deviation over the seeds that are solved: *generation* before the obstacle, *revalidation*,
//! *growth* after it, *query* (all that were asked), and their sum, *total*; then nodes that revalidation keeps, nodes that grow after it, and
//! the path's length. The methods of one seed run one after another, so that what else the machine does falls on all of them.

#[path = "neighbors/scenes.rs"]
#[allow(dead_code, reason = "it chooses its scenes itself")]
mod scenes;
mod support;

use roadmill::img::{
    Core, Cut, Event, Executor, InProcess, Job, Judgement, Observer, Progress, Round, Serial,
    Setup, drive,
};
use roadmill::problem::{OldRun, Problem, Replanning};
use roadmill::roadmap::{Digest, Increment, Roadmap, Tally};
use scenes::{Environment, Robot, Scene};
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use support::{arguments_with, cpu_seconds};

const METHODS: &str = "rrt,m1,m2,m3,m4,m5,m6,m7";
const NODES: u64 = 500;
/// So many nodes more than there were before the obstacle, at most.
const FURTHER_MAX: u64 = 4500;
const IN_SET: u64 = 20;
const COLUMNS: [&str; 8] =
    ["generation", "revalidation", "growth", "query", "total", "nodes kept", "nodes grown", "path"];
const DIGITS: [usize; 8] = [1, 2, 1, 2, 1, 0, 0, 1];

fn main() {
    let (arguments, further) = arguments_with(10.0, 20.0, &["--nodes", "--before", "--methods"]);
    let methods: Vec<&str> = further[2].as_deref().unwrap_or(METHODS).split(',').collect();
    let number = |at: usize| {
        further[at].as_ref().map(|text| {
            text.parse::<f64>().unwrap_or_else(|_| panic!("{text} found; a number expected"))
        })
    };
    let before = match number(1) {
        Some(seconds) => Before { nodes: None, seconds },
        None => Before {
            nodes: Some(number(0).map_or(NODES, |nodes| nodes as u64)),
            seconds: f64::INFINITY,
        },
    };
    println!("| scene | method | solved | {} |", COLUMNS.join(" | "));
    println!("{}", "| --- ".repeat(3 + COLUMNS.len()) + "|");
    for environment in [Environment::Clutter, Environment::Clutter3d, Environment::Tunnel] {
        for robot in [Robot::Cube, Robot::Linkage] {
            let scene = Scene { environment, robot };
            let wanted = &arguments.scenes;
            if wanted.is_empty() || wanted.iter().any(|name| scene.name().contains(name.as_str())) {
                study(scene, &methods, before, arguments.seeds, arguments.seconds);
            }
        }
    }
}

/// When growth before the obstacle ends.
#[derive(Clone, Copy)]
struct Before {
    nodes: Option<u64>,
    seconds: f64,
}

/// Prints a row for each method.
fn study(scene: Scene, methods: &[&str], before: Before, seeds: u64, seconds: f64) {
    let mut rows = vec![Vec::new(); methods.len()];
    for seed in 1..=seeds {
        for (method, rows) in methods.iter().zip(&mut rows) {
            rows.extend(measure(scene, seed, method, before, seconds));
        }
    }
    for (method, rows) in methods.iter().zip(&rows) {
        let cells: Vec<String> =
            (0..COLUMNS.len()).map(|column| spread(rows, column, DIGITS[column])).collect();
        let solved = rows.len();
        let method = method.replace('m', "m = ");
        println!("| {} | {method} | {solved} of {seeds} | {} |", scene.name(), cells.join(" | "));
    }
}

/// Mean ± standard deviation of a column.
fn spread(rows: &[[f64; 8]], column: usize, digits: usize) -> String {
    if rows.is_empty() {
        return "-".to_owned();
    }
    let count = rows.len() as f64;
    let mean = rows.iter().map(|row| row[column]).sum::<f64>() / count;
    let squares: f64 = rows.iter().map(|row| (row[column] - mean) * (row[column] - mean)).sum();
    let deviation = (squares / (count - 1.0).max(1.0)).sqrt();
    format!("{mean:.digits$} ± {deviation:.digits$}")
}

/// What one seed of one method comes to, in the order of the columns; `None` where the query was not solved.
fn measure(
    scene: Scene,
    seed: u64,
    method: &str,
    before: Before,
    seconds: f64,
) -> Option<[f64; 8]> {
    let settings = format!("step = {}, goal_bias = 0", scene.step());
    let generator = match method.strip_prefix('m') {
        None => format!("rrt = {{ {settings} }}"),
        Some(directions) => format!("mrrg = {{ {settings}, directions = {directions} }}"),
    };
    let problem = |newcomer: &str, criteria: &str, nodes: Option<u64>| {
        let limits = nodes.map_or_else(String::new, |nodes| format!("[limits]\nnodes = {nodes}\n"));
        let text = format!(
            "{criteria}{}{newcomer}[img]\nsets_per_round = 1\n[[strategies]]\nlabel = \"graph\"\nnodes = {IN_SET}\n\
             generator = {{ {generator} }}\namong = {{ until-joined = {{}} }}\n{limits}",
            scene.text(seed)
        );
        Problem::parse(Path::new("replanning.toml"), &text)
            .unwrap_or_else(|error| panic!("{error}"))
    };
    let problem_before = problem("", "evaluators = []\n", before.nodes);
    let grown = grow(problem_before.clone(), before.seconds);
    let generation = grown.spent.first + grown.spent.growth;
    let old = OldRun {
        problem: &problem_before,
        roadmap: &grown.roadmap,
        ledger: Digest::of(b"a build in memory"),
        place: "",
    };
    let most = grown.roadmap.configs().len() as u64 + FURTHER_MAX;
    let problem_after = problem(scene.newcomer(), "", Some(most));
    let replanned = problem_after.replanned(&old, &Replanning::default());
    let replanned = replanned.unwrap_or_else(|error| panic!("{error}"));
    let kept = replanned.survived.increment.configs.len() as f64;
    let regrown = grow(replanned.problem, seconds);
    let length = regrown.length?;
    let Spent { first: revalidation, growth, query } = regrown.spent;
    let total = generation + revalidation + growth + query;
    let [generation, revalidation, growth, query, total] =
        [generation, revalidation, growth, query, total].map(|seconds| 1e3 * seconds);
    let more = regrown.roadmap.configs().len() as f64 - kept;
    Some([generation, revalidation, growth, query, total, kept, more, length])
}

/// CPU seconds by kind of work.
#[derive(Clone, Copy, Default)]
struct Spent {
    /// Making the first set, which is what is left of the old roadmap where there is one.
    first: f64,
    /// Making, joining and folding the others.
    growth: f64,
    query: f64,
}

struct Grown {
    roadmap: Roadmap,
    spent: Spent,
    /// The path's, if the query was solved.
    length: Option<f64>,
}

/// Builds in this thread until the problem's criteria or limits are met, or for so many CPU seconds.
fn grow(problem: Problem, seconds: f64) -> Grown {
    let setup = Arc::new(Setup::new(problem));
    let mut core = Core::new(&setup, 0);
    let mut timed = Timed { serial: Serial::new(setup), spent: Spent::default() };
    let mut watch = Watch { end: cpu_seconds() + seconds, last: None };
    let Ok(_) = drive(&mut core, &mut timed, &mut watch);
    let answer = watch.last.as_ref().and_then(|judgement| judgement.verdicts.first()?.answer());
    let length = answer.and_then(|answer| Some(answer.path.as_ref()?.length));
    Grown { spent: timed.spent, roadmap: timed.into_roadmap(), length }
}

/// Jobs one after another, timed.
struct Timed {
    serial: Serial,
    spent: Spent,
}

impl Executor for Timed {
    fn publish(&mut self, increment: &Arc<Increment>) {
        let begun = cpu_seconds();
        self.serial.publish(increment);
        self.spent.growth += cpu_seconds() - begun;
    }

    fn fold(&mut self, round: &Round) {
        let begun = cpu_seconds();
        self.serial.fold(round);
        self.spent.growth += cpu_seconds() - begun;
    }

    fn submit(&mut self, job: Job) {
        self.serial.submit(job);
    }

    fn next(&mut self, wait: Duration) -> Option<Event> {
        let begun = cpu_seconds();
        let event = self.serial.next(wait);
        let seconds = cpu_seconds() - begun;
        match &event {
            Some(Event::Done(Job::Evaluate { .. }, _)) => self.spent.query += seconds,
            Some(Event::Done(Job::Generate { number, .. }, _)) if number.0 == 0 => {
                self.spent.first += seconds;
            }
            _ => self.spent.growth += seconds,
        }
        event
    }

    fn alive(&self) -> usize {
        self.serial.alive()
    }

    fn tally(&self) -> &Tally {
        self.serial.tally()
    }
}

impl InProcess for Timed {
    fn into_roadmap(self) -> Roadmap {
        self.serial.into_roadmap()
    }
}

/// Keeps what the evaluators said last, and ends a build when the thread's CPU time is up.
struct Watch {
    end: f64,
    last: Option<Judgement>,
}

impl Observer for Watch {
    type Error = Infallible;

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Infallible> {
        self.last = Some(judgement.clone());
        Ok(())
    }

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Infallible> {
        Ok((cpu_seconds() >= self.end).then_some(Cut::Time))
    }
}
