//! Roadmaps: configurations, edges, connected components, and the fold that grows them.

mod centre;
mod components;
mod configs;
mod digest;
mod increment;
mod search;

pub use crate::digest::Digest;
pub use components::{Component, Components};
pub use configs::Configs;
pub use increment::{Edge, Increment};
pub use search::{Graph, Route};

use crate::space::Space;
use digest::RoadmapHasher;

/// A roadmap: the milestones and edges of the node sets folded so far, in their order.
///
/// Nodes are numbered in that order from 0; what a node set's own increment calls node `i` is
/// node `first + i` of the roadmap.
#[derive(Clone, Debug)]
pub struct Roadmap {
    configs: Configs,
    edges: Vec<Edge>,
    components: Components,
    sets: u64,
    hasher: RoadmapHasher,
}

impl Roadmap {
    /// The empty roadmap over a space.
    pub fn new(space: &Space) -> Roadmap {
        Roadmap {
            configs: Configs::new(space.len()),
            edges: Vec::new(),
            components: Components::default(),
            sets: 0,
            hasher: RoadmapHasher::new(space.len()),
        }
    }

    /// Folds the next round: its increments in set order, and for each the edges that join it to
    /// the roadmap and to the round's earlier increments (in the numbering of the result).
    pub fn fold_round<'a>(
        &mut self,
        space: &Space,
        sets: impl IntoIterator<Item = (&'a Increment, &'a [Edge])>,
    ) {
        let sets: Vec<_> = sets.into_iter().collect();
        for (increment, joins) in &sets {
            let first = self.configs.len() as u32;
            self.hasher.add_set(first, increment, joins);
            self.components.add_nodes(space, &increment.configs);
            self.configs.extend(&increment.configs);
            for edge in &increment.edges {
                let edge = edge.shifted(first);
                self.components.unite(edge.low, edge.high);
                self.edges.push(edge);
            }
        }
        for (_, joins) in &sets {
            for edge in *joins {
                self.components.unite(edge.low, edge.high);
                self.edges.push(*edge);
            }
        }
        self.sets += sets.len() as u64;
        self.components.refresh_centres(space, &self.configs);
    }

    /// The milestones.
    pub fn configs(&self) -> &Configs {
        &self.configs
    }

    /// The edges: of each round first those inside its increments, then the joining ones, in set
    /// order.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The connected components.
    pub fn components(&self) -> &Components {
        &self.components
    }

    /// Number of node sets folded.
    pub fn sets(&self) -> u64 {
        self.sets
    }

    /// The digest of the roadmap's canonical bytes; `docs/architecture.md` defines them.
    pub fn digest(&self) -> Digest {
        self.hasher.digest()
    }
}
