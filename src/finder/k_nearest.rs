use super::Finder;
use crate::methods::Complaint;
use crate::neighbor::{Neighbor, k_nearest_graph};
use crate::roadmap::{Components, Configs};
use crate::space::Space;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The `neighbors` nearest milestones, whatever their distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct KNearest {
    /// How many.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
}

fn default_neighbors() -> u32 {
    10
}

impl Default for KNearest {
    fn default() -> KNearest {
        KNearest { neighbors: default_neighbors() }
    }
}

impl Finder for KNearest {
    fn near(
        &self,
        space: &Space,
        configs: &Configs,
        components: &Components,
        q: &[f64],
    ) -> Vec<Neighbor> {
        components.k_nearest(space, configs, q, self.neighbors as usize)
    }

    fn pairs(&self, space: &Space, configs: &Configs) -> Vec<(u32, u32)> {
        k_nearest_graph(space, configs, self.neighbors as usize)
    }

    fn most(&self) -> Option<usize> {
        Some(self.neighbors as usize)
    }

    fn complaint(&self) -> Option<Complaint> {
        (self.neighbors == 0).then(|| Complaint::new("neighbors", "0", "at least 1"))
    }
}
