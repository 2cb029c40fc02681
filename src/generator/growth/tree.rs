use super::set::{GrowingSet, Place};
use crate::neighbor::{Best, Neighbor, Subset};
use crate::numbers::NodeId;
use crate::roadmap::{Component, Configs};
use crate::seed::Seed;

/// What a set grows from: connected components of the roadmap at the start of the round, and what the set has added to
/// them. Once it has cycles it is a graph, but grows in the same way.
pub(in crate::generator) struct GrowingTree<'a> {
    components: Vec<&'a Component>,
    /// Numbers of the roots that are no nodes, and of milestones of the set, ascending.
    own: Vec<u32>,
}

/// A place near a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::generator) struct Near {
    /// Which one.
    pub number: u32,
    /// Its distance in the space's metric.
    pub distance: f64,
}

impl<'a> GrowingTree<'a> {
    /// A tree of nothing.
    pub fn empty() -> GrowingTree<'a> {
        GrowingTree { components: Vec::new(), own: Vec::new() }
    }

    /// The trees of configurations, each the component of the roadmap that contains the configuration as a node, the one
    /// with the lowest id if several do.
    ///
    /// Where none does, one set of its label makes the configuration a milestone, which then is the tree: the first set, or,
    /// where sets are too small to hold all the configurations, the first that has room. The tree of any other set
    /// begins at the configuration and leaves it to that set to make it a node, so that it comes once per strategy: what
    /// grows from there hangs at no node, and is joined to the rest by the connection among sets.
    pub fn of<const N: usize>(
        set: &mut GrowingSet<'a>,
        seed: &Seed,
        configurations: [&'a [f64]; N],
    ) -> [GrowingTree<'a>; N] {
        let mut trees = [const { GrowingTree { components: Vec::new(), own: Vec::new() } }; N];
        let mut milestones = Vec::new();
        for (index, (tree, q)) in trees.iter_mut().zip(configurations).enumerate() {
            let node = set.frozen.and_then(|frozen| frozen.configs().iter().position(|at| at == q));
            match (set.frozen, node) {
                (Some(frozen), Some(node)) => {
                    tree.components.push(frozen.components().of_node(NodeId(node as u32)));
                }
                _ if seed.ordinal().0 == (index / set.count()) as u64 => milestones.push(index),
                _ => tree.own.push(set.add_root(q)),
            }
        }
        for index in milestones {
            trees[index].own.push(set.add(configurations[index]));
        }
        trees
    }

    /// Takes a milestone of the set in.
    pub fn add(&mut self, number: u32) {
        self.own.push(number);
    }

    /// Takes another tree in.
    pub fn unite(&mut self, other: GrowingTree<'a>) {
        self.components.extend(other.components);
        self.own.extend(other.own);
        self.own.sort_unstable();
    }

    /// Whether both grow from the same component.
    pub fn is_same(&self, other: &GrowingTree) -> bool {
        let mut components = self.components.iter();
        components.any(|own| other.components.iter().any(|theirs| theirs.name == own.name))
    }

    /// Number of its nodes.
    pub fn nodes(&self, set: &GrowingSet) -> usize {
        let old: usize = self.components.iter().map(|component| component.members.len()).sum();
        old + self.own_nodes(set).count()
    }

    /// Whether a configuration is one of its places.
    pub fn has(&self, set: &GrowingSet, q: &[f64]) -> bool {
        let in_component = |component: &&Component| {
            let configs = set.frozen.map(|frozen| frozen.configs());
            let is_there = |node: &u32| configs.is_some_and(|all| all.get(*node as usize) == q);
            component.members.iter().any(is_there)
        };
        self.components.iter().any(in_component)
            || self.own.iter().any(|number| set.config(*number) == q)
    }

    /// The place nearest to a configuration, ties by number; `None` in a tree of nothing.
    pub fn nearest(&self, set: &GrowingSet, q: &[f64]) -> Option<Near> {
        self.near(set, q, 1, self.own.iter().copied()).into_iter().next()
    }

    /// The at most `count` nodes nearest to a configuration, nearest first, ties by number.
    pub fn nearest_nodes(&self, set: &GrowingSet, q: &[f64], count: usize) -> Vec<Near> {
        self.near(set, q, count, self.own_nodes(set))
    }

    fn own_nodes(&self, set: &GrowingSet) -> impl Iterator<Item = u32> {
        self.own.iter().copied().filter(|number| matches!(set.place(*number), Place::New(_)))
    }

    /// The nearest of the components' nodes, by the roadmap's index, and of `own`, of which there are few.
    fn near(
        &self,
        set: &GrowingSet,
        q: &[f64],
        count: usize,
        own: impl Iterator<Item = u32>,
    ) -> Vec<Near> {
        let space = &set.cx.space;
        let mut best: Best<Neighbor> = Best::new(count);
        if let Some(frozen) = set.frozen {
            let mut one = Configs::new(space.len());
            one.push(q);
            let (query, configs) = (Subset { all: &one, ids: &[0] }, frozen.configs());
            for component in &self.components {
                let components = frozen.components();
                let near = components.closest_pairs(space, query, configs, component, count);
                for pair in near {
                    best.offer(Neighbor { distance: pair.distance, id: pair.second });
                }
            }
        }
        for id in own {
            if let Some(distance) = space.distance_unless_above(q, set.config(id), best.bound()) {
                best.offer(Neighbor { distance, id });
            }
        }
        let near = best.into_items().into_iter();
        near.map(|Neighbor { distance, id }| Near { number: id, distance }).collect()
    }
}
