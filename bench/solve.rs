//! How soon scenes are solved, beside OMPL's PRM: the same surfaces, metric resolution and query.
//!
//! ```text
//! ROADMILL_PEER=PEER cargo bench --bench solve -- [--seeds N] [--seconds S] [--among WAYS]
//!     [--csv FILE] [--svg FILE] SCENE …
//! cargo bench --bench solve -- --from FILE --svg FILE
//! ```
//!
//! PEER is `bench/peers/race.cpp`, built as `bench/race.rs` says. Builds every scene at default settings
//! with seeds 1 to N (default 20), each for at most S CPU seconds (default 60), ours and OMPL's in turn.
//! `--among nearest-nodes,until-joined,…` builds it as often again with other connections among sets
//! (`docs/problems.md`; `nodes-and-components` is the default). Prints the medians, those of the times over
//! all builds: one that is not solved counts with the seconds that it took. The CSV file gets a line for each
//! build: scene, program, seed, solved or not, nodes, CPU seconds; the SVG file a dot, or a ring where it was
//! not solved. `--from` draws what stands in a CSV file.

mod support;

use roadmill::connect::{AmongKind, ComponentPairs, NearestNodes, NodesAndComponents, UntilJoined};
use roadmill::img::Setup;
use roadmill::local::Planner;
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
    fn add(&mut self, solved: bool, nodes: f64, seconds: f64) {
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
    let (arguments, words) = arguments_with(20.0, 60.0, &["--among", "--csv", "--svg", "--from"]);
    let write = |file: &Option<String>, text: String| {
        if let Some(file) = file {
            std::fs::write(file, text).expect("the file can be written");
        }
    };
    if let Some(file) = &words[3] {
        let text = std::fs::read_to_string(file).expect("the file can be read");
        return write(&words[2], picture(&of_csv(&text)));
    }
    let Ok(peer) = std::env::var("ROADMILL_PEER") else {
        println!("solve: skipped, ROADMILL_PEER does not name the built bench/peers/race.cpp");
        return;
    };
    let ways = words[0].as_deref().unwrap_or("nodes-and-components");
    let ways: Vec<_> = ways.split(',').map(|name| (name, among(name))).collect();
    println!("| scene | program | solved | nodes | CPU s | OMPL's median : this |");
    println!("|{}", " --- |".repeat(6));
    let mut all = Vec::new();
    for scene in &arguments.scenes {
        let problem = surfaces(Path::new(scene));
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(file("scene"), scene_text(&problem)).expect("the scene can be written");
        let ends = problem.query().expect("a scene with a query");
        let values: Vec<_> = ends.start.iter().chain(&ends.goal).map(f64::to_string).collect();
        std::fs::write(file("query"), values.join(" ")).expect("the query can be written");

        let builds = |program: &str| Builds {
            scene: problem.name().to_owned(),
            program: program.to_owned(),
            ..Builds::default()
        };
        let mut theirs = builds("OMPL");
        let mut ours: Vec<_> = ways.iter().map(|(name, _)| builds(name)).collect();
        for seed in 1..=arguments.seeds {
            for (builds, (_, among)) in ours.iter_mut().zip(&ways) {
                let builder = problem.to_builder().seed(seed);
                let problem = builder.change_strategies(|s| s.among(among.clone())).build();
                let problem = problem.unwrap_or_else(|error| panic!("{error}"));
                let built = solve(&Arc::new(Setup::new(problem)), arguments.seconds);
                let (solved, nodes) = (built.satisfied, built.nodes as f64);
                builds.add(solved, nodes, built.seconds);
            }
            let [seed_word, limit] = [seed.to_string(), arguments.seconds.to_string()];
            let [scene, query] = ["scene", "query"].map(file);
            let found = run(&peer, &["solve", &scene, &query, &seed_word, &limit]);
            theirs.add(found[2] == 1.0, found[1], found[0]);
        }
        let of = median(&mut theirs.seconds.clone());
        ours.push(theirs);
        ours.iter().for_each(|builds| println!("{}", builds.row(of)));
        all.extend(ours);
    }
    write(&words[1], csv_of(&all));
    write(&words[2], picture(&all));
}

