use super::Run;
use crate::exit::Code;
use crate::run::{Stopped, Summary};
use roadmill::problem::Problem;
use roadmill::query::Path;
use roadmill::roadmap::Digest;

/// A build that has come to an end, now or before.
#[derive(Debug)]
pub struct Ended {
    pub(super) run: Run,
    pub(super) problem: Problem,
    pub(super) stopped: Stopped,
    pub(super) rounds: u64,
    pub(super) digest: Digest,
    pub(super) path: Option<Path>,
    pub(super) summary: Option<Summary>,
}

impl Ended {
    /// The run, to be resumed, verified or queried.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// The problem as it is now, all chapters taken together.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// How many complete rounds it has.
    pub fn rounds(&self) -> u64 {
        self.rounds
    }

    /// The digest of the roadmap of the complete rounds.
    pub fn digest(&self) -> Digest {
        self.digest
    }

    /// Why the build stopped.
    pub fn stopped(&self) -> &Stopped {
        &self.stopped
    }

    /// The same for people.
    pub fn reason(&self) -> &str {
        &self.stopped.reason
    }

    /// The path of the problem's own query, if one was found.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_ref()
    }

    /// The summary; `None` where the build had ended before and there was nothing to do.
    pub fn summary(&self) -> Option<&Summary> {
        self.summary.as_ref()
    }

    /// The exit code of the program `roadmill` for such an end, and what it says if that is no success.
    pub fn outcome(&self) -> (Code, String) {
        self.stopped.outcome(&self.problem)
    }

    /// How the build goes on, where it can: the command and the option that decides how far.
    pub fn way_on(&self) -> Option<String> {
        self.stopped.way_on(self.run.folder())
    }
}
