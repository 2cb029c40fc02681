//! Workers, or agents with workers, in virtual time: the jobs are not done, they take the time that was measured. Who gets which jobs is
//! what the coordinator's own roster says.

use roadmill::evaluate::Verdict;
use roadmill::img::{Cut, Event, Executor, Finished, Job, Joined, Outcome, Round, Setup};
use roadmill::model::Asked;
use roadmill::numbers::SetNumber;
use roadmill::roadmap::{Configs, Increment, Roadmap, Tally};
use roadmill_coordinator::dispatch::Roster;
use roadmill_workers::WorkerId;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

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

/// Who gets jobs from the coordinator: a worker, or an agent with several.
struct Member {
    /// The jobs that it has and has not begun, the most urgent first.
    desk: BTreeSet<(usize, Job)>,
    /// Of each core: how much of the log its process has taken in, and whether it is at work.
    cores: Vec<Core>,
    /// How much of the log has come here, and how much was sent.
    known: usize,
    sent: usize,
    /// Jobs that are done, with their nanoseconds, and not yet told.
    done: Vec<(Job, u64)>,
    /// Whether a message of it is on its way or without a reply. A worker sends one at a time.
    is_awaiting: bool,
}

#[derive(Clone, Copy, Default)]
struct Core {
    place: usize,
    is_busy: bool,
}

/// What happens at a time.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Happening {
    /// Jobs come to a member, and the log up to a place.
    Given { member: usize, known: usize, jobs: Vec<Job> },
    /// A core has done a job, in so many nanoseconds.
    Done { member: usize, core: usize, job: Job, nanoseconds: u64 },
    /// What a member did comes to the coordinator.
    Told { member: usize, jobs: Vec<(Job, u64)> },
}

/// The staff.
pub struct VirtualStaff<'a> {
    costs: &'a Costs,
    machine: Machine,
    sets_per_round: u64,
    dofs: usize,
    /// After so many sets the build is cut.
    sets_max: u64,
    roster: Roster,
    members: Vec<Member>,
    /// By time in nanoseconds; at one time, in the order in which it came to be known.
    happenings: BinaryHeap<Reverse<(u64, u64, Happening)>>,
    known: u64,
    heard: VecDeque<Job>,
    /// Workers whose last message has no reply yet.
    unanswered: BTreeSet<usize>,
    /// Bytes and CPU seconds of all entries up to each.
    log: Vec<[f64; 2]>,
    roadmap: Roadmap,
    /// When all that was sent so far, and all that came, is through the coordinator's network.
    sent_at: f64,
    came_at: f64,
    pub spent: Spent,
    /// [`VirtualStaff::spent`] when a third of the sets were folded.
    pub warm: Option<Spent>,
}

