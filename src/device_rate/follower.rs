use super::{Answer, Exact, Projection, Rule};
use crate::model::{Model, Scratch};
use std::io;
use std::mem::take;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};

/// Answers questions about collisions at once, while a thread of its own computes exact answers.
///
/// [`Follower::ask`] waits for nothing: it takes an exact answer that has come since the last question, leaves the configuration for the
/// thread, and answers by the [`Projection`]. The thread always works at the configuration that was asked for last when it became free, so that
/// it never falls behind. Ends when it is dropped, after the exact answer that is just computed.
///
/// If the model panics, the thread ends, answers are extrapolated from the last exact one, and [`Follower::is_running`] says so.
///
/// ```
/// use roadmill::device_rate::{Basis, Follower, Rule};
/// use roadmill::problem::Problem;
///
/// let problem = Problem::load("tests/problems/slide.toml".as_ref())?;
/// let mut follower = Follower::start(problem.model().description().prepare(), Rule::default())?;
/// let q = [2.0, 0.0, 0.0];
/// while follower.ask(&q)?.basis != Basis::Exact {
///     std::thread::yield_now();
/// }
/// // The ball is in the slab, and now that is known.
/// assert!(follower.ask(&q)?.collides);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Follower {
    projection: Projection,
    exchange: Arc<Exchange>,
    thread: Option<JoinHandle<()>>,
}

/// What is passed between who asks and the thread.
#[derive(Debug, Default)]
struct Exchange {
    desk: Mutex<Desk>,
    /// There is a configuration to be looked at, or the end.
    news: Condvar,
}

#[derive(Debug, Default)]
struct Desk {
    wanted: Option<Vec<f64>>,
    found: Option<Exact>,
    ends: bool,
}

impl Exchange {
    /// The desk; whoever holds it only puts values there or takes them away.
    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Computes exact answers until the end.
    fn work(&self, model: &dyn Model) {
        let scratch = &mut Scratch::new();
        loop {
            let mut desk = self.desk();
            let q = loop {
                if desk.ends {
                    return;
                }
                match take(&mut desk.wanted) {
                    Some(q) => break q,
                    None => desk = self.news.wait(desk).unwrap_or_else(PoisonError::into_inner),
                }
            };
            drop(desk);
            let exact = Exact::at(model, &q, scratch);
            self.desk().found = Some(exact);
        }
    }
}

impl Follower {
    /// Starts the thread.
    ///
    /// # Errors
    /// When the system refuses to start one.
    pub fn start(model: Box<dyn Model>, rule: Rule) -> io::Result<Follower> {
        let projection = Projection::new(model.space().clone(), rule);
        let exchange = Arc::new(Exchange::default());
        let of_thread = exchange.clone();
        let thread = Builder::new().name("exact answers".to_owned());
        let thread = thread.spawn(move || of_thread.work(&*model))?;
        Ok(Follower { projection, exchange, thread: Some(thread) })
    }

    /// Whether `q` collides, without waiting: exact where the last exact answer is that of `q`, else extrapolated from it.
    ///
    /// # Errors
    /// Says what is wrong with `q`: the number of values, or a value.
    pub fn ask(&mut self, q: &[f64]) -> Result<Answer, String> {
        let q = self.projection.stored(q)?;
        let mut desk = self.exchange.desk();
        let found = take(&mut desk.found);
        let is_known = found.as_ref().or(self.projection.last()).is_some_and(|it| it.q() == q);
        desk.wanted = (!is_known).then(|| q.clone());
        drop(desk);
        self.exchange.news.notify_one();
        if let Some(found) = found {
            self.projection.learn(found);
        }
        Ok(self.projection.answer(&q))
    }

    /// The last exact answer that a question has taken note of.
    pub fn last_exact(&self) -> Option<&Exact> {
        self.projection.last()
    }

    /// Whether there is still a thread that computes exact answers.
    pub fn is_running(&self) -> bool {
        self.thread.as_ref().is_some_and(|thread| !thread.is_finished())
    }
}

impl Drop for Follower {
    fn drop(&mut self) {
        self.exchange.desk().ends = true;
        self.exchange.news.notify_one();
        if let Some(thread) = self.thread.take() {
            // A model that panicked has said so already.
            let _ = thread.join();
        }
    }
}
