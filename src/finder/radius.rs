use super::{Finder, Milestones};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::{self, Neighbor};
use crate::roadmap::Configs;
use crate::scene::LENGTH_MAX;
use crate::seed::Stream;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// All milestones within a radius, as the first PRM has them (Kavraki et al. 1996, §III-A: *"within some
/// predefined distance"*); with `most` the nearest of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Radius {
    /// The largest distance, in the space's metric.
    pub radius: f64,
    /// The most neighbours of a configuration. Within a set there may be more: there both milestones of a pair
    /// have it.
    #[serde(default)]
    pub most: Option<u32>,
}

impl Radius {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(radius: f64) -> Radius {
        Radius { radius, most: None }
    }
}

impl Finder for Radius {
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let Milestones { configs, components, component, but, total } = *milestones;
        // Those that are no neighbours would take the places of others.
        let most = if component.is_some() || but.is_some() { None } else { self.most(total) };
        let mut near = components.in_radius(&cx.space, configs, q, self.radius, most);
        near.retain(|neighbor| milestones.has(neighbor.id));
        near.truncate(self.most(total).unwrap_or(usize::MAX));
        near
    }

    fn near_of_few(
        &self,
        cx: &Context,
        few: &Configs,
        total: usize,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let ids = 0..few.len() as u32;
        neighbor::in_radius(&cx.space, few, ids, q, self.radius, self.most(total))
    }

    fn pairs(
        &self,
        cx: &Context,
        configs: &Configs,
        _chance: &mut Stream,
        _scratch: &mut Scratch,
    ) -> Vec<(u32, u32)> {
        let space = &cx.space;
        let Some(most) = self.most(configs.len()) else {
            return neighbor::radius_graph(space, configs, self.radius);
        };
        // Both relations are symmetric in the distance: a pair is kept where either milestone has it among its
        // nearest.
        let mut pairs = neighbor::k_nearest_graph(space, configs, most);
        let config = |id: u32| configs.get(id as usize);
        pairs.retain(|(a, b)| space.distance(config(*a), config(*b)) <= self.radius);
        pairs
    }

    fn most(&self, _total: usize) -> Option<usize> {
        self.most.map(|most| most as usize)
    }

    fn complaint(&self) -> Option<Complaint> {
        Complaint::of_length("radius", self.radius, LENGTH_MAX)
            .or_else(|| (self.most == Some(0)).then(|| Complaint::new("most", "0", "at least 1")))
    }
}
