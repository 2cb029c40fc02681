use super::log::{Log, bytes_of};
use super::roster::Roster;
use crate::cpu::Meter;
use crate::crew::{Crew, CrewError, News};
use crate::signals::Signals;
use roadmill::img::{Cut, Event, Executor, Finished, Front, Job, Loss, Round, Setup};
use roadmill::internal::wire;
use roadmill::roadmap::{Digest, Increment, Outline, Tally};
use roadmill_workers::message::{Done, FromWorker, PROTOCOL, ToWorker};
use roadmill_workers::{WorkerId, canary};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::os::fd::BorrowedFd;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

/// So many workers may be lost one after the other before their first message. Others are then started only now and
/// then: where memory or processes have run short, those that are there go on alone.
const STILLBORN_MAX: usize = 3;
/// Between two times that a worker is started where others did not come to their first message.
const HIRE_PAUSE: Duration = Duration::from_secs(5);

/// How far the conversation with a worker has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum WorkerPhase {
    /// It was started; nothing has come from it.
    Starting,
    /// It has the problem and makes it ready for work.
    SettingUp,
    /// It takes jobs.
    Ready,
}

struct Worker {
    phase: WorkerPhase,
    /// The entries of the log before this place have been sent to it.
    place: usize,
}

/// The workers of a crew as an executor. Jobs are pulled: a worker that tells what it has done is given the
/// most urgent jobs that wait. When a worker is lost the build is told which jobs are lost with it, which it
/// submits again, and another worker is started.
///
/// Crews whose members are all lost one after the other, none of them having finished a job, end the build:
/// [`Cut::WorkersLost`] says why. So does a worker that runs another program or computes other numbers.
pub struct Dispatcher<C> {
    setup: Arc<Setup>,
    /// Of the roadmap only what this process needs: the workers have it.
    outline: Outline,
    front: Front,
    log: Log,
    crew: C,
    workers: BTreeMap<WorkerId, Worker>,
    /// The digest of every worker's canary increment.
    canary: Digest,
    /// The message that brings the problem.
    problem: Arc<Vec<u8>>,
    /// Workers lost since a job was last finished.
    fruitless_losses: usize,
    /// Whether any worker ever sent its first message.
    was_greeted: bool,
    /// Workers lost before their first message since one was last sent.
    stillborn: usize,
    /// When a missing worker may be started.
    next_hire: Instant,
    roster: Roster,
    /// Workers whose last message has not been answered.
    asking: BTreeSet<WorkerId>,
    events: VecDeque<Event>,
    /// Ends waiting when a signal comes.
    signals: Option<Arc<Signals>>,
    failed: bool,
    messages: Meter,
    folds: Meter,
}

impl<C: Crew> Dispatcher<C> {
    /// Starts as many workers as the crew is to have. To be called, as all methods, from one thread
    /// that lives as long as the build.
    ///
    /// # Errors
    /// When a worker cannot be started.
    pub fn start(setup: Arc<Setup>, crew: C) -> Result<Dispatcher<C>, CrewError> {
        let problem = ToWorker::Problem(Box::new(setup.problem.clone()));
        let mut dispatcher = Dispatcher {
            outline: Outline::new(&setup.cx.space),
            front: Front::default(),
            log: Log::default(),
            canary: canary(&setup),
            problem: Arc::new(wire::encode(&problem)),
            setup,
            crew,
            workers: BTreeMap::new(),
            fruitless_losses: 0,
            was_greeted: false,
            stillborn: 0,
            next_hire: Instant::now(),
            roster: Roster::default(),
            asking: BTreeSet::new(),
            events: VecDeque::new(),
            signals: None,
            failed: false,
            messages: Meter::default(),
            folds: Meter::default(),
        };
        for _ in 0..dispatcher.crew.size() {
            let program = dispatcher.crew.program();
            dispatcher
                .hire()
                .map_err(CrewError::system(format!("cannot start a worker ({program})")))?;
        }
        Ok(dispatcher)
    }

    /// The same dispatcher, which stops waiting when a signal comes.
    pub fn with_signals(self, signals: Arc<Signals>) -> Dispatcher<C> {
        Dispatcher { signals: Some(signals), ..self }
    }

    /// Ends the workers and removes every trace of the crew.
    ///
    /// # Errors
    /// When something cannot be removed.
    pub fn close(self) -> Result<(), CrewError> {
        self.crew.close()
    }

    /// How many bytes of shared memory hold what all workers read, now and whenever it is looked at.
    pub fn stored_bytes(&self) -> Arc<AtomicU64> {
        self.crew.stored_bytes()
    }

    /// CPU seconds that messages took: waiting for them, reading, checking, decoding and sending them.
    pub fn message_seconds(&self) -> f64 {
        self.messages.seconds()
    }

