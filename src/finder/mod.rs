//! Neighbour finders: which milestones near a configuration the connections try. One file per method.
//!
//! What a finder gives is *defined* by looking at all milestones; the indices of [`neighbor`](crate::neighbor) give
//! the same, bit for bit, in less time. So whether and when an index is built changes no roadmap.
//!
//! ```
//! use roadmill::finder::{Finder, KNearest};
//! use roadmill::problem::Problem;
//! use roadmill::roadmap::{Components, Configs};
//!
//! let space = Problem::load("tests/problems/slide.toml".as_ref())?.space();
//! let mut milestones = Configs::new(space.len());
//! for x in [0.0, 1.0, 3.0] {
//!     milestones.push(&[x, 0.0, 0.0]);
//! }
//! let unconnected = Components::of(&space, &milestones, &[]);
//! let near = KNearest { neighbors: 2 }.near(&space, &milestones, &unconnected, &[2.8, 0.0, 0.0]);
//! assert_eq!(near.iter().map(|neighbor| neighbor.id).collect::<Vec<_>>(), [2, 1]);
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod k_nearest;
mod radius;

methods! {
    /// The neighbour finders, as a problem file names them.
    pub enum FinderKind: dyn Finder {
        KNearest(k_nearest::KNearest),
        Radius(radius::Radius), // new ones at the end, since ledgers know methods by number
    }
}

pub use k_nearest::KNearest;
pub use radius::Radius;

use crate::methods::{Complaint, methods};
use crate::neighbor::Neighbor;
use crate::roadmap::{Components, Configs};
use crate::space::Space;

/// A neighbour finder.
pub trait Finder {
    /// The milestones near `q`, nearest first, ties by id. `components` are those of the graph over `configs`; they
    /// keep its index.
    fn near(
        &self,
        space: &Space,
        configs: &Configs,
        components: &Components,
        q: &[f64],
    ) -> Vec<Neighbor>;

    /// The pairs of neighbours within a set: each pair once, the lower id first, in ascending order, where the one
    /// is near the other or the other near the one.
    fn pairs(&self, space: &Space, configs: &Configs) -> Vec<(u32, u32)>;

    /// The most neighbours of a configuration; `None` where there may be any number.
    fn most(&self) -> Option<usize>;

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }
}

/// The report's: the ten nearest.
impl Default for FinderKind {
    fn default() -> FinderKind {
        FinderKind::KNearest(KNearest::default())
    }
}

#[cfg(test)]
mod tests;
