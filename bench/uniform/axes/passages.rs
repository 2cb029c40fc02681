//! Figures 5.10 to 5.12: what Obstacle 1, 2 and 3, whose passage is the same, change.

use super::boxes::Cuboid;
use super::scenes::{PASSAGE, Scene, THICKNESSES, obstacle};
use super::{Fineness, METHODS, Method, mean, milestones, verdict, verdicts};
use crate::Bench;
use crate::support::cpu_seconds;
use crate::support::panels::{Look, Panel, Series, svg};

const SAMPLES: usize = 1000;
/// How many samples Figure 5.12 wants in the passage.
const IN_PASSAGE: usize = 100;
/// How many samples are drawn at a time until so many are there.
const AT_A_TIME: usize = 50;
/// What counts as the same.
const SAME: f64 = 0.1;

/// The most runs in which bounds are no obstacles, since most of what MAPRM draws is then pushed out of bounds and dropped.
const UNBOUNDED_RUNS: u64 = 10;

/// The study whose runs Figure 5.10 has as well.
const OF_1000: &str = "figure-5.11";

/// What is told of each run.
const COUNT: usize = 0;
const SECONDS: usize = 1;

/// The means over the runs for Obstacle 1, 2 and 3.
type Means = [f64; 3];

/// A sampler's means: of the count and of the CPU seconds.
struct Row {
    method: Method,
    means: [Means; 2],
}

impl Row {
    /// The largest mean divided by the smallest, less 1.
    fn spread(&self, number: usize) -> f64 {
        let most = self.means[number].iter().copied().fold(0.0, f64::max);
        let least = self.means[number].iter().copied().fold(f64::INFINITY, f64::min);
        most / least - 1.0
    }
}

fn is_in_passage(q: &[f64]) -> bool {
    let Cuboid { min, max } = PASSAGE;
    (0..3).all(|i| (min[i]..=max[i]).contains(&q[i]))
}

/// How many of 1000 samples are in the passage, and the CPU seconds that they took.
fn of_1000(scene: &Scene, method: Method, fineness: Fineness, seed: u64) -> Vec<f64> {
    let cx = scene.problem.context();
    let begun = cpu_seconds();
    let configs = milestones(&cx, &method.sampler(fineness), SAMPLES, (seed, 0));
    let seconds = cpu_seconds() - begun;
    let inside = configs.iter().filter(|q| is_in_passage(q)).count();
    vec![inside as f64, seconds]
}

/// How many samples there are when the hundredth is in the passage, and the CPU seconds that they took.
fn until_in_passage(scene: &Scene, method: Method, fineness: Fineness, seed: u64) -> Vec<f64> {
    let cx = scene.problem.context();
    let (mut drawn, mut inside) = (0, 0);
    let begun = cpu_seconds();
    for set in 0.. {
        let configs = milestones(&cx, &method.sampler(fineness), AT_A_TIME, (seed, set));
        for q in configs.iter() {
            drawn += 1;
            inside += usize::from(is_in_passage(q));
            if inside == IN_PASSAGE {
                return vec![f64::from(drawn), cpu_seconds() - begun];
            }
        }
    }
    unreachable!("sets have no end")
}

/// Runs all samplers in all three environments; `bounded` says whether the sides of the bounds are obstacles.
fn rows(
    bench: &mut Bench,
    study: &'static str,
    bounded: bool,
    measure: fn(&Scene, Method, Fineness, u64) -> Vec<f64>,
) -> Vec<Row> {
    let mut rows = Vec::new();
    let asked = bench.runs;
    if !bounded {
        bench.runs = asked.min(UNBOUNDED_RUNS);
    }
    for method in METHODS {
        if method == Method::Prm && !bounded {
            continue; // the bounds are nothing to it
        }
        let mut means = [[0.0; 3]; 2];
        for (at, thickness) in THICKNESSES.into_iter().enumerate() {
            let scene = obstacle(thickness);
            let fineness =
                Fineness { bounds: bounded, ..Fineness::of_width(scene.width, scene.longest_side) };
            let mark = if bounded { "" } else { " without bounds" };
            let case = format!("Obstacle {} {}{mark}", at + 1, method.name());
            let runs = bench.case_of(study, &case, |seed| measure(&scene, method, fineness, seed));
            means[COUNT][at] = mean(&runs, COUNT);
            means[SECONDS][at] = mean(&runs, SECONDS);
        }
        rows.push(Row { method, means });
    }
    bench.runs = asked;
    rows
}

fn print(rows: &[Row], number: usize, what: &str) {
    println!("| {what} | Obstacle 1 | Obstacle 2 | Obstacle 3 | most : least |");
    println!("|{}", " --- |".repeat(5));
    for row in rows {
        let shown = row.means[number].map(|mean| match number {
            COUNT => format!("{mean:.1}"),
            _ => format!("{:.2}", 1000.0 * mean),
        });
        let [one, two, three] = shown;
        let spread = 1.0 + row.spread(number);
        println!("| {} | {one} | {two} | {three} | {spread:.2} |", row.method.name());
    }
    println!();
}

fn panel(rows: &[Row], number: usize, title: &str, y_label: &str) -> Panel {
    let times = if number == SECONDS { 1000.0 } else { 1.0 };
    let series = rows.iter().map(|row| Series {
        name: row.method.name().to_owned(),
        colour: row.method.colour(),
        look: Look::Line,
        points: (0..3).map(|at| [at as f64, times * row.means[number][at]]).collect(),
    });
    Panel {
        title: title.to_owned(),
        x_label: String::new(),
        y_label: y_label.to_owned(),
        log_y: number == SECONDS,
        words: (0..3).map(|at| (at as f64, format!("Obstacle {}", at + 1))).collect(),
        series: series.collect(),
    }
}