fn csv_of(all: &[Builds]) -> String {
    let mut csv = "scene,program,seed,solved,nodes,cpu_seconds\n".to_owned();
    for Builds { scene, program, seconds, nodes, solved } in all {
        for (i, ((seconds, nodes), solved)) in seconds.iter().zip(nodes).zip(solved).enumerate() {
            let (seed, solved) = (i + 1, u8::from(*solved));
            writeln!(csv, "{scene},{program},{seed},{solved},{nodes},{seconds:.4}")
                .expect("memory");
        }
    }
    csv
}

fn of_csv(text: &str) -> Vec<Builds> {
    let mut all: Vec<Builds> = Vec::new();
    for line in text.lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let (scene, program) = (words[0].to_owned(), words[1].to_owned());
        let number = |word: usize| words[word].parse::<f64>().expect("a number");
        let known = all.iter().position(|b| b.scene == scene && b.program == program);
        let index = known.unwrap_or_else(|| {
            all.push(Builds { scene, program, ..Builds::default() });
            all.len() - 1
        });
        all[index].add(number(3) == 1.0, number(4), number(5));
    }
    all
}

fn among(name: &str) -> AmongKind {
    let (neighbors, planners) = (10, vec![Planner::StraightLine]);
    match name {
        "component-pairs" => AmongKind::ComponentPairs(ComponentPairs::default()),
        "nodes-and-components" => AmongKind::NodesAndComponents(NodesAndComponents::default()),
        "nearest-nodes" => AmongKind::NearestNodes(NearestNodes { neighbors, planners }),
        "until-joined" => AmongKind::UntilJoined(UntilJoined { neighbors, planners }),
        _ => panic!("--among: `{name}` found; a connection among sets expected"),
    }
}

/// A row of dots for each scene and program.
fn picture(all: &[Builds]) -> String {
    let step = all.iter().take_while(|builds| builds.scene == all[0].scene).count();
    // An empty row below each scene.
    let rows = (all.len() + all.len() / step) as f64;
    let x = Scale::decades(all.iter().flat_map(|builds| &builds.seconds).copied());
    let y = Scale { low: 0.0, high: rows, log: false };
    let title = "CPU seconds until the query is solved; bars are medians, rings were not solved";
    let mut plot = Plot::new(title, ["CPU seconds", ""], [900.0, 120.0 + 24.0 * rows], x, y);
    let ticks: Vec<_> = x.powers().iter().map(|power| (*power, plain(*power))).collect();
    plot.columns(&ticks);
    for (i, builds) in all.chunks(step).enumerate() {
        let top = rows - (i * (step + 1)) as f64 - 0.5;
        plot.rows(&[(top - 0.5 * step as f64, builds[0].scene.clone())]);
        for (row, (builds, colour)) in builds.iter().zip(COLOURS).enumerate() {
            let y = top - 0.5 - row as f64;
            for (i, (seconds, solved)) in builds.seconds.iter().zip(&builds.solved).enumerate() {
                // A little up and down, so that dots do not cover one another.
                let point = [*seconds, y + 0.12 * ((i % 5) as f64 - 2.0)];
                if *solved {
                    plot.dots(&[point], colour, 3.0);
                } else {
                    plot.ring(point, colour);
                }
            }
            plot.bar([median(&mut builds.seconds.clone()), y], 10.0, colour);
        }
    }
    let legend = all[..step].iter().zip(COLOURS).map(|(builds, colour)| {
        let name = match &*builds.program {
            "OMPL" => "OMPL PRM".to_owned(),
            ours => format!("roadmill, {ours}"),
        };
        (name, colour)
    });
    plot.legend(&legend.collect::<Vec<_>>());
    plot.finish()
}
