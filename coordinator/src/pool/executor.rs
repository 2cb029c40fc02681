use super::log::{Log, bytes_of};
use super::process::{Executable, WorkerProcess};
use super::roster::Roster;
use crate::cpu::Meter;
use crate::signals::Signals;
use roadmill::img::{Cut, Event, Executor, Finished, Front, Job, Loss, Round, Setup};
use roadmill::roadmap::{Digest, Increment, Outline, Tally};
use roadmill::wire;
use roadmill_workers::channel::{ChannelError, Delivery, Hub, Received, WorkerId};
use roadmill_workers::message::{Done, FromWorker, PROTOCOL, ToWorker};
use roadmill_workers::{build_id, canary};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

/// Between two times that all hearts are listened to.
const LOOK_PAUSE: Duration = Duration::from_secs(1);

/// Why a pool cannot be started.
#[derive(Debug, thiserror::Error)]
pub enum PoolError {
    /// The channel to the workers failed.
    #[error(transparent)]
    Channel(#[from] ChannelError),
    /// The system refused something.
    #[error("{0}: {1}")]
    System(&'static str, #[source] std::io::Error),
}

/// What a worker is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Started; nothing has come from it.
    Starting,
    /// It sets the problem up.
    SettingUp,
    /// It takes jobs.
    Ready,
}

struct Worker {
    process: WorkerProcess,
    state: State,
    /// How much of the log it has.
    place: usize,
}

/// Worker processes as an executor. Jobs are pulled: a worker that tells what it has done is given the
/// most urgent there are. A worker that dies loses its jobs, which the build hands out again, and is
/// replaced.
pub struct Pool {
    setup: Arc<Setup>,
    /// Of the roadmap only what this process needs: the workers have it.
    outline: Outline,
    front: Front,
    log: Log,
    /// Dropped before the hub, whose files they use.
    workers: BTreeMap<WorkerId, Worker>,
    hub: Hub,
    executable: Executable,
    build: Digest,
    canary: Digest,
    problem: Arc<Vec<u8>>,
    wanted: usize,
    next_worker: u64,
    /// Deaths since a job was last finished.
    fruitless_deaths: usize,
    roster: Roster,
    /// Workers whose messages have not been answered.
    asking: BTreeSet<WorkerId>,
    events: VecDeque<Event>,
    signals: Arc<Signals>,
    failed: bool,
    /// When all hearts were listened to last.
    looked: Instant,
    messages: Meter,
    folds: Meter,
}

/// What woke the pool.
struct Woken {
    by_message: bool,
    by_hearts: Vec<WorkerId>,
}

impl Pool {
    /// Opens the channel and starts the workers. To be called, as all methods, from one thread
    /// that lives as long as the build.
    ///
    /// # Errors
    /// When the channel cannot be made or no process started.
    pub fn start(
        setup: Arc<Setup>,
        workers: usize,
        signals: Arc<Signals>,
    ) -> Result<Pool, PoolError> {
        let system = |what| move |error| PoolError::System(what, error);
        let executable = Executable::open().map_err(system("cannot open the executable"))?;
        let build = build_id().map_err(system("cannot read the executable"))?;
        let problem = ToWorker::Problem(Box::new(setup.problem.clone()));
        let mut pool = Pool {
            outline: Outline::new(&setup.cx.space),
            front: Front::default(),
            log: Log::default(),
            // A dead worker may hold its place until it is cleaned up after.
            hub: Hub::create(workers + 2)?,
            executable,
            build,
            canary: canary(&setup),
            problem: Arc::new(wire::encode(&problem)),
            setup,
            wanted: workers,
            workers: BTreeMap::new(),
            next_worker: 0,
            fruitless_deaths: 0,
            roster: Roster::default(),
            asking: BTreeSet::new(),
            events: VecDeque::new(),
            signals,
            failed: false,
            looked: Instant::now(),
            messages: Meter::default(),
            folds: Meter::default(),
        };
        for _ in 0..workers {
            pool.hire().map_err(system("cannot start a worker"))?;
        }
        Ok(pool)
    }

    /// Ends the workers and removes every trace of the channel.
    ///
    /// # Errors
    /// What could not be removed: the next run will try again.
    pub fn close(self) -> Result<(), PoolError> {
        drop(self.workers);
        self.hub.close().map_err(PoolError::from)
    }

    /// How many bytes of shared memory hold what all workers read.
    pub fn stored_bytes(&mut self) -> Arc<AtomicU64> {
        self.hub.store().bytes()
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
        let id = WorkerId(self.next_worker);
        self.next_worker += 1;
        let process = WorkerProcess::start(&self.executable, self.hub.directory(), id)?;
        self.workers.insert(id, Worker { process, state: State::Starting, place: 0 });
        Ok(())
    }

    /// Ends a worker that has died or must, and starts another in its place.
    fn replace(&mut self, id: WorkerId, why: &str) {
        let Some(mut worker) = self.workers.remove(&id) else {
            return;
        };
        let status = worker.process.end();
        self.hub.forget(id);
        self.asking.remove(&id);
        let lost = self.roster.dismiss(id).into_iter();
        self.events.extend(lost.map(|job| Event::Lost(job, Loss::Worker)));
        self.fruitless_deaths += 1;
        let status = status.map_or_else(String::new, |status| format!(" ({status})"));
        if self.fruitless_deaths > (3 * self.wanted).max(5) {
            self.fail(format!(
                "{} workers died one after the other without finishing a job; the last: {why}{status}",
                self.fruitless_deaths
            ));
        } else if let Err(error) = self.hire()
            && self.workers.is_empty()
        {
            self.fail(format!("no worker is left and none can be started: {error}"));
        }
    }

