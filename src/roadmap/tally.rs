//! The size and the digest of a roadmap, for those who follow a build without searching the roadmap.

use super::digest::RoadmapHasher;
use super::forest::Forest;
use super::{Digest, Edge, Increment};
use crate::space::Space;

/// How many sets, nodes, edges and components a roadmap has, and its digest.
#[derive(Clone, Debug)]
pub struct Tally {
    sets: u64,
    nodes: usize,
    edges: usize,
    components: usize,
    /// `None` for roadmaps whose digest nobody asks for.
    hasher: Option<RoadmapHasher>,
}

impl Tally {
    /// That of the empty roadmap over a space.
    pub fn new(space: &Space) -> Tally {
        Tally { hasher: Some(RoadmapHasher::new(space.len())), ..Tally::unhashed() }
    }

    /// The same without a digest.
    pub(super) fn unhashed() -> Tally {
        Tally { sets: 0, nodes: 0, edges: 0, components: 0, hasher: None }
    }

    /// Counts and hashes the next set; its components are left to the caller.
    pub(super) fn add_set(&mut self, increment: &Increment, joins: &[Edge]) {
        if let Some(hasher) = &mut self.hasher {
            hasher.add_set(self.nodes as u32, increment, joins);
        }
        self.sets += 1;
        self.nodes += increment.configs.len();
        self.edges += increment.edges.len() + increment.root_edges.len() + joins.len();
    }

    /// Sets the number of components, at the end of a fold.
    pub(super) fn set_components(&mut self, components: usize) {
        if let Some(hasher) = &mut self.hasher {
            hasher.take_in();
        }
        self.components = components;
    }

    /// Number of node sets folded.
    pub fn sets(&self) -> u64 {
        self.sets
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Number of edges.
    pub fn edges(&self) -> usize {
        self.edges
    }

    /// Number of connected components.
    pub fn components(&self) -> usize {
        self.components
    }

    /// The digest of the roadmap's canonical bytes; `docs/architecture.md` defines them.
    ///
    /// # Panics
    /// If it is that of a worker's roadmap, which is not hashed.
    pub fn digest(&self) -> Digest {
        self.hasher.as_ref().expect("a worker's roadmap is not hashed").digest()
    }
}

/// The roadmap as a coordinator keeps it while workers do the searching: its tally and, per node, the four bytes from
/// which the number of components follows.
#[derive(Clone, Debug)]
pub struct Outline {
    tally: Tally,
    forest: Forest,
}

impl Outline {
    /// The outline of the empty roadmap over a space.
    pub fn new(space: &Space) -> Outline {
        Outline { tally: Tally::new(space), forest: Forest::default() }
    }

    /// Folds the next round, as [`super::Roadmap::fold_round`] does.
    pub fn fold_round<'a>(&mut self, sets: impl IntoIterator<Item = (&'a Increment, &'a [Edge])>) {
        let mut components = self.tally.components;
        for (increment, joins) in sets {
            let first = self.tally.nodes as u32;
            self.tally.add_set(increment, joins);
            self.forest.grow(increment.configs.len() as u32);
            components += increment.configs.len();
            let inner = increment.edges.iter().map(|edge| edge.shifted(first));
            let roots = increment.root_edges_from(first);
            for edge in inner.chain(roots).chain(joins.iter().copied()) {
                let [low, high] = self.forest.unite(edge.low, edge.high);
                components -= usize::from(low != high);
            }
        }
        self.tally.set_components(components);
    }

    /// The roadmap's size and digest.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }
}
