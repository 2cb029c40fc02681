//! A pool of workers in virtual time: the jobs are not done, they take the time that was measured.

use roadmill::evaluate::Verdict;
use roadmill::img::{Cut, Event, Executor, Finished, Job, Joined, Outcome, Round, Setup};
use roadmill::model::Asked;
use roadmill::numbers::SetNumber;
use roadmill::roadmap::{Configs, Increment, Roadmap, Tally};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

/// As much work as a message brings, as the coordinator has it.
const HELD_SECONDS: f64 = 0.02;

/// Every worker is told where a set and the edges that join it lie in shared memory, and their digests.
pub const TOLD_BYTES: f64 = 90.0;

/// What was measured of a problem, in CPU seconds, all per set.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    pub generate: Vec<f64>,
    pub join: Vec<f64>,
    /// What every earlier set of the round adds to a join.
    pub join_more: f64,
    /// Decoding the set and finding its components, in every process that has a copy of the roadmap.
    pub take_in: f64,
    pub fold: f64,
    /// Of a round.
    pub evaluate: f64,
}

/// What the machine takes.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    /// The coordinator's CPU seconds per set, whatever the number of workers, but for messages.
    pub set_seconds: f64,
    /// Its CPU seconds per message and reply.
    pub message_seconds: f64,
    /// From one end of a message to the other.
    pub latency: f64,
    pub bytes_per_second: f64,
    /// How many times slower than measured all jobs are.
    pub slower: f64,
    /// Whether one takes sets in for all, instead of every worker for itself.
    pub shared: bool,
    /// Where the workers are those of agents on several machines.
    pub network: Option<Network>,
}

/// What lies between the coordinator's machine and those of its agents.
#[derive(Clone, Copy, Debug)]
pub struct Network {
    /// Workers of each agent.
    pub cores: usize,
    /// From one end to the other, in seconds.
    pub latency: f64,
    /// What the coordinator's machine can send, and receive, in all.
    pub bytes_per_second: f64,
    /// Of a set and the edges that join it, as they are sent to every agent but the one that made them.
    pub set_bytes: f64,
}

/// Time spent since the beginning, of all workers together but for the coordinator's.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// On the clock.
    pub now: f64,
    pub sets: u64,
    pub coordinator: f64,
    /// Generating, joining and evaluating.
    pub jobs: f64,
    /// Of that, evaluating.
    pub evaluations: f64,
    /// Of that, what joins take because their rounds have many sets.
    pub rounds: f64,
    /// Bringing copies of the roadmap up to date.
    pub copies: f64,
}

/// The pool.
pub struct VirtualPool<'a> {
    costs: &'a Costs,
    machine: Machine,
    sets_per_round: u64,
    dofs: usize,
    /// After so many sets the build is cut.
    sets_max: u64,
    /// How much of the log each worker has.
    places: Vec<usize>,
    idle: BTreeSet<usize>,
    /// By urgency.
    waiting: [BTreeSet<Job>; 3],
    /// Answers on their way: nanoseconds of arrival, worker and jobs.
    answers: BinaryHeap<Reverse<(u64, usize, Vec<Job>)>>,
    heard: VecDeque<Job>,
    /// Bytes and CPU seconds of all entries up to each.
    log: Vec<[f64; 2]>,
    roadmap: Roadmap,
    /// How much of the log each agent has been sent.
    agents: Vec<usize>,
    /// When all that was sent so far, and all that came, is through the coordinator's network.
    sent_at: f64,
    came_at: f64,
    pub spent: Spent,
    /// [`VirtualPool::spent`] when a third of the sets were folded.
    pub warm: Option<Spent>,
}

