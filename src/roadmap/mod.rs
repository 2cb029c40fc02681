//! Roadmaps: configurations, edges, connected components, and the fold that grows them.

mod centre;
mod components;
mod digest;
mod edges;
mod finder;
mod forest;
mod increment;
mod search;
mod tally;

pub use crate::digest::Digest;
pub use crate::space::Configs;
pub use components::{Component, Components};
pub use edges::Edges;
pub(crate) use forest::Forest;
pub use increment::{Edge, Increment};
pub use search::{Graph, Route};
pub use tally::{Outline, Tally};

use crate::neighbor::Neighbor;
use crate::shelf::Shelf;
use crate::space::Space;
use std::sync::Arc;

/// A roadmap: the milestones and edges of the node sets folded so far, in their order.
///
/// Nodes are numbered in that order from 0; what a node set's own increment calls node `i` is
/// node `first + i` of the roadmap.
#[derive(Clone, Debug)]
pub struct Roadmap {
    configs: Configs,
    edges: Edges,
    components: Components,
    rounds: Vec<Extent>,
    tally: Tally,
    keeps_edges: bool,
    /// Where what never changes any more goes; with none it stays.
    shelf: Option<Arc<dyn Shelf>>,
}

/// How far a roadmap went at the end of a round: everything before is what it then was, since nodes
/// and edges are only ever appended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// Number of node sets.
    pub sets: u64,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of edges.
    pub edges: usize,
}

impl Roadmap {
    /// The empty roadmap over a space.
    pub fn new(space: &Space) -> Roadmap {
        Roadmap {
            configs: Configs::new(space.len()),
            edges: Edges::default(),
            components: Components::default(),
            rounds: Vec::new(),
            tally: Tally::new(space),
            keeps_edges: true,
            shelf: None,
        }
    }

    /// The same for one of several replicas, which has in common with the others what stands on a shelf, and is
    /// not hashed. Where nothing is judged it can do without edges: [`Roadmap::edges`] and
    /// [`Roadmap::rounds`] stay empty.
    pub fn of_worker(space: &Space, shelf: Arc<dyn Shelf>, keeps_edges: bool) -> Roadmap {
        let components = Components::with_shelf(shelf.clone());
        let tally = Tally::unhashed();
        Roadmap { components, keeps_edges, tally, shelf: Some(shelf), ..Roadmap::new(space) }
    }

    /// Folds the next round: its increments in set order, and for each the edges that join it to
    /// the roadmap and to the round's earlier increments (in the numbering of the result).
    pub fn fold_round<'a>(
        &mut self,
        space: &Space,
        sets: impl IntoIterator<Item = (&'a Increment, &'a [Edge])>,
    ) {
        let sets = sets.into_iter().map(|(increment, joins)| {
            let components = Components::of(space, &increment.configs, &increment.edges);
            (increment, components, joins)
        });
        self.fold_components(space, sets);
    }

    /// [`Roadmap::fold_round`] with the components of each increment, where they are known.
    pub fn fold_components<'a>(
        &mut self,
        space: &Space,
        sets: impl IntoIterator<Item = (&'a Increment, Components, &'a [Edge])>,
    ) {
        let mut joins = Vec::new();
        for (increment, components, edges) in sets {
            let first = self.configs.len() as u32;
            self.tally.add_set(increment, edges);
            self.components.append(components);
            self.configs.extend(&increment.configs);
            if self.keeps_edges {
                self.edges.extend(increment.edges.iter().map(|edge| edge.shifted(first)));
            }
            joins.push(edges);
        }
        for edge in joins.into_iter().flatten() {
            self.components.unite(edge.low, edge.high);
            if self.keeps_edges {
                self.edges.extend([*edge]);
            }
        }
        if let Some(shelf) = &self.shelf {
            self.configs.share_full_blocks(&**shelf);
            self.edges.share_full_blocks(&**shelf);
        }
        if self.keeps_edges {
            self.rounds.push(Extent {
                sets: self.tally.sets(),
                nodes: self.configs.len(),
                edges: self.edges.len(),
            });
        }
        self.components.refresh_centres(space, &self.configs);
        self.tally.set_components(self.components.count());
    }

    /// The at most `k` milestones nearest to `q`, nearest first, ties by id.
    pub fn k_nearest(&self, space: &Space, q: &[f64], k: usize) -> Vec<Neighbor> {
        self.components.k_nearest(space, &self.configs, q, k)
    }

    /// The milestones within a radius of `q`; see [`Components::in_radius`].
    pub fn in_radius(
        &self,
        space: &Space,
        q: &[f64],
        radius: f64,
        most: Option<usize>,
    ) -> Vec<Neighbor> {
        self.components.in_radius(space, &self.configs, q, radius, most)
    }

    /// The milestones.
    pub fn configs(&self) -> &Configs {
        &self.configs
    }

    /// The edges: of each round first those inside its increments, then the joining ones, in set
    /// order.
    pub fn edges(&self) -> &Edges {
        &self.edges
    }

    /// The connected components.
    pub fn components(&self) -> &Components {
        &self.components
    }

    /// Number of node sets folded.
    pub fn sets(&self) -> u64 {
        self.tally.sets()
    }

    /// How far the roadmap went at the end of each round.
    pub fn rounds(&self) -> &[Extent] {
        &self.rounds
    }

    /// The connected components as they were when the roadmap went as far as `extent`.
    pub fn components_at(&self, space: &Space, extent: Extent) -> Components {
        let nodes = self.configs.iter().take(extent.nodes);
        Components::built(space, &self.configs, nodes, self.edges.iter().take(extent.edges))
    }

    /// What the roadmap comes to.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// The digest of the roadmap's canonical bytes; `docs/architecture.md` defines them.
    ///
    /// # Panics
    /// If the roadmap is a worker's.
    pub fn digest(&self) -> Digest {
        self.tally.digest()
    }
}

#[cfg(test)]
mod tests;