fn of(rows: &[Row], method: Method) -> &Row {
    rows.iter().find(|row| row.method == method).expect("all methods are run")
}

fn grows(means: Means) -> bool {
    means[0] < means[1] && means[1] < means[2]
}

fn falls(means: Means) -> bool {
    means[0] > means[1] && means[1] > means[2]
}

fn shown(means: Means, digits: usize) -> String {
    means.map(|mean| format!("{mean:.digits$}")).join(", ")
}

/// Figure 5.10: the CPU time of 1000 samples of UMAPRM and MAPRM.
pub fn cost(bench: &mut Bench) {
    let mut rows = rows(bench, OF_1000, true, of_1000);
    rows.retain(|row| row.method != Method::Prm);
    print(&rows, SECONDS, "CPU ms of 1000 samples");
    bench.draw(&svg(&[panel(&rows, SECONDS, "1000 samples on the axis", "CPU ms")]));
    let [umaprm, maprm] = [Method::Umaprm, Method::Maprm].map(|method| of(&rows, method));
    verdicts();
    let [us, them] = [umaprm, maprm].map(|row| row.means[SECONDS].map(|s| 1000.0 * s));
    verdict(
        "MAPRM's time falls from Obstacle 1 to 3",
        &format!("{} ms", shown(them, 2)),
        falls(them),
    );
    verdict(
        "UMAPRM's time varies less than MAPRM's",
        &format!(
            "most : least {:.2} and {:.2}",
            1.0 + umaprm.spread(SECONDS),
            1.0 + maprm.spread(SECONDS)
        ),
        umaprm.spread(SECONDS) < maprm.spread(SECONDS),
    );
    verdict(
        "UMAPRM's time is longest for Obstacle 3",
        &format!("{} ms", shown(us, 2)),
        us[2] > us[0] && us[2] > us[1],
    );
}

/// Figure 5.11: how many of 1000 samples are in the passage, and their CPU time.
pub fn fixed_number(bench: &mut Bench) {
    let bounded = rows(bench, OF_1000, true, of_1000);
    print(&bounded, COUNT, "of 1000 samples in the passage");
    print(&bounded, SECONDS, "CPU ms of 1000 samples");
    let free = rows(bench, OF_1000, false, of_1000);
    print(&free, COUNT, "of 1000 in the passage, bounds being no obstacles");
    bench.draw(&svg(&[
        panel(&bounded, COUNT, "of 1000 samples", "in the passage"),
        panel(&bounded, SECONDS, "1000 samples", "CPU ms"),
    ]));
    verdicts();
    let [umaprm, maprm] = [Method::Umaprm, Method::Maprm].map(|method| of(&bounded, method));
    verdict(
        "UMAPRM's number in the passage is the same within 10 %",
        &format!("{}: {:.1} %", shown(umaprm.means[COUNT], 1), 100.0 * umaprm.spread(COUNT)),
        umaprm.spread(COUNT) <= SAME,
    );
    verdict(
        "MAPRM's number in the passage grows",
        &shown(maprm.means[COUNT], 1),
        grows(maprm.means[COUNT]),
    );
    let [us, them] = [umaprm, maprm].map(|row| row.means[SECONDS].map(|s| 1000.0 * s));
    verdict(
        "MAPRM takes longer for 1000 samples than UMAPRM, in all three",
        &format!("{} ms for {}", shown(them, 2), shown(us, 2)),
        (0..3).all(|at| them[at] > us[at]),
    );
}

/// Figure 5.12: how many samples there are when 100 are in the passage, and their CPU time.
pub fn fixed_number_in_passage(bench: &mut Bench) {
    let rows = rows(bench, "figure-5.12", true, until_in_passage);
    print(&rows, COUNT, "samples when 100 are in the passage");
    print(&rows, SECONDS, "their CPU ms");
    bench.draw(&svg(&[
        panel(&rows, COUNT, "100 samples in the passage", "samples in all"),
        panel(&rows, SECONDS, "100 samples in the passage", "CPU ms"),
    ]));
    verdicts();
    let [umaprm, maprm] = [Method::Umaprm, Method::Maprm].map(|method| of(&rows, method));
    let [us, them] = [umaprm, maprm].map(|row| row.means[COUNT]);
    verdict("MAPRM's number of samples falls", &shown(them, 0), falls(them));
    verdict(
        "UMAPRM needs fewer samples than MAPRM, in all three",
        &format!("{} for {}", shown(us, 0), shown(them, 0)),
        (0..3).all(|at| us[at] < them[at]),
    );
    verdict(
        "UMAPRM's number of samples is the same within 10 %",
        &format!("{}: {:.1} %", shown(us, 0), 100.0 * umaprm.spread(COUNT)),
        umaprm.spread(COUNT) <= SAME,
    );
    let them = maprm.means[SECONDS].map(|seconds| 1000.0 * seconds);
    verdict("MAPRM's time falls", &format!("{} ms", shown(them, 2)), falls(them));
    verdict(
        "UMAPRM's time varies less than MAPRM's",
        &format!(
            "most : least {:.2} and {:.2}",
            1.0 + umaprm.spread(SECONDS),
            1.0 + maprm.spread(SECONDS)
        ),
        umaprm.spread(SECONDS) < maprm.spread(SECONDS),
    );
}
