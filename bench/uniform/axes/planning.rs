//! Figures 5.14 and 5.15: queries solved with each sampler, and how far their paths keep from the obstacles.

use super::scenes::{Scene, heterogeneous, maze, s_tunnel};
use super::{Fineness, METHODS, Method, mean, verdict, verdicts};
use crate::Bench;
use crate::support::panels::{Look, Panel, Series, svg};
use crate::support::solve;
use roadmill::clearance::{of_motion, of_path};
use roadmill::img::Setup;
use roadmill::model::Scratch;
use roadmill::problem::StrategySpec;
use roadmill::query::Path;
use std::sync::Arc;

/// The study whose runs the other one has as well.
const STUDY: &str = "figure-5.14";
/// More nodes and sets than there are in any time, so that the seconds alone end a build.
const MOST: u64 = u32::MAX as u64 / 2;
/// What counts as alike.
const ALIKE: f64 = 0.1;

/// What is told of each run: whether it was solved, its CPU seconds and nodes, and of its path the mean clearance, the mean over its
/// edges of their least clearance, and the length; 0 without a path.
pub const SOLVED: usize = 0;
pub const SECONDS: usize = 1;
pub const NODES: usize = 2;
const MEAN_CLEARANCE: usize = 3;
const EDGE_CLEARANCE: usize = 4;

/// Builds with one sampler, at default settings but for that, until the query is solved or the seconds have gone by.
pub fn build(scene: &Scene, method: Method, seed: u64, seconds: f64) -> Vec<f64> {
    let fineness = Fineness::of_width(scene.width, scene.longest_side);
    let strategy = StrategySpec::sampled("axes", method.sampler(fineness));
    let builder = scene.problem.to_builder().strategies([strategy]).default_schedule();
    let builder = builder.most_nodes(MOST).most_sets(MOST);
    let problem = builder.build().unwrap_or_else(|error| panic!("{error}")).with_seed(seed);
    let setup = Arc::new(Setup::new(problem));
    let solved = solve(&setup, seconds);
    let path = solved.path.filter(|_| solved.satisfied);
    let of_path = path.map_or([0.0; 3], |path| clearances(&setup, &path, fineness.tolerance));
    let head = [f64::from(u8::from(solved.satisfied)), solved.seconds, solved.nodes as f64];
    head.into_iter().chain(of_path).collect()
}

fn clearances(setup: &Setup, path: &Path, tolerance: f64) -> [f64; 3] {
    let (cx, scratch) = (setup.context(), &mut Scratch::new());
    let whole = of_path(cx, &path.configs, tolerance, scratch).expect("there are obstacles");
    let configs: Vec<&[f64]> = path.configs.iter().collect();
    let least: Vec<f64> = configs
        .windows(2)
        .filter_map(|ends| of_motion(cx, ends[0], ends[1], tolerance, scratch))
        .map(|edge| edge.least)
        .collect();
    [whole.mean, least.iter().sum::<f64>() / least.len().max(1) as f64, path.length]
}

/// The runs of one environment, per sampler.
struct Of {
    scene: &'static str,
    runs: Vec<(Method, Vec<Vec<f64>>)>,
}

impl Of {
    fn runs(&self, method: Method) -> Option<&[Vec<f64>]> {
        self.runs.iter().find(|(of, _)| *of == method).map(|(_, runs)| &runs[..])
    }

    /// The mean of a number over all runs: of CPU seconds a run that is not solved counts with those that it took.
    fn over_all(&self, method: Method, number: usize) -> Option<f64> {
        self.runs(method).map(|runs| mean(runs, number))
    }

    /// The mean of a number over the runs that were solved.
    fn over_solved(&self, method: Method, number: usize) -> Option<f64> {
        let solved: Vec<Vec<f64>> =
            self.runs(method)?.iter().filter(|run| run[SOLVED] == 1.0).cloned().collect();
        (!solved.is_empty()).then(|| mean(&solved, number))
    }
}

fn all(bench: &mut Bench) -> Vec<Of> {
    let scenes =
        [("2DMaze", maze()), ("STunnel", Some(s_tunnel())), ("2DHeterogeneous", heterogeneous())];
    let mut all = Vec::new();
    for (name, scene) in scenes {
        let Some(scene) = scene else { continue };
        let mut runs = Vec::new();
        for method in METHODS {
            let case = format!("{name} {}", method.name());
            if bench.wants(&case) {
                let seconds = bench.seconds;
                runs.push((
                    method,
                    bench.case_of(STUDY, &case, |seed| build(&scene, method, seed, seconds)),
                ));
            }
        }
        all.push(Of { scene: name, runs });
    }
    all
}