impl<'a> VirtualPool<'a> {
    pub fn new(
        setup: &Setup,
        (costs, machine): (&'a Costs, Machine),
        workers: usize,
        sets_max: u64,
    ) -> VirtualPool<'a> {
        VirtualPool {
            costs,
            machine,
            sets_per_round: u64::from(setup.problem().sets_per_round()),
            dofs: setup.context().space().len(),
            sets_max,
            places: vec![0; workers],
            idle: (0..workers).collect(),
            waiting: Default::default(),
            answers: BinaryHeap::new(),
            heard: VecDeque::new(),
            log: vec![[0.0; 2]],
            roadmap: Roadmap::new(setup.context().space()),
            agents: vec![0; machine.network.map_or(0, |network| workers.div_ceil(network.cores))],
            sent_at: 0.0,
            came_at: 0.0,
            spent: Spent::default(),
            warm: None,
        }
    }

    fn log(&mut self, bytes: f64, seconds: f64) {
        let [bytes_so_far, seconds_so_far] = self.log[self.log.len() - 1];
        self.log.push([bytes_so_far + bytes, seconds_so_far + seconds]);
    }

    /// The coordinator is at work.
    fn coordinate(&mut self, seconds: f64) {
        self.spent.now += seconds;
        self.spent.coordinator += seconds;
    }

    /// Seconds of a job; and of them, what it takes because its round has many sets.
    fn seconds_of(&self, job: Job) -> [f64; 2] {
        let costs = self.costs;
        let of = |each: &[f64], number: SetNumber| each[number.index() % each.len()];
        let earlier = match job {
            Job::Join { number, .. } => (number.0 % self.sets_per_round) as f64,
            Job::Generate { .. } | Job::Evaluate { .. } => 0.0,
        };
        let checking = match job {
            Job::Generate { number, .. } => of(&costs.generate, number),
            Job::Join { number, .. } => of(&costs.join, number),
            Job::Evaluate { .. } => costs.evaluate,
        };
        // Searching more sets takes no more checks.
        let more = earlier * costs.join_more;
        [checking * self.machine.slower + more, more]
    }

    /// Gives jobs to the workers that have none: of one urgency up to [`HELD_SECONDS`] and an even share, as
    /// the coordinator's roster does, which lets workers go on while their messages travel besides.
    fn feed(&mut self) {
        while let Some(worker) = self.idle.first().copied() {
            let Some(urgency) = self.waiting.iter().position(|jobs| !jobs.is_empty()) else {
                return;
            };
            let share = self.waiting[urgency].len().div_ceil(self.places.len());
            self.idle.remove(&worker);
            let (from, to) = (self.log[self.places[worker]], self.log[self.log.len() - 1]);
            self.places[worker] = self.log.len() - 1;
            let (bytes, copying) = (to[0] - from[0], to[1] - from[1]);
            let mut copies = 0.0;
            if !self.machine.shared {
                copies = copying;
                // An agent tells its own workers where a set lies.
                if self.machine.network.is_none() {
                    self.coordinate(bytes / self.machine.bytes_per_second);
                }
            }
            let held_seconds = HELD_SECONDS + self.round_trip();
            let way = self.send_to_agent_of(worker);
            let (mut jobs, mut all) = (Vec::new(), 0.0);
            while let Some(job) = self.waiting[urgency].first().copied() {
                let [seconds, more] = self.seconds_of(job);
                let is_full = jobs.len() == share || all + seconds > held_seconds;
                if !jobs.is_empty() && is_full {
                    break;
                }
                self.waiting[urgency].pop_first();
                jobs.push(job);
                all += seconds;
                self.spent.rounds += more;
                if matches!(job, Job::Evaluate { .. }) {
                    self.spent.evaluations += seconds;
                }
            }
            self.spent.jobs += all;
            self.spent.copies += copies;
            let done = self.spent.now + 2.0 * self.machine.latency + way + copies + all;
            let arrival = self.arrival(done, jobs.len());
            self.answers.push(Reverse(((arrival * 1e9) as u64, worker, jobs)));
        }
    }

    /// How long a message takes to an agent and back.
    fn round_trip(&self) -> f64 {
        self.machine.network.map_or(0.0, |network| 2.0 * network.latency)
    }

