use super::audit::{Audit, Compared};
use super::fan_out::FanOut;
use super::roster::Roster;
use super::staff::{Board, Machine, Machines, Made, Report, Staff};
use crate::agent::{Fleet, FromAgent, Identity, News, Place, REFUSED, ToAgent};
use crate::crew::CrewError;
use crate::output::Plain;
use roadmill::img::{Front, Job, Loss, Round, Setup, canaries};
use roadmill::internal::wire;
use roadmill::roadmap::{Digest, Increment};
use roadmill_workers::WorkerId;
use roadmill_workers::message::Done;
use std::collections::{BTreeMap, VecDeque};
use std::os::fd::BorrowedFd;
use std::path::Path;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

/// The most processes of an agent.
const CORES_MAX: u32 = 4096;
/// An agent is sent more only while less than this waits to be written to it, so that the memory of this process does
/// not grow with the number of agents that are behind.
const QUEUED_MAX: u64 = 1 << 20;
/// Sets per core that may be generated ahead of the current round where messages take no time.
const LOOKAHEAD_PER_CORE: f64 = 8.0;
/// A round trip that is longer than this does not make an agent get more work.
const ROUND_TRIP_MAX: Duration = Duration::from_millis(250);
/// An agent that has opened its link says within this time who it is.
const GREETING_MAX: Duration = Duration::from_secs(60);
/// The work that a core is given at once, in seconds: see [`Roster`].
const HELD_SECONDS: f64 = 0.02;

/// Between two times that it is written down what each machine does.
const BOARD_PAUSE: Duration = Duration::from_millis(200);

/// How agents are used.
#[derive(Debug, Clone, PartialEq)]
pub struct AgentOptions {
    /// Worker processes of each; `None` for one per core that it may use.
    pub workers: Option<usize>,
    /// How long a build goes on with no agent at work.
    pub wait: Duration,
    /// The share of jobs that two agents do, to be compared.
    pub audit: f64,
    /// Decides which jobs these are: bytes that nobody else knows.
    pub audit_key: [u8; 32],
}

/// How far the conversation with an agent has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Greeted,
    SettingUp,
    Ready,
}

struct Agent {
    place: usize,
    phase: Phase,
    /// The entries before this one have been sent to it.
    told: usize,
    cores: usize,
    /// Since when it is in its phase.
    since: Instant,
}

/// What is known of a place, whichever agents it has had.
#[derive(Debug, Clone, Default)]
struct Account {
    host: String,
    cores: usize,
    done: u64,
    busy: f64,
    /// Core-seconds of agents that were ready and are gone.
    ready: f64,
    worker_deaths: u64,
}

/// Agents of several machines as staff. Each is given jobs for all its cores; it says when they are done, when one of its
/// workers has died, and when it leaves.
///
/// An agent that is lost counts against nobody: its jobs are given to others, and it is started again after a while. One that
/// is another program, computes other numbers or says what cannot be is refused for good. When there is none for longer than
/// [`AgentOptions::wait`], that is the end ([`Report::Failed`]).
pub struct Agents<F> {
    setup: Arc<Setup>,
    front: Front,
    entries: FanOut,
    fleet: F,
    options: AgentOptions,
    members: BTreeMap<WorkerId, Agent>,
    accounts: Vec<Account>,
    roster: Roster,
    audit: Audit,
    /// The message that brings the problem.
    problem: Arc<Vec<u8>>,
    /// The digest of every agent's canaries, once there is an agent to be compared.
    canaries: Option<Digest>,
    reports: VecDeque<Report>,
    /// Since when there are fewer agents than are needed.
    nobody_since: Option<Instant>,
    failed: bool,
    board: Board,
    /// When the board was written last.
    written: Option<Instant>,
}

