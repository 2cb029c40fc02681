//! What the sampled configurations of a ligand at a protein say: clusters of poses, statistics of low energies, and how
//! well ligands are ranked.
//!
//! [`clusters`] joins poses that are near one another, [`Low`] has the statistics by which H.-Y. Yeh ranks ligands,
//! [`Kendall`] and [`interval`] compare a ranking with measured affinities. All are pure functions of numbers: the same
//! bits for the same arguments on every machine.

mod cluster;
mod kendall;
mod low;

pub use cluster::{Cluster, RADIUS, clusters};
pub use kendall::{Interval, Kendall, PValue, interval};
pub use low::Low;
