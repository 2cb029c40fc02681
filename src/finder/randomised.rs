use super::{Finder, KNearest, Milestones, NeighborCount, count_complaint, default_neighbors};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::{Neighbor, Ranked};
use crate::seed::Stream;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Some of the nearest milestones, drawn at random (T. McMahon, S. Jacobs, B. Boyd, L. Tapia, N. M. Amato, *Local randomization in
/// neighbor selection improves PRM roadmap quality*, IROS 2012; S. K. Nath 2013, §2.3: it *"first selects closest k₁ nodes and returns
/// k₂ of them at random"*). Every choice of k₂ is as likely as any other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Randomised {
    /// How many are drawn (k₂).
    #[serde(default = "default_neighbors")]
    pub neighbors: NeighborCount,
    /// Of how many nearest ones (k₁). If nothing is said, of twice as many as are drawn.
    #[serde(default)]
    pub nearest: Option<u32>,
}

impl Default for Randomised {
    fn default() -> Randomised {
        Randomised { neighbors: default_neighbors(), nearest: None }
    }
}

impl Randomised {
    fn nearest(&self, total: usize) -> NeighborCount {
        let twice = self.neighbors.of(total).saturating_mul(2);
        NeighborCount::Fixed(self.nearest.unwrap_or(u32::try_from(twice).unwrap_or(u32::MAX)))
    }
}

impl Finder for Randomised {
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let nearest = KNearest { neighbors: self.nearest(milestones.total) };
        nearest.near(cx, milestones, q, scratch)
    }

    fn most(&self, total: usize) -> Option<usize> {
        Some(self.nearest(total).of(total))
    }

    fn choose(&self, near: &mut Vec<Neighbor>, total: usize, chance: &mut Stream) {
        let wanted = self.neighbors.of(total);
        if near.len() <= wanted {
            return;
        }
        for place in 0..wanted {
            let drawn = place as u64 + chance.below((near.len() - place) as u64);
            near.swap(place, drawn as usize);
        }
        near.truncate(wanted);
        near.sort_by(Ranked::rank);
    }

    fn complaint(&self) -> Option<Complaint> {
        let fewer = match (self.nearest, self.neighbors) {
            (Some(nearest), NeighborCount::Fixed(neighbors)) => nearest < neighbors,
            (nearest, NeighborCount::Auto) => nearest == Some(0),
            (None, NeighborCount::Fixed(_)) => false,
        };
        let expected = "at least as many as neighbors";
        count_complaint(self.neighbors).or_else(|| {
            fewer.then(|| Complaint::new("nearest", self.nearest.unwrap_or(0), expected))
        })
    }
}
