use super::{Finder, Milestones, NeighborCount, count_complaint, default_neighbors};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::Neighbor;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Milestones about as near as the nearest, by a k-d tree (S. Arya, D. M. Mount, N. S. Netanyahu, R. Silverman, A. Y. Wu, *An optimal
/// algorithm for approximate nearest neighbor searching in fixed dimensions*, J. ACM 45, 1998; S. K. Nath 2013, §2.3.1): the
/// i-th that is given is at most 1 + `epsilon` times as far as the true i-th, in the space's metric, whatever its
/// lengths, angles and rotations.
///
/// A cell of the tree is passed over if 1 + ε times its least possible distance is more than that of the last neighbour so far. In exact
/// searches that is so with ε = 0. The least distance is that of points, in which a rotation is the chord to the nearer of its two
/// quaternions; the bound holds for the metric, since a chord is no longer than its arc.
///
/// Which milestones are given depends on the trees, and these follow from the milestones and their number alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Approximate {
    /// How many.
    #[serde(default = "default_neighbors")]
    pub neighbors: NeighborCount,
    /// How much farther than the true ones neighbours may be, as a share of their distance: at least 0, at most 1000.
    #[serde(default = "default_epsilon")]
    pub epsilon: f64,
}

fn default_epsilon() -> f64 {
    0.5
}

/// The largest ε. It is beyond any use.
const EPSILON_MAX: f64 = 1000.0;

impl Default for Approximate {
    fn default() -> Approximate {
        Approximate { neighbors: default_neighbors(), epsilon: default_epsilon() }
    }
}

impl Finder for Approximate {
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let Milestones { configs, components, total, .. } = *milestones;
        let wanted = (self.neighbors.of(total), self.epsilon);
        let is_eligible = |id| milestones.has(id);
        components.approximately_nearest(&cx.space, configs, &is_eligible, q, wanted)
    }

    fn most(&self, total: usize) -> Option<usize> {
        Some(self.neighbors.of(total))
    }

    fn complaint(&self) -> Option<Complaint> {
        let is_sound = (0.0..=EPSILON_MAX).contains(&self.epsilon);
        count_complaint(self.neighbors).or_else(|| {
            (!is_sound).then(|| Complaint::new("epsilon", self.epsilon, "at least 0, at most 1000"))
        })
    }
}
