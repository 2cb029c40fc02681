use super::candidates::CandidatePairs;
use super::{Among, JoinInput, default_planners};
use crate::context::Context;
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Edge;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Closest pairs of nearby components: TR05-007 §4.1, *"For each new connected component, we
/// examine the 3 nearest components in the existing roadmap based on inter-component distance …
/// For each of these component pairs, we attempt to connect the 10 nearest pairs of nodes."*
///
/// The distance of two components is that of their centres; ties go to the component with the
/// smaller node id. Of a round with several sets the nearest are chosen among the roadmap's components and, apart,
/// among those of the round's earlier sets. All pairs are tried, nearest first, and all successes kept. The new components
/// take their turn in the order of their smallest node ids.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct ComponentPairs {
    /// How many nearest components of each new component.
    #[serde(default = "default_components")]
    pub components: u32,
    /// How many closest pairs of nodes of each pair of components.
    #[serde(default = "default_pairs")]
    pub pairs: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

pub(super) fn default_components() -> u32 {
    3
}

pub(super) fn default_pairs() -> u32 {
    10
}

impl Default for ComponentPairs {
    fn default() -> ComponentPairs {
        ComponentPairs {
            components: default_components(),
            pairs: default_pairs(),
            planners: default_planners(),
        }
    }
}

impl Among for ComponentPairs {
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge> {
        let Some(candidates) = CandidatePairs::new(input) else { return Vec::new() };
        let mut edges = Vec::new();
        for component in candidates.new_components() {
            let count = self.components as usize;
            for old in candidates.nearest_components(cx, component, count) {
                for pair in candidates.closest_pairs(cx, component, old, self.pairs as usize) {
                    edges.extend(candidates.connect(cx, &self.planners, pair, scratch));
                }
            }
        }
        edges
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.components == 0 {
            return Some(Complaint::new("components", "0", "at least 1"));
        }
        if self.pairs == 0 {
            return Some(Complaint::new("pairs", "0", "at least 1"));
        }
        local::complaint(&self.planners)
    }
}
