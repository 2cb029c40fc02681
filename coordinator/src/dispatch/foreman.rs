use super::log::{EntryLog, bytes_of};
use super::roster::Roster;
use super::staff::{Made, Report, Staff};
use crate::agent::message::Entry;
use crate::crew::{Crew, CrewError, News};
use roadmill::img::{Front, Job, Loss, Round, Setup, canary};
use roadmill::internal::wire;
use roadmill::numbers::SetNumber;
use roadmill::roadmap::{Digest, Increment};
use roadmill_workers::WorkerId;
use roadmill_workers::message::{Done, FromWorker, PROTOCOL, ToWorker};
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

/// The workers of a crew as staff. Jobs are pulled: a worker that tells what it has done is given the
/// most urgent jobs that wait. When a worker is lost it is said which jobs are lost with it, and another worker is
/// started.
///
/// Crews whose members are all lost one after the other, none of them having finished a job, are no staff any more
/// ([`Report::Failed`] says why). So is one with a worker that runs another program or computes other numbers.
pub struct Foreman<C> {
    setup: Arc<Setup>,
    front: Front,
    log: EntryLog,
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
    reports: VecDeque<Report>,
    failed: bool,
}

impl<C: Crew> Foreman<C> {
    /// Starts as many workers as the crew is to have. To be called, as all methods, from one thread
    /// that lives as long as the build.
    ///
    /// # Errors
    /// When a worker cannot be started.
    pub fn start(setup: Arc<Setup>, crew: C) -> Result<Foreman<C>, CrewError> {
        let problem = ToWorker::Problem(Box::new(setup.problem().clone()));
        let mut foreman = Foreman {
            front: Front::default(),
            log: EntryLog::default(),
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
            reports: VecDeque::new(),
            failed: false,
        };
        for _ in 0..foreman.crew.size() {
            let program = foreman.crew.program();
            foreman
                .hire()
                .map_err(CrewError::system(format!("cannot start a worker ({program})")))?;
        }
        Ok(foreman)
    }

    /// Takes in what changes the workers' replicas, as it came from elsewhere. False where it says that the bytes were
    /// made here, and they were not.
    pub fn take_in(&mut self, entry: Entry) -> bool {
        match entry {
            Entry::Increment(text) => {
                let taken = self.log.publish_text(self.front.next(), text, &mut self.crew);
                self.front.publish();
                taken
            }
            Entry::Fold(texts) => {
                let end = self.front.next();
                let first = SetNumber(end.0.saturating_sub(texts.len() as u64));
                let taken = self.log.fold_texts(first, texts, &mut self.crew);
                self.front.fold();
                taken
            }
        }
    }

    /// Takes on a job that is to be done by a worker that holds no other: a worker died at it.
    pub fn submit_alone(&mut self, job: Job) {
        self.roster.suspect(job);
        self.roster.submit(job);
    }

    /// The next thing that has happened and was not told, without looking for more.
    pub fn pending(&mut self) -> Option<Report> {
        self.reports.pop_front()
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
        self.reports.extend(lost.into_iter().map(|job| Report::Lost(job, loss)));
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
            self.reports.push_back(Report::Failed(why));
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
                Ok(Some(News::Message { member, message })) => self.take(member, message),
                Ok(Some(News::Died { member, why })) => self.replace(member, Loss::Death, &why),
                Ok(Some(News::Lost { member, why })) => self.replace(member, Loss::Departure, &why),
                Ok(None) => return,
                Err(error) => return self.fail(format!("the crew failed: {error}")),
            }
        }
    }

    /// Takes in a message of a worker. One that makes no sense is the worker's fault, not that of its jobs.
    fn take(&mut self, id: WorkerId, message: Vec<u8>) {
        let Some(worker) = self.workers.get_mut(&id) else {
            return;
        };
        let message = Arc::new(message);
        let decoded = match wire::decode_borrowed(&message) {
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
                self.roster.enlist(id, 1);
                self.asking.insert(id);
            }
            (WorkerPhase::Ready, FromWorker::Done(done)) => {
                self.asking.insert(id);
                if let Err(why) = self.take_outcomes(id, &message, &done) {
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
        message: &Arc<Vec<u8>>,
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
            if !self.roster.done(id, *job, *micros as f64 * 1e-6) {
                return Err("it sent the outcome of a job that it did not have".to_owned());
            }
            self.fruitless_losses = 0;
            let begin = outcome.as_ptr().addr() - message.as_ptr().addr();
            let made = Made::new(*job, id, *micros, message, begin..begin + outcome.len());
            if let Some(stored) = stored {
                let stored = stored.map(|offset| offset + begin as u64);
                self.log.keep(*job, bytes_of(outcome, stored, made.digest));
            }
            self.reports.push_back(Report::Done(made));
        }
        Ok(())
    }

    /// Tells a worker that it cannot take part, and fails: every other worker would be like it.
    fn refuse(&mut self, id: WorkerId, why: &str) {
        self.send(id, wire::encode(&ToWorker::Refused(format!("this worker {why}"))));
        self.fail(format!("a worker {why}"));
    }
}

impl<C: Crew> Staff for Foreman<C> {
    fn publish(&mut self, increment: &Increment) {
        self.log.publish(self.front.next(), increment, &mut self.crew);
        self.front.publish();
    }

    fn fold(&mut self, round: &Round) {
        self.log.fold(round, &mut self.crew);
        self.front.fold();
    }

    fn submit(&mut self, job: Job) {
        self.roster.submit(job);
    }

    fn next(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>) -> Option<Report> {
        if let Some(report) = self.reports.pop_front() {
            return Some(report);
        }
        self.hire_missing();
        self.feed(true);
        if self.reports.is_empty() {
            self.crew.wait(wait, also);
            self.hear();
        }
        if !self.reports.is_empty() {
            // Workers that hold nothing need not wait until the build has said what follows.
            self.feed(false);
        }
        self.reports.pop_front()
    }

    fn reject(&mut self, made: &Made, why: &str) {
        self.log.forget(made.job);
        self.replace(made.member, Loss::Departure, &format!("it {why}"));
        self.reports.push_back(Report::Lost(made.job, Loss::Departure));
    }

    fn ready(&self) -> usize {
        self.roster.cores()
    }

    fn stored_bytes(&self) -> Arc<AtomicU64> {
        self.crew.stored_bytes()
    }

    fn close(self) -> Result<(), CrewError> {
        self.crew.close()
    }
}
