//! What the records hold. `docs/ledger.md` describes their bytes.

use super::stopped::Stopped;
use bincode::de::Decoder;
use bincode::enc::Encoder;
use bincode::error::{DecodeError, EncodeError};
use bincode::{Decode, Encode};
use roadmill::evaluate::Verdict;
use roadmill::generator::{GeneratorKind, Reads};
use roadmill::img::{Joined, RoundSet};
use roadmill::internal::wire::WireError;
use roadmill::numbers::{Ordinal, RoundNumber, SetNumber};
use roadmill::problem::{Layout, Problem};
use roadmill::roadmap::{Digest, Full, Increment};
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
    /// A set that a [`Record::Set`] cannot say.
    FullSet(FullSet),
    /// A chapter whose problem has the second layout.
    SecondChapter(SecondChapter),
    /// A chapter whose problem has the third layout.
    ThirdChapter(ThirdChapter),
}

/// How a build goes on from a round.
#[derive(Clone, Debug, PartialEq)]
pub struct Chapter {
    /// Its first round.
    pub first_round: RoundNumber,
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
    /// The bytes of the [`Problem`].
    pub problem: Vec<u8>,
    /// How they are laid out, which the record's kind says.
    pub layout: Layout,
}

/// A [`Chapter`] whose problem has the second layout.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondChapter(pub Box<Chapter>);

/// A [`Chapter`] whose problem has the third layout.
#[derive(Clone, Debug, PartialEq)]
pub struct ThirdChapter(pub Box<Chapter>);

impl Encode for Chapter {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        let Chapter { first_round, program, bits_version, name, seed, dofs, .. } = self;
        (first_round, program, bits_version, name, seed, dofs).encode(encoder)?;
        (&self.problem_digest, &self.sources, &self.problem).encode(encoder)
    }
}

impl<Context> Decode<Context> for Chapter {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Chapter, DecodeError> {
        let (first_round, program, bits_version, name, seed, dofs) = Decode::decode(decoder)?;
        let (problem_digest, sources, problem) = Decode::decode(decoder)?;
        Ok(Chapter {
            first_round,
            program,
            bits_version,
            name,
            seed,
            dofs,
            problem_digest,
            sources,
            problem,
            layout: Layout::First,
        })
    }
}

bincode::impl_borrow_decode!(Chapter);

impl Encode for SecondChapter {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        self.0.encode(encoder)
    }
}

impl<Context> Decode<Context> for SecondChapter {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let chapter =
            Chapter { layout: Layout::Second, ..<Chapter as Decode<Context>>::decode(decoder)? };
        Ok(SecondChapter(Box::new(chapter)))
    }
}
bincode::impl_borrow_decode!(SecondChapter);

impl Encode for ThirdChapter {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        self.0.encode(encoder)
    }
}

impl<Context> Decode<Context> for ThirdChapter {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let chapter =
            Chapter { layout: Layout::Third, ..<Chapter as Decode<Context>>::decode(decoder)? };
        Ok(ThirdChapter(Box::new(chapter)))
    }
}
bincode::impl_borrow_decode!(ThirdChapter);

impl Chapter {
    /// The chapter of a problem, from a round on.
    pub fn new(first_round: RoundNumber, problem: &Problem) -> Chapter {
        let (layout, bytes) = problem.to_bytes();
        Chapter {
            first_round,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            bits_version: BITS_VERSION,
            name: problem.name().to_owned(),
            seed: problem.seed(),
            dofs: problem.space().len() as u32,
            problem_digest: problem.digest(),
            sources: problem.sources().to_vec(),
            problem: bytes,
            layout,
        }
    }

    /// The problem.
    ///
    /// # Errors
    /// When another version of the program wrote it, in another layout.
    pub fn decode(&self) -> Result<Problem, WireError> {
        Problem::from_bytes(self.layout, &self.problem)
    }

    /// The record of the chapter.
    pub fn into_record(self) -> Record {
        match self.layout {
            Layout::First => Record::Chapter(Box::new(self)),
            Layout::Second => Record::SecondChapter(SecondChapter(Box::new(self))),
            Layout::Third => Record::ThirdChapter(ThirdChapter(Box::new(self))),
        }
    }
}

