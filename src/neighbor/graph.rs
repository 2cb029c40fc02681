use super::best::Neighbor;
use super::build::Source;
use super::embedding::{Embedding, FAN};
use super::layout::NONE;
use super::seek::{Search, Seeker};
use super::shortlist::{Met, Shortlist};
use super::tree::Tree;
use crate::shelf;
use crate::space::{Configs, Space};

/// The edges of the k-nearest-neighbour graph: each configuration with the `k` nearest of the others, ties
/// by id, the lower id first, each pair once, in ascending order.
pub fn k_nearest_graph(space: &Space, configs: &Configs, k: usize) -> Vec<(u32, u32)> {
    let count = configs.len();
    let k = k.min(count.saturating_sub(1));
    if k == 0 {
        return Vec::new();
    }
    let embedding = Embedding::new(space);
    let config_of = |id: u32| configs.get(id as usize);
    let end = count as u32;
    let source =
        Source { embedding: &embedding, config_of: &config_of, label_of: &|_| 0, time: end };
    let tree = Tree::new(&source, (0, end), shelf::private);
    let bounds = embedding.bounds(2.0 * tree.longest());
    let mut others = Others { space, configs, id: NONE, near: Shortlist::new(k, bounds) };
    let mut pairs = Pairs::new(count, k);
    let axes = embedding.axes();
    let mut point = vec![0.0; axes];
    for (place, id) in tree.ids().iter().enumerate().filter(|(_, id)| **id != NONE) {
        let leaf = place / FAN;
        for (axis, value) in point.iter_mut().enumerate() {
            *value = tree.points()[(leaf * axes + axis) * FAN + place % FAN];
        }
        others.id = *id;
        others.near.clear();
        Search::new(&tree, &embedding, &point, end, &mut others).outwards(leaf);
        others.give(&mut pairs, k);
    }
    pairs.ascending()
}

/// The nearest of all configurations but one.
struct Others<'a> {
    space: &'a Space,
    configs: &'a Configs,
    id: u32,
    near: Shortlist,
}

impl<'a> Others<'a> {
    fn neighbor(&self) -> impl Fn(&Met) -> Neighbor + use<'a> {
        let (space, configs, id) = (self.space, self.configs, self.id);
        let q = configs.get(id as usize);
        move |met| {
            let distance = space.distance(q, configs.get(met.id as usize));
            Neighbor { distance, id: met.id }
        }
    }

    fn give(&mut self, pairs: &mut Pairs, k: usize) {
        if self.near.left().len() == k {
            self.near.left().iter().for_each(|met| pairs.add(self.id, met.id));
            return;
        }
        let neighbor = self.neighbor();
        for (met, _) in self.near.nearest(neighbor) {
            pairs.add(self.id, met.id);
        }
    }
}

impl Seeker for Others<'_> {
    fn limit(&self) -> f32 {
        self.near.limit()
    }

    fn meet(&mut self, id: u32, square: f32, _: bool) {
        if id != self.id {
            let neighbor = self.neighbor();
            self.near.offer(0, id, square);
            self.near.clear_up(neighbor);
        }
    }

    fn label_counts(&self, _: u32) -> Option<bool> {
        None
    }
}

/// Pairs of ids, to be put in order.
struct Pairs {
    given: Vec<(u32, u32)>,
    /// How many pairs have each id as their lower one.
    counts: Vec<u32>,
}

impl Pairs {
    fn new(count: usize, k: usize) -> Pairs {
        Pairs { given: Vec::with_capacity(count * k), counts: vec![0; count] }
    }

    fn add(&mut self, a: u32, b: u32) {
        self.given.push((a.min(b), a.max(b)));
        self.counts[a.min(b) as usize] += 1;
    }

    /// Each pair once, in ascending order.
    fn ascending(self) -> Vec<(u32, u32)> {
        let mut next = 0;
        let mut ends: Vec<u32> = self.counts;
        for end in &mut ends {
            next += std::mem::replace(end, next);
        }
        let mut higher = vec![0; self.given.len()];
        for (low, high) in self.given.iter() {
            let end = &mut ends[*low as usize];
            higher[*end as usize] = *high;
            *end += 1;
        }
        let (mut pairs, mut first) = (self.given, 0);
        pairs.clear();
        for (low, end) in ends.into_iter().enumerate() {
            let of_low = &mut higher[first..end as usize];
            of_low.sort_unstable();
            for (at, high) in of_low.iter().enumerate() {
                if at == 0 || of_low[at - 1] != *high {
                    pairs.push((low as u32, *high));
                }
            }
            first = end as usize;
        }
        pairs
    }
}
