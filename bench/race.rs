//! The race against OMPL 1.5 and FCL 0.7: the same meshes, pairs, steps, nodes and neighbours, one core.
//!
//! ```text
//! apt-get install libompl-dev libfcl-dev libeigen3-dev g++
//! g++ -O3 -march=x86-64 -std=c++17 bench/peers/race.cpp -I/usr/include/eigen3 -I/usr/include/ompl-1.5 \
//!     -o PEER -lompl -lfcl -lccd
//! ROADMILL_PEER=PEER cargo bench --bench race -- [--lists uniform,gaussian,dense]
//!     [--steps resolution,ompl] [--no-nodes] SCENE …
//! ```
//!
//! Two measures per scene, five rounds in turn, medians of CPU time. *Edges*: pairs of milestones
//! (`bench/support/lists.rs` has the lists; without `--lists` the uniform one) decided three times: free
//! at all times (`swept`, the default), at the steps (`sampled`), and by FCL at the same steps. There are
//! as many as the problem's resolution asks for, or as OMPL takes by itself: no step longer than 1 % of the
//! extent, of positions and of rotations apart. `differ` counts the pairs of which the last two do not say
//! the same, `refused` those that are free at the steps but not swept. If `ROADMILL_COAL` names the built
//! `bench/peers/coal.cpp`, coal 3.0 looks at the same steps too; its own `differ` comes last. *Nodes*: one set of 5000 nodes with
//! 10 neighbours and swept edges, against `PRM::growRoadmap`. OMPL and FCL know no solids and no bounds of
//! bodies, so both sides race with surfaces and with bounds that hold the reference point.

mod support;

use roadmill::Context;
use roadmill::connect::{Nearest, Within};
use roadmill::model::Scratch;
use roadmill::model::bodies::BodyValidity;
use roadmill::model::bodies::validity::MotionChecking;
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::seed::Seed;
use std::collections::BTreeMap;
use std::path::Path;
use support::edges::with_edges;
use support::lists::{List, NEIGHBORS, coarse, refinement};
use support::peer::{changed, pairs_text, run, scene_text, surfaces, verdicts};
use support::{cpu_seconds, median, sample};

const ROUNDS: usize = 5;
const NODES: usize = 5000;

/// Who says into how many steps motions are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Steps {
    Resolution,
    Ompl,
}

impl Steps {
    fn name(self) -> &'static str {
        match self {
            Steps::Resolution => "resolution",
            Steps::Ompl => "OMPL",
        }
    }
}

struct Arguments {
    lists: Vec<List>,
    steps: Vec<Steps>,
    nodes: bool,
    scenes: Vec<String>,
}

fn arguments() -> Arguments {
    let (mut lists, mut steps) = (vec![List::Uniform], vec![Steps::Resolution]);
    let (mut nodes, mut scenes) = (true, Vec::new());
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        match word.as_str() {
            "--lists" => lists = List::named(&words.next().unwrap_or_default()),
            "--steps" => {
                let named = words.next().unwrap_or_default();
                let one = |name| match name {
                    "resolution" => Steps::Resolution,
                    "ompl" => Steps::Ompl,
                    _ => panic!("--steps: `{name}` found; resolution or ompl expected"),
                };
                steps = named.split(',').map(one).collect();
            }
            "--no-nodes" => nodes = false,
            _ => scenes.push(word),
        }
    }
    Arguments { lists, steps, nodes, scenes }
}

fn main() {
    let arguments = arguments();
    let Ok(peer) = std::env::var("ROADMILL_PEER") else {
        println!("race: skipped, ROADMILL_PEER does not name the built bench/peers/race.cpp");
        return;
    };
    println!(
        "| scene | list | steps | per pair | pairs | free | swept/s | sampled/s | FCL/s | coal/s | swept : FCL | sampled : FCL | swept : coal | differ | refused | coal's |"
    );
    println!("|{}", " --- |".repeat(16));
    let (mut ratios, mut nodes) = (BTreeMap::<_, Vec<_>>::new(), Vec::new());
    for scene in &arguments.scenes {
        let track = Track::new(Path::new(scene), &peer);
        for list in &arguments.lists {
            for steps in &arguments.steps {
                let ratio = track.edges(*list, *steps);
                ratios.entry((list.name(), *steps)).or_default().push((ratio, scene));
            }
        }
        if arguments.nodes {
            nodes.push(track.nodes());
        }
    }
    println!("\n| list | steps | swept : FCL, geometric mean | least | of |");
    println!("|{}", " --- |".repeat(5));
    for ((list, steps), ratios) in ratios {
        let logs = ratios.iter().map(|(ratio, _)| libm::log(*ratio)).sum::<f64>();
        let mean = libm::exp(logs / ratios.len() as f64);
        let (least, of) = ratios.iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("a scene");
        let of = Path::new(of).file_stem().unwrap_or_default().display();
        println!("| {list} | {} | {mean:.1} | {least:.1} | {of} |", steps.name());
    }
    if arguments.nodes {
        println!("\n| scene | nodes/s | OMPL nodes/s | ratio |\n| --- | --- | --- | --- |");
        nodes.iter().for_each(|row| println!("{row}"));
    }
}

/// A scene that both sides race on.
struct Track<'a> {
    peer: &'a str,
    problem: Problem,
    folder: tempfile::TempDir,
}

