use crate::context::Context;
use crate::math;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::scene::LENGTH_MAX;
use crate::space::Space;
use bincode::{Decode, Encode};
use serde::de::{self, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::f64::consts::E;
use std::fmt;

/// The step of a problem that names none, as a share of the largest distance in the space: that of OMPL's planners
/// (I. A. Şucan, M. Moll, L. E. Kavraki, *The Open Motion Planning Library*, 2012; `range` in its documentation).
const STEP_SHARE: f64 = 0.2;

pub(in crate::generator) fn default_goal_bias() -> f64 {
    0.05
}

pub(in crate::generator) fn default_attempts() -> u64 {
    10_000
}

/// The step of a method that names one or none, in a space.
pub(in crate::generator) fn step_of(step: Option<f64>, space: &Space) -> f64 {
    step.unwrap_or_else(|| STEP_SHARE * space.diameter())
}

/// The step as it becomes part of a problem: always a number, unless all configurations of the space are one.
pub(in crate::generator) fn calibrated(step: Option<f64>, space: &Space) -> Option<f64> {
    step.or_else(|| Some(step_of(None, space)).filter(|step| *step > 0.0))
}

/// Where a tree begins: at the query's start, or, in a problem without a query, at the model's native configuration.
pub(super) fn root(cx: &Context) -> Option<&[f64]> {
    let start = cx.query.as_ref().map(|query| &query.start[..]);
    start.or_else(|| cx.model.native())
}

/// Refuses a problem in which a tree has nowhere to begin.
pub(in crate::generator) fn needs_root(cx: &Context) -> Result<(), String> {
    let Some(root) = root(cx) else {
        return Err("a tree that begins at the start of a query found, but no [query]".to_owned());
    };
    match cx.model.is_valid(root, &mut Scratch::new()) {
        true => Ok(()),
        false => Err("a tree found, but it begins where the configuration is not valid".to_owned()),
    }
}

/// Refuses a problem without a query, where trees are to begin at both its ends.
pub(in crate::generator) fn needs_query(cx: &Context) -> Result<(), String> {
    match cx.query {
        Some(_) => Ok(()),
        None => Err("a tree that begins at the start of a query found, but no [query]".to_owned()),
    }
}

/// How many neighbours of a new node are tried: in a problem file `"auto"` or a number.
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
        from.deserialize_any(CountVisitor)
    }
}

/// Reads a number of neighbours. An error names the key, which is that of all settings of this type.
struct CountVisitor;

impl Visitor<'_> for CountVisitor {
    type Value = NeighborCount;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "neighbors = \"auto\" or a whole number from 0 to {}", u32::MAX)
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

impl NeighborCount {
    /// How many, in a graph of so many nodes.
    pub fn of(self, nodes: usize) -> usize {
        match self {
            NeighborCount::Auto => ((2.0 * E * math::ln(nodes as f64)) as usize).max(1),
            NeighborCount::Fixed(count) => count as usize,
        }
    }
}

/// What is wrong with the settings that several methods have.
pub(in crate::generator) struct Complaints;

impl Complaints {
    pub fn of_step(step: Option<f64>) -> Option<Complaint> {
        step.and_then(|step| Complaint::of_length("step", step, LENGTH_MAX))
    }

    pub fn of_goal_bias(goal_bias: f64) -> Option<Complaint> {
        let is_sound = (0.0..1.0).contains(&goal_bias);
        (!is_sound).then(|| Complaint::new("goal_bias", goal_bias, "at least 0, less than 1"))
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
    }
}