/// A set and how it is joined to what came before it.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Set {
    /// Its number in the sequence of all sets.
    pub number: SetNumber,
    /// The label of its strategy.
    pub label: String,
    /// Its ordinal within the label.
    pub ordinal: Ordinal,
    /// What it adds.
    pub increment: Arc<Increment>,
    /// How it is joined.
    pub joined: Joined,
}

/// A set that grew from the roadmap or was made from a parent run, or whose nodes have values or whose edges directed
/// costs, and how it is joined to what came before it.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct FullSet {
    /// Its number in the sequence of all sets.
    pub number: SetNumber,
    /// The label of its strategy.
    pub label: String,
    /// Its ordinal within the label.
    pub ordinal: Ordinal,
    /// What the set was made from beside the problem: of one that grew, the digest of the roadmap that it read; of
    /// one that read a parent run, the hash of that run's ledger.
    pub read: Option<Digest>,
    /// What it adds.
    pub increment: Full<Increment>,
    /// How it is joined.
    pub joined: Full<Joined>,
}

/// The bytes of a [`Record::FullSet`], of a set that stays where it is.
#[derive(Clone, Debug, Encode)]
pub struct WrittenFullSet<'a> {
    tag: [u8; 4],
    number: SetNumber,
    label: &'a str,
    ordinal: Ordinal,
    read: Option<Digest>,
    increment: Full<&'a Increment>,
    joined: Full<&'a Joined>,
}

impl WrittenFullSet<'_> {
    /// The record of a set that was folded; `None` where a [`WrittenSet`] says it. `roadmap` is the digest of
    /// the roadmap at the start of the round.
    pub fn new<'a>(
        set: &'a RoundSet,
        problem: &'a Problem,
        roadmap: Digest,
    ) -> Option<WrittenFullSet<'a>> {
        let strategy = &problem.strategies()[set.strategy.index()];
        let read = read_by(strategy.generator(), roadmap);
        let is_plain = set.increment.is_plain() && set.joined.is_plain();
        (read.is_some() || !is_plain).then(|| WrittenFullSet {
            tag: FULL_SET_TAG,
            number: set.number,
            label: strategy.label(),
            ordinal: set.ordinal,
            read,
            increment: Full(&set.increment),
            joined: Full(&set.joined),
        })
    }
}

/// The digest by which a ledger names what a generator's sets read; `roadmap` is that of the roadmap at the start
/// of their round.
pub fn read_by(generator: &GeneratorKind, roadmap: Digest) -> Option<Digest> {
    match generator.method().reads() {
        Reads::Nothing => None,
        Reads::Roadmap => Some(roadmap),
        Reads::Parent(ledger) => Some(ledger),
    }
}

/// The bytes of a [`Record::Set`], of a set that stays where it is.
#[derive(Clone, Debug, Encode)]
pub struct WrittenSet<'a> {
    tag: [u8; 4],
    number: SetNumber,
    label: &'a str,
    ordinal: Ordinal,
    increment: &'a Increment,
    joined: &'a Joined,
}

impl WrittenSet<'_> {
    /// The record of a set that was folded.
    pub fn new<'a>(set: &'a RoundSet, problem: &'a Problem) -> WrittenSet<'a> {
        WrittenSet {
            tag: SET_TAG,
            number: set.number,
            label: problem.strategies()[set.strategy.index()].label(),
            ordinal: set.ordinal,
            increment: &set.increment,
            joined: &set.joined,
        }
    }
}

/// The end of a round, and what the roadmap has come to.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct RoundEnd {
    /// The round.
    pub round: RoundNumber,
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
    pub round: RoundNumber,
    /// One verdict per evaluator.
    pub verdicts: Vec<Verdict>,
}

/// The first bytes of the payload of a [`Record::Set`].
const SET_TAG: [u8; 4] = 1u32.to_le_bytes();
/// The same of a [`Record::FullSet`].
const FULL_SET_TAG: [u8; 4] = 5u32.to_le_bytes();

/// Whether a payload is that of a set, which those who follow a build from afar need not decode.
pub fn is_set(payload: &[u8]) -> bool {
    payload.starts_with(&SET_TAG) || payload.starts_with(&FULL_SET_TAG)
}
