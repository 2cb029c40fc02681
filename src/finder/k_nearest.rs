use super::Finder;
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::{Neighbor, k_nearest_graph};
use crate::roadmap::{Components, Configs};
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
        cx: &Context,
        configs: &Configs,
        components: &Components,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        components.k_nearest(&cx.space, configs, q, self.neighbors as usize)
    }

    fn pairs(&self, cx: &Context, configs: &Configs, _scratch: &mut Scratch) -> Vec<(u32, u32)> {
        k_nearest_graph(&cx.space, configs, self.neighbors as usize)
    }

    fn most(&self) -> Option<usize> {
        Some(self.neighbors as usize)
    }

    fn complaint(&self) -> Option<Complaint> {
        (self.neighbors == 0).then(|| Complaint::new("neighbors", "0", "at least 1"))
    }
}