impl<'a> VirtualStaff<'a> {
    pub fn new(
        setup: &Setup,
        (costs, machine): (&'a Costs, Machine),
        workers: usize,
        sets_max: u64,
    ) -> VirtualStaff<'a> {
        let cores_each = machine.network.map_or(1, |network| network.cores);
        let count = workers.div_ceil(cores_each);
        let mut roster = Roster::default();
        let members = (0..count).map(|member| {
            let cores = cores_each.min(workers - member * cores_each);
            let id = WorkerId(member as u64);
            roster.enlist(id, cores);
            if let Some(network) = machine.network {
                roster.set_round_trip(id, 2.0 * network.latency);
            }
            Member {
                desk: BTreeSet::new(),
                cores: vec![Core::default(); cores],
                known: 0,
                sent: 0,
                done: Vec::new(),
                is_awaiting: true,
            }
        });
        VirtualStaff {
            costs,
            machine,
            sets_per_round: u64::from(setup.problem().sets_per_round()),
            dofs: setup.context().space().len(),
            sets_max,
            members: members.collect(),
            roster,
            happenings: BinaryHeap::new(),
            known: 0,
            heard: VecDeque::new(),
            unanswered: if machine.network.is_none() {
                (0..count).collect()
            } else {
                BTreeSet::new()
            },
            log: vec![[0.0; 2]],
            roadmap: Roadmap::new(setup.context().space()),
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

    fn at(&mut self, seconds: f64, happening: Happening) {
        self.known += 1;
        self.happenings.push(Reverse(((seconds * 1e9) as u64, self.known, happening)));
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

    /// Gives jobs to whoever may have more: to workers whose messages want a reply, to agents at any time.
    fn feed(&mut self) {
        let members: Vec<usize> = match self.machine.network {
            None => self.unanswered.iter().copied().collect(),
            Some(_) => (0..self.members.len()).collect(),
        };
        for member in members {
            self.give(member);
        }
    }

    /// Sends a member what it may have of the jobs that wait, and all that has happened. A worker without jobs is
    /// not answered before there are some; one with jobs is, so that it may tell what it has done since.
    fn give(&mut self, member: usize) {
        let id = WorkerId(member as u64);
        let jobs = self.roster.give(id, |_| true);
        let wants_reply = self.unanswered.contains(&member) && !self.roster.is_free(id);
        if jobs.is_empty() && !wants_reply {
            return;
        }
        self.unanswered.remove(&member);
        let end = self.log.len() - 1;
        let bytes = self.log[end][0] - self.log[self.members[member].sent][0];
        self.members[member].sent = end;
        let way = match self.machine.network {
            None => {
                // Every worker is told, unless one takes sets in for all.
                if !self.machine.shared {
                    self.coordinate(bytes / self.machine.bytes_per_second);
                }
                self.machine.latency
            }
            Some(network) => {
                // The agent that made a set, one of all, has it already.
                let others = 1.0 - 1.0 / self.members.len() as f64;
                let bytes = bytes / TOLD_BYTES * network.set_bytes * others;
                self.sent_at = self.sent_at.max(self.spent.now) + bytes / network.bytes_per_second;
                self.sent_at - self.spent.now + network.latency
            }
        };
        self.at(self.spent.now + way, Happening::Given { member, known: end, jobs });
    }

    /// Lets the free cores of a member begin the most urgent of its jobs.
    fn begin(&mut self, member: usize, now: f64) {
        while let Some(core) = self.members[member].cores.iter().position(|core| !core.is_busy)
            && let Some((_, job)) = self.members[member].desk.pop_first()
        {
            let known = self.members[member].known;
            let state = &mut self.members[member].cores[core];
            let copies = match self.machine.shared {
                true => 0.0,
                false => self.log[known][1] - self.log[state.place][1],
            };
            (state.place, state.is_busy) = (known, true);
            let [seconds, more] = self.seconds_of(job);
            self.spent.jobs += seconds;
            self.spent.rounds += more;
            self.spent.copies += copies;
            if matches!(job, Job::Evaluate { .. }) {
                self.spent.evaluations += seconds;
            }
            let nanoseconds = (seconds * 1e9) as u64;
            let done = Happening::Done { member, core, job, nanoseconds };
            self.at(now + copies + seconds, done);
        }
    }

    /// Sends what a member has done, unless a message of it is still without a reply.
    fn tell(&mut self, member: usize, now: f64) {
        let state = &mut self.members[member];
        if state.done.is_empty() || (state.is_awaiting && self.machine.network.is_none()) {
            return;
        }
        state.is_awaiting = true;
        let jobs: Vec<(Job, u64)> = std::mem::take(&mut state.done);
        let arrival = match self.machine.network {
            None => now + self.machine.latency,
            Some(network) => {
                // A set and its join are two outcomes.
                let bytes = jobs.len() as f64 / 2.0 * network.set_bytes;
                self.came_at = self.came_at.max(now) + bytes / network.bytes_per_second;
                self.came_at + network.latency
            }
        };
        self.at(arrival, Happening::Told { member, jobs });
    }

    /// The next thing happens.
    fn happen(&mut self, nanoseconds: u64, happening: Happening) {
        let now = nanoseconds as f64 * 1e-9;
        match happening {
            Happening::Given { member, known, jobs } => {
                let state = &mut self.members[member];
                state.known = state.known.max(known);
                state.is_awaiting = false;
                state.desk.extend(jobs.into_iter().map(|job| (urgency(job), job)));
                self.begin(member, now);
                self.tell(member, now);
            }
            Happening::Done { member, core, job, nanoseconds } => {
                let state = &mut self.members[member];
                state.cores[core].is_busy = false;
                state.done.push((job, nanoseconds));
                self.tell(member, now);
                self.begin(member, now);
            }
            Happening::Told { member, jobs } => {
                self.spent.now = self.spent.now.max(now);
                let sets = jobs.len() as f64 / 2.0;
                self.coordinate(self.machine.message_seconds + sets * self.machine.set_seconds);
                for (job, nanoseconds) in jobs {
                    self.roster.done(WorkerId(member as u64), job, nanoseconds as f64 * 1e-9);
                    self.heard.push_back(job);
                }
                if self.machine.network.is_none() {
                    self.unanswered.insert(member);
                }
            }
        }
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

impl Executor for VirtualStaff<'_> {
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
        self.roster.submit(job);
    }

    fn next(&mut self, _: Duration) -> Option<Event> {
        if self.spent.sets >= self.sets_max {
            return Some(Event::Cut(Cut::Time));
        }
        loop {
            if let Some(job) = self.heard.pop_front() {
                return Some(Event::Done(job, Finished::new(self.outcome(job))));
            }
            self.feed();
            let Reverse((nanoseconds, _, happening)) = self.happenings.pop()?;
            self.happen(nanoseconds, happening);
        }
    }

    fn alive(&self) -> usize {
        self.roster.cores()
    }

    fn tally(&self) -> &Tally {
        self.roadmap.tally()
    }
}

/// As the coordinator's roster has it: most other work waits for evaluations, and sets that are made for joins.
fn urgency(job: Job) -> usize {
    match job {
        Job::Evaluate { .. } => 0,
        Job::Join { .. } => 1,
        Job::Generate { .. } => 2,
    }
}
