use super::{Event, Executor, Finished, InProcess, Job, Loss, Replica, Round, Setup};
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap, Tally};
use crossbeam::channel::{Receiver, RecvTimeoutError, Sender, unbounded};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

/// Does the jobs in a pool of threads of this process (rayon).
pub struct Threads {
    setup: Arc<Setup>,
    replica: Replica,
    pool: rayon::ThreadPool,
    waiting: BTreeSet<Job>,
    running: usize,
    results: (Sender<Event>, Receiver<Event>),
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl Threads {
    /// An executor for one build with this many threads, at least one.
    ///
    /// # Panics
    /// If the system refuses to start the threads.
    pub fn new(setup: Arc<Setup>, threads: usize) -> Threads {
        Threads::start(setup, threads).expect("threads can be started")
    }

    /// [`Threads::new`] for those who can go on without, or have somebody to tell.
    ///
    /// # Errors
    /// When the system refuses to start so many threads.
    pub fn start(setup: Arc<Setup>, threads: usize) -> std::io::Result<Threads> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.max(1))
            .thread_name(|index| format!("roadmill {index}"))
            .build()
            .map_err(std::io::Error::other)?;
        let replica = Replica::new(&setup);
        let waiting = BTreeSet::new();
        Ok(Threads { setup, replica, pool, waiting, running: 0, results: unbounded() })
    }

    /// Keeps every thread busy with the most urgent jobs; the rest wait here, where urgency rules.
    fn feed(&mut self) {
        while self.running < self.pool.current_num_threads() {
            let Some(job) = self.waiting.pop_first() else {
                return;
            };
            let Some(task) = self.replica.task(&self.setup, job) else {
                continue;
            };
            let (setup, results) = (self.setup.clone(), self.results.0.clone());
            self.running += 1;
            self.pool.spawn(move || {
                let run = || SCRATCH.with_borrow_mut(|scratch| task.run(&setup, scratch));
                let event = match catch_unwind(AssertUnwindSafe(run)) {
                    Ok(outcome) => Event::Done(job, Finished::new(outcome)),
                    Err(_) => Event::Lost(job, Loss::Death),
                };
                // Free the inputs first, so that the fold that follows finds the roadmap unshared.
                drop(task);
                // Nobody listens once the build is over.
                let _ = results.send(event);
            });
        }
    }
}

impl Executor for Threads {
    fn publish(&mut self, increment: &Arc<Increment>) {
        self.replica.publish(&self.setup, increment.clone());
    }

    fn fold(&mut self, round: &Round) {
        self.replica.fold(&self.setup, round.joins());
    }

    fn submit(&mut self, job: Job) {
        self.waiting.insert(job);
    }

    fn next(&mut self, wait: Duration) -> Option<Event> {
        self.feed();
        match self.results.1.recv_timeout(wait) {
            Ok(event) => {
                self.running -= 1;
                Some(event)
            }
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => None,
        }
    }

    fn alive(&self) -> usize {
        self.pool.current_num_threads()
    }

    fn tally(&self) -> &Tally {
        self.replica.roadmap().tally()
    }
}

impl InProcess for Threads {
    fn into_roadmap(self) -> Roadmap {
        self.replica.into_roadmap()
    }
}
