use super::{Finder, Milestones, NeighborCount, count_complaint, default_neighbors};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::{Neighbor, Subset, k_nearest_graph};
use crate::roadmap::Configs;
use crate::seed::Stream;
use bincode::de::{Decode, Decoder};
use bincode::enc::{Encode, Encoder};
use bincode::error::{DecodeError, EncodeError};
use serde::{Deserialize, Serialize};

/// The `neighbors` nearest milestones, whatever their distance, found by the [`Index`](crate::neighbor::Index).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KNearest {
    /// How many.
    #[serde(default = "default_neighbors")]
    pub neighbors: NeighborCount,
}

/// The number; 0, which is no number of neighbours, stands for `"auto"`.
impl Encode for KNearest {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        let number = match self.neighbors {
            NeighborCount::Auto => 0u32,
            NeighborCount::Fixed(count) => count,
        };
        number.encode(encoder)
    }
}

impl<Context> Decode<Context> for KNearest {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<KNearest, DecodeError> {
        let neighbors = match u32::decode(decoder)? {
            0 => NeighborCount::Auto,
            count => NeighborCount::Fixed(count),
        };
        Ok(KNearest { neighbors })
    }
}
bincode::impl_borrow_decode!(KNearest);

impl Default for KNearest {
    fn default() -> KNearest {
        KNearest { neighbors: default_neighbors() }
    }
}

impl Finder for KNearest {
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let Milestones { configs, components, component, but, total } = *milestones;
        let count = self.neighbors.of(total);
        // One more is found, in the place of the one that is left out.
        let with_it = count.saturating_add(usize::from(but.is_some()));
        let mut near = match component {
            None => components.k_nearest(&cx.space, configs, q, with_it),
            Some(component) => {
                let mut one = Configs::new(q.len());
                one.push(q);
                let query = Subset { all: &one, ids: &[0] };
                let pairs = components.closest_pairs(&cx.space, query, configs, component, with_it);
                let ends = pairs.into_iter();
                ends.map(|pair| Neighbor { distance: pair.distance, id: pair.second }).collect()
            }
        };
        near.retain(|neighbor| but != Some(neighbor.id));
        near.truncate(count);
        near
    }

    fn pairs(
        &self,
        cx: &Context,
        configs: &Configs,
        _chance: &mut Stream,
        _scratch: &mut Scratch,
    ) -> Vec<(u32, u32)> {
        k_nearest_graph(&cx.space, configs, self.neighbors.of(configs.len()))
    }

    fn most(&self, total: usize) -> Option<usize> {
        Some(self.neighbors.of(total))
    }

    fn complaint(&self) -> Option<Complaint> {
        count_complaint(self.neighbors)
    }
}
