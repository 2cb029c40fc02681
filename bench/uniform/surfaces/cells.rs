//! Tables 4.1 to 4.3 with Figures 4.7, 4.9 and 4.11: how samples are shared out among 16 cells, four by four, around balls and cubes.
//!
//! A run is 4000 samples. A region is an obstacle's four cells. Of a region a table has, as the dissertation has, the mean share of its
//! samples and the mean's error, and the standard deviation of the share *of one cell*, which is how the dissertation's numbers can be
//! read: with 4000 independent samples a share of 6.25 % has a standard deviation of 0.0038, which is what Table 4.2 has for UOBPRM, and
//! a share of 25 % has one of 0.0068. In Table 4.1 means are those of a cell, too.
//!
//! Stated before the runs: an entry agrees if no mean is farther than 0.01 from the dissertation's. "Uniform" is that Hotelling's test
//! over the runs does not reject the law at a level of 1 %, with the law for a cube robot (`scenes.rs`); each study states what it
//! expects of whom. Bridge test takes being out of bounds as colliding: with one convex obstacle there are no other bridges. UOBPRM has
//! `adjusted_bounds`. OBPRM walks from free and from colliding configurations; a row says what walks from colliding ones alone give.

use super::draws::{self, mean, square};
use super::picture::{Bars, bars};
use super::report::{agreement, chance, head, row, stated};
use super::scenes::{EDGE, Scene, Solid, four_balls, grown, mixture, one_ball};
use crate::Bench;
use crate::support::plot::COLOURS;
use roadmill::uniformity::{Grid, Shares};

const SAMPLES: usize = 4000;
const LEVEL: f64 = 0.01;
const WITHIN: f64 = 0.01;

/// An obstacle's cells, or those of free space.
struct Region {
    name: &'static str,
    cells: &'static [usize],
    colour: &'static str,
}

/// A sampler with what the dissertation has: per region mean and standard deviation.
struct Case {
    name: &'static str,
    sampler: &'static str,
    paper: &'static [[f64; 2]],
}

/// What a case came to.
struct Outcome {
    shares: Shares,
    /// The mean share of each region, or of one of its cells if the study has means of cells.
    means: Vec<f64>,
    /// The standard deviation of one cell's share in each region.
    deviations: Vec<f64>,
}

impl Outcome {
    /// The probability of as large a departure from the law; `None` where there are too few runs to tell.
    fn probability(&self) -> Option<f64> {
        self.shares.test.map(|test| test.probability)
    }

    fn uniform(&self) -> Option<bool> {
        self.probability().map(|probability| probability >= LEVEL)
    }
}

/// What was found of a case; `None` of one that was not run.
type Of<'a> = dyn Fn(&str) -> Option<Found> + 'a;

/// Something stated before the runs: of which case, and what.
struct Statement {
    says: &'static str,
    holds: fn(&Of) -> Option<bool>,
}

/// What statements are about.
#[derive(Clone)]
struct Found {
    uniform: Option<bool>,
    means: Vec<f64>,
    deviation: f64,
}

struct Layout {
    scene: Scene,
    regions: &'static [Region],
    /// The area of surface in each cell, as far as it matters.
    expected: [f64; 16],
    cases: &'static [Case],
    /// Whether means are those of one cell of a region.
    per_cell: bool,
    statements: &'static [Statement],
}

fn outcome(runs: &[Vec<f64>], layout: &Layout) -> Option<Outcome> {
    let counts: Vec<Vec<usize>> =
        runs.iter().map(|run| run[..16].iter().map(|count| *count as usize).collect()).collect();
    let shares = Shares::of(&counts, &layout.expected)?;
    let of = |region: &Region| {
        let sum: f64 = region.cells.iter().map(|cell| shares.cells[*cell].mean).sum();
        if layout.per_cell { sum / region.cells.len() as f64 } else { sum }
    };
    let means = layout.regions.iter().map(of).collect();
    let spread = |region: &Region| {
        let squares = region.cells.iter().map(|cell| square(shares.cells[*cell].deviation));
        (squares.sum::<f64>() / region.cells.len() as f64).sqrt()
    };
    let deviations = layout.regions.iter().map(spread).collect();
    Some(Outcome { means, deviations, shares })
}

