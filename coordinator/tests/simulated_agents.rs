//! Builds by simulated agents: everything that a real fleet can do happens here from one seed, in memory and without
//! waiting. Agents come late, are lost with what they had said or without it, leave, lose workers, answer in any order, and
//! fall behind; jobs are done once or, under an audit, twice.
//!
//! `ROADMILL_AGENT_SIMULATIONS` sets how many builds there are, `ROADMILL_AGENT_SEED` the one to run again.

use roadmill::img::{
    Core, Cut, Finished, Front, Job, LOSSES_MAX, Observer, Outcome, Progress, Replica, Setup, Stop,
    build, canaries, drive,
};
use roadmill::internal::wire;
use roadmill::model::Scratch;
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Outline, Tally};
use roadmill_coordinator::agent::message::{Entry, Text};
use roadmill_coordinator::agent::{Condition, Fleet, FromAgent, Identity, News, Place, ToAgent};
use roadmill_coordinator::dispatch::{AgentOptions, Agents, Dispatcher};
use roadmill_workers::WorkerId;
use roadmill_workers::message::Done;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt;
use std::os::fd::BorrowedFd;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

/// A build of a few rounds, with a strategy that grows from the roadmap and two evaluators.
const PROBLEM: &str = r#"
seed = 5
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [10.0, 6.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[[obstacles]]
shape = { box = { size = [0.4, 4.0, 1.0] } }
position = [5.0, 3.0, 0.0]
[query]
start = [1.0, 3.0]
goal = [9.0, 3.0]
[img]
sets_per_round = 3
schedule = ["a", "a", "g"]
[[strategies]]
label = "a"
nodes = 4
sampler = { uniform = {} }
[[strategies]]
label = "g"
nodes = 3
generator = { expansion-step = { step = 0.2, steps = 15, bounces = 3 } }
among = { nearest-nodes = { neighbors = 4 } }
[[evaluators]]
coverage = { samples = { random = 4 }, percent = 100 }
[[evaluators]]
all = [{ query = {} }, { not = { query = {} } }]
[limits]
sets = 18
"#;

/// Outcomes by the job and the state of the roadmap: jobs are pure, which other tests show by doing them again.
type Memo = Rc<RefCell<BTreeMap<(Job, usize), Finished>>>;

/// What every build of these tests shares.
#[derive(Clone)]
struct Shared {
    setup: Arc<Setup>,
    canaries: Digest,
    memo: Memo,
    /// Digests of the roadmap after so many entries, as an agent first had it.
    states: Rc<RefCell<BTreeMap<usize, Digest>>>,
}

/// A fixed pseudo-random sequence.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % end as u64) as usize
    }

    fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }
}

/// An agent, its workers and its links.
struct Agent {
    member: WorkerId,
    cores: u32,
    /// What the coordinator has sent, and what it has not heard yet.
    inbox: VecDeque<Arc<Vec<u8>>>,
    outbox: VecDeque<Vec<u8>>,
    replica: Replica,
    front: Front,
    entries: usize,
    jobs: BTreeSet<Job>,
    /// Outcomes of its own.
    own: BTreeMap<Job, Vec<u8>>,
}

struct Simulated {
    shared: Shared,
    places: Vec<Place>,
    agents: RefCell<Vec<Option<Agent>>>,
    random: RefCell<Random>,
    news: VecDeque<News>,
    next_member: u64,
    /// How often workers died at each job: never so often that the build would end.
    deaths: BTreeMap<Job, u32>,
    /// So likely in percent is a mishap in each step.
    trouble: usize,
}

impl Simulated {
    fn new(shared: &Shared, seed: u64) -> Simulated {
        let mut random = Random(seed);
        let count = 1 + random.below(4);
        let place = |number| Place::new(&format!("m{number}"), "none").expect("it is a name");
        let places: Vec<Place> = (0..count).map(place).collect();
        let trouble = [0, 3, 12][random.below(3)];
        Simulated {
            shared: shared.clone(),
            agents: RefCell::new(places.iter().map(|_| None).collect()),
            places,
            random: RefCell::new(random),
            news: VecDeque::new(),
            next_member: 0,
            deaths: BTreeMap::new(),
            trouble,
        }
    }

