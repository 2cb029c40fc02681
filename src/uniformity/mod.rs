//! How evenly samples lie on a surface: the measures of H.-Y. Yeh's dissertation (2016, §4.3.2 and §5.2.3), and a test of them that
//! holds for samples that are not independent.
//!
//! - By *cells* ([`Grid`]): the shares of samples in the cells of a regular grid beside the shares of the surface's area.
//! - By *triangles* ([`triangle_counts`]): the samples nearest to each triangle of a mesh beside the triangle's area.
//! - By *distances* ([`nearest_distances`]): how far every sample's nearest other sample is. The standard deviation of these is the smaller, the more
//!   evenly samples lie.
//!
//! The first two give counts. Several milestones of a set may come from one segment, one walk or one pair, so that counts are
//! not multinomial and Pearson's χ² rejects samplers that keep the law. [`Shares`] compares several independent runs
//! instead: it estimates the covariance of the shares from the runs themselves.
//!
//! ```
//! use roadmill::uniformity::{Grid, Shares};
//!
//! let grid = Grid::new([0.0, 0.0, 0.0], [2.0, 2.0, 1.0], [2, 2, 1]).expect("a box");
//! let runs = [[[0.5, 0.5, 0.5], [1.5, 0.5, 0.5]], [[0.5, 1.5, 0.5], [1.5, 1.5, 0.5]]];
//! let counts = runs.map(|points| grid.counts(&points).0);
//! let shares = Shares::of(&counts, &[1.0; 4]).expect("counts of four cells");
//! assert_eq!(shares.cells[0].mean, 0.25);
//! assert_eq!(shares.cells[0].error, Some(0.0));
//! ```

mod beta;
mod distances;
mod grid;
mod shares;
mod triangles;

pub use distances::{Spread, nearest_distances};
pub use grid::Grid;
pub use shares::{CellShare, Hotelling, Shares};
pub use triangles::{triangle_areas, triangle_counts};

#[cfg(test)]
mod tests;
