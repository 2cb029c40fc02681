//! What of a roadmap is valid still when an obstacle has come: by what has changed alone, against a check of everything.
//!
//! ```text
//! cargo bench -p roadmill --bench revalidation [-- [--edges N] [SCENE]]
//! ```
//!
//! The roadmap is of a scene, `problems/walls.toml` if nothing is said: uniform milestones, each with its 15 nearest, as many
//! valid edges as asked for, 1 000 000 if nothing is said. The obstacle that comes is a cube in the middle of the second
//! room; its size is halved in on, over the first 20 000 edges, until it stands in the way of one edge in a hundred.
//! *Revalidation* is [`Revalidation`], over all nodes and then the edges between valid ones, *full* the check of the same in
//! the whole new scene. Seconds of CPU time of one thread, the two in turn, medians of three. All verdicts are compared:
//! `wrongly kept` are those that the full check refuses, `wrongly dropped` those that it accepts.

mod support;

use roadmill::Context;
use roadmill::local::{self, Planner};
use roadmill::model::Scratch;
use roadmill::model::bodies::{BodySpec, ShapeSpec};
use roadmill::neighbor::k_nearest_graph;
use roadmill::problem::Problem;
use roadmill::replan::Revalidation;
use roadmill::roadmap::Configs;
use std::path::PathBuf;
use support::{cpu_seconds, median, sample};

const EDGES: usize = 1_000_000;
const NEIGHBORS: u32 = 15;
/// Milestones for each edge: with so many neighbours there are somewhat more edges than asked for, of which most are valid.
const MILESTONES_PER_EDGE: f64 = 0.12;
const MIDDLE: [f64; 3] = [3.0, 2.0, 2.0];
/// Of how many edges the obstacle stands in the way.
const SHARE: f64 = 0.01;
/// Of the edges by which its size is found.
const LOOKED_AT: usize = 20_000;
const ROUNDS: usize = 3;

fn main() {
    let (mut count, mut scene) = (EDGES, PathBuf::from("problems/walls.toml"));
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        match word.as_str() {
            "--edges" => {
                let text = words.next().unwrap_or_default();
                count = text.parse().unwrap_or_else(|_| panic!("--edges: a number"));
            }
            _ => scene = PathBuf::from(word),
        }
    }
    let before = Problem::load(&scene).unwrap_or_else(|error| panic!("{error}"));
    let (configs, edges) = roadmap(&before.context(), count);
    let size = size_of(&before, &configs, &edges[..LOOKED_AT.min(edges.len())]);
    let after = with_cube(&before, size);
    let change = before.model().description().change(after.model()).expect("the same robot");
    let cx = after.context();
    let (mut seconds, mut verdicts) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
    let mut close = 0;
    for _ in 0..ROUNDS {
        let (begun, scratch) = (cpu_seconds(), &mut Scratch::new());
        let mut revalidation = Revalidation::new(&cx, &change);
        verdicts[0] = kept(
            &configs,
            &edges,
            &mut (&mut revalidation, scratch),
            |(revalidation, scratch), q| revalidation.keeps_node(q, scratch),
            |(revalidation, scratch), ends| {
                revalidation.keeps_motion(Planner::StraightLine, ends, 1, scratch).is_some()
            },
        );
        seconds[0].push(cpu_seconds() - begun);
        close = revalidation.checked();
        let (begun, mut scratch) = (cpu_seconds(), Scratch::new());
        verdicts[1] = kept(
            &configs,
            &edges,
            &mut scratch,
            |scratch, q| cx.model().is_valid(q, scratch),
            |scratch, ends| {
                local::connect(&cx, &[Planner::StraightLine], ends, 1, scratch).is_some()
            },
        );
        seconds[1].push(cpu_seconds() - begun);
    }
    let [revalidated, full] = seconds.map(|mut seconds| median(&mut seconds));
    let differ = |kept: bool| {
        let pairs = verdicts[0].iter().zip(&verdicts[1]);
        pairs.filter(|(one, other)| one != other && **one == kept).count()
    };
    let dropped = verdicts[0][configs.len()..].iter().filter(|kept| !**kept).count();
    let share = dropped as f64 / edges.len() as f64;
    println!("scene             {}", before.name());
    println!("obstacle          a cube of {size:.3} at {MIDDLE:?}");
    println!("nodes             {}", configs.len());
    println!("edges             {}", edges.len());
    println!("looked at closely {close} nodes and edges");
    println!("edges dropped     {dropped} ({:.2} %)", 100.0 * share);
    println!("revalidation      {revalidated:.3} s");
    println!("full check        {full:.3} s");
    println!("ratio             {:.1}", full / revalidated);
    println!("wrongly kept      {}", differ(true));
    println!("wrongly dropped   {}", differ(false));
}

/// The verdicts on all nodes, then on all edges; an edge with an end that is not valid is not.
fn kept<T>(
    configs: &Configs,
    edges: &[(u32, u32)],
    state: &mut T,
    node: impl Fn(&mut T, &[f64]) -> bool,
    edge: impl Fn(&mut T, (&[f64], &[f64])) -> bool,
) -> Vec<bool> {
    let mut kept = Vec::with_capacity(configs.len() + edges.len());
    kept.extend(configs.iter().map(|q| node(state, q)));
    for (low, high) in edges {
        let [low, high] = [*low as usize, *high as usize];
        let valid = kept[low] && kept[high];
        let is_kept = valid && edge(state, (configs.get(low), configs.get(high)));
        kept.push(is_kept);
    }
    kept
}

/// Milestones and `count` valid edges between them.
fn roadmap(cx: &Context, count: usize) -> (Configs, Vec<(u32, u32)>) {
    let configs = sample(cx, (count as f64 * MILESTONES_PER_EDGE) as usize, 0);
    let scratch = &mut Scratch::new();
    let pairs = k_nearest_graph(cx.space(), &configs, NEIGHBORS as usize).into_iter();
    let valid = pairs.filter(|(low, high)| {
        let (a, b) = (configs.get(*low as usize), configs.get(*high as usize));
        cx.model().motion(a, b, 1, scratch).is_some()
    });
    let edges: Vec<_> = valid.take(count).collect();
    assert_eq!(edges.len(), count, "too few valid edges");
    (configs, edges)
}

fn with_cube(before: &Problem, size: f64) -> Problem {
    let cube = BodySpec::new(ShapeSpec::Box { size: [size; 3] }).at(MIDDLE);
    let builder = before
        .to_builder()
        .change_model(|model| model.change_bodies(|bodies| bodies.obstacle(cube)));
    builder.build().unwrap_or_else(|error| panic!("{error}"))
}

/// The size of the cube that stands in the way of the share of these edges.
fn size_of(before: &Problem, configs: &Configs, edges: &[(u32, u32)]) -> f64 {
    let (mut low, mut high) = (0.0, 1.5);
    for _ in 0..12 {
        let size = 0.5 * (low + high);
        let (cx, scratch) = (with_cube(before, size).context(), &mut Scratch::new());
        let is_blocked = |pair: &&(u32, u32)| {
            let (a, b) = (configs.get(pair.0 as usize), configs.get(pair.1 as usize));
            !(cx.model().is_valid(a, scratch)
                && cx.model().is_valid(b, scratch)
                && cx.model().motion(a, b, 1, scratch).is_some())
        };
        let blocked = edges.iter().filter(is_blocked).count();
        match (blocked as f64) < SHARE * edges.len() as f64 {
            true => low = size,
            false => high = size,
        }
    }
    0.5 * (low + high)
}
