use roadmill::img::{Job, Loss};
use roadmill::numbers::{EvaluatorIndex, StrategyIndex};
use roadmill_workers::WorkerId;
use std::collections::{BTreeMap, BTreeSet};

/// The work that a worker is given at once, in seconds, by what jobs of the same kinds took before. A message
/// costs the coordinator some 50 µs and a worker that waits for the reply some 100 µs: little beside this. And
/// when one worker runs out of jobs, no other has more left than this.
const HELD_SECONDS: f64 = 0.02;
/// The most work for each core that an agent is given beyond that since it had run out of work.
const ADDED_SECONDS_MAX: f64 = 0.5;
/// The weight of the newest measurement in the moving average of what jobs of a kind take.
const NEWEST: f64 = 0.25;

/// Which jobs wait, and which worker holds which jobs. Short jobs are handed out several at once. Of each
/// urgency a worker gets at most an even share of the jobs that are open (waiting or held), so that no worker
/// goes without while another holds jobs that it has yet to begin.
///
/// A job at which a worker died is a suspect: it may be what killed the worker. Suspects are handed out alone,
/// so that a job that kills again takes no other job with it and no other job is blamed. Jobs that were lost
/// for reasons of the worker ([`Loss::Departure`]) are handed out like all others.
#[derive(Debug, Default)]
pub struct Roster {
    /// The jobs that wait, by urgency.
    waiting: [BTreeSet<Job>; URGENCIES],
    /// How many jobs wait or are held, by urgency.
    open: [usize; URGENCIES],
    /// What each ready worker holds.
    held: BTreeMap<WorkerId, Desk>,
    /// How many jobs all of them can do at once.
    cores: usize,
    /// Jobs at which a worker died, and which have not been done since.
    suspects: BTreeSet<Job>,
    /// What jobs of a kind take, in seconds: a moving average.
    seconds: BTreeMap<Kind, f64>,
}

/// What a worker holds, or an agent, which has several workers of its own.
#[derive(Debug, Default)]
struct Desk {
    jobs: BTreeSet<Job>,
    /// How many of them are of each kind.
    kinds: BTreeMap<Kind, usize>,
    /// How many jobs are done at once.
    cores: usize,
    /// The work for each core beyond [`HELD_SECONDS`], in seconds. Of an agent only.
    ahead: Option<f64>,
    /// What was added to that, since the agent had run out of work.
    added: f64,
    /// Whether jobs that waited were not given, since it held enough.
    had_enough: bool,
}

impl Desk {
    fn insert(&mut self, job: Job) -> bool {
        let is_new = self.jobs.insert(job);
        *self.kinds.entry(kind(&job)).or_default() += usize::from(is_new);
        is_new
    }

    fn remove(&mut self, job: &Job) -> bool {
        let was_there = self.jobs.remove(job);
        if let Some(count) = self.kinds.get_mut(&kind(job)) {
            *count -= usize::from(was_there);
        }
        was_there
    }
}

/// How many urgencies there are.
const URGENCIES: usize = 3;

/// How urgent a job is: 0 is the most urgent, since most other work waits for it.
fn urgency(job: &Job) -> usize {
    kind(job).urgency()
}

/// What a job does, whatever the set or the round. Jobs of one kind take about equally long.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Evaluate(EvaluatorIndex),
    Join(StrategyIndex),
    Generate(StrategyIndex),
}

impl Kind {
    /// How urgent its jobs are: see [`urgency`].
    fn urgency(&self) -> usize {
        match self {
            Kind::Evaluate(_) => 0,
            Kind::Join(_) => 1,
            Kind::Generate(_) => 2,
        }
    }
}

fn kind(job: &Job) -> Kind {
    match *job {
        Job::Evaluate { evaluator, .. } => Kind::Evaluate(evaluator),
        Job::Join { strategy, .. } => Kind::Join(strategy),
        Job::Generate { strategy, .. } => Kind::Generate(strategy),
    }
}

impl Roster {
    /// Takes in a worker that is ready for jobs, so many at once.
    pub fn enlist(&mut self, worker: WorkerId, cores: usize) {
        self.cores += cores;
        self.held.insert(worker, Desk { cores, ..Desk::default() });
    }

