use super::{Edge, EdgeCost, Increment};
use crate::digest::Digest;
use crate::model::Directed;
use std::fmt;

const EDGE_BYTES: usize = 4 + 4 + 1 + 8;
const PIECE_BYTES: usize = 1 << 16;

/// Hashes a roadmap's canonical bytes, set by set as they are folded.
#[derive(Clone)]
pub(super) struct RoadmapHasher {
    hasher: blake3::Hasher,
    /// Bytes that are not hashed yet: long pieces are hashed several times faster than short ones.
    bytes: Vec<u8>,
}

impl RoadmapHasher {
    pub(super) fn new(dofs: usize) -> RoadmapHasher {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 roadmap digest");
        hasher.update(&(dofs as u64).to_le_bytes());
        RoadmapHasher { hasher, bytes: Vec::new() }
    }

    pub(super) fn add_set(&mut self, first: u32, increment: &Increment, joins: &[Edge]) {
        let bytes = &mut self.bytes;
        let edges = increment.edges.len() + joins.len();
        bytes.reserve(
            24 + 8 * increment.configs.len() * increment.configs.dofs() + EDGE_BYTES * edges,
        );
        bytes.extend((increment.configs.len() as u64).to_le_bytes());
        for value in increment.configs.iter().flatten() {
            bytes.extend((value + 0.0).to_bits().to_le_bytes()); // −0 becomes 0
        }
        bytes.extend((increment.edges.len() as u64).to_le_bytes());
        for edge in &increment.edges {
            push_edge(bytes, &edge.shifted(first));
        }
        bytes.extend((joins.len() as u64).to_le_bytes());
        for edge in joins {
            push_edge(bytes, edge);
        }
        if !(increment.is_plain() && joins.iter().all(Edge::is_plain)) {
            push_rest(bytes, first, increment, joins);
        }
        if bytes.len() > PIECE_BYTES {
            self.take_in();
        }
    }

    /// Hashes the bytes that were added, so that later digests need not hash them each time.
    pub(super) fn take_in(&mut self) {
        self.hasher.update(&self.bytes);
        self.bytes.clear();
    }

    pub(super) fn digest(&self) -> Digest {
        let mut hasher = self.hasher.clone();
        Digest(*hasher.update(&self.bytes).finalize().as_bytes())
    }
}

fn push_edge(bytes: &mut Vec<u8>, edge: &Edge) {
    bytes.extend(edge.low.0.to_le_bytes());
    bytes.extend(edge.high.0.to_le_bytes());
    bytes.push(edge.planner);
    bytes.extend((edge.weight() + 0.0).to_bits().to_le_bytes());
}

/// What sets of the first version do not have: a number that cannot be the count of a set's milestones, the
/// values of the milestones, the root edges, and of all directed edges the weight back and the peak.
fn push_rest(bytes: &mut Vec<u8>, first: u32, increment: &Increment, joins: &[Edge]) {
    let number = |value: f64| (value + 0.0).to_bits().to_le_bytes();
    bytes.extend(u64::MAX.to_le_bytes());
    bytes.extend((increment.values.len() as u64).to_le_bytes());
    bytes.extend(increment.values.iter().flat_map(|value| number(*value)));
    bytes.extend((increment.root_edges.len() as u64).to_le_bytes());
    increment.root_edges_from(first).for_each(|edge| push_edge(bytes, &edge));
    for edge in increment.edges.iter().chain(joins).chain(&increment.root_edges) {
        match edge.cost {
            EdgeCost::Metric(_) => bytes.push(0),
            EdgeCost::Directed(Directed { backward, peak, .. }) => {
                bytes.push(1);
                bytes.extend(number(backward));
                bytes.extend(number(peak));
            }
        }
    }
}

impl fmt::Debug for RoadmapHasher {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RoadmapHasher({})", self.digest())
    }
}
