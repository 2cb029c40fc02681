//! Pairs of a new node and an old one near it, for the methods that choose by nodes.

use super::JoinInput;
use super::joined::Joined;
use crate::context::Context;
use crate::finder::{Finder, KNearest, Milestones};
use crate::local::{self, Planner};
use crate::model::Scratch;
use crate::neighbor::{Best, Neighbor, Subset};
use crate::numbers::NodeId;
use crate::roadmap::{Component, Components, Configs, Edge};
use crate::seed::{Purpose, Seed, Stream};
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// The roadmap, or an earlier increment of the round.
pub(super) struct NodeBlock<'a> {
    /// What its own node 0 is called after the round.
    pub first: NodeId,
    pub configs: &'a Configs,
    pub components: &'a Components,
}

impl NodeBlock<'_> {
    /// A node of the block, numbered within the block.
    pub fn own(&self, node: NodeId) -> NodeId {
        NodeId(node.since(self.first))
    }
}

/// What came before an increment, and the increment.
pub(super) struct CandidatePairs<'a> {
    pub old: Vec<NodeBlock<'a>>,
    pub new: NodeBlock<'a>,
    /// Of an increment that grew from the roadmap: its pairs of a new and an old node that have an edge already.
    linked: BTreeSet<NodePair>,
    /// The seed of the set that the increment is.
    seed: Seed,
}

/// A pair to be tried; ids are those after the round.
#[derive(Clone, Copy, Debug)]
pub(super) struct CandidatePair {
    /// The distance by what found the pair, which orders pairs: the space's, or a finder's own. It is no edge's cost.
    pub distance: f64,
    pub new: NodeId,
    pub old: NodeId,
}

/// The nodes of a pair; ids are those after the round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct NodePair {
    new: NodeId,
    old: NodeId,
}

impl CandidatePair {
    /// Orders pairs by distance, ties by the new and then the old node's id.
    pub fn closest_first(&self, other: &CandidatePair) -> Ordering {
        let ids = |pair: &CandidatePair| (pair.new, pair.old);
        self.distance.total_cmp(&other.distance).then_with(|| ids(self).cmp(&ids(other)))
    }
}