/// Prints the table and draws the figure, whose panels it returns.
fn study(bench: &mut Bench, layout: &Layout) -> Vec<Bars> {
    let cx = layout.scene.problem().context();
    let grid = Grid::new([-4.0; 3], [4.0; 3], [4, 4, 1]).expect("a box");
    let mut titles = vec!["sampler".to_owned()];
    for region in layout.regions {
        titles.push(format!("{}, ours: mean ± sd (error)", region.name));
        titles.push("dissertation".to_owned());
    }
    titles.extend(
        ["largest error of a cell", "p of the law", "µs each", "asked each", "agrees"]
            .map(str::to_owned),
    );
    head(&titles);
    let whole: f64 = layout.expected.iter().sum();
    let (mut found, mut panels) = (Vec::new(), Vec::new());
    for case in layout.cases.iter() {
        if !bench.wants(case.name) {
            continue;
        }
        let runs = bench.case(case.name, |seed| {
            let drawn = draws::run(&cx, case.sampler, seed, SAMPLES);
            let drawn = drawn.unwrap_or_else(|error| panic!("{}: {error}", case.name));
            let (counts, _) = grid.counts(&drawn.bases);
            let counts = counts.iter().map(|count| *count as f64);
            counts.chain([drawn.seconds, drawn.asked]).collect()
        });
        let came = outcome(&runs, layout).expect("samples in each run");
        let mut cells = vec![case.name.to_owned()];
        for (at, region) in layout.regions.iter().enumerate() {
            let [ours, spread] = [came.means[at], came.deviations[at]];
            let sum: f64 = region.cells.iter().map(|cell| layout.expected[*cell]).sum();
            let ideal = sum / whole / if layout.per_cell { region.cells.len() as f64 } else { 1.0 };
            let error = match ideal > 0.0 {
                true => format!(" ({:+.4})", (ours - ideal) / ideal),
                false => String::new(),
            };
            cells.push(format!("{ours:.4} ± {spread:.4}{error}"));
            cells.push(match case.paper.get(at) {
                Some([mean, spread]) => format!("{mean:.4} ± {spread:.4}"),
                None => "–".to_owned(),
            });
        }
        let pairs: Vec<(f64, f64)> =
            came.means.iter().zip(case.paper).map(|(ours, paper)| (*ours, paper[0])).collect();
        cells.push(format!("{:.1} %", 100.0 * came.shares.largest_error));
        cells.push(chance(came.probability()));
        cells.push(format!("{:.1}", mean(&runs, 16) / SAMPLES as f64 * 1e6));
        cells.push(format!("{:.0}", mean(&runs, 17) / SAMPLES as f64));
        cells.push(if pairs.is_empty() { "–" } else { agreement(&pairs, WITHIN) }.to_owned());
        row(&cells);
        panels.push(Bars {
            title: case.name.to_owned(),
            heights: (0..16)
                .map(|cell| (came.shares.cells[cell].mean, colour(layout, cell)))
                .collect(),
            ideals: came.shares.cells.iter().map(|cell| cell.expected).collect(),
        });
        let deviation = came.deviations.iter().sum::<f64>() / came.deviations.len() as f64;
        let uniform = came.uniform();
        found.push((case.name, Found { uniform, means: came.means, deviation }));
    }
    println!();
    let of = |name: &str| {
        let entry = found.iter().find(|(known, _)| *known == name);
        entry.map(|(_, found)| found.clone())
    };
    for statement in layout.statements {
        stated(statement.says, (statement.holds)(&of));
    }
    let legend: Vec<(&str, &str)> =
        layout.regions.iter().map(|region| (region.name, region.colour)).collect();
    bench.draw(&bars(
        "Share of the samples in each of 16 cells; the lines are the law",
        &legend,
        &panels,
    ));
    panels
}

