//! Figures 12 to 16 of the thesis: an RRG with neighbours within a hop limit, beside an RRG with all.
//!
//! For one seed all of them have the same nodes, since edges do not decide where the graph grows; so they can be compared
//! edge by edge, with an RRT, which has no neighbours, to tell what neighbours cost.

use super::scenes::Scene;
use super::support::cpu_seconds;
use roadmill::img::{Job, Outcome, Replica, Setup};
use roadmill::model::{Cost, Model, Reason, Scratch, Validity};
use roadmill::numbers::{SetName, SetNumber};
use roadmill::space::Space;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::sync::Arc;

const LIMITS: [(&str, &str); 5] = [
    ("h = 1", "{ hop_limit = 1, finder = { brute-force = { neighbors = \"auto\" } } }"),
    ("h = 2", "{ hop_limit = 2, finder = { brute-force = { neighbors = \"auto\" } } }"),
    ("h = 3", "{ hop_limit = 3, finder = { brute-force = { neighbors = \"auto\" } } }"),
    ("brute force", "{ finder = { brute-force = { neighbors = \"auto\" } } }"),
    ("index", "\"auto\""),
];

/// What happened since the counts were last taken.
#[derive(Clone, Default)]
struct Counts {
    /// Motions to neighbours, not those of extensions.
    attempts: u64,
    successes: u64,
    /// CPU seconds from the end of a successful extension to the first motion to a neighbour.
    to_neighbor: f64,
    /// Where no neighbour was tried, CPU seconds to the next extension, which has its own search; and how often.
    to_extension: (f64, u64),
    /// CPU seconds that motions to neighbours took.
    motions: f64,
}

/// What was asked last.
#[derive(Clone, Copy, Default, PartialEq)]
enum Last {
    #[default]
    Nothing,
    Validity,
    Extended(f64),
}

thread_local! {
    static SEEN: RefCell<(Counts, Last)> = RefCell::default();
}

/// The problem's model, watched. An extension asks for the validity of a configuration before it asks for the motion there; a
/// motion to a neighbour is asked for alone.
struct Watched(Box<dyn Model>);

impl Model for Watched {
    fn space(&self) -> &Space {
        self.0.space()
    }
    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        SEEN.with_borrow_mut(|(counts, last)| {
            if let Last::Extended(since) = last {
                counts.to_extension.0 += cpu_seconds() - *since;
                counts.to_extension.1 += 1;
            }
            *last = Last::Validity;
        });
        self.0.validity(q, scratch)
    }
    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let extends = SEEN.with_borrow_mut(|(counts, last)| {
            let extends = *last == Last::Validity;
            if let Last::Extended(since) = last {
                counts.to_neighbor += cpu_seconds() - *since;
            }
            counts.attempts += u64::from(!extends);
            *last = Last::Nothing;
            extends
        });
        let begun = cpu_seconds();
        let cost = self.0.motion(a, b, refinement, scratch);
        SEEN.with_borrow_mut(|(counts, last)| match extends {
            true if cost.is_some() => *last = Last::Extended(cpu_seconds()),
            true => {}
            false => {
                counts.motions += cpu_seconds() - begun;
                counts.successes += u64::from(cost.is_some());
            }
        });
        cost
    }
    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        self.0.reasons(q, depths)
    }
    fn is_obstructed(&self) -> bool {
        self.0.is_obstructed()
    }
}

struct Graph {
    edges: BTreeSet<(u32, u32)>,
    nodes: String,
    counts: Counts,
    seconds: f64,
}