    fn fail(&mut self, why: String) {
        if !std::mem::replace(&mut self.failed, true) {
            self.events.push_back(Event::Cut(Cut::WorkersLost(why)));
        }
    }

    /// Answers workers with jobs: those that hold none, and those that do `with_others`. What these ask for
    /// may wait until it is known what follows from what they did, but not longer: they cannot say
    /// more before they are answered.
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
                // What waited had been overtaken.
                continue;
            }
            self.asking.remove(&id);
            self.send(id, wire::encode(&ToWorker::Work { entries, jobs }));
        }
    }

    fn send(&mut self, id: WorkerId, message: impl Into<Arc<Vec<u8>>>) {
        match self.hub.reply(id, message) {
            // One that is gone shows it by its heart.
            Ok(Delivery::Sent | Delivery::Gone) => {}
            Err(error) => self.fail(format!("a message cannot be sent: {error}")),
        }
    }

    fn hear(&mut self) {
        loop {
            match self.hub.receive() {
                Ok(Some(Received::Message { worker, message })) => self.take(worker, &message),
                Ok(Some(Received::Broken { worker, reason })) => {
                    self.replace(worker, &format!("broken message: {reason}"));
                }
                Ok(None) => return,
                Err(error) => return self.fail(format!("the channel failed: {error}")),
            }
        }
    }

    fn take(&mut self, id: WorkerId, message: &[u8]) {
        let Some(worker) = self.workers.get_mut(&id) else {
            return;
        };
        let decoded = match wire::decode_borrowed(message) {
            Ok(decoded) => decoded,
            Err(error) => return self.replace(id, &error.to_string()),
        };
        match (worker.state, decoded) {
            (State::Starting, FromWorker::Hello { protocol, build }) => {
                if (protocol, build) != (PROTOCOL, self.build) {
                    return self.refuse(id, "another version of the program");
                }
                worker.state = State::SettingUp;
                self.send(id, self.problem.clone());
            }
            (State::SettingUp, FromWorker::Ready { canary }) => {
                if canary != self.canary {
                    return self.refuse(id, "another arithmetic: its canary increment differs");
                }
                worker.state = State::Ready;
                self.roster.enlist(id);
                self.asking.insert(id);
            }
            (State::Ready, FromWorker::Done(done)) => {
                self.asking.insert(id);
                if let Err(why) = self.take_outcomes(id, message, &done) {
                    self.replace(id, &why);
                }
            }
            _ => self.replace(id, "a message out of turn"),
        }
    }

    /// Takes in what a worker has done; why it must be replaced, if it must.
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
        // All at once, as they came.
        let stored = done.iter().any(is_for_workers).then(|| self.hub.store().append(message));
        for Done { job, micros, outcome } in done {
            let decoded = wire::decode(outcome).map_err(|error| error.to_string())?;
            if !self.roster.done(id, *job, *micros as f64 * 1e-6) {
                return Err("what it was not asked for".to_owned());
            }
            self.fruitless_deaths = 0;
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

    fn refuse(&mut self, id: WorkerId, why: &str) {
        self.send(id, wire::encode(&ToWorker::Refused(why.to_owned())));
        self.fail(format!("a worker runs {why}"));
    }

    /// Sleeps until a worker says or becomes something, a signal comes or the time is over.
    fn sleep(&mut self, wait: Duration) -> Woken {
        let wait = Timespec { tv_sec: wait.as_secs() as i64, tv_nsec: wait.subsec_nanos().into() };
        let hub = self.hub.as_fd();
        let signals = self.signals.as_fd();
        let mut fds = Vec::with_capacity(2 + self.workers.len());
        fds.push(PollFd::from_borrowed_fd(hub, PollFlags::IN));
        fds.push(PollFd::from_borrowed_fd(signals, PollFlags::IN));
        for worker in self.workers.values() {
            fds.push(PollFd::from_borrowed_fd(worker.process.as_fd(), PollFlags::IN));
        }
        // An interrupted sleep is a short one.
        let _ = poll(&mut fds, Some(&wait));
        let hearts = self.workers.keys().zip(&fds[2..]);
        let by_hearts = hearts.filter(|(_, heart)| !heart.revents().is_empty());
        Woken {
            by_message: !fds[0].revents().is_empty(),
            by_hearts: by_hearts.map(|(id, _)| *id).collect(),
        }
    }

    /// Listens to the hearts that have beaten and, once in a while, to all: one may have fallen silent.
    fn look_after_workers(&mut self, mut beaten: Vec<WorkerId>) {
        if self.looked.elapsed() >= LOOK_PAUSE {
            self.looked = Instant::now();
            beaten = self.workers.keys().copied().collect();
        }
        for id in beaten {
            let Some(worker) = self.workers.get_mut(&id) else { continue };
            if !worker.process.look() {
                continue;
            }
            // What it still said counts.
            self.hear();
            self.replace(id, "it ended");
        }
    }
}

impl Executor for Pool {
    fn publish(&mut self, increment: &Arc<Increment>) {
        self.log.publish(self.front.next(), increment, self.hub.store());
        self.front.publish();
    }

    fn fold(&mut self, round: &Round) {
        let begun = Meter::begin();
        self.log.fold(round, self.hub.store());
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

impl Pool {
    fn wait(&mut self, wait: Duration) -> Option<Event> {
        let until = Instant::now() + wait;
        loop {
            self.feed(true);
            if let Some(event) = self.events.pop_front() {
                return Some(event);
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() || self.signals.came() {
                return None;
            }
            let woken = self.sleep(left);
            if woken.by_message {
                self.hear();
            }
            self.look_after_workers(woken.by_hearts);
            if !self.events.is_empty() {
                // Who holds nothing need not wait until it is known what follows from what was heard.
                self.feed(false);
                return self.events.pop_front();
            }
        }
    }
}