impl<'a> CandidatePairs<'a> {
    /// `None` where there is nothing to join.
    pub fn new(input: &'a JoinInput) -> Option<CandidatePairs<'a>> {
        let roadmap = &input.roadmap;
        let (configs, components) = (roadmap.configs(), roadmap.components());
        let mut old = vec![NodeBlock { first: NodeId(0), configs, components }];
        let mut first = NodeId(configs.len() as u32);
        for built in &input.increments {
            let (configs, components) = (&built.increment.configs, &built.components);
            old.push(NodeBlock { first, configs, components });
            first = first + configs.len() as u32;
        }
        let new = old.pop().filter(|_| !input.increments.is_empty())?;
        let increment = &input.increments[input.increments.len() - 1].increment;
        let linked = increment
            .root_edges_from(new.first.0)
            .map(|link| NodePair { new: link.high, old: link.low });
        let linked = linked.collect();
        Some(CandidatePairs { old, new, linked, seed: input.seed })
    }

    /// Which components are joined before any pair is tried: those that root edges of a growing set join.
    pub fn joined(&self) -> Joined {
        let mut joined = Joined::default();
        for pair in &self.linked {
            joined.unite([pair.old, pair.new].map(|node| self.component(node)));
        }
        joined
    }

    /// Each new node in order with its `neighbors` nearest old ones, nearest first, ties by id.
    pub fn nearest(
        &self,
        cx: &Context,
        neighbors: u32,
        scratch: &mut Scratch,
    ) -> Vec<CandidatePair> {
        // It leaves nothing to chance.
        let chance = &mut self.seed.stream(Purpose::Joining);
        self.found(cx, &KNearest { neighbors: neighbors.into() }, chance, scratch)
    }

    /// Each new node in order with the old ones that a finder gives for it, nearest first, ties by id. What is left to chance
    /// `chance` decides.
    pub fn found(
        &self,
        cx: &Context,
        finder: &dyn Finder,
        chance: &mut Stream,
        scratch: &mut Scratch,
    ) -> Vec<CandidatePair> {
        let total = self.old.iter().map(|part| part.configs.len()).sum();
        let most = finder.most(total).unwrap_or(usize::MAX);
        let mut candidates = Vec::new();
        for (index, q) in self.new.configs.iter().enumerate() {
            let mut near = Vec::new();
            for part in &self.old {
                let all = Milestones::all(part.configs, part.components);
                let part_of = Milestones { total, ..all };
                for mut neighbor in finder.near(cx, &part_of, q, scratch) {
                    neighbor.id += part.first.0;
                    near.push(neighbor);
                }
            }
            near.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
            near.truncate(most);
            finder.choose(&mut near, total, chance);
            let new = self.new.first + index as u32;
            candidates.extend(near.iter().map(|neighbor| CandidatePair {
                distance: neighbor.distance,
                new,
                old: NodeId(neighbor.id),
            }));
        }
        candidates
    }

    /// Tries a pair, from the old node to the new.
    pub fn connect(
        &self,
        cx: &Context,
        planners: &[Planner],
        pair: CandidatePair,
        scratch: &mut Scratch,
    ) -> Option<Edge> {
        if self.linked.contains(&NodePair { new: pair.new, old: pair.old }) {
            return None;
        }
        let node = |id: NodeId| (id, self.config(id));
        local::edge(cx, planners, [node(pair.old), node(pair.new)], 1, scratch)
    }

    /// The smallest id in the component of a node, without any joining edge of the round.
    pub fn component(&self, node: NodeId) -> NodeId {
        let part = self.part(node);
        part.first + part.components.of_node(part.own(node)).name.0
    }

    /// The components, see [`CandidatePairs::component`], of a pair's two nodes.
    pub fn components(&self, pair: CandidatePair) -> [NodeId; 2] {
        [pair.old, pair.new].map(|node| self.component(node))
    }

    /// The old components whose centres are nearest to that of a new one, nearest first, ties by name: at most
    /// `count` of the roadmap's and then at most `count` of the round's earlier increments. The two are
    /// chosen apart, since the components of a round's increments, which are small and lie everywhere, would
    /// else take the places of the roadmap's, and a set that is joined to its round only is joined to little.
    pub fn nearest_components(&self, cx: &Context, new: &Component, count: usize) -> Vec<NodeId> {
        let mut nearest = Vec::new();
        let (roadmap, increments) = self.old.split_at(1);
        for blocks in [roadmap, increments] {
            let mut best = Best::new(count);
            for block in blocks {
                for near in block.components.nearest(&cx.space, &new.centre, count) {
                    best.offer(Neighbor { id: block.first.0 + near.id, ..near });
                }
            }
            nearest.extend(best.into_items().into_iter().map(|near| NodeId(near.id)));
        }
        nearest
    }

    /// The at most `count` closest pairs of a new component's nodes and those of the old component of a name, closest
    /// first.
    pub fn closest_pairs(
        &self,
        cx: &Context,
        new: &Component,
        old: NodeId,
        count: usize,
    ) -> Vec<CandidatePair> {
        let block = self.part(old);
        let component = block.components.of_node(block.own(old));
        let first = Subset { all: self.new.configs, ids: &new.members };
        let configs = block.configs;
        let pairs = block.components.closest_pairs(&cx.space, first, configs, component, count);
        let named = pairs.into_iter().map(|pair| CandidatePair {
            distance: pair.distance,
            new: self.new.first + pair.first,
            old: block.first + pair.second,
        });
        named.collect()
    }

    /// The components of the new increment, in the order of their smallest ids.
    pub fn new_components(&self) -> Vec<&'a Component> {
        let mut components: Vec<&Component> = self.new.components.iter().collect();
        components.sort_by_key(|component| component.name);
        components
    }

    fn config(&self, node: NodeId) -> &[f64] {
        let part = self.part(node);
        part.configs.get(part.own(node).index())
    }

    /// Where a node is from.
    pub fn part(&self, node: NodeId) -> &NodeBlock<'a> {
        let mut parts = self.old.iter().chain([&self.new]).rev();
        parts.find(|part| part.first <= node).expect("the first part begins at 0")
    }
}
