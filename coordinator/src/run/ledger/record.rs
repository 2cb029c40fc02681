//! What the records hold. `docs/ledger.md` describes their bytes.

use super::stopped::Stopped;
use bincode::{Decode, Encode};
use roadmill::evaluate::Verdict;
use roadmill::img::{Joined, RoundSet};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Increment};
use roadmill::wire::{self, WireError};
use roadmill::{BITS_VERSION, SourceFile};
use std::sync::Arc;

/// A record.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub enum Record {
    /// How the build goes on from here; the first record says how it begins.
    Chapter(Box<Chapter>),
    /// A set of the round that ends next.
    Set(Set),
    /// The sets since the last one make a round.
    RoundEnd(RoundEnd),
    /// What the evaluators said of the last round.
    Judged(Judged),
    /// The build stopped.
    Stopped(Stopped),
}

/// How a build goes on from a round.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Chapter {
    /// Its first round.
    pub first_round: u64,
    /// Version of the program.
    pub program: String,
    /// Its version of the bits.
    pub bits_version: u32,
    /// The problem's name.
    pub name: String,
    /// The base seed.
    pub seed: u64,
    /// Number of degrees of freedom.
    pub dofs: u32,
    /// Digest of all that determines the sets.
    pub problem_digest: Digest,
    /// The files that the problem came from.
    pub sources: Vec<SourceFile>,
    /// The bytes of the [`Problem`] as this program's version lays them out.
    pub problem: Vec<u8>,
}

impl Chapter {
    /// The chapter of a problem, from a round on.
    pub fn new(first_round: u64, problem: &Problem) -> Chapter {
        Chapter {
            first_round,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            bits_version: BITS_VERSION,
            name: problem.name.clone(),
            seed: problem.seed,
            dofs: problem.space().len() as u32,
            problem_digest: problem.digest(),
            sources: problem.sources.clone(),
            problem: wire::encode(problem),
        }
    }

    /// The problem.
    ///
    /// # Errors
    /// When another version of the program wrote it, in another layout.
    pub fn decode(&self) -> Result<Problem, WireError> {
        wire::decode(&self.problem)
    }
}

/// A set and how it is joined to what came before it.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Set {
    /// Its place.
    pub place: u64,
    /// The label of its strategy.
    pub label: String,
    /// Its ordinal within the label.
    pub ordinal: u64,
    /// What it adds.
    pub increment: Arc<Increment>,
    /// How it is joined.
    pub joined: Joined,
}

/// The bytes of a [`Record::Set`], of a set that stays where it is.
#[derive(Clone, Debug, Encode)]
pub struct WrittenSet<'a> {
    tag: [u8; 4],
    place: u64,
    label: &'a str,
    ordinal: u64,
    increment: &'a Increment,
    joined: &'a Joined,
}

impl WrittenSet<'_> {
    /// The record of a set that was folded.
    pub fn new<'a>(set: &'a RoundSet, problem: &'a Problem) -> WrittenSet<'a> {
        WrittenSet {
            tag: SET_TAG,
            place: set.place,
            label: &problem.strategies[set.strategy as usize].label,
            ordinal: set.ordinal,
            increment: &set.increment,
            joined: &set.joined,
        }
    }
}

/// The end of a round, and what the roadmap has come to.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct RoundEnd {
    /// The round, from 0.
    pub round: u64,
    /// Sets folded so far.
    pub sets: u64,
    /// Nodes so far.
    pub nodes: u64,
    /// Edges so far.
    pub edges: u64,
    /// Connected components now.
    pub components: u64,
    /// Digest of the roadmap.
    pub roadmap: Digest,
}

/// What the evaluators said of a round.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Judged {
    /// The round.
    pub round: u64,
    /// One verdict per evaluator.
    pub verdicts: Vec<Verdict>,
}

/// The first bytes of the payload of a [`Record::Set`].
const SET_TAG: [u8; 4] = 1u32.to_le_bytes();

/// Whether a payload is that of a set, which those who follow a build from afar need not decode.
pub fn is_set(payload: &[u8]) -> bool {
    payload.starts_with(&SET_TAG)
}