impl<F: Fleet> Agents<F> {
    /// Staff of the agents of a fleet. What they have to be told lies in a file in `folder`.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn new(
        setup: Arc<Setup>,
        options: AgentOptions,
        fleet: F,
        folder: &Path,
    ) -> Result<Agents<F>, CrewError> {
        let problem = ToAgent::Problem(Box::new(setup.problem().clone()));
        let accounts = vec![Account::default(); fleet.places().len()];
        let spool = FanOut::in_folder(folder)
            .map_err(CrewError::system(format!("{}: cannot make a file", folder.display())))?;
        Ok(Agents {
            front: Front::default(),
            entries: spool,
            fleet,
            audit: Audit::new(options.audit, options.audit_key),
            options,
            members: BTreeMap::new(),
            accounts,
            roster: Roster::default(),
            problem: Arc::new(wire::encode(&problem)),
            canaries: None,
            setup,
            reports: VecDeque::new(),
            nobody_since: Some(Instant::now()),
            failed: false,
            board: Board::default(),
            written: None,
        })
    }

    fn fail(&mut self, why: String) {
        if !std::mem::replace(&mut self.failed, true) {
            self.reports.push_back(Report::Failed(why));
        }
    }

    fn place_of(&self, member: WorkerId) -> &str {
        let agent = self.members.get(&member);
        let place = agent.and_then(|agent| self.fleet.places().get(agent.place).copied());
        place.map_or("", Place::name)
    }

    /// The machine of a member: the first place of its name.
    fn machine_of(&self, member: WorkerId) -> usize {
        let name = self.place_of(member);
        let places = self.fleet.places();
        places.iter().position(|place| place.name() == name).unwrap_or(usize::MAX)
    }

    /// How long a sign of life takes to a member and back, in seconds, as far as it decides how much work is given out
    /// ahead: one that was stopped for a while, or a machine that was logged in to slowly, is not given work for minutes.
    fn round_trip(&self, member: WorkerId) -> f64 {
        let round_trip = self.fleet.round_trip(member).unwrap_or_default();
        round_trip.min(ROUND_TRIP_MAX).as_secs_f64()
    }

    fn say(&self, member: WorkerId, what: &str) {
        self.fleet.tell(format_args!("agent {}: {}", Plain(self.place_of(member)), Plain(what)));
    }

    /// Takes leave of an agent; its jobs are lost. `is_refused`: for good.
    fn leave(&mut self, member: WorkerId, why: &str, is_refused: bool) {
        if !self.members.contains_key(&member) {
            return;
        }
        self.say(member, why);
        let Some(agent) = self.members.remove(&member) else { return };
        if agent.phase == Phase::Ready {
            let account = &mut self.accounts[agent.place];
            account.ready += agent.since.elapsed().as_secs_f64() * agent.cores as f64;
        }
        let lost = self.roster.dismiss(member, Loss::Departure);
        for job in lost {
            // One that was only done again is done again by another, or by nobody.
            if !self.audit.lose(job, member) {
                self.reports.push_back(Report::Lost(job, Loss::Departure));
            }
        }
        if is_refused {
            self.fleet.refuse(member, why);
        } else {
            self.fleet.dismiss(member, why);
        }
    }

    /// Refuses an agent that is another program, or says what cannot be.
    fn refuse(&mut self, member: WorkerId, why: &str) {
        let refused = ToAgent::Refused(format!("this agent {why}"));
        self.fleet.send(member, Arc::new(wire::encode(&refused)));
        self.leave(member, &format!("refused: it {why}"), true);
    }

    /// Sends entries and jobs to agents that can take them.
    fn feed(&mut self) {
        let ready = self.members.iter().filter(|(_, agent)| agent.phase == Phase::Ready);
        let ready: Vec<WorkerId> = ready.map(|(member, _)| *member).collect();
        for member in ready {
            self.roster.set_round_trip(member, self.round_trip(member));
            if self.fleet.queued(member) >= QUEUED_MAX {
                continue;
            }
            let machine = self.machine_of(member);
            let Some(agent) = self.members.get_mut(&member) else { continue };
            let (entries, told) = match self.entries.part(agent.told, member) {
                Ok(part) => part,
                Err(error) => {
                    return self.fail(format!("cannot read what agents are to know: {error}"));
                }
            };
            agent.told = told;
            let mut jobs = Vec::new();
            if told == self.entries.end() {
                jobs = self.roster.give(member, |job| self.front.has(&self.setup, job));
                let most = (2 * agent.cores).saturating_sub(self.roster.held(member));
                for job in self.audit.take_for(member, machine, most) {
                    self.roster.assign(member, job);
                    jobs.push(job);
                }
            }
            if entries.is_empty() && jobs.is_empty() {
                continue;
            }
            let alone = jobs.iter().copied().filter(|job| self.roster.is_suspect(job)).collect();
            let work = ToAgent::Work { entries, jobs, alone };
            self.fleet.send(member, Arc::new(wire::encode(&work)));
        }
    }

    /// Gives up agents that do not say who they are.
    fn give_up_silent(&mut self) {
        let is_silent =
            |agent: &Agent| agent.phase == Phase::Greeted && agent.since.elapsed() > GREETING_MAX;
        let silent = self.members.iter().filter(|(_, agent)| is_silent(agent));
        for member in silent.map(|(member, _)| *member).collect::<Vec<_>>() {
            self.leave(member, "lost: it did not say who it is", false);
        }
    }

    /// Takes in all news of the fleet.
    fn hear(&mut self) {
        while let Some(news) = self.fleet.next() {
            match news {
                News::Joined { member, place } => {
                    let workers = self.options.workers.map_or(0, |workers| workers as u32);
                    let greeting = ToAgent::Greeting { who: Identity::own(), workers };
                    self.fleet.send(member, Arc::new(wire::encode(&greeting)));
                    let (phase, since) = (Phase::Greeted, Instant::now());
                    self.members.insert(member, Agent { place, phase, told: 0, cores: 0, since });
                }
                News::Message { member, message } => self.take(member, message),
                News::Lost { member, why } => {
                    if !self.members.contains_key(&member) {
                        // It never came to a conversation.
                        let place = self.fleet.place_of(member).map(str::to_owned);
                        self.fleet.tell(format_args!(
                            "agent {}: {}",
                            Plain(&place.unwrap_or_default()),
                            Plain(&why)
                        ));
                        self.fleet.dismiss(member, &why);
                    } else {
                        self.leave(member, &format!("lost: {why}"), false);
                    }
                }
            }
        }
    }

    fn take(&mut self, member: WorkerId, message: Vec<u8>) {
        let Some(agent) = self.members.get_mut(&member) else { return };
        let message = Arc::new(message);
        let decoded = match wire::decode_borrowed(&message) {
            Ok(decoded) => decoded,
            Err(error) => return self.refuse(member, &format!("sent {error}")),
        };
        match (agent.phase, decoded) {
            (_, FromAgent::Leaving(why)) => self.leave(member, &format!("leaves: {why}"), false),
            (Phase::Greeted, FromAgent::Hello { who, cores, host }) => {
                if let Some(why) = Identity::own().differs_from(&who) {
                    return self.refuse(member, &format!("is another program: {why}"));
                }
                if !(1..=CORES_MAX).contains(&cores) {
                    return self.refuse(
                        member,
                        &format!("has {cores} workers, 1 to {CORES_MAX} expected"),
                    );
                }
                agent.cores = cores as usize;
                agent.phase = Phase::SettingUp;
                let account = &mut self.accounts[agent.place];
                account.host = host.chars().take(64).collect();
                account.cores = cores as usize;
                self.fleet.send(member, self.problem.clone());
                // Made while the agent makes its own.
                let setup = &self.setup;
                self.canaries.get_or_insert_with(|| canaries(setup));
            }
            (Phase::SettingUp, FromAgent::Ready { canaries: theirs }) => {
                if self.canaries != Some(theirs) {
                    return self.refuse(
                        member,
                        "has another arithmetic: the digest of its canaries differs",
                    );
                }
                agent.phase = Phase::Ready;
                agent.since = Instant::now();
                self.roster.enlist(member, agent.cores);
            }
            (Phase::Ready, FromAgent::Done(done)) => self.take_outcomes(member, &message, &done),
            (Phase::Ready, FromAgent::Died { jobs, why }) => {
                self.accounts[agent.place].worker_deaths += 1;
                self.say(member, &format!("a worker died: {why}"));
                for job in self.roster.lose(member, &jobs) {
                    if !self.audit.lose(job, member) {
                        self.reports.push_back(Report::Lost(job, Loss::Death));
                    }
                }
            }
            _ => self.refuse(member, "sent a message out of turn"),
        }
    }

    /// Takes in what an agent has done.
    fn take_outcomes(&mut self, member: WorkerId, message: &Arc<Vec<u8>>, done: &[Done<'_>]) {
        let machine = self.machine_of(member);
        for Done { job, micros, outcome } in done {
            let seconds = *micros as f64 * 1e-6;
            if !self.roster.done(member, *job, seconds) {
                return self.refuse(member, "sent the outcome of a job that it did not have");
            }
            if let Some(agent) = self.members.get(&member) {
                let account = &mut self.accounts[agent.place];
                account.done += 1;
                account.busy += seconds;
            }
            let begin = outcome.as_ptr().addr() - message.as_ptr().addr();
            let made = Made::new(*job, member, *micros, message, begin..begin + outcome.len());
            match self.audit.take(made, machine) {
                Compared::Kept => {}
                Compared::Same(made) => self.finish(made),
                Compared::Differs(made, first) => {
                    let [first, second] =
                        [first, made.member].map(|member| self.place_of(member).to_owned());
                    let by = format!("agents {first} and {second} made different outcomes of it");
                    self.reports.push_back(Report::Contradiction(made.job, by));
                }
            }
        }
    }

    /// Takes an outcome in for good.
    fn finish(&mut self, made: Made) {
        let is_for_workers = match made.job {
            Job::Generate { .. } => self.front.is_ahead(made.job),
            Job::Join { .. } => true,
            Job::Evaluate { .. } => false,
        };
        if is_for_workers && let Err(error) = self.entries.keep(&made) {
            return self.fail(format!("cannot write what agents are to know: {error}"));
        }
        self.reports.push_back(Report::Done(made));
    }

    /// Notices when there is nobody, or nobody to do a job a second time, and when that has been so for too long.
    fn look_for_anybody(&mut self) {
        let ready = self.members.values().filter(|agent| agent.phase == Phase::Ready).count();
        let wanted = if self.audit.is_waiting() { 2 } else { 1 };
        if ready >= wanted {
            self.nobody_since = None;
            return;
        }
        let places = self.fleet.places().len();
        let is_refused = |place: &usize| self.fleet.condition(*place).state == REFUSED;
        if places - (0..places).filter(is_refused).count() < wanted {
            let who = if wanted == 2 { "no two agents" } else { "no agent" };
            let last = self.fleet.last_loss().map_or_else(String::new, |why| format!("; {why}"));
            return self.fail(format!("{who} can be used{last}"));
        }
        let since = *self.nobody_since.get_or_insert_with(Instant::now);
        if since.elapsed() >= self.options.wait {
            let who = if wanted == 2 { "no second agent, to compare," } else { "no agent" };
            let last = self.fleet.last_loss().map_or_else(String::new, |why| format!("; {why}"));
            self.fail(format!("{who} was at work for {} s{last}", self.options.wait.as_secs()));
        }
    }
}

