//! Searches for the nodes and components near a configuration, by indices that are built when they pay.
//!
//! Searches return what brute force returns, so no result depends on whether there is an index. The indices are
//! built by searches; processes that never search (a coordinator, a reader of ledgers) never build one.

use super::component::Component;
use super::components::Components;
use super::indices::{Centres, NO_ENTRY, TAIL, read};
use crate::neighbor::{self, Best, Index, NearPair, Neighbor, Searched, Subset};
use crate::numbers::NodeId;
use crate::space::{Configs, Space};
use std::sync::RwLockReadGuard;
use std::sync::atomic::Ordering;

/// As soon as there are more new nodes they are added to the index after this many searches, which together cost
/// about as much as adding them.
const SEARCHES: u32 = 32;
/// Components with at most this many nodes are searched by brute force.
const FEW_MEMBERS: usize = 256;
/// At most this many components are searched by brute force.
const FEW_COMPONENTS: usize = 64;

/// Searches of nodes and components. Distances are those of [`Space::distance`], `configs` are those of the graph's
/// nodes, queries are in stored form. The ids of what is found are the integers in those of the nodes.
impl Components {
    /// The at most `k` of the graph's nodes nearest to `q`, nearest first, ties by id.
    pub fn k_nearest(
        &self,
        space: &Space,
        configs: &Configs,
        q: &[f64],
        k: usize,
    ) -> Vec<Neighbor> {
        if self.nodes() < TAIL {
            return neighbor::k_nearest(space, configs, 0..self.nodes(), q, k);
        }
        let index = self.index(space, configs, 1);
        let index = index.as_ref().expect("made");
        index.k_nearest(space, &All(configs), self.nodes(), q, k)
    }

    /// The graph's nodes within a radius of `q`: all whose distance to `q` is at most `radius`, a length in the scene's
    /// unit, nearest first, ties by id. With `most`, at most that many, the nearest ones. There are none if the
    /// radius is negative or not a number; an infinite radius has all nodes in it.
    pub fn in_radius(
        &self,
        space: &Space,
        configs: &Configs,
        q: &[f64],
        radius: f64,
        most: Option<usize>,
    ) -> Vec<Neighbor> {
        if self.nodes() < TAIL {
            return neighbor::in_radius(space, configs, 0..self.nodes(), q, radius, most);
        }
        let index = self.index(space, configs, 1);
        let index = index.as_ref().expect("made");
        index.in_radius(space, &All(configs), self.nodes(), q, radius, most)
    }

    /// The at most `count` closest pairs of a configuration of `first` and a node of `component`. Closest first, ties by
    /// the first id, then by the second.
    pub fn closest_pairs(
        &self,
        space: &Space,
        first: Subset,
        configs: &Configs,
        component: &Component,
        count: usize,
    ) -> Vec<NearPair> {
        let members = Subset { all: configs, ids: &component.members };
        let brute = || neighbor::closest_pairs(space, first, members, count);
        if component.members.len() <= FEW_MEMBERS {
            return brute();
        }
        let index = self.index(space, configs, first.ids.len() as u32);
        let index = index.as_ref().expect("made");
        if component.members.len() <= (self.nodes() - index.len()) as usize {
            return brute();
        }
        let members = Members { configs, components: self, slot: self.slot_of(component.name) };
        index.closest_pairs(space, first, &members, self.nodes(), count)
    }

    /// The node of `component` nearest to `q` among those for which `is_meant` says so, ties by id.
    pub fn nearest_member(
        &self,
        space: &Space,
        configs: &Configs,
        component: &Component,
        q: &[f64],
        is_meant: impl Fn(NodeId) -> bool,
    ) -> Option<Neighbor> {
        let meant = |id: &u32| is_meant(NodeId(*id));
        let brute = || {
            let ids = component.members.iter().copied().filter(meant);
            neighbor::k_nearest(space, configs, ids, q, 1).into_iter().next()
        };
        if component.members.len() <= FEW_MEMBERS {
            return brute();
        }
        let index = self.index(space, configs, 1);
        let index = index.as_ref().expect("made");
        if component.members.len() <= (self.nodes() - index.len()) as usize {
            return brute();
        }
        let members = Members { configs, components: self, slot: self.slot_of(component.name) };
        let meant = Meant { members, is_meant };
        index.k_nearest(space, &meant, self.nodes(), q, 1).into_iter().next()
    }

