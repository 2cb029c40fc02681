//! What the generators have in common that grow trees and graphs by steps toward configurations.
//!
//! [`set`] is the node set that grows, [`tree`] what it grows from, [`explore`] the growth toward random configurations,
//! [`directions`] which directions are dispersed, [`graph_neighbors`] which nodes a new one is tried with, [`retraction`] how blocked extensions are bent aside, [`sliding`] how they slide along what blocks them, [`settings`] what several of the methods can be told. The methods
//! themselves stand in files of their own: `rrt.rs`, `rrg.rs`, `mrrg.rs`, `tree.rs`,
//! `rrt_connect.rs`, `end_trees.rs`, `retraction_trees.rs`, `contact_trees.rs`, `sliding_trees.rs` and `local_trees.rs`.

mod directions;
mod explore;
mod extent;
mod graph_neighbors;
mod retraction;
mod set;
mod settings;
mod sliding;
mod tree;

pub(super) use explore::{Exploration, explore, grow_from_root};
pub(super) use graph_neighbors::NeighborSearch;
pub use graph_neighbors::{FoundNeighbors, GraphNeighbors};
pub(super) use set::GrowingSet;
pub(super) use settings::{
    Complaints, calibrated, default_attempts, default_goal_bias, needs_query, needs_root, step_of,
};
pub(super) use tree::GrowingTree;

#[cfg(test)]
mod tests;
