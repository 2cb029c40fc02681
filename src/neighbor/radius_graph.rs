use super::build::Source;
use super::embedding::{Embedding, Point};
use super::seek::{Search, Seeker};
use super::tree::Tree;
use crate::shelf;
use crate::space::{Configs, Space};

/// The edges of the radius graph, in which two configurations are neighbours if their [`Space::distance`] is at most
/// `radius`, a length in the scene's unit. Each edge is given once, the lower id first, in ascending order.
/// There are none if the radius is negative or not a number; an infinite radius gives all pairs. Configurations are
/// in stored form.
pub fn radius_graph(space: &Space, configs: &Configs, radius: f64) -> Vec<(u32, u32)> {
    let count = configs.len() as u32;
    // Also false if the radius is not a number.
    let some_fit = radius >= 0.0;
    if !some_fit || count < 2 {
        return Vec::new();
    }
    let embedding = Embedding::new(space);
    let config_of = |id: u32| configs.get(id as usize);
    let source =
        Source { embedding: &embedding, config_of: &config_of, label_of: &|_| 0, configs: count };
    let tree = Tree::new(&source, 0..count, shelf::private);
    let pruning_bound = embedding.error_bounds(2.0 * tree.longest()).pruning_bound(radius * radius);
    let mut higher = Higher { space, configs, radius, pruning_bound, id: 0, pairs: Vec::new() };
    let mut point = Point::new();
    for id in 0..count {
        point.clear();
        embedding.embed(config_of(id), &mut point);
        higher.id = id;
        let first = higher.pairs.len();
        Search::new(&tree, &embedding, &point, count, &mut higher).search_from_root();
        higher.pairs[first..].sort_unstable();
    }
    higher.pairs
}

/// Seeks, for one configuration, those with a higher id within the radius. Since distances are symmetric to the
/// bit, each edge is found by its lower id.
struct Higher<'a> {
    space: &'a Space,
    configs: &'a Configs,
    radius: f64,
    pruning_bound: f32,
    /// The one whose neighbours are sought.
    id: u32,
    /// The edges found so far.
    pairs: Vec<(u32, u32)>,
}

impl Seeker for Higher<'_> {
    fn pruning_bound(&self) -> f32 {
        self.pruning_bound
    }

    fn offer(&mut self, id: u32, _: f32, _: bool) {
        if id <= self.id {
            return;
        }
        let ends = (self.configs.get(self.id as usize), self.configs.get(id as usize));
        let distance = self.space.distance_unless_above(ends.0, ends.1, self.radius);
        if distance.is_some_and(|distance| distance <= self.radius) {
            self.pairs.push((self.id, id));
        }
    }

    fn label_is_eligible(&self, _: u32) -> Option<bool> {
        None
    }
}
