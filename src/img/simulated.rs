//! An executor that does everything that can go wrong, all from one seed.

use super::{Event, Executor, Finished, InProcess, Job, Loss, Replica, Round, Setup, Task};
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::roadmap::{Digest, Full, Increment, Roadmap, Tally};
use crate::seed::{Purpose, Seed, Stream};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

/// Outcomes known from earlier simulations of the same problem, by the job and everything it
/// reads. Jobs are pure, so they need to be run once only; that they *are* pure is what the
/// suites that really run them test.
pub type Memo = BTreeMap<(Job, Digest), Finished>;

/// A pool of simulated workers that answer late and in any order, answer twice, die at work, leave for
/// reasons of their own, and are given up for dead though they answer later. No job is lost to so many
/// deaths that the build would end; how often workers leave is not bounded.
pub struct Simulated<'a> {
    setup: Arc<Setup>,
    replica: Replica,
    /// Digest of the increments published since the last fold, one after the other.
    published: Vec<Digest>,
    memo: &'a mut Memo,
    stream: Stream,
    workers: usize,
    waiting: BTreeSet<Job>,
    /// Jobs at work with what they will answer.
    running: Vec<(Job, Finished)>,
    /// How many workers died at each job.
    deaths: BTreeMap<Job, u32>,
    scratch: Scratch,
}

impl<'a> Simulated<'a> {
    /// A pool of `workers` whose every mishap follows from `seed`.
    pub fn new(setup: Arc<Setup>, workers: usize, seed: u64, memo: &'a mut Memo) -> Simulated<'a> {
        Simulated {
            replica: Replica::new(&setup),
            setup,
            published: Vec::new(),
            memo,
            stream: Seed::of_set(seed, "simulation", Ordinal(0)).stream(Purpose::Sampling),
            workers,
            waiting: BTreeSet::new(),
            running: Vec::new(),
            deaths: BTreeMap::new(),
            scratch: Scratch::new(),
        }
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.stream.unit() < probability
    }

    fn below(&mut self, count: usize) -> usize {
        (self.stream.unit() * count as f64) as usize
    }

    /// A worker takes a job, mostly the most urgent.
    fn take(&mut self) {
        let index = if self.chance(0.7) { 0 } else { self.below(self.waiting.len()) };
        let Some(job) = self.waiting.iter().nth(index).copied() else {
            return;
        };
        self.waiting.remove(&job);
        let Some(task) = self.replica.task(&self.setup, job) else {
            return;
        };
        let finished = match self.memo.get(&(job, self.inputs(&task))) {
            Some(finished) => finished.clone(),
            None => {
                self.scratch.poison((self.stream.unit() * 1e9) as u64);
                Finished::new(task.run(&self.setup, &mut self.scratch))
            }
        };
        self.memo.insert((job, self.inputs(&task)), finished.clone());
        self.running.push((job, finished));
    }

    /// A digest of everything that the task reads beside the problem.
    fn inputs(&self, task: &Task) -> Digest {
        let mut bytes = Vec::new();
        match task {
            Task::Generate { frozen, .. } => {
                bytes.extend(frozen.iter().flat_map(|frozen| frozen.digest().0));
            }
            Task::Join { input, .. } => {
                bytes.extend(input.roadmap.digest().0);
                for digest in &self.published[..input.increments.len()] {
                    bytes.extend(digest.0);
                }
            }
            Task::Evaluate { roadmap, .. } => bytes.extend(roadmap.digest().0),
        }
        Digest::of(&bytes)
    }
}

impl Executor for Simulated<'_> {
    fn publish(&mut self, increment: &Arc<Increment>) {
        self.published.push(Digest::of(&crate::wire::encode(&Full(&**increment))));
        self.replica.publish(&self.setup, increment.clone());
    }

    fn fold(&mut self, round: &Round) {
        self.published.clear();
        self.replica.fold(&self.setup, round.joins());
    }

    fn submit(&mut self, job: Job) {
        self.waiting.insert(job);
    }

    fn next(&mut self, _wait: Duration) -> Option<Event> {
        loop {
            let room = self.running.len() < self.workers && !self.waiting.is_empty();
            if room && (self.running.is_empty() || self.chance(0.6)) {
                self.take();
                continue;
            }
            if self.running.is_empty() {
                return None;
            }
            let index = self.below(self.running.len());
            let (job, finished) = self.running[index].clone();
            if self.chance(0.15) {
                let is_death = self.chance(0.5);
                let deaths = self.deaths.entry(job).or_default();
                let loss = if is_death && *deaths + 1 < super::core::LOSSES_MAX {
                    *deaths += 1;
                    Loss::Death
                } else {
                    Loss::Departure
                };
                // Half of the workers given up for dead answer all the same, some time later.
                if self.chance(0.5) {
                    self.running.swap_remove(index);
                }
                return Some(Event::Lost(job, loss));
            }
            // Some answer again.
            if !self.chance(0.1) {
                self.running.swap_remove(index);
            }
            return Some(Event::Done(job, finished));
        }
    }

    fn alive(&self) -> usize {
        self.workers
    }

    fn tally(&self) -> &Tally {
        self.replica.roadmap().tally()
    }
}

impl InProcess for Simulated<'_> {
    fn into_roadmap(self) -> Roadmap {
        self.replica.into_roadmap()
    }
}
