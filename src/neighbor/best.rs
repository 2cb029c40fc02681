//! The few best of many.

use std::cmp::Ordering;

/// A neighbour of some configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// Its distance.
    pub distance: f64,
    /// Its id.
    pub id: u32,
}

/// A pair of configurations near one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearPair {
    /// Their distance.
    pub distance: f64,
    /// Id of the one from the first set.
    pub first: u32,
    /// Id of the one from the second set.
    pub second: u32,
}

/// Something that stands at a distance; ids break ties.
pub trait Ranked {
    /// The distance.
    fn distance(&self) -> f64;
    /// The ids, in the order in which they break ties.
    fn ids(&self) -> (u32, u32);
    /// Which of two is nearer.
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

/// The at most so many nearest of all that was offered, whatever the order of the offers.
#[derive(Clone, Debug)]
pub struct Best<T> {
    most: usize,
    items: Vec<T>,
}

impl<T: Ranked> Best<T> {
    /// Nothing yet, and at most `most` later.
    pub fn new(most: usize) -> Best<T> {
        Best { most, items: Vec::new() }
    }

    /// Nothing farther than this can still get in.
    pub fn bound(&self) -> f64 {
        match self.items.last() {
            Some(last) if self.items.len() >= self.most => last.distance(),
            _ if self.most == 0 => 0.0,
            _ => f64::INFINITY,
        }
    }

    /// Takes an item in, if it is among the nearest so far.
    pub fn offer(&mut self, item: T) {
        let place = self.items.partition_point(|known| known.rank(&item).is_lt());
        if place < self.most {
            self.items.truncate(self.most - 1);
            self.items.insert(place, item);
        }
    }

    /// The items, nearest first.
    pub fn into_items(self) -> Vec<T> {
        self.items
    }
}