/// The shares of rows of cells, which is what Table 4.2 of the dissertation may have: found after the runs.
fn rows(panels: &[Bars]) {
    head(&["sampler", "cells 1 to 4", "5 to 8", "9 to 12", "13 to 16"]);
    for panel in panels {
        let shares = panel.heights.chunks(4);
        let shares = shares.map(|row| row.iter().map(|(share, _)| share).sum::<f64>());
        let words = shares.map(|share| format!("{share:.4}"));
        row(&[panel.title.clone()].into_iter().chain(words).collect::<Vec<_>>());
    }
}

fn colour(layout: &Layout, cell: usize) -> &'static str {
    let region = layout.regions.iter().find(|region| region.cells.contains(&cell));
    region.map_or(COLOURS[1], |region| region.colour)
}

const PRM: &str = "uniform = {}";
const GAUSSIAN: &str = "gaussian = { deviation = 0.2 }";
const BRIDGE: &str = "bridge = { deviation = 3.0, bounds = true }";
const OBPRM: &str = "obprm = { step = 0.1 }";
const OUTWARD: &str = "obprm = { step = 0.1, start = \"colliding\" }";
const UOBPRM: &str = "uobprm = { length = 1.0, step = 0.1, adjusted_bounds = true }";

/// Cells that a ball in the middle of the box reaches, and the others. Cells are numbered from 0 along x, then along y.
const MIDDLE: &[Region] = &[
    Region { name: "ball", cells: &[5, 6, 9, 10], colour: COLOURS[0] },
    Region { name: "free", cells: &[0, 1, 2, 3, 4, 7, 8, 11, 12, 13, 14, 15], colour: COLOURS[1] },
];

/// Table 4.1 and Figure 4.7.
pub fn single(bench: &mut Bench) {
    let mut expected = [0.0; 16];
    MIDDLE[0].cells.iter().for_each(|cell| expected[*cell] = 1.0);
    let layout = Layout {
        scene: one_ball(),
        regions: MIDDLE,
        expected,
        per_cell: true,
        cases: &[
            Case { name: "PRM", sampler: PRM, paper: &[[0.0629, 0.0079], [0.0624, 0.0071]] },
            Case {
                name: "Gaussian d=0.2",
                sampler: GAUSSIAN,
                paper: &[[0.2328, 0.0086], [0.0057, 0.0093]],
            },
            Case {
                name: "Bridge d=3",
                sampler: BRIDGE,
                paper: &[[0.0411, 0.0090], [0.0696, 0.0090]],
            },
            Case { name: "OBPRM", sampler: OBPRM, paper: &[[0.25, 0.0093], [0.0, 0.0]] },
            Case { name: "OBPRM outward", sampler: OUTWARD, paper: &[] },
            Case { name: "UOBPRM l=1", sampler: UOBPRM, paper: &[[0.25, 0.0089], [0.0, 0.0]] },
        ],
        statements: &[
            Statement {
                says: "PRM has about a sixteenth in every cell, so that it is far from the law",
                holds: |of| {
                    of("PRM").and_then(|f| Some(!f.uniform? && (f.means[0] - 0.0625).abs() < 0.003))
                },
            },
            Statement {
                says: "Gaussian has no sample in free cells, against the dissertation's 0.0057 in each: none is farther than about 4 d from a small robot's surface",
                holds: |of| of("Gaussian d=0.2").map(|f| f.means[1] == 0.0),
            },
            Statement {
                says: "Bridge has more samples in a free cell than in one of the ball",
                holds: |of| of("Bridge d=3").map(|f| f.means[1] > f.means[0]),
            },
            Statement {
                says: "OBPRM's error is 0: nothing in free cells",
                holds: |of| of("OBPRM").map(|f| f.means[1] == 0.0),
            },
            Statement {
                says: "OBPRM is uniform among the cells, by symmetry",
                holds: |of| of("OBPRM").and_then(|f| f.uniform),
            },
            Statement {
                says: "UOBPRM is uniform, and its error is 0",
                holds: |of| of("UOBPRM l=1").and_then(|f| Some(f.uniform? && f.means[1] == 0.0)),
            },
            Statement {
                says: "UOBPRM has the least deviation in the ball's cells",
                holds: |of| {
                    let least = of("UOBPRM l=1")?.deviation;
                    Some(
                        ["OBPRM", "Gaussian d=0.2"]
                            .iter()
                            .all(|name| of(name).is_none_or(|found| found.deviation > least)),
                    )
                },
            },
        ],
    };
    study(bench, &layout);
}

