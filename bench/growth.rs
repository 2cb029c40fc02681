//! What a node costs while the roadmap grows: CPU time per set at every size, taken apart.
//!
//! ```text
//! cargo bench --bench growth [-- [SCENE …] [NODES [SET]]]
//! ```
//!
//! Each scene is grown up to NODES nodes (default 100 000) in sets of SET (default 100), one set per
//! round, in one thread. *Sparse* is a rod among walls whose motions are checked coarsely, so that
//! what is around the checking shows; *walls* ships with the project; *cubicles* needs `ROADMILL_DATA`.
//! Per size: microseconds of CPU per node, averaged over the last tenth of the growth to that size: in
//! all, then of it validity, what generating, joining and folding cost besides, and 100 neighbours of
//! random configurations in the whole roadmap; then components, edges and resident bytes per node.
//! The last line is the exponent of the growth with size of all and of all but validity, fitted by
//! least squares on logarithms.

mod support;

use roadmill::img::{Job, Joined, Outcome, Replica, Setup};
use roadmill::model::{Cost, Model, Reason, Scratch, Validity};
use roadmill::numbers::{Ordinal, SetName, SetNumber};
use roadmill::problem::Problem;
use roadmill::query::Attachment;
use roadmill::seed::{Purpose, Seed};
use roadmill::space::Space;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use support::cpu_seconds;

/// Sizes at which a line is printed, in nodes.
const SIZES: [u64; 7] = [1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000];

/// The problem's validity, timed.
struct Timed(Box<dyn Model>);

/// So long no single verdict takes.
const OTHERS_HAVE_THE_CORE: Duration = Duration::from_millis(2);

static VALIDITY_NS: AtomicU64 = AtomicU64::new(0);

fn timed<T>(work: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let result = work();
    // This clock is cheap enough for every motion, but also runs while others have the core.
    let elapsed = begun.elapsed();
    if elapsed < OTHERS_HAVE_THE_CORE {
        VALIDITY_NS.fetch_add(elapsed.as_nanos() as u64, Ordering::Relaxed);
    }
    result
}

impl Model for Timed {
    fn space(&self) -> &Space {
        self.0.space()
    }
    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        timed(|| self.0.validity(q, scratch))
    }
    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        timed(|| self.0.motion(a, b, refinement, scratch))
    }
    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        self.0.reasons(q, depths)
    }
    fn is_obstructed(&self) -> bool {
        self.0.is_obstructed()
    }
}

fn main() {
    let words: Vec<String> =
        std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let mut numbers = words.iter().filter_map(|word| word.parse::<u64>().ok());
    let nodes = numbers.next().unwrap_or(100_000);
    let set = numbers.next().unwrap_or(100);
    let names: Vec<_> = words.iter().filter(|word| word.parse::<u64>().is_err()).collect();
    let wanted = |name: &str| names.is_empty() || names.iter().any(|word| *word == name);

    let problems = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
    let walls = Problem::load(&problems.join("walls.toml")).expect("walls ship");
    if wanted("sparse") {
        let resolution = 20.0 * walls.model().bodies().expect("bodies").resolution();
        let sparse = walls.to_builder().name("sparse").change_model(|model| {
            model.change_bodies(|bodies| bodies.change_space(|space| space.resolution(resolution)))
        });
        grow(sparse.build().expect("a sound problem"), nodes, set);
    }
    if wanted("walls") {
        grow(walls, nodes, set);
    }
    match std::env::var_os("ROADMILL_DATA") {
        Some(data) if wanted("cubicles") => {
            let scene = Path::new(&data).join("scenes/ompl/cubicles.cfg");
            grow(Problem::load(&scene).unwrap_or_else(|error| panic!("{error}")), nodes, set);
        }
        Some(_) => {}
        None => println!("cubicles: skipped, ROADMILL_DATA is not set"),
    }
}

/// Seconds of CPU so far, by kind of work.
#[derive(Clone, Copy, Default)]
struct Spent {
    all: f64,
    validity: f64,
    generate: f64,
    join: f64,
    fold: f64,
}