    fn start(&mut self, place: usize) {
        let member = WorkerId(self.next_member);
        self.next_member += 1;
        let cores = 1 + self.random.borrow_mut().below(4) as u32;
        let replica = Replica::new(&self.shared.setup);
        self.agents.borrow_mut()[place] = Some(Agent {
            member,
            cores,
            inbox: VecDeque::new(),
            outbox: VecDeque::new(),
            replica,
            front: Front::default(),
            entries: 0,
            jobs: BTreeSet::new(),
            own: BTreeMap::new(),
        });
        self.news.push_back(News::Joined { member, place });
    }

    /// Something happens at one place.
    fn step(&mut self) {
        let place = self.random.borrow_mut().below(self.places.len());
        let taken = self.agents.borrow_mut()[place].take();
        let Some(mut agent) = taken else { return self.start(place) };
        if self.random.borrow_mut().chance(self.trouble) {
            // With or without what it had still said.
            if self.random.borrow_mut().chance(50) {
                while let Some(message) = agent.outbox.pop_front() {
                    self.news.push_back(News::Message { member: agent.member, message });
                }
            }
            let (member, why) = (agent.member, "simulated".to_owned());
            if self.random.borrow_mut().chance(30) {
                let leaving = FromAgent::Leaving(why);
                let message = wire::encode(&leaving);
                self.news.push_back(News::Message { member, message });
            } else {
                self.news.push_back(News::Lost { member, why });
            }
            // It stays until it is dismissed.
            self.agents.borrow_mut()[place] =
                Some(Agent { inbox: VecDeque::new(), jobs: BTreeSet::new(), ..agent });
            return;
        }
        let what = self.random.borrow_mut().below(3);
        match what {
            0 => {
                if let Some(message) = agent.inbox.pop_front() {
                    agent.hear(&message, &self.shared);
                }
            }
            1 => agent.work(
                &mut self.random.borrow_mut(),
                &mut self.deaths,
                self.trouble,
                &self.shared,
            ),
            _ => {
                if let Some(message) = agent.outbox.pop_front() {
                    self.news.push_back(News::Message { member: agent.member, message });
                }
            }
        }
        self.agents.borrow_mut()[place] = Some(agent);
    }

    fn take_away(&mut self, member: WorkerId) {
        for slot in self.agents.borrow_mut().iter_mut() {
            slot.take_if(|agent| agent.member == member);
        }
        self.news.retain(|news| match news {
            News::Joined { member: of, .. }
            | News::Message { member: of, .. }
            | News::Lost { member: of, .. } => *of != member,
        });
    }

    fn number_of(&self, member: WorkerId) -> Option<usize> {
        let is_it =
            |agent: &Option<Agent>| agent.as_ref().is_some_and(|agent| agent.member == member);
        self.agents.borrow().iter().position(is_it)
    }
}

impl Agent {
    fn say(&mut self, message: &FromAgent<'_>) {
        self.outbox.push_back(wire::encode(message));
    }

    fn hear(&mut self, message: &[u8], shared: &Shared) {
        match wire::decode::<ToAgent>(message).expect("the coordinator speaks well") {
            ToAgent::Greeting { who, .. } => {
                assert_eq!(who, Identity::own());
                let cores = self.cores;
                self.say(&FromAgent::Hello { who, cores, host: "simulated".to_owned() });
            }
            ToAgent::Problem(_) => self.say(&FromAgent::Ready { canaries: shared.canaries }),
            ToAgent::Refused(why) => panic!("refused: {why}"),
            ToAgent::Work { entries, jobs, alone } => {
                assert!(alone.iter().all(|job| jobs.contains(job)));
                entries.into_iter().for_each(|entry| self.take_in(entry, shared));
                for job in jobs {
                    assert!(self.front.has(&shared.setup, job), "{job} without what it reads");
                    assert!(self.jobs.insert(job), "{job} twice");
                }
            }
        }
    }

