//! Searches for the nodes and components near a configuration, by indices that are built when they pay.
//!
//! Searches return what brute force returns, so no result depends on whether there is an index. The indices are
//! built by searches; processes that never search (a coordinator, a reader of ledgers) never build one.

use super::components::{Component, Components};
use crate::neighbor::{self, Best, Index, NearPair, Neighbor, Searched};
use crate::shelf::Shelf;
use crate::space::{Configs, Space};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, RwLock, RwLockReadGuard};

/// Fewer new nodes than this are searched without a tree.
const TAIL: u32 = 128;
/// As soon as there are more new nodes they are added to the index after this many searches, which together cost
/// about as much as adding them.
const SEARCHES: u32 = 32;
/// Components with at most this many nodes are searched by brute force.
const FEW_MEMBERS: usize = 256;
/// At most this many components are searched by brute force.
const FEW_COMPONENTS: usize = 64;
/// Stands in place of an entry where a slot has none.
const NONE: u32 = u32::MAX;

/// The indices of a graph's nodes and of its components' centres. Each is missing until a search builds it.
#[derive(Debug, Default)]
pub(super) struct Finder {
    nodes: RwLock<Option<Index>>,
    shelf: Option<Arc<dyn Shelf>>,
    /// Number of searches of nodes since the index last grew.
    searches: AtomicU32,
    centres: RwLock<Option<Centres>>,
}

impl Clone for Finder {
    fn clone(&self) -> Finder {
        Finder {
            nodes: RwLock::new(read(&self.nodes).clone()),
            shelf: self.shelf.clone(),
            searches: AtomicU32::new(self.searches.load(Ordering::Relaxed)),
            centres: RwLock::new(read(&self.centres).clone()),
        }
    }
}

fn read<T>(lock: &RwLock<T>) -> RwLockReadGuard<'_, T> {
    lock.read().expect("no search panics")
}

impl Finder {
    /// A finder whose index of nodes shares segments with others on a shelf.
    pub(super) fn with_shelf(shelf: Arc<dyn Shelf>) -> Finder {
        Finder { shelf: Some(shelf), ..Finder::default() }
    }

    /// Updates the index of centres after a fold. `changed` are the slots, ascending, whose component is new, gone
    /// or has a new centre.
    pub(super) fn centres_changed(&mut self, slots: &[Option<Component>], changed: &[u32]) {
        if let Some(centres) = self.centres.get_mut().expect("no search panics") {
            centres.update(slots, changed);
        }
    }
}

/// Searches of nodes and components. Distances are those of [`Space::distance`], `configs` are those of the graph's
/// nodes, queries are in stored form.
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

    /// The at most `count` closest pairs of a configuration of `first`, given with the ids that take part, and a node
    /// of `component`. Closest first, ties by the first id, then by the second.
    pub fn closest_pairs(
        &self,
        space: &Space,
        first: (&Configs, &[u32]),
        (configs, component): (&Configs, &Component),
        count: usize,
    ) -> Vec<NearPair> {
        let brute = || neighbor::closest_pairs(space, first, (configs, &component.members), count);
        if component.members.len() <= FEW_MEMBERS {
            return brute();
        }
        let index = self.index(space, configs, first.1.len() as u32);
        let index = index.as_ref().expect("made");
        if component.members.len() <= (self.nodes() - index.len()) as usize {
            return brute();
        }
        let members = Members { configs, components: self, slot: self.slot_of(component.name) };
        index.closest_pairs(space, first, &members, self.nodes(), count)
    }

    /// The at most `count` components whose centres are nearest to `centre`, nearest first, ties by name. The id of
    /// each is its component's name.
    pub fn nearest(&self, space: &Space, centre: &[f64], count: usize) -> Vec<Neighbor> {
        let mut best = Best::new(count);
        let mut offer = |component: &Component| {
            let bound = best.bound();
            if let Some(distance) = space.distance_unless_above(centre, &component.centre, bound) {
                best.offer(Neighbor { distance, id: component.name });
            }
        };
        if self.count() <= FEW_COMPONENTS {
            self.iter().for_each(offer);
            return best.into_items();
        }
        if read(&self.finder.centres).is_none() {
            let mut centres = self.finder.centres.write().expect("no search panics");
            centres.get_or_insert_with(|| Centres::new(space, self.slots()));
        }
        let centres = read(&self.finder.centres);
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
        let finder = &self.finder;
        let index = read(&finder.nodes);
        let before = finder.searches.fetch_add(searches, Ordering::Relaxed);
        let wanted = lacks(&index) >= TAIL && before.saturating_add(searches) >= SEARCHES;
        if index.is_some() && !wanted {
            return index;
        }
        drop(index);
        let mut index = finder.nodes.write().expect("no search panics");
        let made = index.get_or_insert_with(|| Index::with_shelf(space, finder.shelf.clone()));
        if wanted {
            made.extend(self.nodes(), |node| configs.get(node as usize), |node| self.slot_of(node));
            finder.searches.store(0, Ordering::Relaxed);
        }
        drop(index);
        read(&finder.nodes)
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
        self.components.slot_of(node) == self.slot
    }

    fn label_is_eligible(&self, node: u32) -> Option<bool> {
        Some(self.is_eligible(node))
    }
}

