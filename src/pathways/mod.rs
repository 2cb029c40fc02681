//! Pathways: several ways from one configuration to another out of one roadmap, ranked and compared.
//!
//! A query has one answer. A transition of a molecule may go by several pathways, of which the one with the lowest barrier,
//! or the least cost, is only the first. [`k_best`] gives the best ones whatever they are, which often differ by a node or
//! two; [`dissimilar`] gives ones that are at least a distance apart along their whole length, [`distinct`] ones that pass
//! obstacles differently.
//!
//! Lengths and distances are Å of Cα RMSD after superposition in models that have Cα
//! ([`Model::shape`](crate::model::Model::shape)), otherwise in the space's metric. Costs and energies are in the model's
//! units.
//!
//! ```
//! use roadmill::pathways::{self, KBest, Rank};
//! use roadmill::{Build, Cancel, model::Scratch, problem::Problem};
//!
//! let problem = Problem::load("tests/problems/landscape.toml".as_ref())?;
//! let built = Build::new(problem).run()?;
//! let (cx, scratch) = (built.context(), &mut Scratch::new());
//! let ends = cx.query().expect("the problem has a query");
//! let asked = KBest { count: 3, rank: Rank::Barrier, spacing: 0.05 };
//! let attachment = built.problem().attachment();
//! let (roadmap, cancel) = (built.roadmap(), Cancel::new());
//! let found = pathways::k_best(cx, roadmap, ends, &attachment, &asked, &cancel, scratch)?;
//! for pathway in &found.pathways {
//!     println!("{:?} {:?}", pathway.measured.there, pathway.measured.back);
//! }
//! # assert_eq!(found.pathways.len(), 3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod classes;
mod dissimilar;
mod distinct;
mod frame_table;
mod frames;
mod frechet;
mod k_best;
mod measured;
pub mod topology;
mod via_nodes;

pub use crate::roadmap::Rank;
pub use dissimilar::{DISTANCE, Dissimilar, dissimilar, dissimilar_unshortened};
pub use distinct::{Distinct, DistinctPathways, distinct};
pub use frame_table::{DomainAngle, FormedContact, FrameTable};
pub use frames::{Frames, SPACING, TooFine};
pub use frechet::{Decided, discrete_frechet, hausdorff};
pub use k_best::{KBest, k_best};
pub use measured::{Measured, OneWay};

use crate::cancel::Cancel;
use crate::context::Context;
use crate::model::Scratch;
use crate::query::Path;
use rayon::prelude::*;

/// One way from the start to the goal.
#[derive(Clone, Debug)]
pub struct Pathway {
    /// The path. Every edge of it has passed the finer check of paths that are given out.
    pub path: Path,
    /// What it comes to in both directions.
    pub measured: Measured,
    /// The path cut into frames.
    pub frames: Frames,
}

/// The pathways that were found, the best first.
#[derive(Clone, Debug, Default)]
pub struct Pathways {
    /// The pathways in their ranking.
    pub pathways: Vec<Pathway>,
    /// How far each two of them are apart, in the order of the second, then of the first. Where the search was cut, that is
    /// certain of the first 20 pathways only: distances from others are missing as far as they were not measured by then.
    pub pairs: Vec<Pair>,
    /// Whether any route joins the ends, by the roadmap's edges as they are recorded.
    pub connected: bool,
    /// How many routes were looked at closely.
    pub tried: usize,
    /// Edges that failed the finer check and were left out.
    pub dropped_edges: u64,
    /// Whether the search was cancelled, so that there may be others, or better ones.
    pub is_cut: bool,
}

/// How far two pathways are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Their indices in [`Pathways::pathways`], the lower one first.
    pub first: usize,
    /// The higher one.
    pub second: usize,
    /// The discrete Fréchet distance of their frames, with the pair of frames that decides it.
    pub frechet: Decided,
    /// The Hausdorff distance of their frames, the larger of the two directions.
    pub hausdorff: Decided,
}

impl Pathway {
    /// Measures a path and cuts it into frames. `None` where one of its motions does not pass the finer check.
    pub(crate) fn of(
        cx: &Context,
        path: Path,
        spacing: f64,
        scratch: &mut Scratch,
    ) -> Result<Option<Pathway>, TooFine> {
        let Some(measured) = Measured::of(cx, &path, scratch) else { return Ok(None) };
        let frames = Frames::of(cx, &path, spacing, scratch)?;
        Ok(Some(Pathway { path, measured, frames }))
    }
}

/// So many pathways are compared with each other also once a search is cancelled.
const COMPARED: usize = 20;

/// How far each two pathways are apart. Once `cancel` says so, pathways after the first [`COMPARED`] are compared with none before
/// them. Measured in several threads; the outcome does not depend on how many.
pub(crate) fn pairs(cx: &Context, pathways: &[Pathway], cancel: &Cancel) -> Vec<Pair> {
    let with_earlier = |second: usize| -> Vec<Pair> {
        let is_over = second >= COMPARED && cancel.is_cancelled();
        let earlier = &pathways[..if is_over { 0 } else { second }];
        let frames = &pathways[second].frames;
        let pair = |(first, one): (usize, &Pathway)| {
            let frechet = one.frames.frechet(frames, &cx.space);
            let hausdorff = one.frames.hausdorff(frames, &cx.space);
            Pair { first, second, frechet, hausdorff }
        };
        earlier.iter().enumerate().map(pair).collect()
    };
    let all: Vec<Vec<Pair>> = (0..pathways.len()).into_par_iter().map(with_earlier).collect();
    all.concat()
}

#[cfg(test)]
mod tests;
