use super::Configs;
use crate::validity::Asked;
use bincode::{Decode, Encode};

/// An edge between two milestones that a local planner found free from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Edge {
    /// The lower node id.
    pub low: u32,
    /// The higher node id.
    pub high: u32,
    /// Tag of the local planner that succeeded.
    pub planner: u8,
    /// Length of the local planner's motion in the space's metric.
    pub weight: f64,
}

impl Edge {
    /// The same edge with both ids raised by `first`.
    pub fn shifted(self, first: u32) -> Edge {
        Edge { low: self.low + first, high: self.high + first, ..self }
    }
}

/// What one node set adds: milestones and the edges among them, numbered from 0 (TR05-007
/// §3.1: a roadmap increment).
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Increment {
    /// The milestones.
    pub configs: Configs,
    /// Edges among them, in the order in which they were found.
    pub edges: Vec<Edge>,
    /// The validity checks that making the increment took.
    pub asked: Asked,
}

impl Increment {
    /// Whether the increment is well-formed: a check of decoded bytes.
    pub fn is_sound(&self, dofs: usize) -> bool {
        let nodes = self.configs.len() as u64;
        self.configs.is_sound(dofs)
            && self.edges.iter().all(|edge| {
                edge.low < edge.high && u64::from(edge.high) < nodes && edge.weight.is_finite()
            })
    }
}