impl<F: Fleet> Staff for Agents<F> {
    fn publish(&mut self, increment: &Increment) {
        if let Err(error) = self.entries.publish(self.front.next(), increment) {
            self.fail(format!("cannot write what agents are to know: {error}"));
        }
        self.front.publish();
    }

    fn fold(&mut self, round: &Round) {
        if let Err(error) = self.entries.fold(round) {
            self.fail(format!("cannot write what agents are to know: {error}"));
        }
        self.front.fold();
    }

    fn submit(&mut self, job: Job) {
        self.roster.submit(job);
    }

    fn next(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>) -> Option<Report> {
        if let Some(report) = self.reports.pop_front() {
            return Some(report);
        }
        self.write_board();
        self.fleet.tend();
        self.give_up_silent();
        self.look_for_anybody();
        self.feed();
        if self.reports.is_empty() {
            self.fleet.wait(wait, also);
            self.hear();
        }
        self.reports.pop_front()
    }

    fn reject(&mut self, made: &Made, why: &str) {
        self.entries.forget(made.job);
        self.refuse(made.member, why);
        self.reports.push_back(Report::Lost(made.job, Loss::Departure));
    }

    fn ready(&self) -> usize {
        self.roster.cores()
    }

    fn lookahead(&self) -> Option<u64> {
        let ready = self.members.iter().filter(|(_, agent)| agent.phase == Phase::Ready);
        let each = ready.map(|(member, agent)| {
            let round_trip = self.round_trip(*member);
            agent.cores as f64 * LOOKAHEAD_PER_CORE * (1.0 + round_trip / HELD_SECONDS)
        });
        Some(each.sum::<f64>().ceil() as u64)
    }

