//! The bytes of edges and increments.
//!
//! The plain form has been that of ledgers and files of sets from the first version on, and never changes. It
//! can say increments of milestones and edges whose costs are lengths. What it cannot say has the full form
//! ([`Full`]), under kinds of records and messages of its own.

use super::{Edge, EdgeCost, Increment};
use crate::model::{Asked, Directed};
use crate::space::Configs;
use bincode::de::{Decode, Decoder};
use bincode::enc::{Encode, Encoder};
use bincode::error::{DecodeError, EncodeError};

/// Something in its full form.
#[derive(Clone, Debug, PartialEq)]
pub struct Full<T>(pub T);

impl Edge {
    /// Whether the plain form can say the edge.
    pub fn is_plain(&self) -> bool {
        matches!(self.cost, EdgeCost::Metric(_))
    }
}

impl Increment {
    /// Whether the plain form can say the increment.
    pub fn is_plain(&self) -> bool {
        self.values.is_empty()
            && self.root_edges.is_empty()
            && self.edges.iter().all(Edge::is_plain)
    }
}

/// In the plain form, which must be able to say the edge.
impl Encode for Edge {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        let EdgeCost::Metric(length) = self.cost else {
            return Err(EncodeError::Other("an edge that the plain form cannot say"));
        };
        (self.low, self.high, self.planner, length).encode(encoder)
    }
}

impl<Context> Decode<Context> for Edge {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Edge, DecodeError> {
        let (low, high, planner, length) = Decode::decode(decoder)?;
        Ok(Edge::metric(low, high, planner, length))
    }
}
bincode::impl_borrow_decode!(Edge);

/// As an edge in the plain form, or 17 bytes of it and the numbers of a directed cost: the planner's tag is
/// followed by 0 (u8) and the length, or by 1 (u8) and the costs there and back and the peak.
impl Encode for Full<Edge> {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        let Edge { low, high, planner, cost } = self.0;
        (low, high, planner).encode(encoder)?;
        match cost {
            EdgeCost::Metric(length) => (0u8, length).encode(encoder),
            EdgeCost::Directed(Directed { forward, backward, peak }) => {
                (1u8, forward, backward, peak).encode(encoder)
            }
        }
    }
}

impl<Context> Decode<Context> for Full<Edge> {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let (low, high, planner) = Decode::decode(decoder)?;
        let cost = match u8::decode(decoder)? {
            0 => EdgeCost::Metric(f64::decode(decoder)?),
            1 => {
                let (forward, backward, peak) = Decode::decode(decoder)?;
                EdgeCost::Directed(Directed { forward, backward, peak })
            }
            _ => return Err(DecodeError::Other("a kind of cost that there is not")),
        };
        Ok(Full(Edge { low, high, planner, cost }))
    }
}
bincode::impl_borrow_decode!(Full<Edge>);

/// A list of edges as a count (u64) and so many.
impl Encode for Full<&Vec<Edge>> {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        (self.0.len() as u64).encode(encoder)?;
        self.0.iter().try_for_each(|edge| Full(*edge).encode(encoder))
    }
}

impl<Context> Decode<Context> for Full<Vec<Edge>> {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let edges: Vec<Full<Edge>> = Decode::decode(decoder)?;
        Ok(Full(edges.into_iter().map(|edge| edge.0).collect()))
    }
}
bincode::impl_borrow_decode!(Full<Vec<Edge>>);

/// In the plain form, which must be able to say the increment.
impl Encode for Increment {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        if !(self.values.is_empty() && self.root_edges.is_empty()) {
            return Err(EncodeError::Other("an increment that the plain form cannot say"));
        }
        self.configs.encode(encoder)?;
        self.edges.encode(encoder)?;
        self.asked.encode(encoder)
    }
}

impl<Context> Decode<Context> for Increment {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Increment, DecodeError> {
        let configs = Configs::decode(decoder)?;
        let edges = Decode::decode(decoder)?;
        let asked = Asked::decode(decoder)?;
        Ok(Increment { configs, edges, asked, values: Vec::new(), root_edges: Vec::new() })
    }
}
bincode::impl_borrow_decode!(Increment);

impl Encode for Full<&Increment> {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        let Increment { configs, edges, asked, values, root_edges } = self.0;
        configs.encode(encoder)?;
        Full(edges).encode(encoder)?;
        asked.encode(encoder)?;
        values.encode(encoder)?;
        Full(root_edges).encode(encoder)
    }
}

impl Encode for Full<Increment> {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        Full(&self.0).encode(encoder)
    }
}

impl<Context> Decode<Context> for Full<Increment> {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let configs = Configs::decode(decoder)?;
        let Full(edges) = Decode::decode(decoder)?;
        let asked = Asked::decode(decoder)?;
        let values = Vec::decode(decoder)?;
        let Full(root_edges) = Decode::decode(decoder)?;
        Ok(Full(Increment { configs, edges, asked, values, root_edges }))
    }
}
bincode::impl_borrow_decode!(Full<Increment>);
