//! What the sampled configurations of a ligand at a protein say: clusters of poses, statistics of low energies, and how
//! well ligands are ranked.
//!
//! [`clusters`] joins poses that are near one another, [`Low`] has the statistics by which H.-Y. Yeh ranks ligands,
//! [`Kendall`] and [`interval`] compare a ranking with measured affinities. All are pure functions of numbers: the same
//! bits for the same arguments on every machine.

mod affinity;
mod candidates;
mod cluster;
mod kendall;
mod low;
mod reference;
#[cfg(test)]
mod tests;
mod way_out;

pub use affinity::Affinity;
pub use candidates::{Asked, Candidate, Candidates, Exact, Improved, Score, candidates};
pub use cluster::{Cluster, RADIUS, clusters};
pub use kendall::{Interval, Kendall, PValue, interval};
pub use low::Low;
pub use reference::{Comparison, Found, Reference, SAME_POSE};
pub use way_out::WayOut;
