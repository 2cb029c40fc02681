//! What the benches share.
#![allow(dead_code, reason = "each bench uses its part")]

pub mod book;
pub mod brute;
pub mod edges;
pub mod lists;
pub mod noting;
pub mod panels;
pub mod peer;
pub mod plot;
pub mod timing;

use roadmill::Context;
use roadmill::connect::AmongKind;
use roadmill::img::{Core, Cut, Judgement, Observer, Progress, Round, Serial, Setup, Stop, drive};
use roadmill::model::{Asked, Scratch};
use roadmill::neighbor::k_nearest;
use roadmill::numbers::Ordinal;
use roadmill::query::Path;
use roadmill::roadmap::{Configs, Tally};
use roadmill::sampler::{Sampler, SamplerKind, Uniform};
use roadmill::seed::Seed;
use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::convert::Infallible;
use std::sync::Arc;
pub use timing::{cpu_seconds, median};

/// What a bench over scenes is asked for.
pub struct Arguments {
    pub seeds: u64,
    pub seconds: f64,
    /// Strategies get these in the place of their own.
    pub sampler: Option<SamplerKind>,
    pub among: Option<AmongKind>,
    /// Rounds have so many sets.
    pub sets_per_round: Option<u64>,
    pub scenes: Vec<String>,
}

/// Reads `[--seeds N] [--seconds S] [--sampler SAMPLER] [--among AMONG] [--sets-per-round K] SCENE …`, methods as a
/// problem file names them.
pub fn arguments(seeds: f64, seconds: f64) -> Arguments {
    arguments_with(seeds, seconds, &[]).0
}

/// [`arguments`], and the words after some further options.
pub fn arguments_with(
    seeds: f64,
    seconds: f64,
    further: &[&str],
) -> (Arguments, Vec<Option<String>>) {
    let mut arguments = Arguments {
        seeds: seeds as u64,
        seconds,
        sampler: None,
        among: None,
        sets_per_round: None,
        scenes: Vec::new(),
    };
    let mut found = vec![None; further.len()];
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        let mut next = || words.next().unwrap_or_else(|| panic!("something after {word}"));
        if let Some(option) = further.iter().position(|option| *option == word) {
            found[option] = Some(next());
            continue;
        }
        let number =
            |text: String| text.parse::<f64>().unwrap_or_else(|_| panic!("{text}: a number"));
        match word.as_str() {
            "--seeds" => arguments.seeds = number(next()) as u64,
            "--seconds" => arguments.seconds = number(next()),
            "--sampler" => arguments.sampler = Some(method(&next())),
            "--sets-per-round" => arguments.sets_per_round = Some(number(next()) as u64),
            "--among" => arguments.among = Some(method(&next())),
            _ => arguments.scenes.push(word),
        }
    }
    (arguments, found)
}

/// A method as a problem file names it.
pub fn method<T: DeserializeOwned>(text: &str) -> T {
    toml::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// What a build came to.
pub struct Solved {
    pub satisfied: bool,
    pub nodes: u64,
    pub seconds: f64,
    /// What was asked of validity checking: by all sets, joins and evaluations.
    pub asked: Asked,
    /// The path that meets the query, if there is one.
    pub path: Option<Path>,
}

/// Builds in this thread until all criteria are met or so many CPU seconds have gone by.
pub fn solve(setup: &Arc<Setup>, seconds: f64) -> Solved {
    let begun = cpu_seconds();
    let mut core = Core::new(setup, 0);
    let mut serial = Serial::new(setup.clone());
    let mut watch = Watch { end: begun + seconds, asked: Asked::default(), path: None };
    let Ok(stop) = drive(&mut core, &mut serial, &mut watch);
    Solved {
        satisfied: stop == Stop::Satisfied,
        nodes: core.progress().nodes,
        seconds: cpu_seconds() - begun,
        asked: watch.asked,
        path: watch.path,
    }
}

/// Counts what is asked, keeps the path of the last evaluation, and ends a build when the thread's CPU time is up.
struct Watch {
    end: f64,
    asked: Asked,
    path: Option<Path>,
}

impl Observer for Watch {
    type Error = Infallible;

    fn folded(&mut self, round: &Round, _: &Tally) -> Result<(), Infallible> {
        for set in &round.sets {
            self.asked += set.increment.asked;
            self.asked += set.joined.asked;
        }
        Ok(())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Infallible> {
        judgement.verdicts.iter().for_each(|verdict| self.asked += verdict.asked);
        let mut answers = judgement.verdicts.iter().filter_map(|verdict| verdict.answer.as_ref());
        self.path = answers.find_map(|answer| answer.path.clone());
        Ok(())
    }

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Infallible> {
        Ok((cpu_seconds() >= self.end).then_some(Cut::Time))
    }
}

/// Valid uniform configurations.
pub fn sample(cx: &Context, count: usize, ordinal: u64) -> Configs {
    let mut configs = Configs::new(cx.space().len());
    let seed = Seed::of_set(1, "race", Ordinal(ordinal));
    let sampled = Uniform::default().sample(cx, &seed, count, &mut Scratch::new(), &mut configs);
    sampled.expect("the scene has free configurations");
    configs
}

/// 2000 configurations, and the pairs of each with its nearest.
pub fn pairs(cx: &Context, neighbors: usize) -> (Configs, Vec<(usize, usize)>) {
    let configs = sample(cx, 2000, u64::MAX);
    let mut pairs = BTreeSet::new();
    for i in 0..configs.len() {
        let others = (0..configs.len() as u32).filter(|other| *other as usize != i);
        for near in k_nearest(cx.space(), &configs, others, configs.get(i), neighbors) {
            let j = near.id as usize;
            pairs.insert((i.min(j), i.max(j)));
        }
    }
    (configs, pairs.into_iter().collect())
}
