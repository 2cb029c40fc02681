use crate::math;
use bincode::{Decode, Encode};
use serde::de::{self, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::f64::consts::E;
use std::fmt;

/// How many neighbours: in a problem file `"auto"` or a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Encode, Decode)]
#[serde(into = "NeighborWord")]
pub enum NeighborCount {
    /// ⌊2e ln n⌋ in a graph of n nodes, and at least one (S. Karaman, E. Frazzoli, *Sampling-based algorithms for optimal
    /// motion planning*, 2011, §3.3.3: *"k_RRG = 2e is a valid choice for all problem instances"*).
    #[default]
    Auto,
    /// As many as said.
    Fixed(u32),
}

/// As a problem file has it.
#[derive(Serialize)]
#[serde(untagged)]
enum NeighborWord {
    Number(u32),
    Word(AutoWord),
}

#[derive(Serialize)]
enum AutoWord {
    #[serde(rename = "auto")]
    Auto,
}

impl<'de> Deserialize<'de> for NeighborCount {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<NeighborCount, D::Error> {
        from.deserialize_any(CountVisitor { or: "" })
    }
}

/// Reads a number of neighbours.
pub(crate) struct CountVisitor {
    /// What else may stand in its place, for people.
    pub or: &'static str,
}

impl Visitor<'_> for CountVisitor {
    type Value = NeighborCount;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "\"auto\" or a whole number from 0 to {}{}", u32::MAX, self.or)
    }

    fn visit_u64<E: de::Error>(self, count: u64) -> Result<NeighborCount, E> {
        let fitting = u32::try_from(count).map(NeighborCount::Fixed);
        fitting.map_err(|_| E::invalid_value(Unexpected::Unsigned(count), &self))
    }

    fn visit_i64<E: de::Error>(self, count: i64) -> Result<NeighborCount, E> {
        let fitting = u32::try_from(count).map(NeighborCount::Fixed);
        fitting.map_err(|_| E::invalid_value(Unexpected::Signed(count), &self))
    }

    fn visit_str<E: de::Error>(self, word: &str) -> Result<NeighborCount, E> {
        match word {
            "auto" => Ok(NeighborCount::Auto),
            other => Err(E::invalid_value(Unexpected::Str(other), &self)),
        }
    }
}

impl From<NeighborCount> for NeighborWord {
    fn from(count: NeighborCount) -> NeighborWord {
        match count {
            NeighborCount::Fixed(count) => NeighborWord::Number(count),
            NeighborCount::Auto => NeighborWord::Word(AutoWord::Auto),
        }
    }
}

impl From<u32> for NeighborCount {
    fn from(count: u32) -> NeighborCount {
        NeighborCount::Fixed(count)
    }
}

impl NeighborCount {
    /// How many, in a graph of so many nodes.
    pub fn of(self, nodes: usize) -> usize {
        match self {
            NeighborCount::Auto => ((2.0 * E * math::ln(nodes as f64)) as usize).max(1),
            NeighborCount::Fixed(count) => count as usize,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In the thesis' graphs of up to 200 nodes *"k ranges between 1 and 28"* (Nath 2013, §5.2.3.1).
    #[test]
    fn as_many_neighbours_as_in_the_thesis() {
        assert_eq!([1, 2, 3, 200].map(|nodes| NeighborCount::Auto.of(nodes)), [1, 3, 5, 28]);
        assert_eq!(NeighborCount::Fixed(7).of(200), 7);
        // A graph without nodes has no logarithm.
        assert_eq!(NeighborCount::Auto.of(0), 1);
    }
}
