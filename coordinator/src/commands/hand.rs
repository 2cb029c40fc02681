use roadmill::device_rate::{Basis, Follower, Rule};
use roadmill::problem::Problem;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How long an exact answer is waited for, and how long it is slept between two looks.
const PATIENCE: Duration = Duration::from_millis(5);
const PAUSE: Duration = Duration::from_micros(500);
/// Statuses of answers that tell nothing.
const NO_CONFIGURATION: &str = "400 Bad Request";
const NO_THREAD: &str = "503 Service Unavailable";

/// Whether the robot that somebody moves by hand in a page collides: a [`Follower`] of the problem's model, which is made ready
/// when it is first asked.
pub(super) struct Hand {
    problem: Problem,
    /// `None` if the system has refused to start its thread.
    follower: OnceLock<Option<Mutex<Follower>>>,
}

impl Hand {
    /// For the robot of a problem.
    pub fn of(problem: &Problem) -> Hand {
        Hand { problem: problem.clone(), follower: OnceLock::new() }
    }

    /// Whether it is the robot of that problem.
    pub fn is_of(&self, problem: &Problem) -> bool {
        self.problem.digest() == problem.digest()
    }

    /// As JSON: whether the configuration, whose values stand in the text with commas between, collides or is else not valid, and whether that is
    /// exact; if not it is estimated from the last exact answer, and a moment later the exact one is there. `collides` is `null` where nothing is
    /// known yet. An exact answer that comes within [`PATIENCE`] is waited for, so that pages which ask in turn do not put each
    /// other off.
    ///
    /// # Errors
    /// The status of the answer: 400 if the text is no configuration, 503 if there is no thread for exact answers.
    pub fn told(&self, values: &str) -> Result<String, &'static str> {
        let values: Result<Vec<f64>, _> = values.split(',').map(str::parse).collect();
        let values = values.map_err(|_| NO_CONFIGURATION)?;
        let start = || {
            let model = self.problem.model().description().prepare();
            Follower::start(model, Rule::default()).ok().map(Mutex::new)
        };
        let follower = self.follower.get_or_init(start).as_ref().ok_or(NO_THREAD)?;
        let mut follower = follower.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = Instant::now();
        let mut answer = follower.ask(&values).map_err(|_| NO_CONFIGURATION)?;
        while answer.basis != Basis::Exact && begun.elapsed() < PATIENCE {
            if !follower.is_running() {
                return Err(NO_THREAD);
            }
            thread::sleep(PAUSE);
            answer = follower.ask(&values).map_err(|_| NO_CONFIGURATION)?;
        }
        let collides = match answer.basis {
            Basis::Unknown => "null".to_owned(),
            Basis::Exact | Basis::Projected => answer.collides.to_string(),
        };
        let exact = answer.basis == Basis::Exact;
        Ok(format!("{{\"collides\":{collides},\"exact\":{exact}}}"))
    }
}
