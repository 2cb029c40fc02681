//! Roadmaps: configurations, edges, connected components, and the fold that grows them.

pub(crate) mod bidirectional;
mod centre;
mod component;
mod components;
mod digest;
mod edges;
mod encoding;
mod forest;
mod grown;
mod increment;
mod indices;
pub(crate) mod landmarks;
mod round;
mod search;
mod searches;
mod shapes;
mod tally;
mod tree_searches;
mod trees;

pub use crate::digest::Digest;
pub use crate::space::Configs;
pub use component::Component;
pub use components::Components;
pub use edges::Edges;
pub use encoding::Full;
pub(crate) use forest::Forest;
pub use grown::Grown;
pub use increment::{Edge, EdgeCost, Increment, SetForm};
pub use round::{Joined, Round, RoundSet};
pub use search::{Graph, Route};
pub use shapes::Shapes;
pub use tally::{Outline, Tally};
pub use trees::Rank;
pub(crate) use trees::{Tree, Value};

use crate::neighbor::Neighbor;
use crate::numbers::NodeId;
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
    /// The numbers that the model gives every milestone.
    values: Vec<f64>,
    rounds: Vec<Extent>,
    grown: Grown,
    tally: Tally,
    keeps_edges: bool,
    /// Where full blocks of nodes and edges, which never change any more, are kept for all replicas; `None` keeps
    /// everything in this roadmap.
    shelf: Option<Arc<dyn Shelf>>,
}

/// The size of a roadmap at the end of a round. Since nodes and edges are only ever appended, the first `nodes` nodes
/// and the first `edges` edges are the roadmap as it then was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// Number of node sets.
    pub sets: u64,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of edges.
    pub edges: usize,
}

/// What a fold takes of a set.
pub struct SetToFold<'a> {
    /// What the set adds.
    pub increment: &'a Increment,
    /// The connected components of the increment alone.
    pub components: Components,
    /// The edges that join the set to what came before it, in the numbering of the result.
    pub joins: &'a [Edge],
}

impl Roadmap {
    /// The empty roadmap over a space.
    pub fn new(space: &Space) -> Roadmap {
        Roadmap {
            configs: Configs::new(space.len()),
            edges: Edges::default(),
            components: Components::default(),
            values: Vec::new(),
            rounds: Vec::new(),
            grown: Grown::default(),
            tally: Tally::new(space),
            keeps_edges: true,
            shelf: None,
        }
    }

    /// The empty roadmap of a worker, which is one of several replicas: they share what is on the shelf, and compute
    /// no digest. A worker that evaluates nothing needs no edges (`keeps_edges`): [`Roadmap::edges`] and
    /// [`Roadmap::rounds`] then stay empty.
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
            SetToFold { increment, components, joins }
        });
        self.fold_components(space, sets);
    }

    /// [`Roadmap::fold_round`] with the components of each increment, where they are known.
    pub fn fold_components<'a>(
        &mut self,
        space: &Space,
        sets: impl IntoIterator<Item = SetToFold<'a>>,
    ) {
        let mut joins = Vec::new();
        for SetToFold { increment, components, joins: edges } in sets {
            let first = self.configs.len() as u32;
            self.tally.add_set(increment, edges);
            self.grown.add_set(increment);
            self.components.append(components);
            self.configs.extend(&increment.configs);
            if self.keeps_edges {
                self.edges.extend(increment.edges.iter().map(|edge| edge.shifted(first)));
                self.edges.extend(increment.root_edges_from(first));
            }
            self.values.extend_from_slice(&increment.values);
            for link in increment.root_edges_from(first) {
                self.components.unite(link.low, link.high);
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

    /// The at most `k` milestones nearest to `q`, nearest first, ties by id. The ids of what is found are the integers
    /// in the [`NodeId`]s.
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

    /// The ids of all nodes, in order.
    pub fn nodes(&self) -> impl Iterator<Item = NodeId> + use<> {
        NodeId::each(NodeId(0)..NodeId(self.configs.len() as u32))
    }

    /// The milestones; the one of a node stands at the [index](NodeId::index) of its id.
    pub fn configs(&self) -> &Configs {
        &self.configs
    }

    /// The edges: of each round first those inside its increments, each followed by the edges by which the
    /// increment grew from older nodes, then the joining ones, in set order.
    pub fn edges(&self) -> &Edges {
        &self.edges
    }

    /// The numbers that the model gives every milestone, milestone after milestone; see
    /// [`Model::node_values`](crate::model::Model::node_values).
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The `count` numbers that the model gives the milestone `node`.
    pub fn values_of(&self, node: NodeId, count: usize) -> &[f64] {
        &self.values[node.index() * count..(node.index() + 1) * count]
    }

    /// The connected components.
    pub fn components(&self) -> &Components {
        &self.components
    }

    /// Number of node sets folded.
    pub fn sets(&self) -> u64 {
        self.tally.sets()
    }

    /// How far the roadmap goes now.
    pub fn extent(&self) -> Extent {
        let (nodes, edges) = (self.configs.len(), self.edges.len());
        Extent { sets: self.sets(), nodes, edges }
    }

    /// Which nodes are of sets that grew from what was there.
    pub fn grown(&self) -> &Grown {
        &self.grown
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

    /// The roadmap's size and digest.
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
