//! Chapter 5: samples on the medial axis. All robots are points, as in the dissertation (§5.2.1).

mod boxes;
mod distances;
mod distributions;
mod passages;
mod planning;
mod scenes;
mod traps;

use super::Study;
use crate::support::plot::COLOURS;
use roadmill::Context;
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::roadmap::Configs;
use roadmill::sampler::{Maprm, SamplerKind, Umaprm, Uniform};
use roadmill::seed::Seed;

pub const STUDIES: &[Study] = &[
    Study {
        name: "figure-5.7",
        about: "nearest distances and counts of samples on the axis between two unit blocks, in 2D and 3D",
        run: distances::run,
    },
    Study {
        name: "figure-5.8",
        about: "the picture of 1000 samples between two blocks in 2D",
        run: distributions::in_the_plane,
    },
    Study {
        name: "figure-5.9",
        about: "the picture of 1000 samples between two blocks in 3D",
        run: distributions::in_space,
    },
    Study {
        name: "figure-5.10",
        about: "CPU time of 1000 samples on the axis of Obstacle 1, 2 and 3",
        run: passages::cost,
    },
    Study {
        name: "figure-5.11",
        about: "samples in the passage of Obstacle 1, 2 and 3 among 1000, and their CPU time",
        run: passages::fixed_number,
    },
    Study {
        name: "figure-5.12",
        about: "samples and CPU time until 100 are in the passage of Obstacle 1, 2 and 3",
        run: passages::fixed_number_in_passage,
    },
    Study {
        name: "figure-5.14",
        about: "CPU time until the query is solved in 2DMaze, STunnel and 2DHeterogeneous",
        run: planning::time,
    },
    Study {
        name: "figure-5.15",
        about: "clearance of the paths of Figure 5.14",
        run: planning::clearance,
    },
    Study {
        name: "figure-5.14-traps",
        about: "CPU time until a point has left a bug trap, by the width of the opening",
        run: traps::run,
    },
];

/// A sampler that the chapter compares.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Method {
    Umaprm,
    Maprm,
    /// Uniform sampling of the free space.
    Prm,
}

const METHODS: [Method; 3] = [Method::Umaprm, Method::Maprm, Method::Prm];

/// How finely the samplers on the axis look.
#[derive(Clone, Copy)]
struct Fineness {
    /// Length of UMAPRM's segments.
    length: f64,
    /// Distance of neighbours on these, and length of MAPRM's first push.
    step: f64,
    /// How exactly the axis is found.
    tolerance: f64,
    /// Whether the sides of the bounds are obstacles.
    bounds: bool,
}

impl Fineness {
    /// By a rule for all scenes of Figures 5.10 to 5.15: the step is a quarter of the width of the narrowest place, so that UMAPRM sees
    /// the axis there, the tolerance a hundredth of it, and segments are a tenth as long as the longest side of the bounds. The sides of
    /// the bounds are obstacles: samples are on the axis of the entire space (§5.2.4).
    fn of_width(width: f64, longest_side: f64) -> Fineness {
        let (step, tolerance) = (width / 4.0, width / 100.0);
        Fineness { length: longest_side / 10.0, step, tolerance, bounds: true }
    }
}

impl Method {
    fn name(self) -> &'static str {
        match self {
            Method::Umaprm => "UMAPRM",
            Method::Maprm => "MAPRM",
            Method::Prm => "PRM",
        }
    }

    /// As the dissertation draws it: green, blue and red.
    fn colour(self) -> &'static str {
        match self {
            Method::Umaprm => COLOURS[2],
            Method::Maprm => COLOURS[1],
            Method::Prm => COLOURS[0],
        }
    }

    fn sampler(self, fineness: Fineness) -> SamplerKind {
        let Fineness { length, step, tolerance, bounds } = fineness;
        match self {
            Method::Umaprm => {
                SamplerKind::Umaprm(Umaprm { bounds, ..Umaprm::new(length, step, tolerance) })
            }
            Method::Maprm => SamplerKind::Maprm(Maprm { bounds, ..Maprm::new(step, tolerance) }),
            Method::Prm => SamplerKind::Uniform(Uniform::default()),
        }
    }
}

/// The milestones of a set with a seed and a number.
fn milestones(
    cx: &Context,
    sampler: &SamplerKind,
    count: usize,
    (seed, set): (u64, u64),
) -> Configs {
    let mut configs = Configs::new(cx.space().len());
    let seed = Seed::of_set(seed, "axes", Ordinal(set));
    let done = sampler.method().sample(cx, &seed, count, &mut Scratch::new(), &mut configs);
    done.unwrap_or_else(|error| panic!("{sampler:?}: {error}"));
    configs
}

/// The mean of a number of each run.
fn mean(runs: &[Vec<f64>], number: usize) -> f64 {
    runs.iter().map(|run| run[number]).sum::<f64>() / runs.len() as f64
}

/// The heading of a list of verdicts.
fn verdicts() {
    println!("\n| verdict, stated before the runs | ours | holds |\n| --- | --- | --- |");
}

/// A verdict: what was stated before the runs, what they came to, and whether the statement holds.
fn verdict(statement: &str, ours: &str, holds: bool) {
    println!("| {statement} | {ours} | {} |", if holds { "yes" } else { "no" });
}
