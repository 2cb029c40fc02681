//! What searches return, the order in which they return it, and the nearest of many by that order.

use std::cmp::Ordering;

/// A configuration that a search has found near its query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// Distance to the query by [`Space::distance`](crate::space::Space::distance), in the scene's length unit, or by what
    /// else the search measures.
    pub distance: f64,
    /// Id of the configuration.
    pub id: u32,
}

/// A pair of configurations of two sets that are near one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearPair {
    /// Their distance by [`Space::distance`](crate::space::Space::distance), in the scene's length unit.
    pub distance: f64,
    /// Id of the configuration of the first set.
    pub first: u32,
    /// Id of the configuration of the second set.
    pub second: u32,
}

/// What is ordered by distance, with ids that break ties.
pub trait Ranked {
    /// The distance.
    fn distance(&self) -> f64;
    /// The ids: the first breaks ties of the distance, the second ties of both.
    fn ids(&self) -> (u32, u32);
    /// The order of two items: the nearer is less, of equally near ones that with the lower ids.
    fn rank(&self, other: &Self) -> Ordering {
        self.distance().total_cmp(&other.distance()).then(self.ids().cmp(&other.ids()))
    }
}

impl Ranked for Neighbor {
    fn distance(&self) -> f64 {
        self.distance
    }
    fn ids(&self) -> (u32, u32) {
        (self.id, 0)
    }
}

impl Ranked for NearPair {
    fn distance(&self) -> f64 {
        self.distance
    }
    fn ids(&self) -> (u32, u32) {
        (self.first, self.second)
    }
}

/// Keeps the nearest of the items offered, at most a given number, in whatever order they are offered. An offer
/// costs as much time as there are items kept; it is meant for few.
#[derive(Clone, Debug)]
pub struct Best<T> {
    most: usize,
    items: Vec<T>,
}

impl<T: Ranked> Best<T> {
    /// Has no items yet, and will keep at most `most`.
    pub fn new(most: usize) -> Best<T> {
        Best { most, items: Vec::new() }
    }

    /// The pruning bound: items farther away than this are not kept any more. Infinite while there is room.
    pub fn bound(&self) -> f64 {
        match self.items.last() {
            Some(last) if self.items.len() >= self.most => last.distance(),
            _ if self.most == 0 => 0.0,
            _ => f64::INFINITY,
        }
    }

    /// Keeps an item if it is among the nearest so far.
    pub fn offer(&mut self, item: T) {
        let position = self.items.partition_point(|known| known.rank(&item).is_lt());
        if position < self.most {
            self.items.truncate(self.most - 1);
            self.items.insert(position, item);
        }
    }

    /// The items kept, nearest first.
    pub fn into_items(self) -> Vec<T> {
        self.items
    }
}
