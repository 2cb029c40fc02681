use super::foreman::Foreman;
use super::staff::{Board, Made, Report, Staff};
use crate::cpu::Meter;
use crate::crew::{Crew, CrewError};
use crate::signals::Signals;
use roadmill::img::{Cut, Event, Executor, Finished, Job, Outcome, Round, Setup};
use roadmill::internal::wire;
use roadmill::roadmap::{Increment, Outline, Tally};
use std::os::fd::BorrowedFd;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

/// [`Staff`] as an executor: what they make is decoded, and of the roadmap is kept what the build itself needs.
pub struct Dispatcher<S> {
    staff: S,
    /// Of the roadmap only what this process needs: the workers have it.
    outline: Outline,
    /// Ends waiting when a signal comes.
    signals: Option<Arc<Signals>>,
    messages: Meter,
    folds: Meter,
}

impl<C: Crew> Dispatcher<Foreman<C>> {
    /// Starts as many workers as the crew is to have. To be called, as all methods, from one thread
    /// that lives as long as the build.
    ///
    /// # Errors
    /// When a worker cannot be started.
    pub fn start(setup: Arc<Setup>, crew: C) -> Result<Dispatcher<Foreman<C>>, CrewError> {
        let outline = Outline::new(setup.context().space());
        Ok(Dispatcher::of(Foreman::start(setup, crew)?, outline))
    }
}

impl<S: Staff> Dispatcher<S> {
    /// An executor whose jobs this staff does; `outline` is that of the roadmap so far.
    pub fn of(staff: S, outline: Outline) -> Dispatcher<S> {
        let (messages, folds) = (Meter::default(), Meter::default());
        Dispatcher { staff, outline, signals: None, messages, folds }
    }

    /// The same dispatcher, which stops waiting when a signal comes.
    pub fn with_signals(self, signals: Arc<Signals>) -> Dispatcher<S> {
        Dispatcher { signals: Some(signals), ..self }
    }

    /// Ends the staff and removes every trace of them.
    ///
    /// # Errors
    /// When something cannot be removed.
    pub fn close(self) -> Result<(), CrewError> {
        self.staff.close()
    }

    /// How many bytes of shared memory hold what all workers read, now and whenever it is looked at.
    pub fn stored_bytes(&self) -> Arc<AtomicU64> {
        self.staff.stored_bytes()
    }

    /// Where it is written what each machine does, where there may be several.
    pub fn board(&self) -> Option<Board> {
        self.staff.board()
    }

    /// CPU seconds that messages took: waiting for them, reading, checking, decoding and sending them.
    pub fn message_seconds(&self) -> f64 {
        self.messages.seconds()
    }

    /// CPU seconds that folding took, the roadmap's digest included.
    pub fn fold_seconds(&self) -> f64 {
        self.folds.seconds()
    }

    fn signal_came(&self) -> bool {
        self.signals.as_ref().is_some_and(|signals| signals.came())
    }

    /// What follows from a report for the build; nothing where what came is no outcome.
    fn event(&mut self, report: Report) -> Option<Event> {
        Some(match report {
            Report::Done(made) => Event::Done(made.job, self.decode(&made)?),
            Report::Lost(job, loss) => Event::Lost(job, loss),
            Report::Failed(why) => Event::Cut(Cut::WorkersLost(why)),
            Report::Contradiction(job, by) => Event::Contradiction(job, by),
        })
    }

    fn decode(&mut self, made: &Made) -> Option<Finished> {
        match wire::decode::<Outcome>(made.bytes()) {
            Ok(outcome) => Some(Finished { outcome, digest: made.digest }),
            Err(error) => {
                self.staff.reject(made, &format!("sent {error}"));
                None
            }
        }
    }

    fn wait(&mut self, wait: Duration) -> Option<Event> {
        let until = Instant::now() + wait;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let signals: Option<BorrowedFd<'_>> =
                self.signals.as_ref().map(|signals| signals.as_fd());
            if let Some(report) = self.staff.next(left, signals)
                && let Some(event) = self.event(report)
            {
                return Some(event);
            }
            if left.is_zero() || self.signal_came() {
                return None;
            }
        }
    }
}

impl<S: Staff> Executor for Dispatcher<S> {
    fn publish(&mut self, increment: &Arc<Increment>) {
        self.staff.publish(increment);
    }

    fn fold(&mut self, round: &Round) {
        let begun = Meter::begin();
        self.staff.fold(round);
        self.outline.fold_round(round.parts());
        self.folds.end(begun);
    }

    fn submit(&mut self, job: Job) {
        self.staff.submit(job);
    }

    fn next(&mut self, wait: Duration) -> Option<Event> {
        let begun = Meter::begin();
        let event = self.wait(wait);
        self.messages.end(begun);
        event
    }

    fn alive(&self) -> usize {
        self.staff.ready()
    }

    fn lookahead(&self) -> Option<u64> {
        self.staff.lookahead()
    }

    fn tally(&self) -> &Tally {
        self.outline.tally()
    }
}
