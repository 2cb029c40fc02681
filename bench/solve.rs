//! How soon scenes are solved, beside OMPL's PRM: the same surfaces, metric resolution and query.
//!
//! ```text
//! ROADMILL_PEER=PEER cargo bench --bench solve -- [--seeds N] [--seconds S] [--among WAYS]
//!     [--csv FILE] [--svg FILE] SCENE …
//! ```
//!
//! PEER is `bench/peers/race.cpp`, built as `bench/race.rs` says. Builds every scene at default settings
//! with seeds 1 to N (default 20), each for at most S CPU seconds (default 60), ours and OMPL's in turn.
//! `--among nearest-nodes,until-joined,…` builds it as often again with other connections among sets
//! (`docs/problems.md`; `component-pairs` is the default). Prints the medians, those of the times over
//! all builds: one that is not solved counts with the seconds that it took. The CSV file gets a line for each
//! build: scene, program, seed, solved or not, nodes, CPU seconds; the SVG file a dot.

mod support;

use roadmill::connect::{AmongKind, ComponentPairs, NearestNodes, UntilJoined};
use roadmill::img::Setup;
use roadmill::local::Planner;
use roadmill::problem::Problem;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use support::peer::{run, scene_text, surfaces};
use support::plot::{COLOURS, Plot, Scale, plain};
use support::{arguments_with, median, solve};

/// Builds of one scene by one program.
#[derive(Default)]
struct Builds {
    scene: String,
    program: String,
    seconds: Vec<f64>,
    nodes: Vec<f64>,
    solved: Vec<bool>,
}

impl Builds {
    fn add(&mut self, seed: u64, solved: bool, nodes: f64, seconds: f64, csv: &mut String) {
        let Builds { scene, program, .. } = self;
        let line = format!("{scene},{program},{seed},{},{nodes},{seconds:.4}", u8::from(solved));
        writeln!(csv, "{line}").expect("memory");
        self.seconds.push(seconds);
        self.nodes.push(nodes);
        self.solved.push(solved);
    }

    fn row(&self, of: f64) -> String {
        let [nodes, seconds] = [&self.nodes, &self.seconds].map(|values| {
            let mut values = values.clone();
            (median(&mut values), values[0], values[values.len() - 1])
        });
        format!(
            "| {} | {} | {} of {} | {:.0} ({:.0}–{:.0}) | {:.3} ({:.3}–{:.2}) | {:.1} |",
            self.scene,
            self.program,
            self.solved.iter().filter(|solved| **solved).count(),
            self.solved.len(),
            nodes.0,
            nodes.1,
            nodes.2,
            seconds.0,
            seconds.1,
            seconds.2,
            of / seconds.0,
        )
    }
}