fn panel(of: &Of, number: usize, y_label: &str, log_y: bool) -> Panel {
    let series = of.runs.iter().enumerate().map(|(at, (method, runs))| {
        let shown = runs.iter().filter(|run| number == SECONDS || run[SOLVED] == 1.0);
        let points = shown
            .enumerate()
            .map(|(run, numbers)| [at as f64 + 0.012 * (run as f64 - 20.0), numbers[number]]);
        Series {
            name: method.name().to_owned(),
            colour: method.colour(),
            look: Look::Dots,
            points: points.collect(),
        }
    });
    let words = of.runs.iter().enumerate();
    Panel {
        title: of.scene.to_owned(),
        x_label: String::new(),
        y_label: y_label.to_owned(),
        log_y,
        words: words.map(|(at, (method, _))| (at as f64, method.name().to_owned())).collect(),
        series: series.collect(),
    }
}

/// Figure 5.14.
pub fn time(bench: &mut Bench) {
    let all = all(bench);
    println!("| environment | sampler | solved | nodes, mean | CPU s, mean | normalised to PRM |");
    println!("|{}", " --- |".repeat(6));
    for of in &all {
        for (method, runs) in &of.runs {
            let solved = runs.iter().filter(|run| run[SOLVED] == 1.0).count();
            let seconds = mean(runs, SECONDS);
            let normal = of.over_all(Method::Prm, SECONDS).map(|prm| seconds / prm);
            println!(
                "| {} | {} | {solved} of {} | {:.0} | {seconds:.4} | {:.2} |",
                of.scene,
                method.name(),
                runs.len(),
                mean(runs, NODES),
                normal.unwrap_or(f64::NAN)
            );
        }
    }
    let panels: Vec<Panel> = all.iter().map(|of| panel(of, SECONDS, "CPU seconds", true)).collect();
    bench.draw(&svg(&panels));
    verdicts();
    for of in &all {
        let seconds = METHODS.map(|method| of.over_all(method, SECONDS));
        let [Some(umaprm), Some(maprm), Some(prm)] = seconds else { continue };
        let ours = format!("{umaprm:.3} s for {maprm:.3} and {prm:.3}");
        let name = of.scene;
        match name {
            "STunnel" => {
                let fastest = umaprm < maprm && umaprm < prm;
                verdict(&format!("{name}: UMAPRM is fastest"), &ours, fastest);
            }
            _ => {
                let faster = umaprm < maprm;
                verdict(&format!("{name}: UMAPRM is faster than MAPRM"), &ours, faster);
                let slower = umaprm > prm;
                verdict(&format!("{name}: UMAPRM is slower than PRM"), &ours, slower);
            }
        }
    }
}

/// Figure 5.15.
pub fn clearance(bench: &mut Bench) {
    let all = all(bench);
    println!(
        "| environment | sampler | mean clearance | normalised to PRM | least of an edge, mean | normalised |"
    );
    println!("|{}", " --- |".repeat(6));
    for of in &all {
        for (method, _) in &of.runs {
            let [along, edges] = [MEAN_CLEARANCE, EDGE_CLEARANCE].map(|number| {
                let own = of.over_solved(*method, number);
                let prm = of.over_solved(Method::Prm, number);
                let normal = own.zip(prm).map(|(own, prm)| own / prm);
                let text = |number: Option<f64>, digits: usize| {
                    number.map_or("–".to_owned(), |number| format!("{number:.digits$}"))
                };
                format!("{} | {}", text(own, 4), text(normal, 2))
            });
            println!("| {} | {} | {along} | {edges} |", of.scene, method.name());
        }
    }
    let panels =
        all.iter().map(|of| panel(of, MEAN_CLEARANCE, "mean clearance of the path", false));
    bench.draw(&svg(&panels.collect::<Vec<_>>()));
    verdicts();
    for of in &all {
        let clearances = METHODS.map(|method| of.over_solved(method, MEAN_CLEARANCE));
        let [Some(umaprm), Some(maprm), Some(prm)] = clearances else { continue };
        let ours = format!("{umaprm:.3} for {maprm:.3} and {prm:.3}");
        let name = of.scene;
        if name == "2DHeterogeneous" {
            let alike = (umaprm / maprm - 1.0).abs() <= ALIKE;
            let statement = format!("{name}: UMAPRM's clearance is like MAPRM's, within 10 %");
            verdict(&statement, &ours, alike);
        } else {
            let highest = umaprm > maprm && umaprm > prm;
            let statement = format!("{name}: UMAPRM's clearance is above MAPRM's and PRM's");
            verdict(&statement, &ours, highest);
        }
    }
}
