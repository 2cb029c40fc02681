use super::best::Neighbor;
use super::build::Source;
use super::embedding::{Embedding, FAN};
use super::layout::NONE;
use super::seek::{Search, Seeker};
use super::shortlist::{Candidate, Shortlist};
use super::tree::Tree;
use crate::shelf;
use crate::space::{Configs, Space};

/// The edges of the k-nearest-neighbour graph: each configuration with the `k` nearest of the others by
/// [`Space::distance`], ties by id. Each edge is given once, the lower id first, in ascending order.
/// Configurations are in stored form.
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
        Source { embedding: &embedding, config_of: &config_of, label_of: &|_| 0, configs: end };
    let tree = Tree::new(&source, 0..end, shelf::private);
    let error_bounds = embedding.error_bounds(2.0 * tree.longest());
    let shortlist = Shortlist::new(k, error_bounds);
    let mut others = Others { space, configs, id: NONE, shortlist };
    let mut pairs = Pairs::new(count, k);
    let axes = embedding.axes();
    let mut point = vec![0.0; axes];
    for (index, id) in tree.ids().iter().enumerate().filter(|(_, id)| **id != NONE) {
        let leaf = index / FAN;
        for (axis, value) in point.iter_mut().enumerate() {
            *value = tree.points()[(leaf * axes + axis) * FAN + index % FAN];
        }
        others.id = *id;
        others.shortlist.clear();
        Search::new(&tree, &embedding, &point, end, &mut others).search_from_leaf(leaf);
        others.add_to(&mut pairs, k);
    }
    pairs.ascending()
}

/// Seeks the configurations nearest to one of them, among the others.
struct Others<'a> {
    space: &'a Space,
    configs: &'a Configs,
    /// The one that the others are measured from.
    id: u32,
    shortlist: Shortlist,
}

impl<'a> Others<'a> {
    fn measure(&self) -> impl Fn(&Candidate) -> Neighbor + use<'a> {
        let (space, configs, id) = (self.space, self.configs, self.id);
        let q = configs.get(id as usize);
        move |candidate| {
            let distance = space.distance(q, configs.get(candidate.id as usize));
            Neighbor { distance, id: candidate.id }
        }
    }

    /// Adds the pairs of the one with its `k` nearest.
    fn add_to(&mut self, pairs: &mut Pairs, k: usize) {
        // As many as are wanted need not be measured.
        if self.shortlist.remaining().len() == k {
            self.shortlist.remaining().iter().for_each(|other| pairs.add(self.id, other.id));
            return;
        }
        let measure = self.measure();
        for (other, _) in self.shortlist.nearest(measure) {
            pairs.add(self.id, other.id);
        }
    }
}

impl Seeker for Others<'_> {
    fn pruning_bound(&self) -> f32 {
        self.shortlist.pruning_bound()
    }

    fn offer(&mut self, id: u32, square: f32, _: bool) {
        if id != self.id {
            let measure = self.measure();
            self.shortlist.offer(0, id, square);
            self.shortlist.trim(measure);
        }
    }

    fn label_is_eligible(&self, _: u32) -> Option<bool> {
        None
    }
}

/// Pairs of ids, to be sorted.
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

    /// The pairs in ascending order, each once: a counting sort by lower ids.
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