fn main() {
    let (arguments, words) = arguments_with(20.0, 60.0, &["--among", "--csv", "--svg"]);
    let Ok(peer) = std::env::var("ROADMILL_PEER") else {
        println!("solve: skipped, ROADMILL_PEER does not name the built bench/peers/race.cpp");
        return;
    };
    let ways = words[0].as_deref().unwrap_or("component-pairs");
    let ways: Vec<_> = ways.split(',').map(|name| (name, among(name))).collect();
    println!("| scene | program | solved | nodes | CPU s | OMPL's median : this |");
    println!("|{}", " --- |".repeat(6));
    let mut csv = "scene,program,seed,solved,nodes,cpu_seconds\n".to_owned();
    let mut all = Vec::new();
    for scene in &arguments.scenes {
        let problem = surfaces(Path::new(scene));
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(file("scene"), scene_text(&problem)).expect("the scene can be written");
        let ends = problem.query.as_ref().expect("a scene with a query");
        let values: Vec<_> = ends.start.iter().chain(&ends.goal).map(f64::to_string).collect();
        std::fs::write(file("query"), values.join(" ")).expect("the query can be written");

        let builds = |program: &str| Builds {
            scene: problem.name.clone(),
            program: program.to_owned(),
            ..Builds::default()
        };
        let mut theirs = builds("OMPL");
        let mut ours: Vec<_> = ways.iter().map(|(name, _)| builds(name)).collect();
        for seed in 1..=arguments.seeds {
            for (builds, (_, among)) in ours.iter_mut().zip(&ways) {
                let mut problem = Problem { seed, ..problem.clone() };
                for strategy in &mut problem.strategies {
                    strategy.among = among.clone();
                }
                let built = solve(&Arc::new(Setup::new(problem)), arguments.seconds);
                let (solved, nodes) = (built.satisfied, built.nodes as f64);
                builds.add(seed, solved, nodes, built.seconds, &mut csv);
            }
            let [seed_word, limit] = [seed.to_string(), arguments.seconds.to_string()];
            let [scene, query] = ["scene", "query"].map(file);
            let found = run(&peer, &["solve", &scene, &query, &seed_word, &limit]);
            theirs.add(seed, found[2] == 1.0, found[1], found[0], &mut csv);
        }
        let of = median(&mut theirs.seconds.clone());
        ours.push(theirs);
        ours.iter().for_each(|builds| println!("{}", builds.row(of)));
        all.extend(ours);
    }
    for (file, text) in [(&words[1], csv), (&words[2], picture(&all, arguments.seconds))] {
        if let Some(file) = file {
            std::fs::write(file, text).expect("the file can be written");
        }
    }
}

fn among(name: &str) -> AmongKind {
    let (neighbors, planners) = (10, vec![Planner::StraightLine]);
    match name {
        "component-pairs" => AmongKind::ComponentPairs(ComponentPairs::default()),
        "nearest-nodes" => AmongKind::NearestNodes(NearestNodes { neighbors, planners }),
        "until-joined" => AmongKind::UntilJoined(UntilJoined { neighbors, planners }),
        _ => panic!("--among: `{name}` found; a connection among sets expected"),
    }
}

/// A row of dots for each scene and program.
fn picture(all: &[Builds], limit: f64) -> String {
    let programs: Vec<&str> =
        all.iter().take_while(|b| b.scene == all[0].scene).map(|b| &*b.program).collect();
    let rows = all.len() as f64;
    let x = Scale::decades(all.iter().flat_map(|builds| &builds.seconds).copied());
    let y = Scale { low: -0.5, high: rows - 0.5, log: false };
    let title = "CPU seconds until the query is solved; the bars are medians";
    let below = format!("CPU seconds, at most {limit}");
    let size = [900.0, 120.0 + 26.0 * rows];
    let mut plot = Plot::new(title, [&below, ""], size, x, y);
    let ticks: Vec<_> = x.powers().iter().map(|power| (*power, plain(*power))).collect();
    plot.columns(&ticks);
    // The first scene on top, its name beside the middle of its rows.
    let step = programs.len();
    let names = all.chunks(step).enumerate().map(|(i, builds)| {
        let middle = (i * step) as f64 + 0.5 * (step - 1) as f64;
        (rows - 1.0 - middle, builds[0].scene.clone())
    });
    plot.rows(&names.collect::<Vec<_>>());
    for (row, builds) in all.iter().enumerate() {
        let colour = COLOURS[row % step];
        let y = rows - 1.0 - row as f64;
        // A little up and down, so that dots do not cover one another.
        let aside = |i: usize| 0.12 * ((i % 5) as f64 - 2.0);
        let points: Vec<_> =
            builds.seconds.iter().enumerate().map(|(i, x)| [*x, y + aside(i)]).collect();
        plot.dots(&points, colour, 3.0);
        plot.bar([median(&mut builds.seconds.clone()), y], 10.0, colour);
    }
    let legend = programs.iter().zip(COLOURS).map(|(name, colour)| {
        let name =
            if *name == "OMPL" { "OMPL PRM".to_owned() } else { format!("roadmill, {name}") };
        (name, colour)
    });
    plot.legend(&legend.collect::<Vec<_>>());
    plot.finish()
}
