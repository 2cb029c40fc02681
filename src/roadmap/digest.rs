use super::{Edge, Increment};
use crate::digest::Digest;
use std::fmt;

/// Hashes a roadmap's canonical bytes, set by set as they are folded.
#[derive(Clone)]
pub(super) struct RoadmapHasher(blake3::Hasher);

impl RoadmapHasher {
    pub(super) fn new(dofs: usize) -> RoadmapHasher {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 roadmap digest");
        hasher.update(&(dofs as u64).to_le_bytes());
        RoadmapHasher(hasher)
    }

    pub(super) fn add_set(&mut self, first: u32, increment: &Increment, joins: &[Edge]) {
        let mut bytes = Vec::new();
        bytes.extend((increment.configs.len() as u64).to_le_bytes());
        for value in increment.configs.iter().flatten() {
            bytes.extend((value + 0.0).to_bits().to_le_bytes()); // −0 becomes 0
        }
        bytes.extend((increment.edges.len() as u64).to_le_bytes());
        for edge in &increment.edges {
            push_edge(&mut bytes, &edge.shifted(first));
        }
        bytes.extend((joins.len() as u64).to_le_bytes());
        for edge in joins {
            push_edge(&mut bytes, edge);
        }
        self.0.update(&bytes);
    }

    pub(super) fn digest(&self) -> Digest {
        Digest(*self.0.finalize().as_bytes())
    }
}

fn push_edge(bytes: &mut Vec<u8>, edge: &Edge) {
    bytes.extend(edge.low.to_le_bytes());
    bytes.extend(edge.high.to_le_bytes());
    bytes.push(edge.planner);
    bytes.extend((edge.weight + 0.0).to_bits().to_le_bytes());
}

impl fmt::Debug for RoadmapHasher {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RoadmapHasher({})", self.digest())
    }
}