    /// CPU seconds that folding took, the roadmap's digest included.
    pub fn fold_seconds(&self) -> f64 {
        self.folds.seconds()
    }

    fn hire(&mut self) -> std::io::Result<()> {
        let id = self.crew.hire()?;
        self.workers.insert(id, Worker { phase: WorkerPhase::Starting, place: 0 });
        Ok(())
    }

    /// Takes leave of a worker that is lost or must be ended, and starts another in its place. `loss` says
    /// whether the jobs that the worker held may be to blame.
    fn replace(&mut self, id: WorkerId, loss: Loss, why: &str) {
        let Some(lost) = self.workers.remove(&id) else { return };
        self.stillborn += usize::from(lost.phase == WorkerPhase::Starting);
        let status = self.crew.dismiss(id);
        self.asking.remove(&id);
        let lost = self.roster.dismiss(id, loss);
        self.events.extend(lost.into_iter().map(|job| Event::Lost(job, loss)));
        self.fruitless_losses += 1;
        if self.fruitless_losses > (3 * self.crew.size()).max(5) {
            let status = status.map_or_else(String::new, |status| format!(" ({status})"));
            let doubt = if self.was_greeted {
                String::new()
            } else {
                format!(
                    "; no worker ever sent its first message: is {} roadmill?",
                    self.crew.program()
                )
            };
            self.fail(format!(
                "{} workers were lost one after the other without finishing a job; the last: \
                 {why}{status}{doubt}",
                self.fruitless_losses
            ));
        } else if (self.workers.is_empty() || self.stillborn <= STILLBORN_MAX)
            && let Err(error) = self.hire()
            && self.workers.is_empty()
        {
            self.fail(format!(
                "no worker is left and none can be started: {error}; the last: {why}"
            ));
        }
        self.next_hire = Instant::now() + HIRE_PAUSE;
    }

    /// Starts a worker if one is missing and it is time to try again.
    fn hire_missing(&mut self) {
        let is_missing = !self.workers.is_empty() && self.workers.len() < self.crew.size();
        if is_missing && !self.failed && Instant::now() >= self.next_hire {
            self.next_hire = Instant::now() + HIRE_PAUSE;
            // If not now, then perhaps later: others are at work.
            let _ = self.hire();
        }
    }

    fn fail(&mut self, why: String) {
        if !std::mem::replace(&mut self.failed, true) {
            self.events.push_back(Event::Cut(Cut::WorkersLost(why)));
        }
    }

    /// Answers workers that hold no jobs and, if `with_others`, those that hold some. A worker that still
    /// holds jobs can wait for the answer until the build has said what follows from the worker's last
    /// message; it must then be answered, since it may not say anything else before.
    fn feed(&mut self, with_others: bool) {
        if self.asking.is_empty() || !(with_others || self.roster.has_work()) {
            return;
        }
        let asking: Vec<WorkerId> = self.asking.iter().copied().collect();
        for id in asking {
            let is_free = self.roster.is_free(id);
            if is_free && !self.roster.has_work() || !is_free && !with_others {
                continue;
            }
            let Some(worker) = self.workers.get_mut(&id) else { continue };
            let (entries, place) = self.log.part(worker.place);
            worker.place = place;
            let jobs = if place == self.log.end() {
                self.roster.give(id, |job| self.front.has(&self.setup, job))
            } else {
                Vec::new()
            };
            if is_free && jobs.is_empty() && entries.is_empty() {
                // All jobs that waited have become superfluous.
                continue;
            }
            self.asking.remove(&id);
            self.send(id, wire::encode(&ToWorker::Work { entries, jobs }));
        }
    }

    fn send(&mut self, id: WorkerId, message: impl Into<Arc<Vec<u8>>>) {
        if let Err(error) = self.crew.send(id, message.into()) {
            self.fail(format!("a message cannot be sent: {error}"));
        }
    }

    /// Takes in all news of the crew.
    fn hear(&mut self) {
        loop {
            match self.crew.next() {
                Ok(Some(News::Message { member, message })) => self.take(member, &message),
                Ok(Some(News::Died { member, why })) => self.replace(member, Loss::Death, &why),
                Ok(Some(News::Lost { member, why })) => self.replace(member, Loss::Departure, &why),
                Ok(None) => return,
                Err(error) => return self.fail(format!("the crew failed: {error}")),
            }
        }
    }