    /// Sends what has happened to the agent of a worker, once for all its workers; how long until it is there. Nothing is
    /// taken to go on besides, so that this is rather too long: an agent holds jobs for a round trip more.
    fn send_to_agent_of(&mut self, worker: usize) -> f64 {
        let Some(network) = self.machine.network else { return 0.0 };
        let agent = &mut self.agents[worker / network.cores];
        let end = self.log.len() - 1;
        // Each set is published, and folded with its round; the agent that made it has it already.
        let sets = (self.log[end][0] - self.log[*agent][0]) / TOLD_BYTES;
        *agent = end;
        let others = 1.0 - network.cores as f64 / self.places.len() as f64;
        let bytes = sets * network.set_bytes * others;
        self.sent_at = self.sent_at.max(self.spent.now) + bytes / network.bytes_per_second;
        self.sent_at - self.spent.now + network.latency
    }

    /// When the outcomes of jobs that are done at this time have come.
    fn arrival(&mut self, done: f64, jobs: usize) -> f64 {
        let Some(network) = self.machine.network else { return done };
        // A set and its join are two outcomes.
        let bytes = jobs as f64 / 2.0 * network.set_bytes;
        self.came_at = self.came_at.max(done) + bytes / network.bytes_per_second;
        self.came_at + network.latency
    }

    /// An outcome that the job could have.
    fn outcome(&self, job: Job) -> Outcome {
        match job {
            Job::Generate { .. } => {
                let mut configs = Configs::new(self.dofs);
                configs.push(&vec![0.0; self.dofs]);
                let (edges, asked) = (Vec::new(), Asked::default());
                Outcome::Increment(Ok(Increment { configs, edges, asked, ..Increment::empty(0) }))
            }
            Job::Join { .. } => {
                Outcome::Joined(Joined { edges: Vec::new(), asked: Asked::default() })
            }
            Job::Evaluate { .. } => {
                Outcome::Verdict(Box::new(Verdict::at_least(1.0, 0.0, Asked::default())))
            }
        }
    }
}

impl Executor for VirtualPool<'_> {
    fn publish(&mut self, _: &Arc<Increment>) {
        self.log(TOLD_BYTES, self.costs.take_in);
    }

    fn fold(&mut self, round: &Round) {
        let sets = round.sets.len() as u64;
        self.log(0.0, sets as f64 * self.costs.fold);
        self.spent.sets += sets;
        if self.spent.sets >= self.sets_max / 3 && self.warm.is_none() {
            self.warm = Some(self.spent);
        }
    }

    fn submit(&mut self, job: Job) {
        let urgency = match job {
            Job::Evaluate { .. } => 0,
            Job::Join { .. } => 1,
            Job::Generate { .. } => 2,
        };
        self.waiting[urgency].insert(job);
    }

    fn next(&mut self, _: Duration) -> Option<Event> {
        if self.spent.sets >= self.sets_max {
            return Some(Event::Cut(Cut::Time));
        }
        loop {
            self.feed();
            if let Some(job) = self.heard.pop_front() {
                return Some(Event::Done(job, Finished::new(self.outcome(job))));
            }
            let Reverse((arrival, ..)) = self.answers.peek()?;
            self.spent.now = self.spent.now.max(*arrival as f64 * 1e-9);
            while self
                .answers
                .peek()
                .is_some_and(|Reverse((arrival, ..))| *arrival as f64 * 1e-9 <= self.spent.now)
            {
                let Some(Reverse((_, worker, jobs))) = self.answers.pop() else { break };
                let sets = jobs.len() as f64 / 2.0;
                self.coordinate(self.machine.message_seconds + sets * self.machine.set_seconds);
                self.idle.insert(worker);
                self.heard.extend(jobs);
            }
        }
    }

    fn alive(&self) -> usize {
        self.places.len()
    }

    fn tally(&self) -> &Tally {
        self.roadmap.tally()
    }
}
