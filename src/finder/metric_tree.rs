use super::{Finder, Milestones, NeighborCount, count_complaint, default_neighbors};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::Neighbor;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The nearest milestones, found by a metric tree (J. K. Uhlmann 1991; S. K. Nath 2013, §2.3.1), which knows distances and the
/// triangle inequality only. It gives what [`KNearest`](super::KNearest) gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct MetricTree {
    /// How many.
    #[serde(default = "default_neighbors")]
    pub neighbors: NeighborCount,
}

impl Default for MetricTree {
    fn default() -> MetricTree {
        MetricTree { neighbors: default_neighbors() }
    }
}

impl Finder for MetricTree {
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let Milestones { configs, components, total, .. } = *milestones;
        let count = self.neighbors.of(total);
        let is_eligible = |id| milestones.has(id);
        components.nearest_by_metric_tree(&cx.space, configs, &is_eligible, q, count)
    }

    fn most(&self, total: usize) -> Option<usize> {
        Some(self.neighbors.of(total))
    }

    fn complaint(&self) -> Option<Complaint> {
        count_complaint(self.neighbors)
    }
}