    /// Takes in a message of a worker. One that makes no sense is the worker's fault, not that of its jobs.
    fn take(&mut self, id: WorkerId, message: &[u8]) {
        let Some(worker) = self.workers.get_mut(&id) else {
            return;
        };
        let decoded = match wire::decode_borrowed(message) {
            Ok(decoded) => decoded,
            Err(error) => {
                return self.replace(id, Loss::Departure, &format!("it sent {error}"));
            }
        };
        match (worker.phase, decoded) {
            (WorkerPhase::Starting, FromWorker::Hello { protocol, build }) => {
                self.was_greeted = true;
                self.stillborn = 0;
                if protocol != PROTOCOL {
                    let why = format!(
                        "speaks version {protocol} of the messages and this program version {PROTOCOL}"
                    );
                    return self.refuse(id, &why);
                }
                if build != self.crew.build() {
                    let why = format!("runs another program than {}", self.crew.program());
                    return self.refuse(id, &why);
                }
                worker.phase = WorkerPhase::SettingUp;
                self.send(id, self.problem.clone());
            }
            (WorkerPhase::SettingUp, FromWorker::Ready { canary }) => {
                if canary != self.canary {
                    return self.refuse(
                        id,
                        "has another arithmetic: the digest of its canary increment differs",
                    );
                }
                worker.phase = WorkerPhase::Ready;
                self.roster.enlist(id);
                self.asking.insert(id);
            }
            (WorkerPhase::Ready, FromWorker::Done(done)) => {
                self.asking.insert(id);
                if let Err(why) = self.take_outcomes(id, message, &done) {
                    self.replace(id, Loss::Departure, &why);
                }
            }
            _ => self.replace(id, Loss::Departure, "it sent a message out of turn"),
        }
    }

    /// Takes in what a worker has done; why the worker must be replaced, if it must.
    fn take_outcomes(
        &mut self,
        id: WorkerId,
        message: &[u8],
        done: &[Done<'_>],
    ) -> Result<(), String> {
        let is_for_workers = |done: &Done| match done.job {
            Job::Generate { .. } => self.front.is_ahead(done.job),
            Job::Join { .. } => true,
            Job::Evaluate { .. } => false,
        };
        // The whole message as it came: its outcomes need not be copied one by one.
        let stored = done.iter().any(is_for_workers).then(|| self.crew.store(message));
        for Done { job, micros, outcome } in done {
            let decoded = wire::decode(outcome).map_err(|error| format!("it sent {error}"))?;
            if !self.roster.done(id, *job, *micros as f64 * 1e-6) {
                return Err("it sent the outcome of a job that it did not have".to_owned());
            }
            self.fruitless_losses = 0;
            let digest = Digest::of(outcome);
            if let Some(stored) = stored {
                let within = outcome.as_ptr().addr() - message.as_ptr().addr();
                let stored = stored.map(|offset| offset + within as u64);
                self.log.keep(*job, bytes_of(outcome, stored, digest));
            }
            self.events.push_back(Event::Done(*job, Finished { outcome: decoded, digest }));
        }
        Ok(())
    }

    /// Tells a worker that it cannot take part, and ends the build: every other worker would be like it.
    fn refuse(&mut self, id: WorkerId, why: &str) {
        self.send(id, wire::encode(&ToWorker::Refused(format!("this worker {why}"))));
        self.fail(format!("a worker {why}"));
    }

    fn signal_came(&self) -> bool {
        self.signals.as_ref().is_some_and(|signals| signals.came())
    }

    fn wait(&mut self, wait: Duration) -> Option<Event> {
        let until = Instant::now() + wait;
        self.hire_missing();
        loop {
            self.feed(true);
            if let Some(event) = self.events.pop_front() {
                return Some(event);
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() || self.signal_came() {
                return None;
            }
            let signals: Option<BorrowedFd<'_>> =
                self.signals.as_ref().map(|signals| signals.as_fd());
            self.crew.wait(left, signals);
            self.hear();
            if !self.events.is_empty() {
                // Workers that hold nothing need not wait until the build has said what follows.
                self.feed(false);
                return self.events.pop_front();
            }
        }
    }
}

impl<C: Crew> Executor for Dispatcher<C> {
    fn publish(&mut self, increment: &Arc<Increment>) {
        self.log.publish(self.front.next(), increment, &mut self.crew);
        self.front.publish();
    }

    fn fold(&mut self, round: &Round) {
        let begun = Meter::begin();
        self.log.fold(round, &mut self.crew);
        self.front.fold();
        self.outline.fold_round(round.parts());
        self.folds.end(begun);
    }

    fn submit(&mut self, job: Job) {
        self.roster.submit(job);
    }

    fn next(&mut self, wait: Duration) -> Option<Event> {
        if let Some(event) = self.events.pop_front() {
            return Some(event);
        }
        let begun = Meter::begin();
        let event = self.wait(wait);
        self.messages.end(begun);
        event
    }

    fn alive(&self) -> usize {
        self.roster.workers()
    }

    fn tally(&self) -> &Tally {
        self.outline.tally()
    }
}