    /// Takes note of how long a message takes to an agent and back, in seconds. As much more work it is given for each
    /// core, and as much again as a worker holds: its jobs go through another process, in which the next one should lie
    /// ready when a worker is done.
    pub fn set_round_trip(&mut self, agent: WorkerId, seconds: f64) {
        if let Some(desk) = self.held.get_mut(&agent) {
            desk.ahead = Some(HELD_SECONDS + seconds);
        }
    }

    /// How many jobs can be done at once by those who are ready, at work or not.
    pub fn cores(&self) -> usize {
        self.cores
    }

    /// Whether a worker holds no jobs.
    pub fn is_free(&self, worker: WorkerId) -> bool {
        self.held(worker) == 0
    }

    /// How many jobs a worker holds.
    pub fn held(&self, worker: WorkerId) -> usize {
        self.held.get(&worker).map_or(0, |desk| desk.jobs.len())
    }

    /// Whether a worker died at a job, which has not been done since.
    pub fn is_suspect(&self, job: &Job) -> bool {
        self.suspects.contains(job)
    }

    /// Takes note that a worker died at a job, elsewhere.
    pub fn suspect(&mut self, job: Job) {
        self.suspects.insert(job);
    }

    /// Whether a job waits: a worker that holds no jobs could be given one.
    pub fn has_work(&self) -> bool {
        self.waiting.iter().any(|jobs| !jobs.is_empty())
    }

    /// Takes in a job that is to be done.
    pub fn submit(&mut self, job: Job) {
        self.open[urgency(&job)] += 1;
        self.waiting[urgency(&job)].insert(job);
    }

    /// Hands out jobs to a worker, the most urgent first; none if the worker holds enough. Jobs for which
    /// `is_needed` says false are dropped.
    pub fn give(&mut self, worker: WorkerId, is_needed: impl Fn(Job) -> bool) -> Vec<Job> {
        let mut given = Vec::new();
        let all_cores = self.cores;
        let Some(desk) = self.held.get_mut(&worker) else { return given };
        let Desk { jobs: held, kinds, cores, ahead, added, had_enough } = desk;
        // What it held was not enough after all: messages take longer than signs of life.
        if std::mem::take(had_enough) && ahead.is_some() && held.len() < *cores {
            *added = (*added + HELD_SECONDS).min(ADDED_SECONDS_MAX);
        }
        // Who has several workers keeps a suspect from the other jobs.
        let is_single = *cores == 1;
        if is_single
            && !self.suspects.is_empty()
            && held.iter().any(|job| self.suspects.contains(job))
        {
            return given;
        }
        let ahead = ahead.map_or(0.0, |ahead| ahead + *added);
        let enough = *cores as f64 * (HELD_SECONDS + ahead);
        let seconds_of = |kind: &Kind| self.seconds.get(kind).copied().unwrap_or(HELD_SECONDS);
        let each = kinds.iter().map(|(kind, count)| *count as f64 * seconds_of(kind));
        let mut seconds: f64 = each.sum();
        for (level, (waiting, open)) in self.waiting.iter_mut().zip(&mut self.open).enumerate() {
            let of_level = kinds.iter().filter(|(kind, _)| kind.urgency() == level);
            let mut own: usize = of_level.map(|(_, count)| *count).sum();
            while let Some(job) = waiting.first().copied() {
                if !is_needed(job) {
                    waiting.pop_first();
                    *open -= 1;
                    continue;
                }
                let is_suspect = is_single && self.suspects.contains(&job);
                let more = seconds_of(&kind(&job));
                let would_wait = held.len() >= *cores;
                if would_wait && (is_suspect || seconds + more > enough) {
                    *had_enough = true;
                    return given;
                }
                // The share is rounded down: what remains is for the workers that are done first.
                if own >= (*open * *cores / all_cores).max(*cores) {
                    break;
                }
                seconds += more;
                waiting.pop_first();
                held.insert(job);
                *kinds.entry(kind(&job)).or_default() += 1;
                own += 1;
                given.push(job);
                if is_suspect {
                    return given;
                }
            }
        }
        given
    }

    /// Gives a job that does not wait to a worker: one that is done a second time.
    pub fn assign(&mut self, worker: WorkerId, job: Job) {
        if let Some(desk) = self.held.get_mut(&worker)
            && desk.insert(job)
        {
            self.open[urgency(&job)] += 1;
        }
    }

