//! Nearest neighbours. They are *defined* by brute force, nearest first and ties by id; the [`Index`]
//! returns the same, bit for bit.

mod best;
mod brute;
mod build;
mod embedding;
mod farthest;
mod graph;
mod index;
mod layout;
mod measure;
mod places;
mod seek;
mod shortlist;
mod tree;

pub use best::{Best, NearPair, Neighbor, Ranked};
pub use brute::{closest_pairs, k_nearest};
pub use farthest::{FarPair, farthest_pair};
pub use graph::k_nearest_graph;
pub use index::{Candidates, Index};

#[cfg(test)]
mod tests;
