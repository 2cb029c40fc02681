use super::candidates::{CandidatePair, CandidatePairs, NodeBlock};
use super::{Among, JoinInput, default_planners};
use crate::context::Context;
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::{Best, Neighbor, Subset};
use crate::numbers::NodeId;
use crate::roadmap::{Component, Edge};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Closest pairs of nearby components: TR05-007 §4.1, *"For each new connected component, we
/// examine the 3 nearest components in the existing roadmap based on inter-component distance …
/// For each of these component pairs, we attempt to connect the 10 nearest pairs of nodes."*
///
/// The distance of two components is that of their centres; ties go to the component with the
/// smaller node id. All pairs are tried, nearest first, and all successes kept. The new components
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

fn default_components() -> u32 {
    3
}

fn default_pairs() -> u32 {
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
        let new = &candidates.new;
        let mut new_components: Vec<&Component> = new.components.iter().collect();
        new_components.sort_by_key(|component| component.name);
        let mut edges = Vec::new();
        for component in new_components {
            for name in self.nearest(cx, &candidates.old, component) {
                let old = candidates.part(name);
                let near = old.components.of_node(old.own(name));
                let first = Subset { all: new.configs, ids: &component.members };
                let count = self.pairs as usize;
                for pair in old.components.closest_pairs(&cx.space, first, old.configs, near, count)
                {
                    let pair = CandidatePair {
                        distance: pair.distance,
                        new: new.first + pair.first,
                        old: old.first + pair.second,
                    };
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

impl ComponentPairs {
    /// The names, after the round, of the old components nearest to a new one, nearest first.
    fn nearest(
        &self,
        cx: &Context,
        old: &[NodeBlock],
        new: &Component,
    ) -> impl Iterator<Item = NodeId> {
        let count = self.components as usize;
        let mut best = Best::new(count);
        for part in old {
            for near in part.components.nearest(&cx.space, &new.centre, count) {
                best.offer(Neighbor { id: part.first.0 + near.id, ..near });
            }
        }
        best.into_items().into_iter().map(|near| NodeId(near.id))
    }
}
