//! How far more workers help: the build's own state machine with up to 4096 workers in virtual time.
//!
//! ```text
//! cargo bench -p roadmill-coordinator --bench workers -- [--nodes N] [--set NODES] [--slower F] [--shared] [--set-us U]
//!     [--message-us U] [--latency-us U] [--gigabytes G] [--svg FILE] SCENE
//! cargo bench -p roadmill-coordinator --bench workers -- --agents CORES [--way-us U] [--network-gigabits G] [--nodes N] [--set NODES] … SCENE
//! ```
//!
//! First the scene is grown up to N nodes (default 20 000), in sets of NODES (as the scene says), by doing
//! every job once, and the CPU time of each is noted over the second half: generating a set, taking it in
//! (decoding it, finding its components), joining it, folding it; of the criterion, judging the last roadmap
//! that does not meet it. Then 256 sets are joined as one round, which gives what every earlier set of a
//! round adds to a join. Then `img::Core` is driven by workers that take these times
//! (`bench/support/virtual_staff.rs`), jobs being F times longer with `--slower`: proteins' energies take
//! far longer than rigid bodies' tests. The coordinator works U microseconds per set (default 60, which
//! is right for sets of 50 nodes) and 40 per message, which brings jobs of up to 20 ms; messages arrive after
//! 45 µs and are copied at 0.8 GB/s, 90 bytes per set and worker
//! (`docs/performance.md` has these). As in the program, every worker takes in all sets before its next job:
//! configurations, edges and segments lie in memory once, but which component a node is in each keeps for
//! itself. With `--shared` that is done once for all.
//!
//! With `--agents` the workers are those of agents with CORES workers each: every agent is sent every set that it has not
//! made itself, over a network of G gigabits a second (default 1) at the coordinator, a message taking U microseconds
//! (default 250) from one end to the other, and workers hold as much more work as a round trip takes. The bytes are those of the
//! encoded outcomes.
//!
//! Printed per number of workers and sets per round: the efficiency, that is the share of the workers' time
//! in which they do what a single process would do for the same sets; and what most of the loss goes
//! into where that is under 0.9: `copies`, that is taking in sets, the `coordinator` (at work for over 70 % of the
//! time), longer joins in `rounds` of many sets, the `criteria`, or else `waiting` for the end of a round.
//! Costs are those of a roadmap of N nodes throughout.

#[path = "support/plot.rs"]
#[allow(dead_code, reason = "each bench uses its part")]
mod plot;
#[path = "support/timing.rs"]
mod timing;
#[path = "support/virtual_staff.rs"]
mod virtual_staff;

use plot::{COLOURS, Plot, Scale};
use roadmill::img::{Core, Job, Joined, Observer, Outcome, Replica, Setup, Task, drive};
use roadmill::internal::wire;
use roadmill::model::Scratch;
use roadmill::numbers::{EvaluatorIndex, SetName, SetNumber};
use roadmill::problem::{NODES_MAX, Problem};
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;
use timing::{cpu_seconds, median};
use virtual_staff::{Costs, Machine, Network, Spent, TOLD_BYTES, VirtualStaff};

const WORKERS: [usize; 7] = [1, 4, 16, 64, 256, 1024, 4096];
const SETS_PER_ROUND: [u32; 5] = [5, 50, 500, 5000, 20_000];
/// As `coordinator` has it.
const LOOKAHEAD_PER_WORKER: u64 = 8;
const HELD_SECONDS: f64 = 0.02;
/// A coordinator that is at work for a larger share of the time is what workers wait for.
const BUSY: f64 = 0.7;
/// What is built in virtual time: a point in an empty room, judged as other problems are.
const NOTHING: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[query]
start = [1.0, 1.0]
goal = [8.0, 8.0]
[[strategies]]
label = "a"
nodes = 1
sampler = { uniform = {} }
"#;
/// Sets joined as one round.
const ROUND: u64 = 256;

struct Arguments {
    nodes: u64,
    set: Option<u32>,
    machine: Machine,
    svg: Option<String>,
    scene: String,
}

