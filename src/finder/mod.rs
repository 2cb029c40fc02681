//! Neighbour finders: which milestones near a configuration the connections try. One file per method.
//!
//! What an exact finder gives is *defined* by looking at all milestones; the indices of [`neighbor`] give
//! the same, bit for bit, in less time. So whether and when an index is built changes no roadmap. What [`Approximate`] gives follows
//! from the milestones and their number, what [`Randomised`] gives from the set's seed besides.
//!
//! ```
//! use roadmill::finder::{Finder, KNearest, Milestones};
//! use roadmill::{model::Scratch, problem::Problem};
//! use roadmill::roadmap::{Components, Configs};
//!
//! let cx = Problem::load("tests/problems/slide.toml".as_ref())?.context();
//! let mut milestones = Configs::new(cx.space().len());
//! for x in [0.0, 1.0, 3.0] {
//!     milestones.push(&[x, 0.0, 0.0]);
//! }
//! let unconnected = Components::of(cx.space(), &milestones, &[]);
//! let (finder, scratch) = (KNearest { neighbors: 2.into() }, &mut Scratch::new());
//! let all = Milestones::all(&milestones, &unconnected);
//! let near = finder.near(&cx, &all, &[2.8, 0.0, 0.0], scratch);
//! assert_eq!(near.iter().map(|neighbor| neighbor.id).collect::<Vec<_>>(), [2, 1]);
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod approximate;
mod brute_force;
mod ca_rmsd;
mod count;
mod k_nearest;
mod metric_tree;
mod milestones;
mod radius;
mod randomised;

methods! {
    /// The neighbour finders, as a problem file names them.
    pub enum FinderKind: dyn Finder {
        KNearest(k_nearest::KNearest),
        Radius(radius::Radius),
        CaRmsd(ca_rmsd::CaRmsd),
        BruteForce(brute_force::BruteForce),
        Approximate(approximate::Approximate),
        MetricTree(metric_tree::MetricTree),
        Randomised(randomised::Randomised), // new ones at the end, since ledgers know methods by number
    }
}

pub use approximate::Approximate;
pub use brute_force::BruteForce;
pub use ca_rmsd::CaRmsd;
pub(crate) use count::CountVisitor;
pub use count::NeighborCount;
pub use k_nearest::KNearest;
pub use metric_tree::MetricTree;
pub use milestones::Milestones;
pub use radius::Radius;
pub use randomised::Randomised;

use crate::context::Context;
use crate::methods::{Complaint, methods};
use crate::model::Scratch;
use crate::neighbor::{self, Neighbor};
use crate::roadmap::{Components, Configs};
use crate::seed::Stream;
use std::collections::BTreeSet;

/// A neighbour finder.
///
/// Neighbours are found in two steps, since milestones may lie in several graphs: in each [`near`](Finder::near) gives those from which,
/// put together in order and cut off after [`most`](Finder::most), [`choose`](Finder::choose) chooses.
pub trait Finder {
    /// The milestones near `q`, nearest first, ties by id. The distances are the finder's own: in the space's metric, or
    /// whatever it measures by.
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        scratch: &mut Scratch,
    ) -> Vec<Neighbor>;

    /// The same among `few` milestones, which no graph keeps an index of, by looking at all; ids are their positions. `total` is
    /// as in [`Milestones`].
    fn near_of_few(
        &self,
        cx: &Context,
        few: &Configs,
        total: usize,
        q: &[f64],
        _scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let most = self.most(total).unwrap_or(few.len());
        neighbor::k_nearest(&cx.space, few, 0..few.len() as u32, q, most)
    }

    /// The pairs of neighbours within a set: each pair once, the lower id first, in ascending order, where the one
    /// is near the other or the other near the one.
    fn pairs(
        &self,
        cx: &Context,
        configs: &Configs,
        chance: &mut Stream,
        scratch: &mut Scratch,
    ) -> Vec<(u32, u32)> {
        let components = Components::of(&cx.space, configs, &[]);
        let all = Milestones::all(configs, &components);
        let mut pairs = BTreeSet::new();
        for (id, q) in configs.iter().enumerate() {
            let id = id as u32;
            let mut near = self.near(cx, &all.but(id), q, scratch);
            self.choose(&mut near, all.total, chance);
            pairs.extend(near.iter().map(|other| (other.id.min(id), other.id.max(id))));
        }
        pairs.into_iter().collect()
    }

    /// The most neighbours of a configuration that [`near`](Finder::near) gives where there are `total` milestones; `None` where
    /// there may be any number.
    fn most(&self, total: usize) -> Option<usize>;

    /// Leaves of the neighbours that [`near`](Finder::near) gave, where there are `total` milestones, those that are to be tried,
    /// nearest first. `chance` is the set's own stream of random numbers for this.
    fn choose(&self, _near: &mut Vec<Neighbor>, _total: usize, _chance: &mut Stream) {}

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

/// The number of neighbours of a finder that is told none: as many as in TR05-007 §4.1.
fn default_neighbors() -> NeighborCount {
    NeighborCount::Fixed(10)
}

/// What is wrong with a number of neighbours.
fn count_complaint(neighbors: NeighborCount) -> Option<Complaint> {
    let is_none = neighbors == NeighborCount::Fixed(0);
    is_none.then(|| Complaint::new("neighbors", "0", "\"auto\" or at least 1"))
}

#[cfg(test)]
mod tests;
