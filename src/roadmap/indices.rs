//! The nearest-neighbour indices over the nodes and over the component centres of a growing graph, and what is kept of its
//! nodes' shapes.
//!
//! An index is built when a search first needs it, so that a graph that nobody searches (a coordinator's,
//! a ledger reader's) has none.

use super::component::Component;
use super::shapes::Shapes;
use crate::neighbor::{Index, KdTree, MetricTree, SearchTrees};
use crate::shelf::Shelf;
use crate::space::Space;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, RwLock, RwLockReadGuard};

/// Nodes or centres that an index lacks are added to it when there are at least this many; before, each
/// search looks at them one by one.
pub(super) const TAIL: u32 = 128;
/// Marks a slot without an entry.
pub(super) const NO_ENTRY: u32 = u32::MAX;

/// The indices over a graph's nodes and over the centres of its components, as far as they are built.
/// Searches share a graph, hence the locks.
#[derive(Debug, Default)]
pub(super) struct Indices {
    pub(super) nodes: RwLock<Option<Index>>,
    /// Where replicas of one graph share the segments of the node index.
    pub(super) shelf: Option<Arc<dyn Shelf>>,
    /// Number of node searches since the node index last grew.
    pub(super) searches: AtomicU32,
    pub(super) centres: RwLock<Option<Centres>>,
    /// The shapes of the nodes that were there when shapes were last searched.
    pub(super) shapes: RwLock<Shapes>,
    /// Trees for approximate searches of nodes.
    pub(super) kd_trees: RwLock<SearchTrees<KdTree>>,
    /// Trees for searches of nodes that know the metric only.
    pub(super) metric_trees: RwLock<SearchTrees<MetricTree>>,
}

impl Clone for Indices {
    fn clone(&self) -> Indices {
        Indices {
            nodes: RwLock::new(read(&self.nodes).clone()),
            shelf: self.shelf.clone(),
            searches: AtomicU32::new(self.searches.load(Ordering::Relaxed)),
            centres: RwLock::new(read(&self.centres).clone()),
            shapes: RwLock::new(read(&self.shapes).clone()),
            kd_trees: RwLock::new(read(&self.kd_trees).clone()),
            metric_trees: RwLock::new(read(&self.metric_trees).clone()),
        }
    }
}

pub(super) fn read<T>(lock: &RwLock<T>) -> RwLockReadGuard<'_, T> {
    lock.read().expect("no search panics")
}

impl Indices {
    /// No indices yet, for a graph whose node index shares its segments on a shelf.
    pub(super) fn with_shelf(shelf: Arc<dyn Shelf>) -> Indices {
        Indices { shelf: Some(shelf), ..Indices::default() }
    }

    /// Takes in that the components in the slots `changed`, ascending, are new, gone or have new centres.
    pub(super) fn centres_changed(&mut self, slots: &[Option<Component>], changed: &[u32]) {
        if let Some(centres) = self.centres.get_mut().expect("no search panics") {
            centres.update(slots, changed);
        }
    }
}

/// The centres of components as entries of a nearest-neighbour index.
///
/// A component that changed in the last fold has no entry and is compared by itself, since most of these
/// change in the next fold again (the largest component changes in every fold). A component that the last
/// fold left alone gets an entry, which is valid until the component changes; an index cannot drop single
/// entries, so that invalid ones stay in it and are passed over. When more than half of the entries are
/// invalid, the index is built anew from the valid ones.
#[derive(Clone, Debug)]
pub(super) struct Centres {
    pub(super) index: Index,
    /// Per entry, the slot of the component that had this centre when the entry was made.
    pub(super) slots: Vec<u32>,
    /// Per slot, the entry with the present centre of its component; [`NO_ENTRY`] where there is none.
    pub(super) entry_of: Vec<u32>,
    /// Slots of the components that changed in the last fold and so have no entry.
    pub(super) unindexed: Vec<u32>,
    /// Any configuration: the centre of entries whose component is gone.
    pub(super) nowhere: Vec<f64>,
}

impl Centres {
    pub(super) fn new(space: &Space, slots: &[Option<Component>]) -> Centres {
        let mut centres = Centres {
            index: Index::new(space),
            slots: Vec::new(),
            entry_of: vec![NO_ENTRY; slots.len()],
            unindexed: Vec::new(),
            nowhere: vec![0.0; space.len()],
        };
        for slot in 0..slots.len() as u32 {
            centres.enter(slots, slot);
        }
        centres.grow(slots);
        centres
    }

    /// Makes an entry for the component in a slot, if there is one.
    fn enter(&mut self, slots: &[Option<Component>], slot: u32) {
        if slots[slot as usize].is_some() {
            self.entry_of[slot as usize] = self.slots.len() as u32;
            self.slots.push(slot);
        }
    }

    /// Takes in that the components in the slots `changed`, ascending, are new, gone or have new centres.
    fn update(&mut self, slots: &[Option<Component>], changed: &[u32]) {
        self.entry_of.resize(slots.len(), NO_ENTRY);
        for slot in changed {
            self.entry_of[*slot as usize] = NO_ENTRY;
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

    /// Builds the entries anew from the valid ones.
    fn renew(&mut self, slots: &[Option<Component>]) {
        let entries = std::mem::take(&mut self.slots);
        self.index.clear();
        for (entry, slot) in entries.into_iter().enumerate() {
            if self.entry_of[slot as usize] == entry as u32 {
                self.enter(slots, slot);
            }
        }
    }

    /// Extends the index over the entries that it lacks, once they are many enough to be worth it.
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
