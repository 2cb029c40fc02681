//! Figure 5.7: how evenly samples lie on the axis between two unit blocks.

use super::scenes::{HALF_SIDE, blocks};
use super::{Fineness, Method, mean, milestones, verdict, verdicts};
use crate::Bench;
use crate::support::panels::{Look, Panel, Series, svg};
use crate::support::plot::COLOURS;
use roadmill::Context;
use roadmill::numbers::Ordinal;
use roadmill::roadmap::Configs;
use roadmill::seed::{Purpose, Seed};
use roadmill::uniformity::{Grid, Hotelling, Shares, Spread, nearest_distances};

/// The study whose runs others have as well.
const STUDY: &str = "figure-5.7";

pub const SAMPLES: usize = 1000;

/// How finely is looked. The tolerance is far below the mean distance of neighbours, 0.002 in the plane, so that samples do not scatter
/// about the axis; bounds are no obstacles, so that the part of the axis that belongs to them is left out.
pub const FINENESS: Fineness = Fineness { length: 1.0, step: 0.1, tolerance: 1e-6, bounds: false };

/// The level of the test of counts.
const LEVEL: f64 = 0.01;
/// How near UMAPRM's deviation is to that of uniform points.
const NEAR: f64 = 0.1;

/// What lies on the axis: samples of a sampler, or points drawn uniformly on it, which is known.
#[derive(Clone, Copy)]
pub enum Drawn {
    By(Method),
    OnAxis,
}

pub const DRAWN: [Drawn; 3] = [Drawn::By(Method::Umaprm), Drawn::By(Method::Maprm), Drawn::OnAxis];

impl Drawn {
    pub fn name(self) -> &'static str {
        match self {
            Drawn::By(method) => method.name(),
            Drawn::OnAxis => "uniform on the axis",
        }
    }

    pub fn colour(self) -> &'static str {
        match self {
            Drawn::By(method) => method.colour(),
            Drawn::OnAxis => COLOURS[0],
        }
    }

    fn case(self, dimensions: usize) -> String {
        format!("{dimensions}D {}", self.name())
    }

    /// Of each run the deviation of the nearest distances, and the number of samples in each cell.
    pub fn runs(self, bench: &mut Bench, dimensions: usize) -> Vec<Vec<f64>> {
        let cx = blocks(dimensions).problem.context();
        bench.case_of(STUDY, &self.case(dimensions), |seed| {
            let configs = self.samples(&cx, seed);
            let distances = nearest_distances(cx.space(), &configs);
            let spread = Spread::of(&distances).expect("there are samples");
            let counts = counts(&configs, dimensions);
            let counts = counts.iter().map(|count| *count as f64);
            std::iter::once(spread.deviation).chain(counts).collect()
        })
    }

    /// The samples of a run.
    pub fn samples(self, cx: &Context, seed: u64) -> Configs {
        let drawn = match self {
            Drawn::By(method) => method,
            Drawn::OnAxis => return on_axis(cx, seed),
        };
        milestones(cx, &drawn.sampler(FINENESS), SAMPLES, (seed, 0))
    }
}

/// Points of the whole space, drawn uniformly and moved onto the axis along x.
fn on_axis(cx: &Context, seed: u64) -> Configs {
    let mut stream = Seed::of_set(seed, "on the axis", Ordinal(0)).stream(Purpose::Sampling);
    let (mut configs, mut q) = (Configs::new(cx.space().len()), vec![0.0; cx.space().len()]);
    for _ in 0..SAMPLES {
        cx.space().sample_uniform(&mut stream, &mut q);
        q[0] = 0.0;
        configs.push(&q);
    }
    configs
}

/// Equal cells of the axis: 12 along the line, 4 times 4 of the plane.
pub fn cells(dimensions: usize) -> Grid {
    let far = HALF_SIDE;
    let (high, count) = if dimensions == 2 { (1.0, [1, 12, 1]) } else { (far, [1, 4, 4]) };
    Grid::new([-1.0, -far, -high], [1.0, far, high], count).expect("a box")
}