fn grow(problem: Problem, nodes: u64, set: u64) {
    let problem = problem.to_builder().change_strategies(|strategy| strategy.nodes(set)).build();
    let problem = problem.unwrap_or_else(|error| panic!("{error}"));
    println!("{}: sets of {set} nodes", problem.name());
    println!(
        "   nodes  µs/node  validity  generate   join   fold  neighbours  components  edges/node  bytes/node"
    );
    let setup = Setup::new(problem).wrap_model(|model| Box::new(Timed(model)));
    let before = resident_bytes();
    let mut replica = Replica::new(&setup);
    let mut scratch = Scratch::new();
    let (mut spent, mut mark) = (Spent::default(), Spent::default());
    let (mut number, mut points) = (SetNumber(0), Vec::new());
    for size in SIZES.into_iter().take_while(|size| *size <= nodes) {
        let mut marked = 0;
        loop {
            let grown = replica.roadmap().configs().len() as u64;
            if grown >= size {
                break;
            }
            if grown < size - size / 10 {
                (mark, marked) = (spent, grown);
            }
            grow_by_one(&setup, &mut replica, number, &mut scratch, &mut spent);
            number = number.next();
        }
        let roadmap = replica.roadmap();
        let count = roadmap.configs().len() as f64;
        let since = count - marked as f64;
        let micros = |now: f64, then: f64| (now - then) * 1e6 / since;
        let all = micros(spent.all, mark.all);
        let validity = micros(spent.validity, mark.validity);
        println!(
            "{count:8} {all:8.1} {validity:9.1} {:9.1} {:6.1} {:6.1} {:11.1} {:11} {:11.1} {:11.0}",
            micros(spent.generate, mark.generate),
            micros(spent.join, mark.join),
            micros(spent.fold, mark.fold),
            neighbours(&setup, &replica),
            roadmap.components().count(),
            roadmap.edges().len() as f64 / count,
            resident_bytes().saturating_sub(before) as f64 / count,
        );
        points.push((count, all, all - validity));
    }
    let exponent = |of: fn(&(f64, f64, f64)) -> f64| {
        slope(&points.iter().map(|point| (point.0, of(point))).collect::<Vec<_>>())
    };
    println!(
        "         exponent {:.3}, without validity {:.3}; digest {}",
        exponent(|point| point.1),
        exponent(|point| point.2),
        replica.roadmap().digest(),
    );
}

/// Generates, joins and folds one set.
fn grow_by_one(
    setup: &Setup,
    replica: &mut Replica,
    number: SetNumber,
    scratch: &mut Scratch,
    spent: &mut Spent,
) {
    let begun = cpu_seconds();
    let mut split = |since: f64, of: &mut f64| {
        let now = cpu_seconds();
        let validity = VALIDITY_NS.swap(0, Ordering::Relaxed) as f64 * 1e-9;
        spent.validity += validity;
        *of += now - since - validity;
        now
    };
    let (mut generate, mut join, mut fold) = (0.0, 0.0, 0.0);
    let name = setup.plan().name_of(number).expect("the schedule does not adapt");
    let SetName { strategy, ordinal } = name;
    let generate_set = Job::Generate { number, strategy, ordinal };
    let task = replica.task(setup, generate_set).expect("sets can be generated");
    let Outcome::Increment(Ok(increment)) = task.run(setup, scratch) else {
        panic!("the scene has free configurations")
    };
    let now = split(begun, &mut generate);
    replica.publish(setup, Arc::new(increment));
    let now = split(now, &mut fold);
    let join_set = Job::Join { number, strategy, ordinal };
    let task = replica.task(setup, join_set).expect("the set is published");
    let Outcome::Joined(Joined { edges, .. }) = task.run(setup, scratch) else {
        panic!("joins give edges")
    };
    drop(task);
    let now = split(now, &mut join);
    replica.fold(setup, std::iter::once(&edges[..]));
    let end = split(now, &mut fold);
    spent.generate += generate;
    spent.join += join;
    spent.fold += fold;
    spent.all += end - begun;
}

/// Microseconds per search for a random configuration's ten nearest milestones.
fn neighbours(setup: &Setup, replica: &Replica) -> f64 {
    let (space, roadmap) = (setup.context().space(), replica.roadmap());
    let mut stream = Seed::of_set(1, "growth", Ordinal(0)).stream(Purpose::Sampling);
    let mut q = vec![0.0; space.len()];
    let (mut seconds, searches) = (0.0, 100);
    for _ in 0..searches {
        space.sample_uniform(&mut stream, &mut q);
        let begun = cpu_seconds();
        let k = Attachment::default().neighbors as usize;
        let near = roadmap.k_nearest(space, &q, k);
        seconds += cpu_seconds() - begun;
        assert_eq!(near.len(), k);
    }
    seconds * 1e6 / f64::from(searches)
}

/// The exponent of the power law closest to the points.
fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<_> = points.iter().map(|(x, y)| (libm::log(*x), libm::log(*y))).collect();
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let (mut above, mut below) = (0.0, 0.0);
    for (a, b) in &logs {
        above += (a - x) * (b - y);
        below += (a - x) * (a - x);
    }
    above / below
}

fn resident_bytes() -> u64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = text.split(' ').nth(1).and_then(|word| word.parse::<u64>().ok());
    pages.unwrap_or(0) * rustix::param::page_size() as u64
}
