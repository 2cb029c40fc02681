use roadmill::device_rate::{Basis, Follower, Rule};
use roadmill::problem::Problem;
use std::sync::{Mutex, OnceLock, PoisonError};

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
    /// exact; if not it is estimated from the last exact answer, and a moment later the exact one is there.
    /// `None` if the text is no configuration, or nothing can be told.
    pub fn told(&self, values: &str) -> Option<String> {
        let values: Result<Vec<f64>, _> = values.split(',').map(str::parse).collect();
        let values = values.ok()?;
        let start = || {
            let model = self.problem.model().description().prepare();
            Follower::start(model, Rule::default()).ok().map(Mutex::new)
        };
        let follower = self.follower.get_or_init(start).as_ref()?;
        let mut follower = follower.lock().unwrap_or_else(PoisonError::into_inner);
        let answer = follower.ask(&values).ok()?;
        let exact = answer.basis == Basis::Exact;
        Some(format!("{{\"collides\":{},\"exact\":{exact}}}", answer.collides))
    }
}