    /// The at most `count` components whose centres are nearest to `centre`, nearest first, ties by name. The id of
    /// each is the integer in its component's name.
    pub fn nearest(&self, space: &Space, centre: &[f64], count: usize) -> Vec<Neighbor> {
        let mut best = Best::new(count);
        let mut offer = |component: &Component| {
            let bound = best.bound();
            if let Some(distance) = space.distance_unless_above(centre, &component.centre, bound) {
                best.offer(Neighbor { distance, id: component.name.0 });
            }
        };
        if self.count() <= FEW_COMPONENTS {
            self.iter().for_each(offer);
            return best.into_items();
        }
        if read(&self.indices.centres).is_none() {
            let mut centres = self.indices.centres.write().expect("no search panics");
            centres.get_or_insert_with(|| Centres::new(space, self.slots()));
        }
        let centres = read(&self.indices.centres);
        let centres = centres.as_ref().expect("made");
        centres
            .unindexed
            .iter()
            .filter_map(|slot| self.slots()[*slot as usize].as_ref())
            .for_each(&mut offer);
        let entries = Entries { centres, slots: self.slots() };
        let end = centres.slots.len() as u32;
        for near in centres.index.k_nearest(space, &entries, end, centre, count) {
            best.offer(near);
        }
        best.into_items()
    }

    /// The index of the nodes, about to be searched by `searches` queries. It may lack the last nodes.
    fn index(
        &self,
        space: &Space,
        configs: &Configs,
        searches: u32,
    ) -> RwLockReadGuard<'_, Option<Index>> {
        let lacks = |index: &Option<Index>| self.nodes() - index.as_ref().map_or(0, Index::len);
        let indices = &self.indices;
        let index = read(&indices.nodes);
        let before = indices.searches.fetch_add(searches, Ordering::Relaxed);
        let wanted = lacks(&index) >= TAIL && before.saturating_add(searches) >= SEARCHES;
        if index.is_some() && !wanted {
            return index;
        }
        drop(index);
        let mut index = indices.nodes.write().expect("no search panics");
        let made = index.get_or_insert_with(|| Index::with_shelf(space, indices.shelf.clone()));
        if wanted {
            made.extend(
                self.nodes(),
                |node| configs.get(node as usize),
                |node| self.slot_of(NodeId(node)),
            );
            indices.searches.store(0, Ordering::Relaxed);
        }
        drop(index);
        read(&indices.nodes)
    }
}

/// All nodes of a graph.
struct All<'a>(&'a Configs);

impl Searched for All<'_> {
    fn config(&self, node: u32) -> &[f64] {
        self.0.get(node as usize)
    }
}

/// The nodes of one component.
struct Members<'a> {
    configs: &'a Configs,
    components: &'a Components,
    slot: u32,
}

impl Searched for Members<'_> {
    fn config(&self, node: u32) -> &[f64] {
        self.configs.get(node as usize)
    }

    fn is_eligible(&self, node: u32) -> bool {
        self.components.slot_of(NodeId(node)) == self.slot
    }

    fn label_is_eligible(&self, node: u32) -> Option<bool> {
        Some(self.is_eligible(node))
    }
}

/// Those nodes of one component that are meant.
struct Meant<'a, F> {
    members: Members<'a>,
    is_meant: F,
}

impl<F: Fn(NodeId) -> bool> Searched for Meant<'_, F> {
    fn config(&self, node: u32) -> &[f64] {
        self.members.config(node)
    }

    fn is_eligible(&self, node: u32) -> bool {
        self.members.is_eligible(node) && (self.is_meant)(NodeId(node))
    }

    fn label_is_eligible(&self, node: u32) -> Option<bool> {
        Some(false).filter(|_| !self.members.is_eligible(node))
    }
}

/// The current entries, under the names of their components.
struct Entries<'a> {
    centres: &'a Centres,
    slots: &'a [Option<Component>],
}

impl Entries<'_> {
    fn component(&self, entry: u32) -> Option<&Component> {
        self.slots[self.centres.slots[entry as usize] as usize].as_ref()
    }
}

impl Searched for Entries<'_> {
    fn config(&self, entry: u32) -> &[f64] {
        self.component(entry).map_or(&self.centres.nowhere, |component| &component.centre)
    }

    fn is_eligible(&self, entry: u32) -> bool {
        let slot = self.centres.slots[entry as usize];
        self.centres.entry_of[slot as usize] == entry && self.slots[slot as usize].is_some()
    }

    fn name(&self, entry: u32) -> u32 {
        self.component(entry).map_or(NO_ENTRY, |component| component.name.0)
    }
}
