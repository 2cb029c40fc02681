use super::{Edge, Full, Increment};
use crate::model::Asked;
use crate::numbers::{Ordinal, RoundNumber, SetNumber, StrategyIndex};
use bincode::de::{Decode, Decoder};
use bincode::enc::{Encode, Encoder};
use bincode::error::{DecodeError, EncodeError};
use std::sync::Arc;

/// A complete round.
#[derive(Clone, Debug)]
pub struct Round {
    /// Which round it is.
    pub number: RoundNumber,
    /// Its sets in the order of their numbers.
    pub sets: Vec<RoundSet>,
}

impl Round {
    /// What its sets add, and the edges that join each: what a fold takes.
    pub fn parts(&self) -> impl Iterator<Item = (&Increment, &[Edge])> {
        self.sets.iter().map(|set| (&*set.increment, &set.joined.edges[..]))
    }

    /// Per set the edges that join it to what came before it.
    pub fn joins(&self) -> impl ExactSizeIterator<Item = &[Edge]> {
        self.sets.iter().map(|set| &set.joined.edges[..])
    }
}

/// A set of a complete round.
#[derive(Clone, Debug)]
pub struct RoundSet {
    /// Its number in the sequence of all sets.
    pub number: SetNumber,
    /// Its strategy.
    pub strategy: StrategyIndex,
    /// Its number within the strategy.
    pub ordinal: Ordinal,
    /// What it adds.
    pub increment: Arc<Increment>,
    /// How it is joined to what came before.
    pub joined: Joined,
}

/// The edges that join a set to what came before it, numbered as in the roadmap after the round.
#[derive(Clone, Debug, PartialEq, bincode::Encode, bincode::Decode)]
pub struct Joined {
    /// The edges in the order in which they were found.
    pub edges: Vec<Edge>,
    /// What the join cost.
    pub asked: Asked,
}

impl Joined {
    /// Whether the plain form can say the edges.
    pub fn is_plain(&self) -> bool {
        self.edges.iter().all(Edge::is_plain)
    }
}

impl Encode for Full<&Joined> {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        Full(&self.0.edges).encode(encoder)?;
        self.0.asked.encode(encoder)
    }
}

impl Encode for Full<Joined> {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        Full(&self.0).encode(encoder)
    }
}

impl<Context> Decode<Context> for Full<Joined> {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let Full(edges) = Decode::decode(decoder)?;
        Ok(Full(Joined { edges, asked: Asked::decode(decoder)? }))
    }
}
bincode::impl_borrow_decode!(Full<Joined>);