/// Grows a graph in rounds of one set.
fn grow(scene: Scene, seed: u64, generator: &str, nodes: u64, in_set: u64) -> Graph {
    let problem = scene.problem(seed, generator, in_set);
    let setup = Setup::new(problem).wrap_model(|model| Box::new(Watched(model)));
    let (mut replica, mut scratch) = (Replica::new(&setup), Scratch::new());
    let mut number = SetNumber(0);
    SEEN.set(Default::default());
    let mut seconds = 0.0;
    while (replica.roadmap().configs().len() as u64) < nodes {
        let SetName { strategy, ordinal } = setup.plan().name_of(number).expect("one strategy");
        let job = Job::Generate { number, strategy, ordinal };
        let task = replica.task(&setup, job).expect("sets can be generated");
        let begun = cpu_seconds();
        let Outcome::Increment(made) = task.run(&setup, &mut scratch) else { panic!("a set") };
        seconds += cpu_seconds() - begun;
        drop(task);
        let made = made.unwrap_or_else(|gave_up| panic!("{}: {gave_up:?}", scene.name()));
        replica.publish(&setup, Arc::new(made));
        replica.fold(&setup, std::iter::once(&[][..]));
        number = number.next();
    }
    let roadmap = replica.roadmap();
    let edges = roadmap.edges().iter().map(|edge| (edge.low.0, edge.high.0)).collect();
    let bits = roadmap.configs().iter().flatten().flat_map(|value| value.to_le_bytes());
    let nodes = blake3::hash(&bits.collect::<Vec<u8>>()).to_string();
    Graph { edges, nodes, counts: SEEN.take().0, seconds }
}

#[derive(Default)]
struct Column(Vec<f64>);

impl Column {
    /// Mean ± standard deviation.
    fn text(&self, digits: usize) -> String {
        let count = self.0.len() as f64;
        let mean = self.0.iter().sum::<f64>() / count;
        let squares: f64 = self.0.iter().map(|value| (value - mean) * (value - mean)).sum();
        let deviation = (squares / (count - 1.0).max(1.0)).sqrt();
        format!("{mean:.digits$} ± {deviation:.digits$}")
    }
}

pub fn run(nodes: u64, seeds: RangeInclusive<u64>, wanted: &str) {
    let in_set = 200.max(nodes / 20);
    let (first, last) = (seeds.start(), seeds.end());
    println!(
        "{nodes} nodes in sets of {in_set}, seeds {first} to {last}, mean ± standard deviation\n"
    );
    println!(
        "| scene | neighbours | finding them, ms | motions to them, ms | attempts | success % | edges | same edges % |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for scene in Scene::ALL.into_iter().filter(|scene| scene.name().contains(wanted)) {
        let mut columns: Vec<[Column; 6]> = LIMITS.iter().map(|_| Default::default()).collect();
        let mut whole = Column::default();
        for seed in seeds.clone() {
            let step = scene.step();
            let tree = format!("{{ rrt = {{ step = {step}, goal_bias = 0 }} }}");
            let tree = grow(scene, seed, &tree, nodes, in_set);
            let (time, often) = tree.counts.to_extension;
            let extension = time / often as f64;
            let graphs = LIMITS.map(|(_, neighbors)| {
                let settings = format!("step = {step}, goal_bias = 0, neighbors = {neighbors}");
                grow(scene, seed, &format!("{{ rrg = {{ {settings} }} }}"), nodes, in_set)
            });
            assert!(graphs.iter().all(|graph| graph.nodes == tree.nodes), "edges moved nodes");
            assert_eq!(graphs[3].edges, graphs[4].edges, "the index is exact");
            whole.0.push(graphs[4].seconds * 1e3);
            for (graph, columns) in graphs.iter().zip(&mut columns) {
                let counts = &graph.counts;
                let (time, often) = counts.to_extension;
                let finding = counts.to_neighbor + time;
                let finding = finding - often as f64 * extension;
                let same = graph.edges.intersection(&graphs[3].edges).count() as f64;
                let values = [
                    finding * 1e3,
                    counts.motions * 1e3,
                    counts.attempts as f64,
                    100.0 * counts.successes as f64 / counts.attempts.max(1) as f64,
                    graph.edges.len() as f64,
                    100.0 * same / graphs[3].edges.len() as f64,
                ];
                columns.iter_mut().zip(values).for_each(|(column, value)| column.0.push(value));
            }
        }
        for ((name, _), columns) in LIMITS.iter().zip(&columns) {
            let cells = columns.iter().zip([2, 1, 0, 1, 0, 1]);
            let cells: Vec<_> = cells.map(|(column, digits)| column.text(digits)).collect();
            println!("| {} | {name} | {} |", scene.name(), cells.join(" | "));
        }
        println!(
            "| {} | all of the growth with the index, ms | {} | | | | | |",
            scene.name(),
            whole.text(1)
        );
    }
}
