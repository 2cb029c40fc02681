//! What one search costs, and how good it is.

use super::scenes::linkage;
use super::support::cpu_seconds;
use roadmill::Context;
use roadmill::finder::{
    Approximate, BruteForce, Finder, KNearest, MetricTree, Milestones, Radius, Randomised,
};
use roadmill::model::Scratch;
use roadmill::neighbor::{Neighbor, k_nearest};
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::roadmap::{Components, Configs};
use roadmill::seed::{Purpose, Seed, Stream};
use std::path::Path;

const SIZES: [u64; 4] = [200, 2_000, 20_000, 200_000];
const NEIGHBORS: u32 = 10;
/// So many searches are timed; before them, as many as it takes to have an index built.
const SEARCHES: usize = 200;
const BEFORE: usize = 40;

pub fn run(most: u64) {
    for (space, text) in [
        ("2 (a point in the plane)", body("translation-2d", "[0, 0]", "[10, 10]")),
        ("6 (a rigid body in space)", body("rigid-3d", "[0, 0, 0]", "[10, 10, 10]")),
        ("20 (a chain of 21 bars, its base fixed)", chain(21)),
    ] {
        let problem = Problem::parse(Path::new("queries.toml"), &text);
        let cx = problem.unwrap_or_else(|error| panic!("{error}")).context();
        println!("\n{space}\n");
        println!("| finder | nodes | µs per search | found % | farther, mean | farther, most |");
        println!("|---|---|---|---|---|---|");
        for size in SIZES.into_iter().filter(|size| *size <= most) {
            measure(&cx, size as usize);
        }
    }
}

fn body(motion: &str, min: &str, max: &str) -> String {
    format!(
        "[space]\nmotion = \"{motion}\"\nmin = {min}\nmax = {max}\nbounds = \"body\"\n\
         [robot]\nbodies = [{{ shape = {{ box = {{ size = [2, 1, 1] }} }} }}]\n"
    )
}

fn chain(links: usize) -> String {
    let bounds = "min = [-9, -9, -9]\nmax = [9, 9, 9]\nbounds = \"body\"";
    format!("[space]\nmotion = \"fixed\"\n{bounds}\n[robot]\n{}", linkage(links))
}

fn drawn(cx: &Context, count: usize, stream: &mut Stream) -> Configs {
    let (mut configs, mut q) = (Configs::new(cx.space().len()), vec![0.0; cx.space().len()]);
    for _ in 0..count {
        cx.space().sample_uniform(stream, &mut q);
        configs.push(&q);
    }
    configs
}

fn measure(cx: &Context, size: usize) {
    let mut stream = Seed::of_set(1, "queries", Ordinal(0)).stream(Purpose::Sampling);
    let nodes = drawn(cx, size, &mut stream);
    let queries = drawn(cx, BEFORE + SEARCHES, &mut stream);
    let components = Components::of(cx.space(), &nodes, &[]);
    let all = Milestones::all(&nodes, &components);
    let truth = |q| k_nearest(cx.space(), &nodes, 0..size as u32, q, NEIGHBORS as usize);
    let expected: Vec<Vec<Neighbor>> = queries.iter().skip(BEFORE).map(truth).collect();
    // Within the median distance of the tenth neighbour.
    let mut tenth: Vec<f64> = expected.iter().map(|near| near[near.len() - 1].distance).collect();
    tenth.sort_by(f64::total_cmp);
    let radius = Radius::new(tenth[tenth.len() / 2]);
    let neighbors = NEIGHBORS.into();
    let approximate = |epsilon| Approximate { neighbors, epsilon };
    let [tenth, half, twice] = [0.1, 0.5, 2.0].map(approximate);
    let finders: [(&str, &dyn Finder); 8] = [
        ("brute-force", &BruteForce { neighbors }),
        ("k-nearest", &KNearest { neighbors }),
        ("metric-tree", &MetricTree { neighbors }),
        ("approximate, ε = 0.1", &tenth),
        ("approximate, ε = 0.5", &half),
        ("approximate, ε = 2", &twice),
        ("radius", &radius),
        ("randomised, 10 of 20", &Randomised { neighbors, nearest: None }),
    ];
    for (name, finder) in finders {
        let scratch = &mut Scratch::new();
        let mut search = |q: &[f64]| {
            let mut near = finder.near(cx, &all, q, scratch);
            finder.choose(&mut near, all.total, &mut stream);
            near
        };
        for q in queries.iter().take(BEFORE) {
            search(q);
        }
        let begun = cpu_seconds();
        let found: Vec<Vec<Neighbor>> = queries.iter().skip(BEFORE).map(&mut search).collect();
        let micros = (cpu_seconds() - begun) * 1e6 / SEARCHES as f64;
        print!("| {name} | {size} | {micros:.1} |");
        // A radius promises another thing than the nearest.
        if name == "radius" {
            println!(" | | |");
            continue;
        }
        let (mut same, mut ratios) = (0, Vec::new());
        for (near, nearest) in found.iter().zip(&expected) {
            same += near.iter().filter(|one| nearest.contains(one)).count();
            let pairs = near.iter().zip(nearest);
            ratios.extend(pairs.map(|(near, nearest)| near.distance / nearest.distance));
        }
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        let most = ratios.iter().copied().fold(0.0, f64::max);
        let share = 100.0 * same as f64 / ratios.len() as f64;
        println!(" {share:.1} | {mean:.3} | {most:.3} |");
    }
}
