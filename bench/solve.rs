//! How soon scenes are solved, beside OMPL's PRM and RRT-Connect: the same surfaces, metric resolution and query.
//!
//! ```text
//! ROADMILL_PEER=PEER cargo bench --bench solve -- [--seeds N] [--first-seed F] [--seconds S] [--among WAYS]
//!     [--settings FILES] [--peers PLANNERS] [--csv FILE] [--svg FILE] SCENE …
//! cargo bench --bench solve -- --from FILE --svg FILE
//! ```
//!
//! PEER is `bench/peers/race.cpp`, built as `bench/race.rs` says.
//!
//! Builds every scene with N seeds (default 20), the first of which is F (default 1),
//! each for at most S CPU seconds (default 60), ours and OMPL's in turn. Ours are built at default settings, or, with
//! `--among nearest-nodes,until-joined,…`, as often again with these connections among sets (`docs/problems.md`), or, with
//! `--settings one.toml,two.toml`, with the tables `[img]` and `[[strategies]]` of these files. PLANNERS are `prm`,
//! `rrt-connect` (both by default) or `none`; `prm:3` solves only with the first three seeds, for scenes in which a planner always takes
//! all the time that it has. A path of OMPL's counts only if its motions also pass at steps 20 times finer
//! than those that OMPL has looked at, as ours do before they are given out.
//!
//! Prints the medians, those of the times over all builds: one that is not solved counts with the seconds that it took. The
//! last column is the better of OMPL's two medians, divided by this one. The CSV file gets a line for each build: scene, program,
//! seed, solved or not, nodes, CPU seconds; the SVG file a dot, or a ring where it was not solved. `--from` draws what stands in a
//! CSV file.

mod support;

use roadmill::connect::{AmongKind, ComponentPairs, NearestNodes, NodesAndComponents, UntilJoined};
use roadmill::img::Setup;
use roadmill::local::Planner;
use roadmill::model::Scratch;
use roadmill::model::bodies::validity::MotionChecking;
use roadmill::problem::{Problem, StrategySpec};
use serde::Deserialize;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use support::edges::with_edges;
use support::peer::{run, scene_text, surfaces};
use support::plot::{COLOURS, Plot, Scale, plain};
use support::{arguments_with, median, method, solve};

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

/// How many times finer than OMPL the steps are at which a path of OMPL's is looked at again.
const FINER: u32 = 20;

/// A way in which our scenes are built.
struct Way {
    name: String,
    change: Box<dyn Fn(Problem) -> Problem>,
}

impl Way {
    fn default() -> Way {
        Way { name: "default".to_owned(), change: Box::new(|problem| problem) }
    }

    /// With a connection among sets.
    fn among(name: &str) -> Way {
        let among = among(name);
        let change = move |problem: Problem| {
            let builder = problem.to_builder().change_strategies(|s| s.among(among.clone()));
            builder.build().unwrap_or_else(|error| panic!("{error}"))
        };
        Way { name: name.to_owned(), change: Box::new(change) }
    }

    /// With the tables of a file.
    fn settings(path: &str) -> Way {
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let settings: Settings = method(&text);
        let change = move |problem: Problem| {
            let builder = problem.to_builder().strategies(settings.strategies.clone());
            let builder = match &settings.img.schedule {
                Some(labels) => builder.schedule(labels.clone()),
                None => builder.default_schedule(),
            };
            let builder = match settings.img.sets_per_round {
                Some(sets) => builder.sets_per_round(sets),
                None => builder,
            };
            builder.build().unwrap_or_else(|error| panic!("{error}"))
        };
        let name = Path::new(path).file_stem().unwrap_or_default().to_string_lossy();
        Way { name: name.into_owned(), change: Box::new(change) }
    }
}

/// What a file of `--settings` says.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    #[serde(default)]
    img: Img,
    strategies: Vec<StrategySpec>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Img {
    sets_per_round: Option<u64>,
    schedule: Option<Vec<String>>,
}

fn main() {
    let options = ["--among", "--csv", "--svg", "--from", "--settings", "--peers", "--first-seed"];
    let (arguments, words) = arguments_with(20.0, 60.0, &options);
    let write = |file: &Option<String>, text: String| {
        if let Some(file) = file {
            std::fs::write(file, text).expect("the file can be written");
        }
    };
    if let Some(file) = &words[3] {
        let text = std::fs::read_to_string(file).expect("the file can be read");
        return write(&words[2], picture(&of_csv(&text)));
    }
    let planners = words[5].as_deref().unwrap_or("prm,rrt-connect");
    let planners = planners.split(',').filter(|name| *name != "none");
    let planners: Vec<(&str, u64)> = planners.map(planner_and_seeds).collect();
    let peer = std::env::var("ROADMILL_PEER").unwrap_or_default();
    if peer.is_empty() && !planners.is_empty() {
        println!("solve: skipped, ROADMILL_PEER does not name the built bench/peers/race.cpp");
        return;
    }
    let listed = |word: usize| words[word].iter().flat_map(|names| names.split(','));
    let mut ways: Vec<Way> = listed(0).map(Way::among).collect();
    ways.extend(listed(4).map(Way::settings));
    if ways.is_empty() {
        ways.push(Way::default());
    }
    let first: u64 = words[6].as_deref().map_or(1, |word| word.parse().expect("a seed"));
    println!("| scene | program | solved | nodes | CPU s | OMPL's better median : this |");
    println!("|{}", " --- |".repeat(6));
    let mut all = Vec::new();
    for scene in &arguments.scenes {
        let track = Track::new(Path::new(scene), &peer);
        let builds = |program: String| Builds {
            scene: track.problem.name().to_owned(),
            program,
            ..Builds::default()
        };
        let mut ours: Vec<_> = ways.iter().map(|way| builds(way.name.clone())).collect();
        let mut theirs: Vec<_> =
            planners.iter().map(|(name, _)| builds(format!("OMPL {name}"))).collect();
        for seed in first..first + arguments.seeds {
            for (builds, way) in ours.iter_mut().zip(&ways) {
                let problem = (way.change)(track.problem.clone().with_seed(seed));
                let built = solve(&Arc::new(Setup::new(problem)), arguments.seconds);
                builds.add(built.satisfied, built.nodes as f64, built.seconds);
            }
            for (builds, (planner, seeds)) in theirs.iter_mut().zip(&planners) {
                if seed - first >= *seeds {
                    continue;
                }
                let (solved, nodes, seconds) = track.peer_solves(planner, seed, arguments.seconds);
                builds.add(solved, nodes, seconds);
            }
        }
        let medians = theirs.iter().map(|builds| median(&mut builds.seconds.clone()));
        let best = medians.fold(f64::INFINITY, f64::min);
        ours.extend(theirs);
        ours.iter().for_each(|builds| println!("{}", builds.row(best)));
        all.extend(ours);
    }
    write(&words[1], csv_of(&all));
    write(&words[2], picture(&all));
}

