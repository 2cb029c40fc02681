//! Nearest neighbours. They are *defined* by brute force, nearest first and ties by id: whatever
//! index comes later must return the same.

mod brute;
mod farthest;

pub use brute::{NearPair, Neighbor, closest_pairs, k_nearest};
pub use farthest::{FarPair, farthest_pair};
