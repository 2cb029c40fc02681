use super::Setup;
use crate::connect::JoinInput;
use crate::evaluate::Verdict;
use crate::roadmap::{Digest, Edge, Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::validity::{Asked, Scratch};
use bincode::{Decode, Encode};
use std::sync::Arc;

/// A piece of work, named by what it makes. The order is that of urgency.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Encode, Decode)]
pub enum Job {
    /// Judge the roadmap after `round` by one of the problem's evaluators.
    Evaluate {
        /// The round just folded.
        round: u64,
        /// Index of the evaluator.
        evaluator: u32,
    },
    /// Find the edges that join the set at `place` to what came before it.
    Join {
        /// The set's place.
        place: u64,
        /// Index of its strategy.
        strategy: u32,
        /// Its ordinal within the strategy.
        ordinal: u64,
    },
    /// Make the increment of the set at `place`.
    Generate {
        /// The set's place.
        place: u64,
        /// Index of its strategy.
        strategy: u32,
        /// Its ordinal within the strategy.
        ordinal: u64,
    },
}

/// What a job made.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub enum Outcome {
    /// Of [`Job::Generate`].
    Increment(Result<Increment, GaveUp>),
    /// Of [`Job::Join`].
    Joined(Joined),
    /// Of [`Job::Evaluate`].
    Verdict(Box<Verdict>),
}

/// The edges that join a set to what came before it, numbered as in the roadmap after the round.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Joined {
    /// The edges in the order in which they were found.
    pub edges: Vec<Edge>,
    /// What the join cost.
    pub asked: Asked,
}

/// An outcome with the digest of its bytes, by which duplicates are compared.
#[derive(Clone, Debug)]
pub struct Finished {
    /// The outcome.
    pub outcome: Outcome,
    /// Digest of its encoding.
    pub digest: Digest,
}

impl Finished {
    /// An outcome and its digest.
    pub fn new(outcome: Outcome) -> Finished {
        let digest = Digest::of(&crate::wire::encode(&outcome));
        Finished { outcome, digest }
    }
}

/// A job together with everything its outcome depends on.
#[derive(Clone, Debug)]
pub enum Task {
    /// See [`Job::Generate`].
    Generate {
        /// Index of the strategy.
        strategy: u32,
        /// The set's ordinal within it.
        ordinal: u64,
    },
    /// See [`Job::Join`].
    Join {
        /// Index of the strategy.
        strategy: u32,
        /// What was there before, and the set.
        input: JoinInput,
    },
    /// See [`Job::Evaluate`].
    Evaluate {
        /// Index of the evaluator.
        evaluator: u32,
        /// The roadmap.
        roadmap: Arc<Roadmap>,
    },
}

impl Task {
    /// Does the work. The outcome depends on the problem and the task alone, never on what
    /// `scratch` held.
    pub fn run(&self, setup: &Setup, scratch: &mut Scratch) -> Outcome {
        let cx = &setup.cx;
        match self {
            Task::Generate { strategy, ordinal } => {
                let strategy = &setup.problem.strategies[*strategy as usize];
                Outcome::Increment(strategy.generate(cx, *ordinal, scratch))
            }
            Task::Join { strategy, input } => {
                let strategy = &setup.problem.strategies[*strategy as usize];
                scratch.take_asked();
                let edges = strategy.among.method().connect(cx, input, scratch);
                Outcome::Joined(Joined { edges, asked: scratch.take_asked() })
            }
            Task::Evaluate { evaluator, roadmap } => {
                let method = setup.problem.evaluators[*evaluator as usize].method();
                let verdict = method.evaluate(cx, &evaluator.to_string(), roadmap, scratch);
                Outcome::Verdict(Box::new(verdict))
            }
        }
    }
}
