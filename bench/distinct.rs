//! How many topologically different paths a graph has, by the number of directions in which its nodes are extended.
//!
//! ```text
//! cargo bench --bench distinct -- [NODES [SEEDS [M]]]
//! ```
//!
//! An mRRG of NODES nodes (default 1000) grows in the cluttered plane of S. K. Nath's thesis (2013, §5.2.1), with m = 1 to 7 directions, or M alone, and
//! for seeds 1 to SEEDS (default 10); the obstacles are others for every seed. Of the shortest routes of the 100 classes of
//! paths whose shortest routes are the shortest (`pathways::distinct`, without shortcuts): how long the first, the tenth and the
//! hundredth is, and how many are at most a twentieth and a tenth longer than the first; mean ± standard deviation. Where a graph does
//! not join start and goal, or has fewer than 100 classes, that is counted and left out.

#[path = "neighbors/scenes.rs"]
#[allow(dead_code, reason = "one of its scenes is used")]
mod scenes;

use roadmill::model::Scratch;
use roadmill::pathways::topology::Topology;
use roadmill::pathways::{Distinct, distinct};
use roadmill::problem::Problem;
use roadmill::{Build, Cancel};
use scenes::{Environment, Robot, Scene};
use std::path::Path;

const CLASSES: usize = 100;

fn main() {
    let mut words =
        std::env::args().skip(1).filter(|word| word != "--bench").map(|word| word.parse::<u64>());
    let mut number = |default| words.next().map_or(default, |word| word.expect("a number"));
    let (nodes, seeds, alone) = (number(1000), number(10), number(0));
    println!("{nodes} nodes, seeds 1 to {seeds}, mean ± standard deviation\n");
    println!("| m | shortest | tenth | hundredth | within 5 % | within 10 % | edges | left out |");
    println!("|---|---|---|---|---|---|---|---|");
    for directions in (1..=7).filter(|directions| [0, u64::from(*directions)].contains(&alone)) {
        let rows: Vec<Option<[f64; 6]>> =
            (1..=seeds).map(|seed| measure(seed, directions, nodes)).collect();
        let left_out = rows.iter().filter(|row| row.is_none()).count();
        let rows: Vec<[f64; 6]> = rows.into_iter().flatten().collect();
        let cell = |column: usize, digits: usize| {
            if rows.is_empty() {
                return "-".to_owned();
            }
            let count = rows.len() as f64;
            let mean = rows.iter().map(|row| row[column]).sum::<f64>() / count;
            let square = |row: &[f64; 6]| (row[column] - mean) * (row[column] - mean);
            let deviation = (rows.iter().map(square).sum::<f64>() / (count - 1.0).max(1.0)).sqrt();
            format!("{mean:.digits$} ± {deviation:.digits$}")
        };
        let cells: Vec<_> =
            [2, 2, 2, 0, 0, 0].into_iter().enumerate().map(|(c, d)| cell(c, d)).collect();
        println!("| {directions} | {} | {left_out} |", cells.join(" | "));
    }
}

fn measure(seed: u64, directions: u32, nodes: u64) -> Option<[f64; 6]> {
    let scene = Scene { environment: Environment::Clutter, robot: Robot::Cube };
    let (step, in_set) = (scene.step(), 50);
    let text = format!(
        "{}[img]\nsets_per_round = 1\n[[strategies]]\nlabel = \"graph\"\nnodes = {in_set}\n\
         generator = {{ mrrg = {{ step = {step}, goal_bias = 0, directions = {directions} }} }}\n\
         among = {{ until-joined = {{}} }}\n\
         [[evaluators]]\nall = [{{ query = {{}} }}, {{ not = {{ query = {{}} }} }}]\n\
         [limits]\nsets = {}\n",
        scene.text(seed),
        nodes / in_set
    );
    let problem = Problem::parse(Path::new("distinct.toml"), &text);
    let problem = problem.unwrap_or_else(|error| panic!("{error}"));
    let built = Build::new(problem).threads(1).run().unwrap_or_else(|error| panic!("{error}"));
    let (cx, scratch) = (built.context(), &mut Scratch::new());
    let description = built.problem().model().description();
    let topology = Topology::of(cx, description, scratch).expect("bodies have obstacles");
    let asked = Distinct { count: CLASSES, spacing: 10.0, tries: 1000, shortcuts: 0 };
    let ends = cx.query().expect("a query");
    let attachment = built.problem().attachment();
    let (roadmap, cancel) = (built.roadmap(), Cancel::new());
    let found = distinct(cx, roadmap, ends, &attachment, &topology, &asked, &cancel, scratch);
    let found = found.unwrap_or_else(|error| panic!("{error}")).pathways.pathways;
    let lengths: Vec<f64> = found.iter().map(|pathway| pathway.path.length).collect();
    if lengths.len() < CLASSES {
        return None;
    }
    let within =
        |share: f64| lengths.iter().filter(|length| **length <= share * lengths[0]).count();
    let edges = roadmap.edges().len() as f64;
    Some([lengths[0], lengths[9], lengths[99], within(1.05) as f64, within(1.1) as f64, edges])
}