impl Track<'_> {
    fn new<'a>(path: &Path, peer: &'a str) -> Track<'a> {
        let problem = with_edges(&surfaces(path), MotionChecking::Swept);
        let folder = tempfile::tempdir().expect("a temporary folder");
        let track = Track { peer, problem, folder };
        track.write("scene", scene_text(&track.problem));
        track
    }

    fn file(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    fn write(&self, name: &str, text: String) {
        std::fs::write(self.file(name), text).expect("a temporary file can be written");
    }

    /// Prints a line; how many times faster swept motions are than FCL's.
    fn edges(&self, list: List, counted: Steps) -> f64 {
        let resolution = match counted {
            Steps::Resolution => self.problem.model().bodies().expect("bodies").resolution(),
            Steps::Ompl => coarse(&self.problem),
        };
        let [swept_cx, sampled_cx] =
            [MotionChecking::Swept, MotionChecking::Sampled].map(|edges| {
                let problem = changed(&self.problem, |bodies| {
                    bodies.change_space(|space| space.edges(edges).resolution(resolution))
                });
                problem.context()
            });
        let (configs, pairs) = list.draw(&self.problem, &self.problem.context());
        let ends = || pairs.iter().map(|(a, b)| (configs.get(*a), configs.get(*b)));
        let steps_of = |a: &[f64], b: &[f64]| {
            BodyValidity::of(swept_cx.model()).expect("bodies").steps(a, b, 1)
        };
        let mut steps: Vec<u64> = ends().map(|(a, b)| steps_of(a, b)).collect();
        let mut refinements = vec![1; steps.len()];
        if counted == Steps::Ompl {
            self.write("pairs", pairs_text(ends(), steps.iter().copied()));
            let counts = run(self.peer, &["count", &self.file("scene"), &self.file("pairs")]);
            steps = counts.iter().map(|count| *count as u64).collect();
            let refine = |((a, b), count): (_, &u64)| refinement(swept_cx.model(), a, b, *count);
            refinements = ends().zip(&steps).map(refine).collect();
        }
        self.write("pairs", pairs_text(ends(), steps.iter().copied()));

        let decide = |cx: &Context, seconds: &mut Vec<f64>| -> Vec<bool> {
            let begun = cpu_seconds();
            let scratch = &mut Scratch::new();
            let motion = |((a, b), refinement): (_, &u32)| {
                cx.model().motion(a, b, *refinement, scratch).is_some()
            };
            let verdicts = ends().zip(&refinements).map(motion).collect();
            seconds.push(cpu_seconds() - begun);
            verdicts
        };
        let (mut swept, mut sampled, mut theirs) = (Vec::new(), Vec::new(), Vec::new());
        let (mut proved, mut at_steps) = (Vec::new(), Vec::new());
        let (mut peer_verdicts, mut coal_verdicts) = (Vec::new(), Vec::new());
        let (coal, mut coals) = (std::env::var("ROADMILL_COAL").ok(), Vec::new());
        for _ in 0..ROUNDS {
            proved = decide(&swept_cx, &mut swept);
            at_steps = decide(&sampled_cx, &mut sampled);
            let [scene, pairs, out] = ["scene", "pairs", "verdicts"].map(|name| self.file(name));
            theirs.push(run(self.peer, &["edges", &scene, &pairs, &out])[0]);
            peer_verdicts = verdicts(&out);
            if let Some(coal) = &coal {
                coals.push(run(coal, &["edges", &scene, &pairs, &out])[0]);
                coal_verdicts = verdicts(&out);
            }
        }
        let differ = |theirs: &[bool]| at_steps.iter().zip(theirs).filter(|(a, b)| a != b).count();
        let refused = at_steps.iter().zip(&proved).filter(|(steps, all)| **steps && !**all);
        let free = at_steps.iter().filter(|free| **free).count();
        let rate = |seconds: &mut Vec<f64>| pairs.len() as f64 / median(seconds);
        let [swept, sampled, theirs] = [&mut swept, &mut sampled, &mut theirs].map(rate);
        let [coal_rate, coal_ratio, coal_differ] = match coal {
            None => ["–"; 3].map(str::to_owned),
            Some(_) => {
                let coal = rate(&mut coals);
                let differ = differ(&coal_verdicts).to_string();
                [format!("{coal:.0}"), format!("{:.1}", swept / coal), differ]
            }
        };
        println!(
            "| {} | {} | {} | {:.1} | {} | {:.1} % | {swept:.0} | {sampled:.0} | {theirs:.0} | {coal_rate} | {:.1} | {:.1} | {coal_ratio} | {} | {} | {coal_differ} |",
            self.problem.name(),
            list.name(),
            counted.name(),
            steps.iter().sum::<u64>() as f64 / pairs.len() as f64,
            pairs.len(),
            100.0 * free as f64 / pairs.len() as f64,
            swept / theirs,
            sampled / theirs,
            differ(&peer_verdicts),
            refused.count(),
        );
        swept / theirs
    }

    /// A line of the table of nodes.
    fn nodes(&self) -> String {
        let cx = self.problem.context();
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for round in 0..ROUNDS {
            let begun = cpu_seconds();
            let set = sample(&cx, NODES, round as u64);
            let within = Nearest { neighbors: NEIGHBORS as u32, ..Nearest::default() };
            let seed = Seed::of_set(1, "race", Ordinal(round as u64));
            assert!(!within.connect(&cx, &seed, &set, &mut Scratch::new()).is_empty());
            ours.push(cpu_seconds() - begun);
            let words = [NODES, NEIGHBORS, round + 1].map(|number| number.to_string());
            let [nodes, neighbors, seed] = words.each_ref().map(String::as_str);
            let scene = self.file("scene");
            theirs.push(run(self.peer, &["grow", &scene, nodes, neighbors, seed])[0]);
        }
        let [ours, theirs] = [&mut ours, &mut theirs].map(|seconds| NODES as f64 / median(seconds));
        format!("| {} | {ours:.0} | {theirs:.0} | {:.1} |", self.problem.name(), ours / theirs)
    }
}