/// How many samples are in each cell.
fn counts(configs: &Configs, dimensions: usize) -> Vec<usize> {
    let at = |q: &[f64], axis: usize| q.get(axis).copied().unwrap_or(0.0);
    let points: Vec<[f64; 3]> = configs.iter().map(|q| [q[0], q[1], at(q, 2)]).collect();
    cells(dimensions).counts(&points).0
}

/// What the runs of a case came to.
struct Row {
    deviation: f64,
    test: Option<Hotelling>,
}

pub fn run(bench: &mut Bench) {
    println!(
        "| blocks | samples | deviation of nearest distances (its own over the runs) | largest error of a cell's share | F | p |"
    );
    println!("|{}", " --- |".repeat(6));
    let (mut rows, mut panels) = (Vec::new(), Vec::new());
    for dimensions in [2, 3] {
        let mut of_blocks = Vec::new();
        let mut series = Vec::new();
        for (at, drawn) in DRAWN.into_iter().enumerate() {
            if !bench.wants(&drawn.case(dimensions)) {
                continue;
            }
            let runs = drawn.runs(bench, dimensions);
            of_blocks.push(row(&format!("{dimensions}D"), drawn, &runs));
            series.push(Series {
                name: drawn.name().to_owned(),
                colour: drawn.colour(),
                look: Look::Dots,
                points: (0..runs.len())
                    .map(|run| [at as f64 + 0.012 * (run as f64 - 20.0), runs[run][0]])
                    .collect(),
            });
        }
        panels.push(Panel {
            title: format!("two unit blocks in {dimensions}D"),
            x_label: "a dot a run of 1000 samples".to_owned(),
            y_label: "deviation of nearest distances".to_owned(),
            log_y: false,
            words: (0..3).map(|at| (at as f64, DRAWN[at].name().to_owned())).collect(),
            series,
        });
        rows.push(of_blocks);
    }
    bench.draw(&svg(&panels));
    verdicts();
    for (name, rows) in ["2D", "3D"].into_iter().zip(&rows) {
        if let [umaprm, maprm, uniform] = &rows[..] {
            judge(name, umaprm, maprm, uniform);
        }
    }
}

fn row(blocks: &str, drawn: Drawn, runs: &[Vec<f64>]) -> Row {
    let deviations: Vec<f64> = runs.iter().map(|run| run[0]).collect();
    let over = Spread::of(&deviations).expect("there are runs");
    let counts: Vec<Vec<usize>> =
        runs.iter().map(|run| run[1..].iter().map(|count| *count as usize).collect()).collect();
    let shares = Shares::of(&counts, &vec![1.0; counts[0].len()]).expect("counts of runs");
    let (f, p) = shares.test.map_or((f64::NAN, f64::NAN), |test| (test.f, test.probability));
    println!(
        "| {blocks} | {} | {:.5} ({:.5}) | {:.1} % | {f:.2} | {p:.2e} |",
        drawn.name(),
        over.mean,
        over.deviation,
        100.0 * shares.largest_error
    );
    Row { deviation: mean(runs, 0), test: shares.test }
}

fn judge(name: &str, umaprm: &Row, maprm: &Row, uniform: &Row) {
    let [to_uniform, to_maprm] = [uniform, maprm].map(|row| umaprm.deviation / row.deviation);
    verdict(
        &format!("{name}: UMAPRM's deviation is within 10 % of that of uniform points"),
        &format!("{to_uniform:.3} of it"),
        (to_uniform - 1.0).abs() <= NEAR,
    );
    verdict(
        &format!("{name}: UMAPRM's deviation is below MAPRM's"),
        &format!("{to_maprm:.3} of it"),
        to_maprm < 1.0,
    );
    let tests = [("UMAPRM", umaprm, true), ("MAPRM", maprm, false)];
    for (sampler, row, passes) in tests {
        let Some(test) = row.test else { continue };
        let word = if passes { "passes" } else { "fails" };
        verdict(
            &format!("{name}: {sampler} {word} the test of counts at 1 %"),
            &format!("p = {:.2e}", test.probability),
            (test.probability >= LEVEL) == passes,
        );
    }
}