/// An index of the centres of components.
///
/// A component that changed in the last fold is not in the index but compared on its own, since most of those
/// change again at once: the largest does in every fold. A component that did not change gets an entry in the
/// index, which is current until the component changes. When more than half of the entries are no longer
/// current, the index is built anew.
#[derive(Clone, Debug)]
struct Centres {
    index: Index,
    /// Per entry the slot of its component.
    slots: Vec<u32>,
    /// Per slot the current entry of its component, or [`NONE`].
    entry_of: Vec<u32>,
    /// Slots of the components that have no entry.
    unindexed: Vec<u32>,
    /// Stands in place of the centre of a component that is gone.
    nowhere: Vec<f64>,
}

impl Centres {
    fn new(space: &Space, slots: &[Option<Component>]) -> Centres {
        let mut centres = Centres {
            index: Index::new(space),
            slots: Vec::new(),
            entry_of: vec![NONE; slots.len()],
            unindexed: Vec::new(),
            nowhere: vec![0.0; space.len()],
        };
        for slot in 0..slots.len() as u32 {
            centres.enter(slots, slot);
        }
        centres.grow(slots);
        centres
    }

    /// Gives the component in a slot, if there is one, an entry.
    fn enter(&mut self, slots: &[Option<Component>], slot: u32) {
        if slots[slot as usize].is_some() {
            self.entry_of[slot as usize] = self.slots.len() as u32;
            self.slots.push(slot);
        }
    }

    /// See [`Finder::centres_changed`].
    fn update(&mut self, slots: &[Option<Component>], changed: &[u32]) {
        self.entry_of.resize(slots.len(), NONE);
        for slot in changed {
            self.entry_of[*slot as usize] = NONE;
        }
        let unindexed = changed.iter().copied().filter(|slot| slots[*slot as usize].is_some());
        for slot in std::mem::replace(&mut self.unindexed, unindexed.collect()) {
            if changed.binary_search(&slot).is_err() {
                self.enter(slots, slot);
            }
        }
        if self.slots.len() > 2 * slots.len() + TAIL as usize {
            self.renew(slots);
        }
        self.grow(slots);
    }

    /// Removes the entries that are not current.
    fn renew(&mut self, slots: &[Option<Component>]) {
        let entries = std::mem::take(&mut self.slots);
        self.index.clear();
        for (entry, slot) in entries.into_iter().enumerate() {
            if self.entry_of[slot as usize] == entry as u32 {
                self.enter(slots, slot);
            }
        }
    }

    /// Adds the newest entries to the index if there are many.
    fn grow(&mut self, slots: &[Option<Component>]) {
        let end = self.slots.len() as u32;
        if end - self.index.len() >= TAIL {
            let Centres { index, slots: slot_of, nowhere, .. } = self;
            let component = |entry: u32| slots[slot_of[entry as usize] as usize].as_ref();
            let centre =
                |entry| component(entry).map_or(&nowhere[..], |component| &component.centre);
            index.extend(end, centre, |_| 0);
        }
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
        self.component(entry).map_or(NONE, |component| component.name)
    }
}
