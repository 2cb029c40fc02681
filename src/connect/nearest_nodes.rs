use super::candidates::CandidatePairs;
use super::{Among, JoinInput, complaint, default_neighbors, default_planners};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Edge;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Each new node with its `neighbors` nearest nodes of the roadmap and of the round's earlier
/// increments: as PRM connects (Kavraki et al. 1996). TR05-007 §5 calls its own way of merging *"a naive
/// approach … that only attempts connections between nearby components"*; this one looks at nodes, so
/// every one gets a chance, whatever the centre of its component. All pairs are tried and all
/// successes kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct NearestNodes {
    /// How many nearest nodes of each new one.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

impl Default for NearestNodes {
    fn default() -> NearestNodes {
        NearestNodes { neighbors: default_neighbors(), planners: default_planners() }
    }
}

impl Among for NearestNodes {
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge> {
        let Some(candidates) = CandidatePairs::new(input) else { return Vec::new() };
        let pairs = candidates.nearest(cx, self.neighbors, scratch).into_iter();
        pairs.filter_map(|pair| candidates.connect(cx, &self.planners, pair, scratch)).collect()
    }

    fn complaint(&self) -> Option<Complaint> {
        complaint(self.neighbors, &self.planners)
    }
}
