//! Pairs of a new node and an old one near it, for the methods that choose by nodes.

use super::JoinInput;
use crate::context::Context;
use crate::finder::{Finder, KNearest};
use crate::local::{self, Planner};
use crate::model::Scratch;
use crate::roadmap::{Components, Configs, Edge};
use std::collections::BTreeSet;

/// The roadmap, or an earlier increment of the round.
pub(super) struct NodeBlock<'a> {
    /// What its own node 0 is called after the round.
    pub first: u32,
    pub configs: &'a Configs,
    pub components: &'a Components,
}

/// What came before an increment, and the increment.
pub(super) struct CandidatePairs<'a> {
    pub old: Vec<NodeBlock<'a>>,
    pub new: NodeBlock<'a>,
    /// Of an increment that grew from the roadmap: its pairs of a new and an old node that have an edge already.
    linked: BTreeSet<(u32, u32)>,
}

/// A pair to be tried; ids are those after the round.
#[derive(Clone, Copy, Debug)]
pub(super) struct CandidatePair {
    pub distance: f64,
    pub new: u32,
    pub old: u32,
}

impl<'a> CandidatePairs<'a> {
    /// `None` where there is nothing to join.
    pub fn new(input: &'a JoinInput) -> Option<CandidatePairs<'a>> {
        let roadmap = &input.roadmap;
        let (configs, components) = (roadmap.configs(), roadmap.components());
        let mut old = vec![NodeBlock { first: 0, configs, components }];
        let mut first = configs.len() as u32;
        for built in &input.increments {
            let (configs, components) = (&built.increment.configs, &built.components);
            old.push(NodeBlock { first, configs, components });
            first += configs.len() as u32;
        }
        let new = old.pop().filter(|_| !input.increments.is_empty())?;
        let increment = &input.increments[input.increments.len() - 1].increment;
        let linked =
            increment.root_edges_from(new.first).map(|link| (link.high, link.low)).collect();
        Some(CandidatePairs { old, new, linked })
    }

    /// The pairs of an old and a new node that have an edge already.
    pub fn linked(&self) -> impl Iterator<Item = [u32; 2]> {
        self.linked.iter().map(|(new, old)| [*old, *new])
    }

    /// Each new node in order with its `neighbors` nearest old ones, nearest first, ties by id.
    pub fn nearest(&self, cx: &Context, neighbors: u32) -> Vec<CandidatePair> {
        self.found(cx, &KNearest { neighbors })
    }

    /// Each new node in order with the old ones that a finder gives for it, nearest first, ties by id.
    pub fn found(&self, cx: &Context, finder: &dyn Finder) -> Vec<CandidatePair> {
        let mut candidates = Vec::new();
        for (index, q) in self.new.configs.iter().enumerate() {
            let mut near = Vec::new();
            for part in &self.old {
                for mut neighbor in finder.near(&cx.space, part.configs, part.components, q) {
                    neighbor.id += part.first;
                    near.push(neighbor);
                }
            }
            near.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
            near.truncate(finder.most().unwrap_or(usize::MAX));
            let new = self.new.first + index as u32;
            candidates.extend(near.iter().map(|neighbor| CandidatePair {
                distance: neighbor.distance,
                new,
                old: neighbor.id,
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
        if self.linked.contains(&(pair.new, pair.old)) {
            return None;
        }
        let node = |id: u32| (id, self.config(id));
        local::edge(cx, planners, [node(pair.old), node(pair.new)], 1, scratch)
    }

    /// The smallest id in the component of a node, without any joining edge of the round.
    pub fn component(&self, node: u32) -> u32 {
        let part = self.part(node);
        part.first + part.components.of_node(node - part.first).name
    }

    fn config(&self, node: u32) -> &[f64] {
        let part = self.part(node);
        part.configs.get((node - part.first) as usize)
    }

    /// Where a node is from.
    pub fn part(&self, node: u32) -> &NodeBlock<'a> {
        let mut parts = self.old.iter().chain([&self.new]).rev();
        parts.find(|part| part.first <= node).expect("the first part begins at 0")
    }
}
