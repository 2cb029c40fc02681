use super::{Within, complaint, connect_pairs, default_neighbors, default_planners};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::k_nearest_graph;
use crate::roadmap::{Configs, Edge};
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Each milestone with its `neighbors` nearest of the set: TR05-007 §4.1, *"we only attempt to
/// connect the 10 nearest neighbors"*. The pairs are the union of the directed k-nearest
/// relations, each once, in ascending order, tried from the lower to the higher id.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Nearest {
    /// How many neighbours of each milestone.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

impl Default for Nearest {
    fn default() -> Nearest {
        Nearest { neighbors: default_neighbors(), planners: default_planners() }
    }
}

impl Within for Nearest {
    fn connect(
        &self,
        cx: &Context,
        _seed: &Seed,
        configs: &Configs,
        scratch: &mut Scratch,
    ) -> Vec<Edge> {
        let pairs = k_nearest_graph(&cx.space, configs, self.neighbors as usize);
        connect_pairs(cx, &self.planners, configs, &pairs, scratch)
    }

    fn complaint(&self) -> Option<Complaint> {
        complaint(self.neighbors, &self.planners)
    }
}
