//! What coordinator and agents say to one another, as bytes of [`roadmill::internal::wire`].
//!
//! ```text
//! coordinator                                agent
//! Greeting { who, workers }   ───────────▶
//!                             ◀───────────   Hello { who, cores, host }
//! Problem, or Refused         ───────────▶
//!                             ◀───────────   Ready { canaries }
//! Work { entries, jobs }      ───────────▶                               at any time
//!                             ◀───────────   Done, Died                  at any time
//!                             ◀───────────   Leaving
//! ```
//!
//! The two do not take turns: over a long way that would cost a round trip for every message.

use super::identity::Identity;
use bincode::{BorrowDecode, Decode, Encode};
use roadmill::img::Job;
use roadmill::problem::Problem;
use roadmill::roadmap::Digest;
use roadmill_workers::message::Done;
use std::sync::Arc;

/// Version of these messages. Those up to [`FromAgent::Hello`] and [`ToAgent::Refused`] are the same in all versions.
pub const PROTOCOL: u32 = 1;

/// To an agent.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum ToAgent {
    /// The first message.
    Greeting {
        /// Who asks.
        who: Identity,
        /// How many worker processes the agent is to start; 0 for one per core that it may use.
        workers: u32,
    },
    /// The agent cannot take part; why.
    Refused(String),
    /// What is to be planned.
    Problem(Box<Problem>),
    /// Entries for the replicas, then jobs.
    Work {
        /// The next ones, in order.
        entries: Vec<Entry>,
        /// More jobs.
        jobs: Vec<Job>,
        /// Which of them are to be done by a worker that holds no other job: a worker died at each.
        alone: Vec<Job>,
    },
}

/// What changes the replicas of an agent's workers.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum Entry {
    /// The increment of the next set: the bytes of the [`roadmill::img::Outcome`] that it is.
    Increment(Text),
    /// The end of a round: for each of its sets the bytes of the [`roadmill::img::Outcome`] that joins it.
    Fold(Vec<Text>),
}

/// The bytes of an outcome.
#[derive(Debug, Clone, PartialEq, Encode, Decode)]
pub enum Text {
    /// They are here.
    Here(Arc<Vec<u8>>),
    /// The agent has sent them itself and has kept them.
    Own(Digest),
}

/// From an agent.
#[derive(Debug, Clone, PartialEq, Encode, BorrowDecode)]
pub enum FromAgent<'a> {
    /// The first message.
    Hello {
        /// Who answers.
        who: Identity,
        /// How many worker processes it starts.
        cores: u32,
        /// The name of its machine, for people.
        host: String,
    },
    /// The problem is set up and workers are at hand.
    Ready {
        /// Digests of a small increment, join and judgement made for comparison: the same arithmetic gives the same.
        canaries: Digest,
    },
    /// Jobs that are done.
    Done(Vec<Done<'a>>),
    /// A worker of the agent has died of itself while it held these jobs, which are lost.
    Died {
        /// The jobs.
        jobs: Vec<Job>,
        /// How it died, for people.
        why: String,
    },
    /// The agent ends, and its jobs are lost; why, for people.
    Leaving(String),
}