    fn take_in(&mut self, entry: Entry, shared: &Shared) {
        let setup = &shared.setup;
        match entry {
            Entry::Increment(text) => {
                let number = self.front.next();
                let own =
                    |job: &Job| matches!(job, Job::Generate { number: of, .. } if *of == number);
                let Outcome::Increment(Ok(made)) = self.outcome(text, own) else {
                    panic!("no increment")
                };
                self.replica.publish(setup, Arc::new(made));
                self.front.publish();
            }
            Entry::Fold(texts) => {
                let first = self.front.next().0 - texts.len() as u64;
                let mut joins = Vec::new();
                for (number, text) in (first..).zip(texts) {
                    let own =
                        |job: &Job| matches!(job, Job::Join { number: of, .. } if of.0 == number);
                    let Outcome::Joined(joined) = self.outcome(text, own) else {
                        panic!("no join")
                    };
                    joins.push(joined.edges);
                }
                self.replica.fold(setup, joins.iter().map(|edges| &edges[..]));
                self.front.fold();
            }
        }
        self.entries += 1;
        let digest = self.replica.roadmap().digest();
        let mut states = shared.states.borrow_mut();
        assert_eq!(*states.entry(self.entries).or_insert(digest), digest, "another roadmap");
    }

    fn outcome(&self, text: Text, own: impl Fn(&Job) -> bool) -> Outcome {
        let bytes = match text {
            Text::Here(bytes) => bytes.to_vec(),
            Text::Own(digest) => {
                let (_, bytes) =
                    self.own.iter().find(|(job, _)| own(job)).expect("it was made here");
                assert_eq!(Digest::of(bytes), digest);
                bytes.clone()
            }
        };
        wire::decode(&bytes).expect("it is an outcome")
    }

    /// Does some of its jobs, or loses a worker with some of them.
    fn work(
        &mut self,
        random: &mut Random,
        deaths: &mut BTreeMap<Job, u32>,
        trouble: usize,
        shared: &Shared,
    ) {
        let mut taken = Vec::new();
        for _ in 0..1 + random.below(self.cores as usize) {
            let job = self.jobs.iter().nth(random.below(self.jobs.len().max(1))).copied();
            taken.extend(job.filter(|job| self.jobs.remove(job)));
        }
        if taken.is_empty() {
            return;
        }
        if random.chance(trouble) {
            let may_die = |job: &Job| deaths.get(job).is_none_or(|deaths| deaths + 1 < LOSSES_MAX);
            if taken.iter().all(may_die) {
                taken.iter().for_each(|job| *deaths.entry(*job).or_default() += 1);
                return self.say(&FromAgent::Died { jobs: taken, why: "simulated".to_owned() });
            }
        }
        let mut made = Vec::new();
        for job in taken {
            let key = match job {
                Job::Generate { strategy, .. } if !shared.setup.grows(strategy) => (job, 0),
                // What was published after it was handed out is nothing to a job.
                Job::Join { .. } | Job::Generate { .. } | Job::Evaluate { .. } => {
                    (job, self.front_entries())
                }
            };
            let known = shared.memo.borrow().get(&key).cloned();
            let finished = known.unwrap_or_else(|| {
                let task = self.replica.task(&shared.setup, job).expect("it has what it reads");
                let finished = Finished::new(task.run(&shared.setup, &mut Scratch::new()));
                shared.memo.borrow_mut().insert(key, finished.clone());
                finished
            });
            made.push((job, wire::encode(&finished.outcome)));
        }
        let done = made.iter().map(|(job, outcome)| Done { job: *job, micros: 100, outcome });
        let done = FromAgent::Done(done.collect());
        self.outbox.push_back(wire::encode(&done));
        self.own.extend(made);
    }