    fn board(&self) -> Option<Board> {
        Some(self.board.clone())
    }

    fn close(mut self) -> Result<(), CrewError> {
        self.written = None;
        self.write_board();
        self.fleet.close();
        Ok(())
    }
}

impl<F: Fleet> Agents<F> {
    /// Writes down what each machine does, now and then.
    fn write_board(&mut self) {
        if self.written.is_some_and(|written| written.elapsed() < BOARD_PAUSE) {
            return;
        }
        self.written = Some(Instant::now());
        let machines = Machines { machines: self.machines(), audited: self.audit.counts() };
        *self.board.lock().unwrap_or_else(PoisonError::into_inner) = machines;
    }

    fn machines(&self) -> Vec<Machine> {
        let machine = |(number, (place, account)): (usize, (&Place, &Account))| {
            let condition = self.fleet.condition(number);
            let member = self.members.iter().find(|(_, agent)| agent.place == number);
            let is_ready = |agent: &Agent| agent.phase == Phase::Ready;
            let ready = member.filter(|(_, agent)| is_ready(agent));
            let now = ready
                .map_or(0.0, |(_, agent)| agent.since.elapsed().as_secs_f64() * agent.cores as f64);
            Machine {
                name: place.name().to_owned(),
                host: account.host.clone(),
                state: if ready.is_some() { "ready" } else { condition.state }.to_owned(),
                reason: condition.reason,
                cores: account.cores,
                held: member.map_or(0, |(member, _)| self.roster.held(*member)),
                done: account.done,
                busy_seconds: account.busy,
                waiting_seconds: (account.ready + now - account.busy).max(0.0),
                bytes_received: condition.traffic.came,
                bytes_sent: condition.traffic.sent,
                restarts: condition.restarts,
                worker_deaths: account.worker_deaths,
                round_trip_seconds: condition.round_trip.map(|round_trip| round_trip.as_secs_f64()),
            }
        };
        self.fleet.places().into_iter().zip(&self.accounts).enumerate().map(machine).collect()
    }
}