    /// Takes note that a worker has done a job, in so many seconds. False if the worker did not hold the job.
    pub fn done(&mut self, worker: WorkerId, job: Job, seconds: f64) -> bool {
        if !self.held.get_mut(&worker).is_some_and(|desk| desk.remove(&job)) {
            return false;
        }
        self.open[urgency(&job)] -= 1;
        self.suspects.remove(&job);
        let mean = self.seconds.entry(kind(&job)).or_insert(seconds);
        *mean += NEWEST * (seconds - *mean);
        true
    }

    /// Takes note that a worker is gone, and why. The jobs that are lost with the worker: whoever still needs
    /// them submits them again.
    pub fn dismiss(&mut self, worker: WorkerId, loss: Loss) -> BTreeSet<Job> {
        let Desk { jobs: lost, cores, .. } = self.held.remove(&worker).unwrap_or_default();
        self.cores -= cores;
        lost.iter().for_each(|job| self.open[urgency(job)] -= 1);
        if loss == Loss::Death {
            self.suspects.extend(&lost);
        }
        lost
    }

    /// Takes note that one of a member's own workers died while it held these jobs; those that are lost.
    pub fn lose(&mut self, member: WorkerId, jobs: &[Job]) -> Vec<Job> {
        let Some(desk) = self.held.get_mut(&member) else { return Vec::new() };
        let lost: Vec<Job> = jobs.iter().copied().filter(|job| desk.remove(job)).collect();
        lost.iter().for_each(|job| self.open[urgency(job)] -= 1);
        self.suspects.extend(&lost);
        lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use roadmill::numbers::{Ordinal, SetNumber};

    fn join(number: u64) -> Job {
        let (number, ordinal) = (SetNumber(number), Ordinal(number));
        Job::Join { number, strategy: StrategyIndex(0), ordinal }
    }

    fn generate(number: u64) -> Job {
        let (number, ordinal) = (SetNumber(number), Ordinal(number));
        Job::Generate { number, strategy: StrategyIndex(0), ordinal }
    }

    /// Workers, each of which has done one job of each kind in so many seconds.
    fn roster(workers: u64, seconds: f64) -> Roster {
        let mut roster = Roster::default();
        for worker in (0..workers).map(WorkerId) {
            roster.enlist(worker, 1);
            for job in [join(1_000_000), generate(1_000_000)] {
                roster.submit(job);
                assert_eq!(roster.give(worker, |_| true), [job]);
                assert!(roster.done(worker, job, seconds));
            }
        }
        roster
    }

    #[test]
    fn jobs_of_unknown_length_and_long_ones_are_given_one_by_one() {
        for mut roster in [roster(2, 60.0), Roster::default()] {
            let worker = WorkerId(0);
            roster.enlist(worker, 1);
            (0..4).for_each(|number| roster.submit(generate(number)));
            assert_eq!(roster.give(worker, |_| true), [generate(0)]);
            assert_eq!(roster.give(worker, |_| true), []);
            assert!(!roster.done(worker, generate(1), 60.0), "it had not this one");
            assert!(roster.done(worker, generate(0), 60.0));
            assert!(!roster.done(worker, generate(0), 60.0), "not twice");
            // Another is more urgent; one is no longer needed.
            roster.submit(join(0));
            assert_eq!(roster.give(worker, |job| job != join(0)), [generate(1)]);
        }
    }

    #[test]
    fn short_jobs_make_some_milliseconds_of_work() {
        let mut roster = roster(1, 0.003);
        (0..100).for_each(|number| roster.submit(generate(number)));
        let given = roster.give(WorkerId(0), |_| true);
        assert_eq!(given, (0..6).map(generate).collect::<Vec<_>>());
        assert!(roster.done(WorkerId(0), generate(0), 0.003));
        assert_eq!(roster.give(WorkerId(0), |_| true), [generate(6)]);
    }

    proptest! {
        /// However many jobs there are: in whatever order workers ask and finish, none is left without
        /// while another has two joins to begin.
        #[test]
        fn joins_are_shared_out_evenly(
            workers in 1u64..6, joins in 0u64..20, ahead in 0u64..10,
            first in any::<prop::sample::Index>(),
        ) {
            let mut roster = roster(workers, 1e-4);
            (0..joins).for_each(|number| roster.submit(join(number)));
            (0..ahead).for_each(|number| roster.submit(generate(100 + number)));
            let first = first.index(workers as usize) as u64;
            let order = (0..workers).map(|worker| WorkerId((worker + first) % workers));
            let mut left: Vec<_> = order.map(|worker| (worker, Vec::new())).collect();
            let mut all = BTreeSet::<Job>::new();
            loop {
                for (worker, jobs) in &mut left {
                    let given = roster.give(*worker, |_| true);
                    all.extend(given.iter().copied());
                    jobs.extend(given);
                    jobs.sort();
                }
                // Every worker begins its first job: the others are still to be begun.
                let is_idle = left.iter().any(|(_, jobs)| jobs.is_empty());
                let to_begin = left.iter().map(|(_, jobs)| {
                    jobs.iter().skip(1).filter(|job| urgency(job) == 1).count()
                });
                prop_assert!(!is_idle || to_begin.max() < Some(2));
                if left.iter().all(|(_, jobs)| jobs.is_empty()) {
                    break;
                }
                for (worker, jobs) in &mut left {
                    if !jobs.is_empty() {
                        prop_assert!(roster.done(*worker, jobs.remove(0), 1e-4));
                    }
                }
            }
            prop_assert_eq!(all.len() as u64, joins + ahead);
            prop_assert_eq!(roster.open, [0; URGENCIES]);
        }
    }

    /// An agent over a slow way is given more, until it does not run out of work; a worker never is.
    #[test]
    fn who_runs_out_of_work_is_given_more() {
        for (is_agent, expected) in [(true, 12..60), (false, 6..7)] {
            let mut roster = roster(1, 0.003);
            let member = WorkerId(0);
            if is_agent {
                roster.set_round_trip(member, 0.0);
            }
            (0..1000).for_each(|number| roster.submit(generate(number)));
            let mut given = Vec::new();
            for _ in 0..5 {
                given = roster.give(member, |_| true);
                for job in &given {
                    assert!(roster.done(member, *job, 0.003));
                }
            }
            assert!(expected.contains(&given.len()), "{} jobs", given.len());
        }
    }

    #[test]
    fn jobs_lost_with_a_member_are_handed_out_together_again() {
        let given_after = |loss| {
            let mut roster = roster(1, 1e-4);
            (0..4).for_each(|number| roster.submit(generate(number)));
            assert_eq!(roster.give(WorkerId(0), |_| true).len(), 4);
            let lost = roster.dismiss(WorkerId(0), loss);
            assert_eq!((lost.len(), roster.open), (4, [0; URGENCIES]));
            roster.enlist(WorkerId(1), 1);
            lost.into_iter().for_each(|job| roster.submit(job));
            roster.give(WorkerId(1), |_| true).len()
        };
        assert_eq!(given_after(Loss::Departure), 4);
        assert_eq!(given_after(Loss::Death), 1, "suspects are handed out alone");
    }

    /// One of several jobs kills: only that one is lost again, whoever gets it.
    #[test]
    fn a_job_that_kills_is_found_among_those_lost_with_it() {
        let mut roster = roster(2, 1e-4);
        let deadly = generate(3);
        (0..12).for_each(|number| roster.submit(generate(number)));
        let mut losses = BTreeMap::new();
        let mut done = BTreeSet::new();
        let mut newcomers = (2..).map(WorkerId);
        while losses.get(&deadly) < Some(&3) {
            let workers: Vec<WorkerId> = roster.held.keys().copied().collect();
            for worker in workers {
                roster.give(worker, |_| true);
                let held: Vec<Job> = roster.held[&worker].jobs.iter().copied().collect();
                for job in held {
                    if job != deadly {
                        assert!(roster.done(worker, job, 1e-4) && done.insert(job));
                        continue;
                    }
                    for lost in roster.dismiss(worker, Loss::Death) {
                        *losses.entry(lost).or_insert(0) += 1;
                        roster.submit(lost);
                    }
                    roster.enlist(newcomers.next().expect("endless"), 1);
                    break;
                }
            }
        }
        assert!(losses.len() > 1, "it was lost with others at first");
        assert!(losses.iter().all(|(job, losses)| *job == deadly || *losses == 1), "{losses:?}");
    }
}