    /// Nodes of the roadmap that jobs of now read.
    fn front_entries(&self) -> usize {
        self.replica.roadmap().tally().nodes()
    }
}

impl Fleet for Simulated {
    fn places(&self) -> Vec<&Place> {
        self.places.iter().collect()
    }

    fn condition(&self, _place: usize) -> Condition {
        Condition::default()
    }

    fn place_of(&self, member: WorkerId) -> Option<&str> {
        Some(self.places[self.number_of(member)?].name())
    }

    fn last_loss(&self) -> Option<String> {
        None
    }

    fn send(&self, member: WorkerId, message: Arc<Vec<u8>>) {
        let Some(place) = self.number_of(member) else { return };
        if let Some(agent) = &mut self.agents.borrow_mut()[place] {
            agent.inbox.push_back(message);
        }
    }

    fn queued(&self, _member: WorkerId) -> u64 {
        // Full now and then.
        if self.random.borrow_mut().chance(20) { u64::MAX } else { 0 }
    }

    fn round_trip(&self, _member: WorkerId) -> Option<Duration> {
        Some(Duration::from_millis(self.random.borrow_mut().below(50) as u64))
    }

    fn dismiss(&mut self, member: WorkerId, _why: &str) {
        self.take_away(member);
    }

    fn refuse(&mut self, _member: WorkerId, why: &str) {
        panic!("refused: {why}");
    }

    fn tend(&mut self) {}

    fn wait(&mut self, _wait: Duration, _also: Option<BorrowedFd<'_>>) {
        let steps = 1 + self.random.borrow_mut().below(12);
        (0..steps).for_each(|_| self.step());
    }

    fn next(&mut self) -> Option<News> {
        self.news.pop_front()
    }

    fn tell(&self, _text: fmt::Arguments<'_>) {}

    fn close(self) {}
}

/// Ends a build that does not come to its end.
struct Bounded(u64);

impl Observer for Bounded {
    type Error = std::convert::Infallible;

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Self::Error> {
        self.0 += 1;
        assert!(self.0 < 1_000_000, "it does not come to an end");
        Ok(None)
    }
}

#[test]
fn simulated_agents_give_the_same_roadmap() {
    let problem = Problem::parse("problem.toml".as_ref(), PROBLEM).expect("it is a problem");
    let setup = Arc::new(Setup::new(problem));
    let digest = build(&setup).roadmap.digest();
    let shared = Shared {
        canaries: canaries(&setup),
        setup: setup.clone(),
        memo: Memo::default(),
        states: Rc::default(),
    };
    let number = |name| std::env::var(name).ok().map(|text| text.parse().expect("a number"));
    let count: u64 = number("ROADMILL_AGENT_SIMULATIONS").unwrap_or(1000);
    let seeds = number("ROADMILL_AGENT_SEED").map_or(0..count, |seed| seed..seed + 1);
    let folder = tempfile::tempdir().expect("a folder can be made");
    for seed in seeds {
        let fleet = Simulated::new(&shared, seed);
        // One agent alone has nobody to be compared with.
        let audit = match fleet.places.len() {
            1 => 0.0,
            _ => [0.0, 0.3, 1.0][Random(!seed).below(3)],
        };
        let options = AgentOptions {
            workers: None,
            wait: Duration::from_secs(3600),
            audit,
            audit_key: [seed as u8; 32],
        };
        let agents =
            Agents::new(setup.clone(), options, fleet, folder.path()).expect("a file can be made");
        let outline = Outline::new(setup.context().space());
        let mut dispatcher = Dispatcher::of(agents, outline);
        let mut core = Core::new(&setup, 4);
        let stop = drive(&mut core, &mut dispatcher, &mut Bounded(0)).expect("it cannot fail");
        assert_eq!(stop, Stop::SetLimit, "seed {seed}");
        use roadmill::img::Executor;
        assert_eq!(dispatcher.tally().digest(), digest, "seed {seed}");
    }
}