/// A planner's name, and how many seeds it is given: `prm:3` is three of `prm`.
fn planner_and_seeds(word: &str) -> (&str, u64) {
    match word.split_once(':') {
        Some((name, seeds)) => (name, seeds.parse().expect("a number of seeds after the colon")),
        None => (word, u64::MAX),
    }
}

/// A scene that both sides solve.
struct Track<'a> {
    peer: &'a str,
    problem: Problem,
    folder: tempfile::TempDir,
}

impl Track<'_> {
    fn new<'a>(path: &Path, peer: &'a str) -> Track<'a> {
        let problem = surfaces(path);
        let track = Track { peer, problem, folder: tempfile::tempdir().expect("a folder") };
        let ends = track.problem.query().expect("a scene with a query");
        let values: Vec<_> = ends.start.iter().chain(&ends.goal).map(f64::to_string).collect();
        std::fs::write(track.file("query"), values.join(" ")).expect("the query can be written");
        let scene = scene_text(&track.problem);
        std::fs::write(track.file("scene"), scene).expect("the scene can be written");
        track
    }

    fn file(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    /// Whether OMPL's planner finds a path that passes the finer check, its nodes, and the CPU seconds that it took.
    fn peer_solves(&self, planner: &str, seed: u64, limit: f64) -> (bool, f64, f64) {
        let [scene, query, path] = ["scene", "query", "path"].map(|name| self.file(name));
        let [seed, limit] = [seed.to_string(), limit.to_string()];
        let words = ["solve", &scene, &query, &seed, &limit, planner, &path];
        let found = run(self.peer, &words);
        let solved = found[2] == 1.0 && self.passes(&path);
        (solved, found[1], found[0])
    }

    /// Whether all motions of the path in a file are valid.
    fn passes(&self, path: &str) -> bool {
        let text = std::fs::read_to_string(path).expect("the path can be read");
        let configuration = |line: &str| -> Vec<f64> {
            line.split_whitespace().map(|word| word.parse().expect("a number")).collect()
        };
        let path: Vec<Vec<f64>> = text.lines().map(configuration).collect();
        let cx = with_edges(&self.problem, MotionChecking::Sampled).context();
        let scratch = &mut Scratch::new();
        path.windows(2).all(|ends| cx.model().motion(&ends[0], &ends[1], FINER, scratch).is_some())
    }
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

/// A row of dots for each scene and program; a scene's builds stand together.
fn picture(all: &[Builds]) -> String {
    let scenes: Vec<&[Builds]> = all.chunk_by(|a, b| a.scene == b.scene).collect();
    let mut programs: Vec<&str> = Vec::new();
    for builds in all {
        if !programs.contains(&&*builds.program) {
            programs.push(&builds.program);
        }
    }
    let coloured = || programs.iter().zip(COLOURS.iter().cycle());
    // An empty row below each scene.
    let rows = (all.len() + scenes.len()) as f64;
    let x = Scale::decades(all.iter().flat_map(|builds| &builds.seconds).copied());
    let y = Scale { low: 0.0, high: rows, log: false };
    let title = "CPU seconds until the query is solved; bars are medians, rings were not solved";
    let mut plot = Plot::new(title, ["CPU seconds", ""], [900.0, 120.0 + 24.0 * rows], x, y);
    let ticks: Vec<_> = x.powers().iter().map(|power| (*power, plain(*power))).collect();
    plot.columns(&ticks);
    let mut top = rows - 0.5;
    for of_scene in scenes {
        plot.rows(&[(top - 0.5 * of_scene.len() as f64, of_scene[0].scene.clone())]);
        for (row, builds) in of_scene.iter().enumerate() {
            let y = top - 0.5 - row as f64;
            let own = coloured().find(|(program, _)| **program == builds.program);
            let (_, colour) = own.expect("all programs are listed");
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
        top -= of_scene.len() as f64 + 1.0;
    }
    let legend = coloured().map(|(program, colour)| {
        let name = match *program {
            "OMPL prm" => "OMPL's PRM".to_owned(),
            "OMPL rrt-connect" => "OMPL's RRT-Connect".to_owned(),
            ours => format!("roadmill, {ours}"),
        };
        (name, *colour)
    });
    plot.legend(&legend.collect::<Vec<_>>());
    plot.finish()
}
