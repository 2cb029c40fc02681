//! Lists of motions to be decided, and how many steps they are cut into.

use super::{pairs, sample};
use roadmill::Context;
use roadmill::model::bodies::BodyValidity;
use roadmill::model::{Model, Scratch};
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::roadmap::{Components, Configs};
use roadmill::sampler::{Gaussian, Sampler};
use roadmill::seed::{Purpose, Seed};
use std::collections::BTreeSet;

/// Which motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum List {
    /// The 10 nearest of 2000 uniform milestones.
    Uniform,
    /// The 10 nearest of 2000 Gaussian milestones, half the robot's radius as deviation.
    Gaussian,
    /// Every so many of the 10 nearest of 10 000 uniform milestones.
    Dense,
}

pub const NEIGHBORS: usize = 10;
const MILESTONES: usize = 2000;
const DENSE_MILESTONES: usize = 10_000;
/// About so many pairs of a dense list are taken.
const DENSE_PAIRS: usize = 12_000;

impl List {
    pub const ALL: [List; 3] = [List::Uniform, List::Gaussian, List::Dense];

    pub fn name(self) -> &'static str {
        match self {
            List::Uniform => "uniform",
            List::Gaussian => "gaussian",
            List::Dense => "dense",
        }
    }

    /// Those that a word of the command line names, with commas between.
    pub fn named(names: &str) -> Vec<List> {
        let list = |name| List::ALL.into_iter().find(|list| list.name() == name);
        names.split(',').map(|name| list(name).expect("a list")).collect()
    }

    /// The milestones, and the pairs of them.
    pub fn draw(self, problem: &Problem, cx: &Context) -> (Configs, Vec<(usize, usize)>) {
        match self {
            List::Uniform => pairs(cx, NEIGHBORS),
            List::Gaussian => {
                let configs = near_obstacles(problem, cx, MILESTONES);
                let pairs = nearest(cx, &configs);
                (configs, pairs)
            }
            List::Dense => {
                let configs = sample(cx, DENSE_MILESTONES, u64::MAX);
                let pairs = nearest(cx, &configs);
                let every = pairs.len().div_ceil(DENSE_PAIRS);
                (configs, pairs.into_iter().step_by(every).collect())
            }
        }
    }
}

/// Gaussian milestones, half the robot's radius as deviation.
pub fn near_obstacles(problem: &Problem, cx: &Context, count: usize) -> Configs {
    let deviation = problem.model().bodies().expect("bodies").robot().reach() / 2.0;
    let sampler = Gaussian { deviation, bounds: false, attempts: 1_000_000 };
    let mut configs = Configs::new(cx.space().len());
    let seed = Seed::of_set(1, "near obstacles", Ordinal(0));
    let sampled = sampler.sample(cx, &seed, count, &mut Scratch::new(), &mut configs);
    sampled.expect("the scene has obstacles");
    configs
}

/// Each of the configurations with its nearest.
pub fn nearest(cx: &Context, configs: &Configs) -> Vec<(usize, usize)> {
    let alone = Components::of(cx.space(), configs, &[]);
    let mut pairs = BTreeSet::new();
    for (i, q) in configs.iter().enumerate() {
        let near = alone.k_nearest(cx.space(), configs, q, NEIGHBORS + 1);
        let others = near.iter().map(|near| near.id as usize).filter(|j| *j != i);
        pairs.extend(others.take(NEIGHBORS).map(|j| (i.min(j), i.max(j))));
    }
    pairs.into_iter().collect()
}

/// So many pairs of any two of the configurations.
pub fn any(configs: &Configs, count: usize) -> Vec<(usize, usize)> {
    let mut stream = Seed::of_set(1, "any", Ordinal(0)).stream(Purpose::Sampling);
    let mut one = || ((stream.unit() * configs.len() as f64) as usize).min(configs.len() - 1);
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let (i, j) = (one(), one());
        if i != j {
            pairs.push((i, j));
        }
    }
    pairs
}

/// A resolution so coarse that refining it can cut a motion into any number of steps.
pub fn coarse(problem: &Problem) -> f64 {
    let [min, max] = [
        problem.model().bodies().expect("bodies").bounds().min,
        problem.model().bodies().expect("bodies").bounds().max,
    ];
    let across: f64 = (0..3).map(|i| max[i] - min[i]).sum();
    1000.0 * (across + 4.0 * problem.model().bodies().expect("bodies").robot().reach())
}

/// The refinement of that resolution that cuts a motion into so many steps.
pub fn refinement(model: &dyn Model, a: &[f64], b: &[f64], steps: u64) -> u32 {
    let validity = BodyValidity::of(model).expect("bodies");
    let (mut low, mut high) = (1, u32::MAX);
    while low < high {
        let middle = low + (high - low).div_ceil(2);
        if validity.steps(a, b, middle) <= steps { low = middle } else { high = middle - 1 }
    }
    assert_eq!(validity.steps(a, b, low), steps, "the resolution is coarse enough");
    low
}
