use super::{Finder, Milestones, NeighborCount, count_complaint, default_neighbors};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::{self, Neighbor};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The nearest milestones, found by looking at all (S. K. Nath 2013, Algorithm 5): what defines the exact finders. It gives what
/// [`KNearest`](super::KNearest) gives, in a time that grows with the number of milestones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct BruteForce {
    /// How many.
    #[serde(default = "default_neighbors")]
    pub neighbors: NeighborCount,
}

impl Default for BruteForce {
    fn default() -> BruteForce {
        BruteForce { neighbors: default_neighbors() }
    }
}

impl Finder for BruteForce {
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let count = self.neighbors.of(milestones.total);
        neighbor::k_nearest(&cx.space, milestones.configs, milestones.ids(), q, count)
    }

    fn most(&self, total: usize) -> Option<usize> {
        Some(self.neighbors.of(total))
    }

    fn complaint(&self) -> Option<Complaint> {
        count_complaint(self.neighbors)
    }
}
