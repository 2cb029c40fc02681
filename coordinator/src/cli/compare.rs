//! Arguments of `compare`.

use super::{GrowthArguments, ProblemArguments, folder};
use clap::Args;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// The most seeds of a comparison.
const SEEDS_MAX: u64 = 1000;

/// Of `compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// What is compared: `own` (the problem's strategies as they are), names of samplers or generators (uniform, halton,
    /// rrt-connect), or strategies as a problem file has them (near = { sampler = { gaussian = { deviation = 0.5 } } })
    #[arg(long, visible_alias = "samplers", value_name = "STRATEGY", num_args = 1.., required = true)]
    pub strategies: Vec<String>,
    /// Base seeds: numbers, or FIRST-LAST
    #[arg(long, value_name = "SEEDS", num_args = 1.., default_values = ["1-5"], value_parser = seeds)]
    pub seeds: Vec<RangeInclusive<u64>>,
    /// Folder for the runs, the tables and the page; the same command goes on where it was
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub out: PathBuf,
    /// Do not stop where the criteria are met, but at the limits: to see how values go on
    #[arg(long)]
    pub go_on: bool,
    #[command(flatten)]
    pub growth: GrowthArguments,
}

impl CompareArguments {
    /// The seeds, each once, in the order given.
    pub fn each_seed(&self) -> Vec<u64> {
        let mut seeds = Vec::new();
        for seed in self.seeds.iter().cloned().flatten() {
            if !seeds.contains(&seed) {
                seeds.push(seed);
            }
        }
        seeds
    }
}

fn seeds(text: &str) -> Result<RangeInclusive<u64>, String> {
    let parse = || {
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        let (first, last): (u64, u64) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
        (first <= last && last - first < SEEDS_MAX).then_some(first..=last)
    };
    parse().ok_or_else(|| {
        format!("a number or FIRST-LAST expected, two numbers that are at most {SEEDS_MAX} seeds")
    })
}
