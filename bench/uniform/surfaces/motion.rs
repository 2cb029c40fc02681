//! Tables 4.6 and 4.7: what it takes to meet a query in the Tunnel and in the Z-Tunnel, with one sampler alone.
//!
//! A run grows a roadmap in sets of 20 samples, each joined with its 10 nearest in the set and among what came before by straight lines
//! that are looked at in steps, until the query is met or the cap is reached: `--seconds`, here 20 CPU seconds at most. A run that
//! reaches the cap counts with what it had then.
//!
//! Robots: in the Tunnel a cube of edge 1, and a linkage of four boxes of 0.8 × 0.3 × 0.3, one after the other, with
//! joints that bend by up to 90° to either side, about z, y and z in turn; links may not touch but their neighbours. In the
//! Z-Tunnel a cube of edge 0.8. UOBPRM has no `adjusted_bounds`: walls reach the bounds everywhere.
//!
//! The dissertation's "CD calls" are configurations checked, on motions as well. Here configurations are those that samplers asked for,
//! and motions are counted as such, however many steps they have. An entry agrees if nodes are within a factor of 3 of the
//! dissertation's, which is of other tunnels; more is in the order of the samplers.
//!
//! Stated before the runs: as in the dissertation PRM needs the most nodes and the most time of all in both tunnels with the rigid body;
//! the best UOBPRM needs fewer nodes than PRM, Gaussian, Bridge and OBPRM with either robot and in the Z-Tunnel; UOBPRM needs the fewest
//! nodes with the longest step, 1, and the most with the shortest, 0.2.

use super::draws::mean;
use super::report::{head, row, stated};
use super::scenes::{Scene, parse, query, tunnel, z_tunnel};
use crate::Bench;
use crate::support::{cpu_seconds, median};
use roadmill::img::{Core, Cut, Judgement, Observer, Progress, Round, Serial, Setup, Stop, drive};
use roadmill::model::Asked;
use roadmill::problem::Problem;
use roadmill::roadmap::Tally;
use std::convert::Infallible;
use std::sync::Arc;

/// The most CPU seconds of a run.
const SECONDS: f64 = 20.0;
/// By how much nodes may differ.
const FACTOR: f64 = 3.0;

struct Case {
    name: &'static str,
    sampler: &'static str,
    /// Nodes, edges, seconds and calls of collision detection in the dissertation.
    paper: [f64; 4],
}

/// What a build came to, counted as it goes on.
struct Watch {
    end: f64,
    asked: Asked,
    edges: usize,
}

impl Observer for Watch {
    type Error = Infallible;

