//! One build, and the roadmap as it was when each of several criteria was first met.

use super::cpu_seconds;
use roadmill::Context;
use roadmill::evaluate::{Connectivity, Coverage, EvaluatorKind, Samples, Verdict};
use roadmill::img::{Core, Cut, Observer, Progress, Round, Serial, Setup, Stop, drive};
use roadmill::local::Planner;
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::roadmap::{Configs, Roadmap, Tally};
use roadmill::sampler::SamplerKind;
use roadmill::seed::Seed;
use std::convert::Infallible;
use std::sync::Arc;

/// How configurations are attached to a roadmap.
#[derive(Clone)]
pub struct Attaching {
    pub neighbors: u32,
    pub planners: Vec<Planner>,
}

impl Default for Attaching {
    fn default() -> Attaching {
        Attaching { neighbors: 10, planners: vec![Planner::StraightLine] }
    }
}

impl Attaching {
    pub fn coverage(&self, samples: Samples, percent: f64) -> EvaluatorKind {
        let Attaching { neighbors, planners } = self.clone();
        EvaluatorKind::Coverage(Coverage { samples, percent, neighbors, planners })
    }

    pub fn connectivity(&self, samples: Samples, percent: f64) -> EvaluatorKind {
        let Attaching { neighbors, planners } = self.clone();
        EvaluatorKind::Connectivity(Connectivity { samples, percent, neighbors, planners })
    }
}

/// So many configurations of each sampler, as a list. What a sampler does not find is missing.
pub fn listed(
    cx: &Context,
    (seed, label): (u64, &str),
    drawn: &[(&SamplerKind, usize)],
) -> Samples {
    let mut configs = Configs::new(cx.space().len());
    for (ordinal, (sampler, count)) in drawn.iter().enumerate() {
        let seed = Seed::of_set(seed, label, Ordinal(ordinal as u64));
        let _ = sampler.method().sample(cx, &seed, *count, &mut Scratch::new(), &mut configs);
    }
    Samples::Listed(configs.iter().map(<[f64]>::to_vec).collect())
}

/// When a build ends although not all criteria have been met.
#[derive(Clone, Copy)]
pub struct Cap {
    pub nodes: u64,
    /// CPU seconds of this thread.
    pub seconds: f64,
}

/// The roadmap after the first round in which a criterion was met, or else at the end of the build.
#[derive(Clone, Debug, Default)]
pub struct Noted {
    pub satisfied: bool,
    pub rounds: u64,
    pub nodes: u64,
    pub edges: u64,
    pub components: u64,
    /// Configurations and motions that the sets had asked for.
    pub cost: u64,
    /// CPU seconds, the criteria's included.
    pub seconds: f64,
    /// Shares of the tests that can be connected, and of their pairs that are.
    pub connectible: f64,
    pub solved: f64,
}

/// Builds until each of `criteria` has been met once, or up to the cap. The problem's own are left out.
/// `each` is shown the roadmap after every round.
pub fn note(
    setup: &Arc<Setup>,
    criteria: &[EvaluatorKind],
    tests: Option<(&Samples, &Attaching)>,
    cap: Cap,
    each: &mut dyn FnMut(&Roadmap),
) -> (Vec<Noted>, Stop) {
    let problem = setup.problem().to_builder().evaluators([]).most_nodes(cap.nodes).build();
    let setup = Arc::new(Setup::new(problem.unwrap_or_else(|error| panic!("{error}"))));
    let tests = tests.map(|(samples, how)| {
        [how.coverage(samples.clone(), 100.0), how.connectivity(samples.clone(), 100.0)]
    });
    let begun = cpu_seconds();
    let mut watch = Watch {
        setup: setup.clone(),
        criteria,
        tests,
        begun,
        end: begun + cap.seconds,
        noted: vec![None; criteria.len()],
        cost: 0,
        scratch: Scratch::new(),
        roadmap: Roadmap::new(setup.context().space()),
        each,
    };
    let mut serial = Serial::new(setup.clone());
    let Ok(stop) = drive(&mut Core::new(&setup, 0), &mut serial, &mut watch);
    let roadmap = std::mem::replace(&mut watch.roadmap, Roadmap::new(setup.context().space()));
    let last = watch.now(&roadmap, false);
    (watch.noted.into_iter().map(|noted| noted.unwrap_or_else(|| last.clone())).collect(), stop)
}

struct Watch<'a> {
    setup: Arc<Setup>,
    criteria: &'a [EvaluatorKind],
    tests: Option<[EvaluatorKind; 2]>,
    begun: f64,
    end: f64,
    noted: Vec<Option<Noted>>,
    cost: u64,
    scratch: Scratch,
    roadmap: Roadmap,
    each: &'a mut dyn FnMut(&Roadmap),
}

impl Watch<'_> {
    fn judge(&mut self, criterion: &EvaluatorKind, path: &str, roadmap: &Roadmap) -> Verdict {
        criterion.method().evaluate(self.setup.context(), path, roadmap, &mut self.scratch)
    }

    fn now(&mut self, roadmap: &Roadmap, satisfied: bool) -> Noted {
        let seconds = cpu_seconds() - self.begun;
        let shares = self
            .tests
            .clone()
            .map(|tests| tests.map(|test| self.judge(&test, "tests", roadmap).value));
        let [connectible, solved] = shares.unwrap_or_default();
        Noted {
            satisfied,
            rounds: roadmap.rounds().len() as u64,
            nodes: roadmap.configs().len() as u64,
            edges: roadmap.edges().len() as u64,
            components: roadmap.components().count() as u64,
            cost: self.cost,
            seconds,
            connectible,
            solved,
        }
    }
}

impl Observer for Watch<'_> {
    type Error = Infallible;

    fn folded(&mut self, round: &Round, _: &Tally) -> Result<(), Infallible> {
        let space = self.setup.context().space();
        let mut roadmap = std::mem::replace(&mut self.roadmap, Roadmap::new(space));
        roadmap.fold_round(space, round.parts());
        for asked in round.sets.iter().flat_map(|set| [set.increment.asked, set.joined.asked]) {
            self.cost += asked.configurations + asked.motions;
        }
        for (index, criterion) in self.criteria.iter().enumerate() {
            let met =
                |watch: &mut Self| watch.judge(criterion, &index.to_string(), &roadmap).satisfied;
            if self.noted[index].is_none() && met(self) {
                self.noted[index] = Some(self.now(&roadmap, true));
            }
        }
        (self.each)(&roadmap);
        self.roadmap = roadmap;
        Ok(())
    }

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Infallible> {
        let all = !self.noted.is_empty() && self.noted.iter().all(Option::is_some);
        Ok((all || cpu_seconds() >= self.end).then_some(Cut::Time))
    }
}