/// The quarters of the box, in the order of the obstacles in `scenes.rs`.
const BALLS: &[Region] = &[
    Region { name: "ball 1", cells: &[8, 9, 12, 13], colour: COLOURS[0] },
    Region { name: "ball 2", cells: &[10, 11, 14, 15], colour: COLOURS[1] },
    Region { name: "ball 3", cells: &[0, 1, 4, 5], colour: COLOURS[2] },
    Region { name: "ball 4", cells: &[2, 3, 6, 7], colour: COLOURS[3] },
];

/// Table 4.2 and Figure 4.9.
pub fn four(bench: &mut Bench) {
    let layout = Layout {
        scene: four_balls(),
        regions: BALLS,
        expected: [1.0; 16],
        per_cell: false,
        cases: &[
            Case {
                name: "PRM",
                sampler: PRM,
                paper: &[[0.2151, 0.0128], [0.2848, 0.0125], [0.2848, 0.0126], [0.2153, 0.0128]],
            },
            Case {
                name: "Gaussian d=0.2",
                sampler: GAUSSIAN,
                paper: &[[0.2505, 0.0029], [0.2503, 0.0030], [0.2488, 0.0032], [0.2504, 0.0034]],
            },
            Case {
                name: "Bridge d=3",
                sampler: BRIDGE,
                paper: &[[0.1975, 0.0526], [0.3152, 0.0524], [0.3107, 0.0526], [0.1765, 0.0523]],
            },
            Case {
                name: "OBPRM",
                sampler: OBPRM,
                paper: &[[0.2089, 0.0153], [0.2907, 0.0150], [0.2925, 0.0148], [0.2078, 0.0156]],
            },
            Case { name: "OBPRM outward", sampler: OUTWARD, paper: &[] },
            Case {
                name: "UOBPRM l=1",
                sampler: UOBPRM,
                paper: &[[0.2488, 0.0038], [0.2511, 0.0034], [0.2495, 0.0039], [0.2494, 0.0033]],
            },
        ],
        statements: &[
            Statement {
                says: "UOBPRM is uniform",
                holds: |of| of("UOBPRM l=1").and_then(|f| f.uniform),
            },
            Statement {
                says: "Gaussian is uniform",
                holds: |of| of("Gaussian d=0.2").and_then(|f| f.uniform),
            },
            Statement {
                says: "a cell's deviation is lower with Gaussian than with UOBPRM, as in the dissertation: its samples are independent",
                holds: |of| Some(of("Gaussian d=0.2")?.deviation < of("UOBPRM l=1")?.deviation),
            },
            Statement {
                says: "OBPRM is not uniform: cells at the box's middle get more than those at its sides",
                holds: |of| of("OBPRM").and_then(|f| Some(!f.uniform?)),
            },
            Statement {
                says: "walks of OBPRM from colliding configurations alone are uniform on balls, by symmetry",
                holds: |of| of("OBPRM outward").and_then(|f| f.uniform),
            },
            Statement {
                says: "each sampler has a quarter around each ball, by symmetry, within 0.01: the dissertation's PRM, Bridge and OBPRM have not",
                holds: |of| {
                    let of = ["PRM", "Bridge d=3", "OBPRM"].map(of);
                    let near = |f: &Found| f.means.iter().all(|mean| (mean - 0.25).abs() < 0.01);
                    of.iter().all(Option::is_some).then(|| of.iter().flatten().all(near))
                },
            },
        ],
    };
    rows(&study(bench, &layout));
}