    fn folded(&mut self, round: &Round, tally: &Tally) -> Result<(), Infallible> {
        for set in &round.sets {
            self.asked += set.increment.asked;
            self.asked += set.joined.asked;
        }
        self.edges = tally.edges();
        Ok(())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Infallible> {
        judgement.verdicts.iter().for_each(|verdict| self.asked += verdict.asked);
        Ok(())
    }

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Infallible> {
        Ok((cpu_seconds() >= self.end).then_some(Cut::Time))
    }
}

/// What a run has: whether the query was met, nodes, edges, CPU seconds, configurations and motions asked for.
fn build(problem: Problem, seconds: f64) -> Vec<f64> {
    let setup = Arc::new(Setup::new(problem));
    let begun = cpu_seconds();
    let mut core = Core::new(&setup, 0);
    let mut serial = Serial::new(setup.clone());
    let mut watch = Watch { end: begun + seconds, asked: Asked::default(), edges: 0 };
    let Ok(stop) = drive(&mut core, &mut serial, &mut watch);
    vec![
        f64::from(u8::from(stop == Stop::Satisfied)),
        core.progress().nodes as f64,
        watch.edges as f64,
        cpu_seconds() - begun,
        watch.asked.configurations as f64,
        watch.asked.motions as f64,
    ]
}

/// A robot with the ends of its query.
struct Robot {
    text: String,
    ends: [&'static str; 2],
}

fn cube(edge: f64, ends: [&'static str; 2]) -> Robot {
    let text = format!(
        "edges = \"sampled\"\n[robot]\nbodies = [{{ shape = {{ box = {{ size = [{edge:?}, {edge:?}, {edge:?}] }} }} }}]"
    );
    Robot { text, ends }
}

fn linkage() -> Robot {
    let body =
        "bodies = [{ shape = { box = { size = [0.8, 0.3, 0.3] } }, position = [0.4, 0, 0] }]";
    let mut text = format!("edges = \"sampled\"\n[robot]\n{body}\n");
    for (name, axis) in [("second", "[0, 0, 1]"), ("third", "[0, 1, 0]"), ("fourth", "[0, 0, 1]")] {
        text += &format!(
            "[[robot.links]]\nname = \"{name}\"\n{body}\njoint = {{ kind = {{ revolute = {{ axis = {axis}, degrees = [-90, 90] }} }}, before = {{ position = [0.8, 0, 0] }} }}\n"
        );
    }
    let ends = ["[-19, 0, 0, 1, 0, 0, 0, 0, 0, 0]", "[16, 0, 0, 1, 0, 0, 0, 0, 0, 0]"];
    Robot { text, ends }
}

/// Means of a case that was run.
struct Mean {
    name: &'static str,
    nodes: f64,
    seconds: f64,
}

fn measured(
    bench: &mut Bench,
    scene: &Scene,
    robot: &Robot,
    letter: &str,
    cases: &[Case],
) -> Vec<Mean> {
    let seconds = bench.seconds.min(SECONDS);
    let mut means = Vec::new();
    for case in cases {
        let name = format!("{letter} {}", case.name);
        if !bench.wants(&name) && !bench.wants(letter) {
            continue;
        }
        let text = query(scene, &robot.text, robot.ends, case.sampler);
        let problem = parse(scene.name, &text);
        let runs = bench.case(&name, |seed| build(problem.clone().with_seed(seed), seconds));
        let met = mean(&runs, 0) * runs.len() as f64;
        let ours = [1, 2, 3, 4, 5].map(|at| mean(&runs, at));
        let middle = median(&mut runs.iter().map(|run| run[1]).collect::<Vec<f64>>());
        let ratio = ours[0] / case.paper[0];
        let near = (FACTOR.recip()..=FACTOR).contains(&ratio);
        let [nodes, edges, time, configurations, motions] = ours;
        let [paper_nodes, paper_edges, paper_time, paper_calls] = case.paper;
        row(&[
            letter.to_owned(),
            case.name.to_owned(),
            format!("{met:.0} of {}", runs.len()),
            format!("{nodes:.0} ({middle:.0}) / {paper_nodes:.0}"),
            format!("{edges:.0} / {paper_edges:.0}"),
            format!("{time:.3} / {paper_time:.1}"),
            format!("{configurations:.0} + {motions:.0} / {paper_calls:.0}"),
            if near { "yes" } else { "no" }.to_owned(),
        ]);
        means.push(Mean { name: case.name, nodes, seconds: time });
    }
    means
}

fn titles() {
    head(&[
        "robot",
        "sampler",
        "query met",
        "nodes: mean (median) / dissertation",
        "edges",
        "CPU s",
        "configurations + motions / CD calls",
        "agrees",
    ]);
}

const BRIDGE: &str = "bridge = { deviation = 4.0, bounds = true }";

/// Table 4.6.
pub fn tunnels(bench: &mut Bench) {
    let rigid = cube(1.0, ["[-18, 0, 0, 1, 0, 0, 0]", "[18, 0, 0, 1, 0, 0, 0]"]);
    let papers: [(&str, Robot, [[f64; 4]; 9]); 2] = [
        (
            "R",
            rigid,
            [
                [7345.6, 92259.0, 1433.55, 1_017_504.2],
                [1240.4, 11381.6, 39.68, 147_283.5],
                [969.0, 12031.5, 11.13, 125_304.9],
                [763.0, 5839.3, 17.26, 91578.1],
                [4790.1, 51881.3, 850.91, 556_786.0],
                [1507.2, 13198.0, 69.09, 155_927.8],
                [777.6, 6237.7, 22.13, 63387.0],
                [908.1, 7828.0, 25.78, 69271.2],
                [104.5, 388.6, 1.70, 5769.3],
            ],
        ),
        (
            "L",
            linkage(),
            [
                [566.9, 2918.4, 565.80, 101_407.3],
                [280.0, 1795.1, 731.73, 147_053.6],
                [420.8, 3119.8, 8675.55, 278_293.1],
                [356.7, 2226.2, 477.21, 70205.7],
                [322.2, 1211.6, 3012.32, 785_714.2],
                [319.7, 1113.4, 2915.46, 538_420.5],
                [224.9, 868.3, 73.63, 41140.0],
                [87.2, 214.5, 8.41, 9064.4],
                [72.3, 252.0, 4.25, 5039.2],
            ],
        ),
    ];
    let samplers = [
        ("PRM", "uniform = {}"),
        ("Gaussian d=0.6", "gaussian = { deviation = 0.6 }"),
        ("Bridge d=4", BRIDGE),
        ("OBPRM", "obprm = { step = 0.2 }"),
        ("UOBPRM t=0.2", "uobprm = { length = 2.0, step = 0.2 }"),
        ("UOBPRM t=0.25", "uobprm = { length = 2.0, step = 0.25 }"),
        ("UOBPRM t=0.4", "uobprm = { length = 2.0, step = 0.4 }"),
        ("UOBPRM t=0.5", "uobprm = { length = 2.0, step = 0.5 }"),
        ("UOBPRM t=1", "uobprm = { length = 2.0, step = 1.0 }"),
    ];
    titles();
    let mut of = Vec::new();
    for (letter, robot, papers) in papers {
        let cases: Vec<Case> = samplers
            .iter()
            .zip(papers)
            .map(|((name, sampler), paper)| Case { name, sampler, paper })
            .collect();
        of.push((letter, measured(bench, &tunnel(), &robot, letter, &cases)));
    }
    println!();
    for (letter, means) in &of {
        if *letter == "R" {
            most_of_all("R: ", means, samplers.len());
        }
        let says = format!("{letter}: the best UOBPRM needs fewer nodes than the other samplers");
        stated(&says, fewest(means, samplers.len()));
        let uobprm: Vec<f64> = uobprm(means).map(|mean| mean.nodes).collect();
        let (least, most) = bounds(&uobprm);
        let ends = (uobprm.len() == 5).then(|| uobprm[4] <= least && uobprm[0] >= most);
        stated(
            &format!(
                "{letter}: UOBPRM needs the fewest nodes with t = 1 and the most with t = 0.2"
            ),
            ends,
        );
    }
}

fn bounds(numbers: &[f64]) -> (f64, f64) {
    let fold = |(low, high): (f64, f64), number: &f64| (low.min(*number), high.max(*number));
    numbers.iter().fold((f64::INFINITY, 0.0), fold)
}

fn uobprm(means: &[Mean]) -> impl Iterator<Item = &Mean> {
    means.iter().filter(|mean| mean.name.starts_with("UOBPRM"))
}

/// Whether one of UOBPRM's entries has fewer nodes than all others' entries; `None` if not all were run.
fn fewest(means: &[Mean], count: usize) -> Option<bool> {
    let ours = uobprm(means).map(|mean| mean.nodes).fold(f64::INFINITY, f64::min);
    let mut others = means.iter().filter(|mean| !mean.name.starts_with("UOBPRM"));
    (means.len() == count).then(|| others.all(|mean| mean.nodes > ours))
}

/// States that PRM needs the most.
fn most_of_all(before: &str, means: &[Mean], count: usize) {
    let all = means.len() == count;
    let prm = means.iter().find(|mean| mean.name == "PRM").filter(|_| all);
    let nodes = prm.map(|prm| means.iter().all(|other| other.nodes <= prm.nodes));
    stated(&format!("{before}PRM needs the most nodes"), nodes);
    let time = prm.map(|prm| means.iter().all(|other| other.seconds <= prm.seconds));
    stated(&format!("{before}PRM needs the most time"), time);
}

/// Table 4.7.
pub fn z(bench: &mut Bench) {
    let robot = cube(0.8, ["[-8, 0, 0, 1, 0, 0, 0]", "[8, 0, 0, 1, 0, 0, 0]"]);
    let case = |name, sampler, paper| Case { name, sampler, paper };
    let cases = [
        case("PRM", "uniform = {}", [10661.1, 105_701.4, 1850.42, 1_331_432.8]),
        case(
            "Gaussian d=0.2",
            "gaussian = { deviation = 0.2 }",
            [1894.0, 15251.5, 39.89, 198_697.1],
        ),
        case(
            "Bridge d=3",
            "bridge = { deviation = 3.0, bounds = true }",
            [8359.2, 73126.6, 637.34, 332_410.2],
        ),
        case("OBPRM", "obprm = { step = 0.2 }", [3294.9, 25720.0, 503.51, 267_913.9]),
        case(
            "UOBPRM l=1 t=0.01",
            "uobprm = { length = 1.0, step = 0.01 }",
            [516.3, 3936.6, 29.59, 117_561.1],
        ),
    ];
    titles();
    let means = measured(bench, &z_tunnel(), &robot, "R", &cases);
    println!();
    most_of_all("", &means, cases.len());
    stated("UOBPRM needs the fewest nodes", fewest(&means, cases.len()));
    let of = |name: &str| means.iter().find(|mean| mean.name == name).map(|mean| mean.nodes);
    let order =
        [of("UOBPRM l=1 t=0.01"), of("Gaussian d=0.2"), of("OBPRM"), of("Bridge d=3"), of("PRM")];
    let order: Option<Vec<f64>> = order.into_iter().collect();
    stated(
        "nodes have the dissertation's order: UOBPRM, Gaussian, OBPRM, Bridge, PRM",
        order.map(|order| super::report::rises(&order)),
    );
}
