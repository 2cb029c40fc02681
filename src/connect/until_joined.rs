use super::candidates::{CandidatePair, CandidatePairs};
use super::{Among, JoinInput, complaint, default_neighbors, default_planners};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Edge;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The pairs of [`NearestNodes`](super::NearestNodes), closest first, but each only while its two
/// components are not joined yet: the fewest edges that connect what can be connected, as Kruskal's
/// algorithm picks them, for TR05-007 §5, *"techniques for connecting more efficiently"*.
///
/// What counts as joined is what this increment's own edges join, directly or by way of others. What other sets
/// of the same round join at the same time is not known here, since a join's inputs are frozen. The
/// roadmap gets no cycles between sets, so paths along it are longer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct UntilJoined {
    /// How many nearest nodes of each new one.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

impl Default for UntilJoined {
    fn default() -> UntilJoined {
        UntilJoined { neighbors: default_neighbors(), planners: default_planners() }
    }
}

impl Among for UntilJoined {
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge> {
        let Some(candidates) = CandidatePairs::new(input) else { return Vec::new() };
        let mut pairs = candidates.nearest(cx, self.neighbors, scratch);
        pairs.sort_by(CandidatePair::closest_first);
        let mut joined = candidates.joined();
        let mut edges = Vec::new();
        for pair in pairs {
            let sides = candidates.components(pair);
            if joined.same(sides) {
                continue;
            }
            if let Some(edge) = candidates.connect(cx, &self.planners, pair, scratch) {
                joined.unite(sides);
                edges.push(edge);
            }
        }
        edges
    }

    fn complaint(&self) -> Option<Complaint> {
        complaint(self.neighbors, &self.planners)
    }
}
