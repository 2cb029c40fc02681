use crate::crew::CrewError;
use crate::output::Plain;
use roadmill::img::{Job, Loss, Round};
use roadmill::roadmap::{Digest, Increment};
use roadmill_workers::WorkerId;
use std::fmt;
use std::ops::Range;
use std::os::fd::BorrowedFd;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Whoever does the jobs of a build: they are given jobs and everything that the jobs read, and say what came of
/// them. All methods are to be called from one thread.
pub trait Staff {
    /// Makes the increment of the next set known.
    fn publish(&mut self, increment: &Increment);

    /// Makes the end of a round known.
    fn fold(&mut self, round: &Round);

    /// Takes on a job; everything that it reads is known.
    fn submit(&mut self, job: Job);

    /// The next thing that happened, or `None` where nothing did within `wait` or before `also` became readable.
    fn next(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>) -> Option<Report>;

    /// Takes note that what was made is no outcome: whoever made it is given up, and the job is lost. `why` says what
    /// the maker did.
    fn reject(&mut self, made: &Made, why: &str);

    /// How many jobs can be done at once by those who are ready.
    fn ready(&self) -> usize;

    /// How many sets ahead of the current round keep everybody at work; `None` where that was known before the
    /// build began.
    fn lookahead(&self) -> Option<u64> {
        None
    }

    /// Bytes of shared memory that hold what all workers read, now and whenever it is looked at.
    fn stored_bytes(&self) -> Arc<AtomicU64> {
        Arc::default()
    }

    /// Where it is written what each machine does, where there may be several.
    fn board(&self) -> Option<Board> {
        None
    }

    /// Ends all that was started.
    ///
    /// # Errors
    /// When something cannot be removed.
    fn close(self) -> Result<(), CrewError>;
}

/// What has happened.
#[derive(Debug)]
pub enum Report {
    /// A job was done.
    Done(Made),
    /// A job was lost.
    Lost(Job, Loss),
    /// There is nobody to do the jobs any more; why.
    Failed(String),
    /// A job was done twice, and with two outcomes; by whom, for people.
    Contradiction(Job, String),
}

/// What was made of a job: the bytes of an outcome, as they came.
#[derive(Debug, Clone)]
pub struct Made {
    /// The job.
    pub job: Job,
    /// Who did it.
    pub member: WorkerId,
    /// How long it took, in microseconds, by those who did it.
    pub micros: u64,
    /// Digest of the bytes.
    pub digest: Digest,
    /// The message that they came in, and where they are in it.
    message: Arc<Vec<u8>>,
    within: Range<usize>,
}

impl Made {
    /// What was made of `job`: `outcome`, which lies in `message`.
    pub fn new(
        job: Job,
        member: WorkerId,
        micros: u64,
        message: &Arc<Vec<u8>>,
        within: Range<usize>,
    ) -> Made {
        let digest = Digest::of(&message[within.clone()]);
        Made { job, member, micros, digest, message: message.clone(), within }
    }

    /// The bytes of the outcome.
    pub fn bytes(&self) -> &[u8] {
        &self.message[self.within.clone()]
    }
}

/// What each machine does, for whoever looks at it.
pub type Board = Arc<Mutex<Machines>>;

/// What the machines of a build do.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Machines {
    /// One for each place that was asked for.
    pub machines: Vec<Machine>,
    /// What was done twice and compared, where anything is to be.
    pub audited: Option<Audited>,
}

/// Jobs that were done twice, by different machines, and compared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Audited {
    /// Outcomes that were compared.
    pub compared: u64,
}

/// What a machine does for a build, as far as it is known.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Machine {
    /// Its name, as it was asked for.
    pub name: String,
    /// What it calls itself.
    pub host: String,
    /// `ready`, `starting`, `waiting` (to be started again) or `refused`.
    pub state: String,
    /// Why it is not ready, where there is a reason.
    pub reason: String,
    /// How many jobs it does at once.
    pub cores: usize,
    /// Jobs that it holds.
    pub held: usize,
    /// Jobs that it has done.
    pub done: u64,
    /// Seconds that its jobs took, added up over its cores.
    pub busy_seconds: f64,
    /// Core-seconds that it was ready and did nothing.
    pub waiting_seconds: f64,
    /// Bytes that it sent.
    pub bytes_received: u64,
    /// Bytes that it was sent.
    pub bytes_sent: u64,
    /// How often it was started after it had been lost.
    pub restarts: u64,
    /// Deaths of its workers.
    pub worker_deaths: u64,
    /// Seconds that a sign of life takes there and back.
    pub round_trip_seconds: Option<f64>,
}

/// In a line, for people.
impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Plain(&self.name))?;
        if !self.host.is_empty() && self.host != self.name {
            write!(f, " ({})", Plain(&self.host))?;
        }
        write!(f, ": {}", self.state)?;
        if !self.reason.is_empty() {
            write!(f, " ({})", Plain(&self.reason))?;
        }
        if self.cores > 0 {
            write!(f, "; {} cores, {} jobs held, {} done", self.cores, self.held, self.done)?;
            let (busy, waiting) = (self.busy_seconds, self.waiting_seconds);
            write!(f, ", {busy:.1} core-seconds at work and {waiting:.1} waiting")?;
            let megabytes = |bytes: u64| bytes as f64 * 1e-6;
            let (sent, came) = (megabytes(self.bytes_sent), megabytes(self.bytes_received));
            write!(f, ", {sent:.1} MB to it and {came:.1} MB from it")?;
        }
        if let Some(seconds) = self.round_trip_seconds {
            write!(f, ", {:.1} ms there and back", seconds * 1e3)?;
        }
        if self.restarts > 0 {
            write!(f, ", started again {}", times(self.restarts))?;
        }
        if self.worker_deaths > 0 {
            write!(f, ", workers died {}", times(self.worker_deaths))?;
        }
        Ok(())
    }
}

fn times(count: u64) -> String {
    if count == 1 { "once".to_owned() } else { format!("{count} times") }
}

impl fmt::Display for Audited {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} outcomes compared, all the same", self.compared)
    }
}