const MIXED: &[Region] = &[
    Region { name: "ball 1", cells: &[8, 9, 12, 13], colour: COLOURS[0] },
    Region { name: "ball 2", cells: &[2, 3, 6, 7], colour: COLOURS[3] },
    Region { name: "cube 1", cells: &[10, 11, 14, 15], colour: COLOURS[1] },
    Region { name: "cube 2", cells: &[0, 1, 4, 5], colour: COLOURS[2] },
];

/// Table 4.3 and Figure 4.11.
pub fn mixed(bench: &mut Bench) {
    let of = |solid: Solid| grown(solid, EDGE) / 4.0;
    let mut expected = [of(Solid::unit_ball(0.0, 0.0)); 16];
    for cell in MIXED[2..].iter().flat_map(|region| region.cells) {
        expected[*cell] = of(Solid::cube(0.0, 0.0));
    }
    let layout = Layout {
        scene: mixture(),
        regions: MIXED,
        expected,
        per_cell: false,
        cases: &[
            Case {
                name: "PRM",
                sampler: PRM,
                paper: &[[0.2660, 0.0136], [0.2670, 0.0137], [0.2339, 0.0131], [0.2330, 0.0134]],
            },
            Case {
                name: "Gaussian d=0.2",
                sampler: GAUSSIAN,
                paper: &[[0.1948, 0.0040], [0.1938, 0.0042], [0.3057, 0.0048], [0.3057, 0.0045]],
            },
            Case {
                name: "Bridge d=3",
                sampler: BRIDGE,
                paper: &[[0.2407, 0.0629], [0.2789, 0.0632], [0.2408, 0.0481], [0.2396, 0.0473]],
            },
            Case {
                name: "OBPRM",
                sampler: "obprm = { step = 0.025 }",
                paper: &[[0.1897, 0.0109], [0.1897, 0.0109], [0.3107, 0.0188], [0.3099, 0.0194]],
            },
            Case {
                name: "OBPRM outward",
                sampler: "obprm = { step = 0.025, start = \"colliding\" }",
                paper: &[],
            },
            Case {
                name: "UOBPRM l=1",
                sampler: "uobprm = { length = 1.0, step = 0.025, adjusted_bounds = true }",
                paper: &[[0.1734, 0.0032], [0.1728, 0.0029], [0.3266, 0.0039], [0.3271, 0.0039]],
            },
        ],
        statements: &[
            Statement {
                says: "UOBPRM is uniform: what steps of 0.025 miss at the cubes' edges is less than the test sees",
                holds: |of| of("UOBPRM l=1").and_then(|f| f.uniform),
            },
            Statement {
                says: "UOBPRM has within 0.003 of 0.1718 around a ball and of 0.3282 around a cube",
                holds: |of| {
                    let near = |mean: f64, ideal: f64| (mean - ideal).abs() < 0.003;
                    of("UOBPRM l=1").map(|f| {
                        f.means[..2].iter().all(|mean| near(*mean, 0.1718))
                            && f.means[2..].iter().all(|mean| near(*mean, 0.3282))
                    })
                },
            },
            Statement {
                says: "Gaussian is not uniform: pairs miss edges of the cubes",
                holds: |of| of("Gaussian d=0.2").and_then(|f| Some(!f.uniform?)),
            },
            Statement {
                says: "Gaussian has less than 0.18 around a ball, nearer to the law than the dissertation's 0.1948",
                holds: |of| of("Gaussian d=0.2").map(|f| f.means[0] < 0.18 && f.means[1] < 0.18),
            },
            Statement {
                says: "OBPRM is not uniform",
                holds: |of| of("OBPRM").and_then(|f| Some(!f.uniform?)),
            },
            Statement {
                says: "PRM has a quarter in each region within 0.01: the robot is small",
                holds: |of| {
                    of("PRM").map(|f| f.means.iter().all(|mean| (mean - 0.25).abs() < 0.01))
                },
            },
        ],
    };
    study(bench, &layout);
}