fn arguments() -> Option<Arguments> {
    let machine = Machine {
        set_seconds: 60e-6,
        message_seconds: 40e-6,
        latency: 45e-6,
        bytes_per_second: 0.8e9,
        slower: 1.0,
        shared: false,
        network: None,
    };
    let mut network =
        Network { cores: 0, latency: 250e-6, bytes_per_second: 0.125e9, set_bytes: 0.0 };
    let (mut nodes, mut machine, mut svg, mut scene) = (20_000, machine, None, None);
    let mut set = None;
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        let mut number = || {
            let number = words.next().and_then(|word| word.parse::<f64>().ok());
            number.unwrap_or_else(|| panic!("a number after {word}"))
        };
        match word.as_str() {
            "--nodes" => nodes = number() as u64,
            "--set" => set = Some(number() as u32),
            "--slower" => machine.slower = number(),
            "--shared" => machine.shared = true,
            "--agents" => network.cores = number() as usize,
            "--way-us" => network.latency = number() * 1e-6,
            "--network-gigabits" => network.bytes_per_second = number() * 0.125e9,
            "--set-us" => machine.set_seconds = number() * 1e-6,
            "--message-us" => machine.message_seconds = number() * 1e-6,
            "--latency-us" => machine.latency = number() * 1e-6,
            "--gigabytes" => machine.bytes_per_second = number() * 1e9,
            "--svg" => svg = words.next(),
            _ => scene = Some(word),
        }
    }
    machine.network = (network.cores > 0).then_some(network);
    Some(Arguments { nodes, set, machine, svg, scene: scene? })
}

fn main() {
    let Some(Arguments { nodes, set, mut machine, svg, scene }) = arguments() else {
        println!("workers: skipped, no scene given");
        return;
    };
    // Strategies take turns: what adapts cannot be measured job by job.
    let turns = |problem: Problem| match problem.adaptive() {
        Some(_) => problem.to_builder().default_schedule().build(),
        None => Ok(problem),
    };
    let problem = Problem::load(Path::new(&scene)).and_then(|problem| match set {
        Some(set) => problem.to_builder().change_strategies(|s| s.nodes(set.into())).build(),
        None => Ok(problem),
    });
    let problem = problem.and_then(turns);
    let problem = problem.unwrap_or_else(|error| panic!("{error}"));
    let (costs, set_bytes) = measure(&problem, nodes);
    if let Some(network) = &mut machine.network {
        network.set_bytes = set_bytes;
    }
    let mean = |values: &[f64]| 1e6 * values.iter().sum::<f64>() / values.len() as f64;
    println!(
        "{}: sets of {} nodes: generate {:.0} µs, take in {:.0}, join {:.0} and {:.2} for every earlier set of the round, fold {:.0}; evaluate {:.0} µs",
        problem.name(),
        problem.strategies()[0].nodes(),
        mean(&costs.generate),
        1e6 * costs.take_in,
        mean(&costs.join),
        1e6 * costs.join_more,
        1e6 * costs.fold,
        1e6 * costs.evaluate,
    );
    let set = machine.slower * (mean(&costs.generate) + mean(&costs.join))
        + 1e6 * (costs.take_in + costs.fold);
    println!(
        "{machine:?}\na set's work is {set:.0} µs: the coordinator feeds at most {:.0} workers; telling another takes it {:.2} µs per set\n",
        set / (1e6 * machine.set_seconds),
        1e6 * TOLD_BYTES / machine.bytes_per_second,
    );
    println!("| workers |{}", SETS_PER_ROUND.map(|k| format!(" {k} sets per round |")).concat());
    println!("|{}", " --- |".repeat(1 + SETS_PER_ROUND.len()));
    let mut curves = SETS_PER_ROUND.map(|_| Vec::new());
    for workers in WORKERS {
        let cells = SETS_PER_ROUND.iter().zip(&mut curves).map(|(sets_per_round, curve)| {
            let (efficiency, loss) = run(&problem, (&costs, machine), workers, *sets_per_round);
            curve.push([workers as f64, efficiency]);
            let loss = if efficiency < 0.9 { format!(", {loss}") } else { String::new() };
            format!(" {efficiency:.3}{loss} |")
        });
        println!("| {workers} |{}", cells.collect::<String>());
    }
    if let Some(file) = svg {
        let slower = match machine.slower {
            1.0 => String::new(),
            slower => format!(", sets {slower} times slower"),
        };
        let shared = if machine.shared { ", one taking sets in for all" } else { "" };
        let title = format!("{}{slower}: efficiency of workers{shared}", problem.name());
        std::fs::write(file, picture(&title, &curves)).expect("the file can be written");
    }
}

