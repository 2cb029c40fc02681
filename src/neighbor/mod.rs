//! Nearest neighbours of configurations.
//!
//! What a search returns is *defined* by brute force, which measures every configuration by
//! [`Space::distance`](crate::space::Space::distance) and orders them by distance, then by id: [`k_nearest`], [`in_radius`] and
//! [`closest_pairs`]. The [`Index`] returns the same, bit for bit, in less time, as do the searches of a whole set
//! ([`k_nearest_graph`], [`radius_graph`], [`farthest_pair`]). So nothing about an index can reach a roadmap.
//!
//! Metric trees return the same, too. K-d trees may return configurations that are a little farther away; which, follows
//! from the configurations and their number alone, see `search_trees.rs`.

mod ball;
mod best;
mod brute;
mod build;
mod embedding;
mod farthest;
mod index;
mod k_nearest_graph;
mod kd_tree;
mod layout;
mod margins;
mod measure;
mod metric_tree;
mod radius;
mod radius_graph;
mod search_trees;
mod searched;
mod seek;
mod shared_segments;
mod shortlist;
mod tree;

pub use best::{Best, NearPair, Neighbor, Ranked};
pub use brute::{Subset, closest_pairs, in_radius, k_nearest};
pub use farthest::{FarPair, farthest_pair};
pub use index::Index;
pub use k_nearest_graph::k_nearest_graph;
pub(crate) use kd_tree::KdTree;
pub(crate) use metric_tree::MetricTree;
pub use radius_graph::radius_graph;
pub(crate) use search_trees::SearchTrees;
pub use searched::Searched;

#[cfg(test)]
mod search_tree_tests;
#[cfg(test)]
mod tests;
