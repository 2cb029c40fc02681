use super::{Within, default_planners};
use crate::context::Context;
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::neighbor::{Candidates, Index, k_nearest};
use crate::roadmap::{Configs, Edge};
use crate::seed::Seed;
use crate::space::Space;
use crate::validity::Scratch;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Each milestone with its `neighbors` nearest of the set: TR05-007 §4.1, *"we only attempt to
/// connect the 10 nearest neighbors"*. The pairs are the union of the directed k-nearest
/// relations, each once, in ascending order, tried from the lower to the higher id.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Nearest {
    /// How many neighbours of each milestone.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

fn default_neighbors() -> u32 {
    10
}

impl Default for Nearest {
    fn default() -> Nearest {
        Nearest { neighbors: default_neighbors(), planners: default_planners() }
    }
}

impl Within for Nearest {
    fn connect(
        &self,
        cx: &Context,
        _seed: &Seed,
        configs: &Configs,
        scratch: &mut Scratch,
    ) -> Vec<Edge> {
        let pairs = pairs(&cx.space, configs, self.neighbors as usize);
        let mut edges = Vec::new();
        for (low, high) in pairs {
            let ends = (configs.get(low as usize), configs.get(high as usize));
            if let Some((planner, weight)) = local::connect(cx, &self.planners, ends, 1, scratch) {
                edges.push(Edge { low, high, planner: planner.tag(), weight });
            }
        }
        edges
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.neighbors == 0 {
            return Some(("neighbors", "0".to_owned(), "at least 1"));
        }
        local::complaint(&self.planners)
    }
}

/// Fewer configurations than this are searched faster one by one.
const INDEXED_MIN: u32 = 200;

/// The pairs of each configuration and its `k` nearest, lower id first, in ascending order.
fn pairs(space: &Space, configs: &Configs, k: usize) -> Vec<(u32, u32)> {
    let count = configs.len() as u32;
    let mut index = Index::new(space);
    if count >= INDEXED_MIN {
        index.extend(count, |node| configs.get(node as usize), |_| 0);
    }
    let mut pairs = Vec::with_capacity(configs.len() * k.min(configs.len()));
    for (node, q) in (0..count).zip(configs.iter()) {
        let near = if index.is_empty() {
            let others = (0..count).filter(|other| *other != node);
            k_nearest(space, configs, others, q, k)
        } else {
            index.k_nearest(space, &Others { configs, node }, count, q, k)
        };
        for near in near {
            pairs.push((node.min(near.id), node.max(near.id)));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// All configurations but one.
struct Others<'a> {
    configs: &'a Configs,
    node: u32,
}

impl Candidates for Others<'_> {
    fn config(&self, id: u32) -> &[f64] {
        self.configs.get(id as usize)
    }

    fn counts(&self, id: u32) -> bool {
        id != self.node
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::Purpose;
    use crate::space::{Motion, rigid_space};
    use std::collections::BTreeSet;

    #[test]
    fn pairs_are_the_union_of_the_directed_neighbours() {
        let space = rigid_space(Motion::Rigid3d, [0.0; 3], [3.0; 3], 0.5);
        let mut stream = Seed::of_set(1, "pairs", 0).stream(Purpose::Sampling);
        let mut q = vec![0.0; space.len()];
        for count in [0, 1, 2, 9, INDEXED_MIN - 1, INDEXED_MIN, 3 * INDEXED_MIN] {
            let mut configs = Configs::new(space.len());
            for i in 0..count {
                if i % 5 != 4 {
                    space.sample_uniform(&mut stream, &mut q);
                }
                configs.push(&q);
            }
            let mut expected = BTreeSet::new();
            for node in 0..count {
                let others = (0..count).filter(|other| *other != node);
                for near in k_nearest(&space, &configs, others, configs.get(node as usize), 7) {
                    expected.insert((node.min(near.id), node.max(near.id)));
                }
            }
            assert_eq!(pairs(&space, &configs, 7), Vec::from_iter(expected));
        }
    }
}
