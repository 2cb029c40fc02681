use super::Setup;
use crate::connect::JoinInput;
use crate::context::Context;
use crate::evaluate::Verdict;
use crate::model::Scratch;
use crate::numbers::{EvaluatorIndex, Ordinal, RoundNumber, SetNumber, StrategyIndex};
use crate::problem::Problem;
use crate::roadmap::{Digest, Full, Increment, Joined, Roadmap};
use crate::sampler::GaveUp;
use bincode::de::{Decode, Decoder};
use bincode::enc::{Encode, Encoder};
use bincode::error::{DecodeError, EncodeError};
use std::fmt;
use std::sync::Arc;

/// A piece of work, named by what it makes. The order is that of urgency.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, bincode::Encode, bincode::Decode)]
pub enum Job {
    /// Judge the roadmap after `round` by one of the problem's evaluators.
    Evaluate {
        /// The round just folded.
        round: RoundNumber,
        /// The evaluator.
        evaluator: EvaluatorIndex,
    },
    /// Find the edges that join the set `number` to what came before it.
    Join {
        /// The set's number in the sequence of all sets.
        number: SetNumber,
        /// Its strategy.
        strategy: StrategyIndex,
        /// Its number within the strategy.
        ordinal: Ordinal,
    },
    /// Make the increment of the set `number`.
    Generate {
        /// The set's number in the sequence of all sets.
        number: SetNumber,
        /// Its strategy.
        strategy: StrategyIndex,
        /// Its number within the strategy.
        ordinal: Ordinal,
    },
}

/// Names the job by numbers; who knows the problem can name strategies and evaluators better.
impl fmt::Display for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Job::Evaluate { round, evaluator } => {
                write!(f, "judging round {round} by evaluator {evaluator}")
            }
            Job::Join { number, strategy, ordinal } => {
                write!(f, "joining set {number} (set {ordinal} of strategy {strategy})")
            }
            Job::Generate { number, strategy, ordinal } => {
                write!(f, "generating set {number} (set {ordinal} of strategy {strategy})")
            }
        }
    }
}

/// What a job made.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Of [`Job::Generate`].
    Increment(Result<Increment, GaveUp>),
    /// Of [`Job::Join`].
    Joined(Joined),
    /// Of [`Job::Evaluate`].
    Verdict(Box<Verdict>),
}

/// A number that says which outcome follows and in which form, then the outcome.
impl Encode for Outcome {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        match self {
            Outcome::Increment(Ok(made)) if !made.is_plain() => (3u32, Full(made)).encode(encoder),
            Outcome::Increment(made) => (0u32, made).encode(encoder),
            Outcome::Joined(joined) if !joined.is_plain() => (4u32, Full(joined)).encode(encoder),
            Outcome::Joined(joined) => (1u32, joined).encode(encoder),
            Outcome::Verdict(verdict) => (2u32, verdict).encode(encoder),
        }
    }
}

impl<Context> Decode<Context> for Outcome {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Outcome, DecodeError> {
        Ok(match u32::decode(decoder)? {
            0 => Outcome::Increment(Decode::decode(decoder)?),
            1 => Outcome::Joined(Decode::decode(decoder)?),
            2 => Outcome::Verdict(Decode::decode(decoder)?),
            3 => Outcome::Increment(Ok(Full::<Increment>::decode(decoder)?.0)),
            4 => Outcome::Joined(Full::<Joined>::decode(decoder)?.0),
            _ => return Err(DecodeError::Other("a kind of outcome that there is not")),
        })
    }
}
bincode::impl_borrow_decode!(Outcome);

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
        /// The strategy.
        strategy: StrategyIndex,
        /// The set's number within it.
        ordinal: Ordinal,
        /// Of a set that grows from the roadmap: the roadmap at the start of its round.
        frozen: Option<Arc<Roadmap>>,
    },
    /// See [`Job::Join`].
    Join {
        /// The strategy.
        strategy: StrategyIndex,
        /// What was there before, and the set.
        input: JoinInput,
    },
    /// See [`Job::Evaluate`].
    Evaluate {
        /// The evaluator.
        evaluator: EvaluatorIndex,
        /// The roadmap.
        roadmap: Arc<Roadmap>,
    },
}

impl Task {
    /// Does the work. The outcome depends on the problem and the task alone, never on what
    /// `scratch` held.
    pub fn run(&self, setup: &Setup, scratch: &mut Scratch) -> Outcome {
        self.run_by(&setup.problem, &setup.cx, scratch)
    }

    /// The same by the strategies and evaluators of this problem, of whose space and model `cx` is made.
    pub(super) fn run_by(&self, problem: &Problem, cx: &Context, scratch: &mut Scratch) -> Outcome {
        match self {
            Task::Generate { strategy, ordinal, frozen } => {
                let strategy = &problem.strategies[strategy.index()];
                let frozen = frozen.as_deref();
                Outcome::Increment(strategy.generate(cx, *ordinal, frozen, scratch))
            }
            Task::Join { strategy, input } => {
                let strategy = &problem.strategies[strategy.index()];
                scratch.take_asked();
                let edges = strategy.among.method().connect(cx, input, scratch);
                Outcome::Joined(Joined { edges, asked: scratch.take_asked() })
            }
            Task::Evaluate { evaluator, roadmap } => {
                let method = problem.evaluators[evaluator.index()].method();
                let verdict = method.evaluate(cx, &evaluator.to_string(), roadmap, scratch);
                Outcome::Verdict(Box::new(verdict))
            }
        }
    }
}
