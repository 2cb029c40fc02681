//! Iterative relaxation of constraints: which easier version of a problem is tried next.
//!
//! A problem that is too hard is made easier by a [`Relaxation`](crate::model::Relaxation) of its model, solved so, and made harder
//! again level by level, each time helped by the path of the level before, until the problem itself is solved (O. B. Bayazit,
//! *Solving motion planning problems by iterative relaxation of constraints*, dissertation, Texas A&M University, 2003, chapter III:
//! Algorithm B.1, and section E for the level at which it begins).
//!
//! Here is the loop as a pure function: [`next`] is told which levels were tried and whether they were solved, and says which is tried
//! next and with which help. It starts no build and reads no clock. [`Problem::at_level`](crate::problem::Problem::at_level) makes the
//! problem of a level; whoever builds it says what it came to. `docs/relaxation.md` describes both for users.
//!
//! ```
//! use roadmill::relaxation::{Attempt, Guide, Outcome, Settings, Step, Tried, next};
//!
//! let settings = Settings::default();
//! // The problem itself comes first.
//! let first = Attempt { level: 1.0, guide: Guide::Nothing };
//! assert_eq!(next(&settings, &[]), Step::Try(first));
//! // It was not solved within the limits: then half of the constraints.
//! let mut tried = vec![Tried { attempt: first, outcome: Outcome::Unsolved }];
//! let second = Attempt { level: 0.5, guide: Guide::Nothing };
//! assert_eq!(next(&settings, &tried), Step::Try(second));
//! // That was solved, and its path helps with the problem itself.
//! tried.push(Tried { attempt: second, outcome: Outcome::Solved });
//! assert_eq!(next(&settings, &tried), Step::Try(Attempt { level: 1.0, guide: Guide::Path(1) }));
//! ```

mod chain;
mod ladder;
mod settings;

pub use chain::{chain, chain_begin};
pub use ladder::{Attempt, Ended, Guide, Outcome, Step, Tried, follows, next};
pub use settings::Settings;

#[cfg(test)]
mod tests;