/// The real jobs, once each; and the bytes of a set and the edges that join it.
fn measure(problem: &Problem, nodes: u64) -> (Costs, f64) {
    let single = problem.to_builder().sets_per_round(1).build();
    let setup = Setup::new(single.expect("a sound problem"));
    let (mut replica, scratch) = (Replica::new(&setup), &mut Scratch::new());
    let mut costs = Costs::default();
    let (mut take_in, mut fold, mut sizes) = (Vec::new(), Vec::new(), Vec::new());
    let (mut number, mut met) = (SetNumber(0), problem.evaluators().is_empty());
    while (replica.roadmap().configs().len() as u64) < nodes {
        let (bytes, generate) = timed(|| generate(&setup, &replica, number, scratch));
        let ((), taking) = timed(|| take(&setup, &mut replica, &bytes));
        let (Joined { edges, .. }, join) = timed(|| join(&setup, &replica, number, scratch));
        let ((), folding) = timed(|| replica.fold(&setup, std::iter::once(&edges[..])));
        if !met {
            let roadmap = replica.roadmap().clone();
            let task = Task::Evaluate { evaluator: EvaluatorIndex(0), roadmap };
            let (outcome, seconds) = timed(|| task.run(&setup, scratch));
            let Outcome::Verdict(verdict) = outcome else { panic!("evaluations give verdicts") };
            met = verdict.satisfied;
            if !met {
                costs.evaluate = seconds;
            }
        }
        number = number.next();
        if replica.roadmap().configs().len() as u64 > nodes / 2 {
            costs.generate.push(generate);
            costs.join.push(join);
            take_in.push(taking);
            let joined =
                Outcome::Joined(Joined { edges: edges.clone(), asked: Default::default() });
            sizes.push((bytes.len() + wire::encode(&joined).len()) as f64);
            fold.push(folding);
        }
    }
    // The mean: a set that waits for an index to be built anew does so in every copy.
    costs.take_in = take_in.iter().sum::<f64>() / take_in.len() as f64;
    costs.fold = fold.iter().sum::<f64>() / fold.len() as f64;
    let mut joins = Vec::new();
    // Sets that grow are of a round each: what earlier sets of a round add is then left out.
    let grows = problem.strategies().iter().any(|strategy| strategy.generator().grows());
    for earlier in 0..if grows { 4 } else { ROUND } {
        if grows {
            joins.push(0.0);
            continue;
        }
        let bytes = generate(&setup, &replica, number + earlier, scratch);
        take(&setup, &mut replica, &bytes);
        joins.push(timed(|| join(&setup, &replica, number + earlier, scratch)).1);
    }
    let quarter = joins.len() / 4;
    let late = median(&mut joins[3 * quarter..].to_vec());
    let early = median(&mut joins[..quarter].to_vec());
    costs.join_more = (late - early) / (3 * quarter) as f64;
    (costs, sizes.iter().sum::<f64>() / sizes.len() as f64)
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = cpu_seconds();
    (work(), cpu_seconds() - begun)
}

fn generate(setup: &Setup, replica: &Replica, number: SetNumber, scratch: &mut Scratch) -> Vec<u8> {
    let name = setup.plan().name_of(number).expect("the schedule does not adapt");
    let SetName { strategy, ordinal } = name;
    let job = Job::Generate { number, strategy, ordinal };
    let task = replica.task(setup, job).expect("sets can be generated");
    let outcome = task.run(setup, scratch);
    assert!(matches!(outcome, Outcome::Increment(Ok(_))), "the scene has free configurations");
    wire::encode(&outcome)
}

fn take(setup: &Setup, replica: &mut Replica, bytes: &[u8]) {
    let Ok(Outcome::Increment(Ok(increment))) = wire::decode(bytes) else {
        panic!("what was encoded")
    };
    replica.publish(setup, Arc::new(increment));
}

