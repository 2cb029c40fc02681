//! Exit codes, and failures that carry one.

use std::fmt;

/// What the process ends with. The README and `--help` list the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Code {
    /// The criteria are met, or a build without criteria has reached a limit; the path is found, the problem is sound.
    Done = 0,
    /// The system failed: a disk is full, output is lost, a process or thread cannot be started.
    System = 1,
    /// The command line, the problem or an output folder cannot be used.
    Usage = 2,
    /// A limit was reached, or a roadmap searched, without success.
    NoSuccess = 3,
    /// A run folder or a file of sets is damaged or says what cannot be, or a job gave two different outcomes.
    BrokenRun = 4,
    /// The workers died faster than they could be replaced, or a job that kills them.
    WorkersLost = 5,
    /// A signal ended the build.
    Interrupted = 6,
    /// What was recomputed or compared is not the same.
    Differs = 7,
}

/// The table of exit codes, for `--help`.
pub const HELP: &str = "\
Exit codes:
  0  done: the criteria are met (of a build without criteria: a limit is reached), the path is
     found, the problem is sound
  1  the system failed (disk full, output lost, no process or thread can be started)
  2  usage: the command line, the problem or the run folder cannot be used, or is in use
  3  without success: a limit was reached before the criteria were met, a sampler gave up, no
     path was found
  4  broken run: a damaged or impossible run folder or file of sets, or a job with two different
     outcomes
  5  workers lost: they died faster than they could be replaced, or one set killed them
  6  interrupted by a signal; the last complete round is saved
  7  not the same: a set, judgement or stop recomputed by verify, or two runs compared by diff";

/// A failure with its exit code and one message.
#[derive(Debug)]
pub struct Failure {
    /// What the process ends with.
    pub code: Code,
    /// What the user reads.
    pub message: String,
}

impl Failure {
    /// A failure.
    pub fn new(code: Code, message: impl fmt::Display) -> Failure {
        Failure { code, message: message.to_string() }
    }

    /// Something that the user can put right.
    pub fn usage(message: impl fmt::Display) -> Failure {
        Failure::new(Code::Usage, message)
    }

    /// Something that the system refused.
    pub fn system(message: impl fmt::Display) -> Failure {
        Failure::new(Code::System, message)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}
