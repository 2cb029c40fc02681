//! How soon scenes are solved, beside planners of OMPL: the same surfaces, metric resolution and query.
//!
//! ```text
//! ROADMILL_PEER=PEER cargo bench --bench solve -- [--seeds N] [--first-seed F] [--seconds S] [--among WAYS]
//!     [--settings FILES] [--peers PLANNERS] [--times T] [--csv FILE] [--svg FILE] SCENE …
//! cargo bench --bench solve -- --from FILE --svg FILE
//! ```
//!
//! PEER is `bench/peers/race.cpp`, built as `bench/race.rs` says.
//!
//! Builds every scene with N seeds (default 20), the first of which is F (default 1), each for at most S CPU seconds (default
//! 60), ours first and then OMPL's. Ours are built at default settings, or, with
//! `--among nearest-nodes,until-joined,…`, as often again with these connections among sets (`docs/problems.md`), or, with
//! `--settings one.toml,two.toml`, with the tables `[img]` and `[[strategies]]` of these files. PLANNERS are `prm`,
//! `rrt-connect` (both by default), `kpiece`, `est`, `bit-star`, or `none`; `prm:3` solves only with the first three seeds, for scenes in
//! which a planner always takes all the time that it has. With `--times T` they get at most T times the median of our first way, but no less than a second.
//!
//! Who judges paths: ours by FCL, the peer's kernel, and OMPL's by ours, both at steps 20 times finer than the resolution. A path
//! that is refused does not count as solved. Without PEER ours are not judged.
//!
//! Prints the medians, those of the times over all builds: one that is not solved counts with the seconds that it took. *Refused* counts paths that the
//! judge refused. The last column is the best of OMPL's medians, divided by this one. The CSV file gets a line for each build as it ends: scene, program,
//! seed, solved or not, nodes, CPU seconds, refused or not. Builds that stand in it are not done again, so that a bench that was interrupted goes
//! on where it was. The SVG file gets a dot for each build, or a ring where it was not solved. `--from` draws what stands in a
//! CSV file.

mod support;

use roadmill::connect::{AmongKind, ComponentPairs, NearestNodes, NodesAndComponents, UntilJoined};
use roadmill::img::Setup;
use roadmill::local::Planner;
use roadmill::model::Scratch;
use roadmill::model::bodies::BodyValidity;
use roadmill::model::bodies::validity::MotionChecking;
use roadmill::problem::{Problem, StrategySpec};
use serde::Deserialize;
use std::path::Path;
use std::sync::Arc;
use support::book::{Book, Build, Builds, of_csv};
use support::edges::with_edges;
use support::peer::{pairs_text, run, scene_text, surfaces, verdicts};
use support::plot::{COLOURS, Plot, Scale, plain};
use support::{Solved, arguments_with, method, solve};