fn join(setup: &Setup, replica: &Replica, number: SetNumber, scratch: &mut Scratch) -> Joined {
    let name = setup.plan().name_of(number).expect("the schedule does not adapt");
    let SetName { strategy, ordinal } = name;
    let job = Job::Join { number, strategy, ordinal };
    let task = replica.task(setup, job).expect("the set is published");
    let Outcome::Joined(joined) = task.run(setup, scratch) else { panic!("joins give edges") };
    joined
}

/// The efficiency once all are at work, and what most of the loss goes into.
fn run(
    problem: &Problem,
    (costs, machine): (&Costs, Machine),
    workers: usize,
    sets_per_round: u32,
) -> (f64, &'static str) {
    // No job is done, so that any model will do: nothing in an empty room is ready at once.
    let nothing = Problem::parse("nothing".as_ref(), NOTHING).expect("a sound problem");
    let (mut endless, judged) = (nothing.to_builder(), !problem.evaluators().is_empty());
    if !judged {
        endless = endless.evaluators([]);
    }
    let endless = endless
        .sets_per_round(sets_per_round.into())
        .most_nodes(NODES_MAX)
        .most_sets(u64::MAX)
        .build();
    let setup = Setup::new(endless.unwrap_or_else(|error| panic!("{error}")));
    let sets = (12 * workers as u64).max(6 * u64::from(sets_per_round)).max(1000);
    // With agents, as much more as a round trip takes of the work that a core is given at once.
    let longer = machine.network.map_or(1.0, |network| 1.0 + 2.0 * network.latency / HELD_SECONDS);
    let lookahead = (LOOKAHEAD_PER_WORKER as f64 * workers as f64 * longer).ceil() as u64;
    let mut core = Core::new(&setup, lookahead);
    let mut pool = VirtualStaff::new(&setup, (costs, machine), workers, sets);
    struct Nobody;
    impl Observer for Nobody {
        type Error = Infallible;
    }
    let Ok(_) = drive(&mut core, &mut pool, &mut Nobody);
    let (warm, end) = (pool.warm.expect("a third is less than all"), pool.spent);
    let since = |of: fn(&Spent) -> f64| of(&end) - of(&warm);
    let elapsed = since(|spent| spent.now);
    let sets = (end.sets - warm.sets) as f64;
    let all = workers as f64 * elapsed;
    // What the jobs of these sets took, not sets times the mean: their times differ, of a protein by orders of magnitude.
    let checking = since(|spent| spent.jobs - spent.rounds - spent.evaluations);
    let useful = checking + sets * (costs.take_in + costs.fold);
    let waiting = all - since(|spent| spent.jobs) - since(|spent| spent.copies);
    let busy = since(|spent| spent.coordinator) > BUSY * elapsed;
    let losses = [
        (since(|spent| spent.rounds), "rounds"),
        (since(|spent| spent.evaluations), "criteria"),
        (since(|spent| spent.copies) - sets * (costs.take_in + costs.fold), "copies"),
        (waiting, if busy { "coordinator" } else { "waiting" }),
    ];
    let loss = losses.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("four");
    (useful / all, loss.1)
}

fn picture(title: &str, curves: &[Vec<[f64; 2]>]) -> String {
    let x = Scale { low: 1.0, high: 4096.0, log: true };
    let y = Scale { low: 0.0, high: 1.1, log: false };
    let mut plot = Plot::new(title, ["workers", "efficiency"], [900.0, 460.0], x, y);
    plot.columns(&WORKERS.map(|workers| (workers as f64, workers.to_string())));
    plot.rows(&[0.0, 0.25, 0.5, 0.75, 0.9, 1.0].map(|share| (share, format!("{share}"))));
    let names = SETS_PER_ROUND.iter().zip(COLOURS);
    plot.legend(
        &names.map(|(k, colour)| (format!("{k} sets a round"), colour)).collect::<Vec<_>>(),
    );
    for (curve, colour) in curves.iter().zip(COLOURS) {
        plot.line(curve, colour);
    }
    plot.finish()
}
