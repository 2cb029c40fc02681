use super::{Among, JoinInput, default_planners};
use crate::context::Context;
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::neighbor::closest_pairs;
use crate::roadmap::{Component, Configs, Edge};
use crate::validity::Scratch;
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

/// A component of the roadmap or of an earlier increment of the round.
struct Old<'a> {
    distance: f64,
    /// Its name in the numbering of the roadmap after the round.
    name: u32,
    /// What its own node 0 is called in that numbering.
    first: u32,
    configs: &'a Configs,
    component: &'a Component,
}

impl Among for ComponentPairs {
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge> {
        let Some((new, earlier)) = input.increments.split_last() else {
            return Vec::new();
        };
        let mut new_components: Vec<&Component> = new.components.iter().collect();
        new_components.sort_by_key(|component| component.name);
        let before = input.roadmap.configs().len() as u32;
        let new_first = earlier
            .iter()
            .fold(before, |first, built| first + built.increment.configs.len() as u32);

        let mut edges = Vec::new();
        for component in new_components {
            for old in self.nearest(cx, input, component) {
                let pairs = closest_pairs(
                    &cx.space,
                    (&new.increment.configs, &component.members),
                    (old.configs, &old.component.members),
                    self.pairs as usize,
                );
                for pair in pairs {
                    // From the lower id to the higher, as within a set.
                    let ends = (
                        old.configs.get(pair.second as usize),
                        new.increment.configs.get(pair.first as usize),
                    );
                    if let Some((planner, weight)) =
                        local::connect(cx, &self.planners, ends, 1, scratch)
                    {
                        edges.push(Edge {
                            low: old.first + pair.second,
                            high: new_first + pair.first,
                            planner: planner.tag(),
                            weight,
                        });
                    }
                }
            }
        }
        edges
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.components == 0 {
            return Some(("components", "0".to_owned(), "at least 1"));
        }
        if self.pairs == 0 {
            return Some(("pairs", "0".to_owned(), "at least 1"));
        }
        local::complaint(&self.planners)
    }
}

impl ComponentPairs {
    /// The components nearest to `new`, nearest first.
    fn nearest<'a>(&self, cx: &Context, input: &'a JoinInput, new: &Component) -> Vec<Old<'a>> {
        let mut nearest: Vec<Old> = Vec::new();
        let mut offer = |first: u32, configs: &'a Configs, component: &'a Component| {
            let distance = cx.space.distance(&component.centre, &new.centre);
            let name = first + component.name;
            let place = nearest.partition_point(|old| {
                old.distance.total_cmp(&distance).then(old.name.cmp(&name)).is_lt()
            });
            if place < self.components as usize {
                nearest.truncate(self.components as usize - 1);
                nearest.insert(place, Old { distance, name, first, configs, component });
            }
        };
        let roadmap = &input.roadmap;
        for component in roadmap.components().iter() {
            offer(0, roadmap.configs(), component);
        }
        let mut first = roadmap.configs().len() as u32;
        for built in input.increments.iter().rev().skip(1).rev() {
            for component in built.components.iter() {
                offer(first, &built.increment.configs, component);
            }
            first += built.increment.configs.len() as u32;
        }
        nearest
    }
}
