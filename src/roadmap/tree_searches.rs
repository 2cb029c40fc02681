//! Searches of nodes by k-d trees and by metric trees, which are built when a search first needs them.

use super::components::Components;
use super::indices::read;
use crate::neighbor::Neighbor;
use crate::space::{Configs, Space};

/// Distances are those of [`Space::distance`], `configs` are those of the graph's nodes, queries are in stored form. Only
/// nodes for which `is_eligible` says so are given.
impl Components {
    /// About the `k` nodes nearest to `q`, nearest first, ties by id: the i-th is at most 1 + `epsilon` times as far from `q` as the i-th
    /// of those that are nearest. Which they are follows from the nodes and their number.
    pub fn approximately_nearest(
        &self,
        space: &Space,
        configs: &Configs,
        is_eligible: &dyn Fn(u32) -> bool,
        q: &[f64],
        (k, epsilon): (usize, f64),
    ) -> Vec<Neighbor> {
        let (count, trees) = (self.nodes(), &self.indices.kd_trees);
        if !read(trees).is_of(count) {
            trees.write().expect("no search panics").extend(space, configs, count);
        }
        read(trees).approximately_nearest(space, configs, count, is_eligible, q, k, epsilon)
    }

    /// The at most `k` nodes nearest to `q`, nearest first, ties by id, found by the triangle inequality alone.
    pub fn nearest_by_metric_tree(
        &self,
        space: &Space,
        configs: &Configs,
        is_eligible: &dyn Fn(u32) -> bool,
        q: &[f64],
        k: usize,
    ) -> Vec<Neighbor> {
        let (count, trees) = (self.nodes(), &self.indices.metric_trees);
        if !read(trees).is_of(count) {
            trees.write().expect("no search panics").extend(space, configs, count);
        }
        read(trees).nearest(space, configs, count, is_eligible, q, k)
    }
}