/// How many times finer than the resolution the steps are at which a judge looks at a path.
const FINER: u32 = 20;
/// The least that a peer is given, in CPU seconds.
const LEAST_SECONDS: f64 = 1.0;

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
    let options =
        ["--among", "--csv", "--svg", "--from", "--settings", "--peers", "--first-seed", "--times"];
    let (arguments, words) = arguments_with(20.0, 60.0, &options);
    let draw = |all: &[Builds]| {
        if let Some(file) = &words[2] {
            std::fs::write(file, picture(all)).expect("the file can be written");
        }
    };
    if let Some(file) = &words[3] {
        return draw(&of_csv(&std::fs::read_to_string(file).expect("the file can be read")));
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
    let times: Option<f64> = words[7].as_deref().map(|word| word.parse().expect("a number"));
    let mut book = Book::open(words[1].as_deref());
    println!("| scene | program | solved | refused | nodes | CPU s | OMPL's best median : this |");
    println!("|{}", " --- |".repeat(7));
    let mut all = Vec::new();
    for scene in &arguments.scenes {
        let track = Track::new(Path::new(scene), &peer);
        let seeds = |count: u64| first..first + count.min(arguments.seeds);
        let mut of_scene: Vec<Builds> = Vec::new();
        for way in &ways {
            let builds = seeds(u64::MAX).map(|seed| {
                book.build((track.problem.name(), &way.name), seed, || {
                    track.solves(way, seed, arguments.seconds)
                })
            });
            let (scene, program) = (track.problem.name().to_owned(), way.name.clone());
            of_scene.push(Builds { all: builds.collect(), scene, program });
        }
        let ours = of_scene[0].median_seconds();
        let limit = times.map_or(arguments.seconds, |times| (times * ours).max(LEAST_SECONDS));
        for (planner, count) in &planners {
            let program = format!("OMPL {planner}");
            let builds = seeds(*count).map(|seed| {
                book.build((track.problem.name(), &program), seed, || {
                    track.peer_solves(planner, seed, limit)
                })
            });
            let (builds, scene) = (builds.collect(), track.problem.name().to_owned());
            of_scene.push(Builds { all: builds, scene, program });
        }
        let theirs = of_scene[ways.len()..].iter().map(Builds::median_seconds);
        let best = theirs.fold(f64::INFINITY, f64::min);
        of_scene.iter().for_each(|builds| println!("{}", builds.row(best)));
        all.extend(of_scene);
    }
    draw(&all);
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

    /// Builds in one of our ways.
    fn solves(&self, way: &Way, seed: u64, limit: f64) -> Build {
        let problem = (way.change)(self.problem.clone().with_seed(seed));
        let Solved { satisfied, nodes, seconds, path, .. } =
            solve(&Arc::new(Setup::new(problem)), limit);
        let refused = path.is_some_and(|path| !self.peer.is_empty() && !self.peer_accepts(&path));
        Build { seed, solved: satisfied && !refused, nodes: nodes as f64, seconds, refused }
    }

    /// Whether FCL finds all motions of a path of ours free.
    fn peer_accepts(&self, path: &roadmill::query::Path) -> bool {
        let configs: Vec<&[f64]> = path.configs.iter().collect();
        let cx = self.problem.context();
        let ends = configs.windows(2).map(|ends| (ends[0], ends[1]));
        let bodies = BodyValidity::of(cx.model()).expect("bodies");
        let steps = ends.clone().map(|(a, b)| bodies.steps(a, b, FINER));
        let [pairs, verdicts_file] = ["pairs", "verdicts"].map(|name| self.file(name));
        std::fs::write(&pairs, pairs_text(ends, steps)).expect("the pairs can be written");
        run(self.peer, &["edges", &self.file("scene"), &pairs, &verdicts_file]);
        verdicts(&verdicts_file).into_iter().all(|is_free| is_free)
    }

    /// Lets OMPL's planner search.
    fn peer_solves(&self, planner: &str, seed: u64, limit: f64) -> Build {
        let [scene, query, path] = ["scene", "query", "path"].map(|name| self.file(name));
        let [word, limit] = [seed.to_string(), limit.to_string()];
        let words = ["solve", &scene, &query, &word, &limit, planner, &path];
        let found = run(self.peer, &words);
        let has_path = found[2] == 1.0;
        let refused = has_path && !self.passes(&path);
        Build { seed, solved: has_path && !refused, nodes: found[1], seconds: found[0], refused }
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
    let x = Scale::decades(all.iter().flat_map(|builds| &builds.all).map(|build| build.seconds));
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
            for (i, build) in builds.all.iter().enumerate() {
                // A little up and down, so that dots do not cover one another.
                let point = [build.seconds, y + 0.12 * ((i % 5) as f64 - 2.0)];
                if build.solved {
                    plot.dots(&[point], colour, 3.0);
                } else {
                    plot.ring(point, colour);
                }
            }
            plot.bar([builds.median_seconds(), y], 10.0, colour);
        }
        top -= of_scene.len() as f64 + 1.0;
    }
    let legend = coloured().map(|(program, colour)| {
        let name = match *program {
            "OMPL prm" => "OMPL's PRM".to_owned(),
            "OMPL rrt-connect" => "OMPL's RRT-Connect".to_owned(),
            "OMPL kpiece" => "OMPL's KPIECE".to_owned(),
            "OMPL est" => "OMPL's EST".to_owned(),
            "OMPL bit-star" => "OMPL's BIT*".to_owned(),
            ours => format!("roadmill, {ours}"),
        };
        (name, *colour)
    });
    plot.legend(&legend.collect::<Vec<_>>());
    plot.finish()
}
