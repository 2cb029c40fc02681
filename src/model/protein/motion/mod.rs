//! Motions of a protein: whether a chain keeps its distances during a whole motion, proved.
//!
//! A motion turns all torsions at constant rates, each the short way round. At every time of a motion that is accepted
//! all distances of [`Limits`] are kept; a motion is refused if at some time one of them is kept by less than 10⁻⁶ Å, or not
//! at all. `docs/protein-motions.md` derives the bounds.

mod balls;
mod chain;
mod cubic;
mod curves;
mod limits;
mod points;
mod profile;
mod sample;
mod search;
mod straight;

#[cfg(test)]
mod tests;

pub use limits::Limits;
pub use profile::{EnergySteps, Profile, profile, steps};
pub use search::MotionScratch;

use super::linkage::Linkage;
use crate::structure::{Point, Residue};

/// A chain made ready for judging motions.
#[derive(Clone, Debug)]
pub struct MotionValidity {
    chain: chain::Chain,
    obstacles: balls::Obstacles,
}

impl MotionValidity {
    /// Prepares the chain of a linkage and of the residues that it was made of. `obstacles` are points that stand still, in
    /// the frame of the source. `None` where a residue lacks N, CA, C or O, and where N stands in a line with CA and the C
    /// before it ([`in_line`](super::linkage::in_line)).
    pub fn new(
        linkage: &Linkage,
        residues: &[Residue],
        obstacles: &[Point],
        limits: Limits,
    ) -> Option<MotionValidity> {
        let chain = chain::Chain::of(linkage, residues, obstacles, limits)?;
        let obstacles: Vec<Point> =
            obstacles.iter().map(|obstacle| obstacle - chain.origin).collect();
        Some(MotionValidity { obstacles: balls::Obstacles::new(&obstacles), chain })
    }

    /// Whether the motion from `a` to `b`, torsions in radians, keeps all limits at all times. Its reverse has the same
    /// verdict. Numbers that are not finite, or not as many as there are torsions, are refused.
    pub fn is_valid(&self, a: &[f64], b: &[f64], scratch: &mut MotionScratch) -> bool {
        search::is_valid(&self.chain, &self.obstacles, a, b, scratch)
    }

    /// Whether the limits are kept at the times k/`steps` of that motion, the ends among them, for `steps` from 1 on. What
    /// happens between these times is not looked at: this is what the literature does.
    pub fn is_valid_at(
        &self,
        (a, b): (&[f64], &[f64]),
        steps: usize,
        scratch: &mut MotionScratch,
    ) -> bool {
        search::is_valid_at(&self.chain, &self.obstacles, (a, b), steps.max(1), scratch)
    }
}
