//! Neighbour finders: which milestones near a configuration the connections try. One file per method.
//!
//! What a finder gives is *defined* by looking at all milestones; the indices of [`neighbor`](crate::neighbor) give
//! the same, bit for bit, in less time. So whether and when an index is built changes no roadmap.
//!
//! ```
//! use roadmill::finder::{Finder, KNearest};
//! use roadmill::{model::Scratch, problem::Problem};
//! use roadmill::roadmap::{Components, Configs};
//!
//! let cx = Problem::load("tests/problems/slide.toml".as_ref())?.context();
//! let mut milestones = Configs::new(cx.space().len());
//! for x in [0.0, 1.0, 3.0] {
//!     milestones.push(&[x, 0.0, 0.0]);
//! }
//! let unconnected = Components::of(cx.space(), &milestones, &[]);
//! let (finder, scratch) = (KNearest { neighbors: 2 }, &mut Scratch::new());
//! let near = finder.near(&cx, &milestones, &unconnected, &[2.8, 0.0, 0.0], scratch);
//! assert_eq!(near.iter().map(|neighbor| neighbor.id).collect::<Vec<_>>(), [2, 1]);
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod ca_rmsd;
mod k_nearest;
mod radius;

methods! {
    /// The neighbour finders, as a problem file names them.
    pub enum FinderKind: dyn Finder {
        KNearest(k_nearest::KNearest),
        Radius(radius::Radius),
        CaRmsd(ca_rmsd::CaRmsd), // new ones at the end, since ledgers know methods by number
    }
}

pub use ca_rmsd::CaRmsd;
pub use k_nearest::KNearest;
pub use radius::Radius;

use crate::context::Context;
use crate::methods::{Complaint, methods};
use crate::model::Scratch;
use crate::neighbor::Neighbor;
use crate::roadmap::{Components, Configs};

/// A neighbour finder.
pub trait Finder {
    /// The milestones near `q`, nearest first, ties by id. `components` are those of the graph over `configs`; they
    /// keep its index. The distances are the finder's own: in the space's metric, or whatever it measures by.
    fn near(
        &self,
        cx: &Context,
        configs: &Configs,
        components: &Components,
        q: &[f64],
        scratch: &mut Scratch,
    ) -> Vec<Neighbor>;

    /// The pairs of neighbours within a set: each pair once, the lower id first, in ascending order, where the one
    /// is near the other or the other near the one.
    fn pairs(&self, cx: &Context, configs: &Configs, scratch: &mut Scratch) -> Vec<(u32, u32)>;

    /// The most neighbours of a configuration; `None` where there may be any number.
    fn most(&self) -> Option<usize>;

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }

    /// Whether the method is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    fn suits(&self, _cx: &Context) -> Result<(), String> {
        Ok(())
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
