//! Samples of one sampler, with what they cost.

use crate::support::cpu_seconds;
use roadmill::Context;
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::roadmap::Configs;
use roadmill::sampler::{GaveUp, SamplerKind};
use roadmill::seed::Seed;

/// What a sampler drew.
pub struct Drawn {
    /// Where the robot's base is in each sample.
    pub bases: Vec<[f64; 3]>,
    /// CPU seconds.
    pub seconds: f64,
    /// Configurations whose validity was asked for.
    pub asked: f64,
}

/// A sampler as a problem file names it.
pub fn sampler(cx: &Context, text: &str) -> SamplerKind {
    let sampler: SamplerKind = crate::support::method(text);
    assert_eq!((sampler.method().complaint(), sampler.method().suits(cx)), (None, Ok(())));
    sampler
}

/// The samples of one set of a run.
pub fn set(
    cx: &Context,
    sampler: &SamplerKind,
    run: u64,
    ordinal: u64,
    count: usize,
) -> Result<Drawn, GaveUp> {
    let (mut scratch, mut configs) = (Scratch::new(), Configs::new(cx.space().len()));
    let seed = Seed::of_set(run, "surfaces", Ordinal(ordinal));
    let begun = cpu_seconds();
    sampler.method().sample(cx, &seed, count, &mut scratch, &mut configs)?;
    let seconds = cpu_seconds() - begun;
    let bases = configs.iter().map(|q| [q[0], q[1], q[2]]).collect();
    Ok(Drawn { bases, seconds, asked: scratch.take_asked().configurations as f64 })
}

/// All samples of a run in one set.
pub fn run(cx: &Context, text: &str, run: u64, count: usize) -> Result<Drawn, GaveUp> {
    set(cx, &sampler(cx, text), run, 0, count)
}

/// The mean of one number over runs.
pub fn mean(runs: &[Vec<f64>], at: usize) -> f64 {
    runs.iter().map(|run| run[at]).sum::<f64>() / runs.len() as f64
}

pub fn square(number: f64) -> f64 {
    number * number
}
