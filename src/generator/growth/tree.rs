use super::extent::Extent;
use super::set::{Extension, GrowingSet};
use crate::finder::{Finder, Milestones};
use crate::neighbor::{Best, Neighbor, Ranked, Subset};
use crate::numbers::NodeId;
use crate::roadmap::{Component, Configs};
use crate::seed::Seed;

/// What a set grows from: connected components of the roadmap at the start of the round, and what the set has added to
/// them. Once it has cycles it is a graph, but grows in the same way.
pub(in crate::generator) struct GrowingTree<'a> {
    components: Vec<&'a Component>,
    /// Numbers of the roots that are no nodes, and of milestones of the set, ascending.
    own: Vec<u32>,
    /// What its places cover, where the set draws from the box around it.
    extent: Extent,
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
        GrowingTree { components: Vec::new(), own: Vec::new(), extent: Extent::default() }
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
        let mut trees: [GrowingTree<'a>; N] = std::array::from_fn(|_| GrowingTree::empty());
        let mut milestones = Vec::new();
        for (index, (tree, q)) in trees.iter_mut().zip(configurations).enumerate() {
            let node = set.frozen.and_then(|frozen| frozen.configs().iter().position(|at| at == q));
            match (set.frozen, node) {
                (Some(frozen), Some(node)) => {
                    tree.components.push(frozen.components().of_node(NodeId(node as u32)));
                    // An end need not have grown.
                    tree.own.extend(set.grown_only.then_some(node as u32));
                }
                _ if seed.ordinal().0 == (index / set.count()) as u64 => milestones.push(index),
                _ => tree.own.push(set.add_root(q)),
            }
        }
        for index in milestones {
            trees[index].own.push(set.add(configurations[index]));
        }
        trees.iter_mut().for_each(|tree| tree.cover_all(set));
        trees
    }

    /// The component of a node of the roadmap at the start of the round.
    pub fn of_node(set: &GrowingSet<'a>, node: NodeId) -> GrowingTree<'a> {
        let component = set.frozen.map(|frozen| frozen.components().of_node(node));
        let components = component.into_iter().collect();
        let mut tree = GrowingTree { components, ..GrowingTree::empty() };
        tree.cover_all(set);
        tree
    }

    /// Finds what its places cover, if that is going to be asked for.
    fn cover_all(&mut self, set: &GrowingSet) {
        if set.nearby > 0.0 {
            let old = self.components.iter().flat_map(|component| component.members.iter());
            let old = old.filter(|node| set.may_extend(NodeId(**node)));
            for number in old.chain(&self.own) {
                self.extent.cover(&set.cx.space, set.config(*number));
            }
        }
    }

    /// Takes a milestone of the set in.
    pub fn add(&mut self, set: &GrowingSet, number: u32) {
        self.own.push(number);
        if set.nearby > 0.0 {
            self.extent.cover(&set.cx.space, set.config(number));
        }
    }

    /// Extends the tree from one of its places toward a configuration, and takes in all milestones that come of it.
    pub fn extend(&mut self, set: &mut GrowingSet, from: Near, toward: &[f64]) -> Extension {
        let first = set.next_number();
        let extension = set.extend(from, toward);
        (first..set.next_number()).for_each(|number| self.add(set, number));
        extension
    }

    /// A configuration, valid or not, toward which it is to be extended.
    pub fn draw(&self, set: &mut GrowingSet) -> Vec<f64> {
        set.draw_around(&self.extent)
    }

    /// Takes another tree in.
    pub fn unite(&mut self, other: GrowingTree<'a>) {
        self.components.extend(other.components);
        self.own.extend(other.own);
        self.own.sort_unstable();
        self.extent.unite(&other.extent);
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
        let space = &set.cx.space;
        let mut best: Best<Neighbor> = Best::new(1);
        if let Some(frozen) = set.frozen.filter(|_| set.grown_only) {
            let (configs, components) = (frozen.configs(), frozen.components());
            let is_meant = |node| set.may_extend(node);
            for component in &self.components {
                let near = components.nearest_member(space, configs, component, q, is_meant);
                near.into_iter().for_each(|near| best.offer(near));
            }
        } else if let Some(frozen) = set.frozen {
            let mut one = Configs::new(space.len());
            one.push(q);
            let (query, configs) = (Subset { all: &one, ids: &[0] }, frozen.configs());
            for component in &self.components {
                let components = frozen.components();
                for pair in components.closest_pairs(space, query, configs, component, 1) {
                    best.offer(Neighbor { distance: pair.distance, id: pair.second });
                }
            }
        }
        for id in self.own.iter().copied() {
            if let Some(distance) = space.distance_unless_above(q, set.config(id), best.bound()) {
                best.offer(Neighbor { distance, id });
            }
        }
        let nearest = best.into_items().into_iter().next();
        nearest.map(|Neighbor { distance, id }| Near { number: id, distance })
    }

    /// The nodes that a finder gives for a configuration, nearest first, ties by number; `total` is the number of nodes.
    pub fn near_nodes(
        &self,
        set: &mut GrowingSet,
        finder: &dyn Finder,
        total: usize,
        q: &[f64],
    ) -> Vec<Neighbor> {
        let own: Vec<u32> = self.own_nodes(set).collect();
        let mut near = self.near_of_few(set, finder, total, q, &own);
        if let Some(frozen) = set.frozen {
            for component in &self.components {
                let (configs, components) = (frozen.configs(), frozen.components());
                let all = Milestones::all(configs, components);
                let milestones = Milestones { component: Some(component), total, ..all };
                near.extend(finder.near(set.cx, &milestones, q, set.scratch));
            }
        }
        near.sort_by(Ranked::rank);
        near
    }

    /// The same among a few places, by looking at all; their numbers ascend.
    pub fn near_of_few(
        &self,
        set: &mut GrowingSet,
        finder: &dyn Finder,
        total: usize,
        q: &[f64],
        numbers: &[u32],
    ) -> Vec<Neighbor> {
        let mut few = Configs::new(q.len());
        numbers.iter().for_each(|number| few.push(set.config(*number)));
        let near = finder.near_of_few(set.cx, &few, total, q, set.scratch).into_iter();
        near.map(|neighbor| Neighbor { id: numbers[neighbor.id as usize], ..neighbor }).collect()
    }

    fn own_nodes(&self, set: &GrowingSet) -> impl Iterator<Item = u32> {
        self.own.iter().copied().filter(|number| set.is_node(*number))
    }
}
