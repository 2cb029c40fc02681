//! Descents: how a configuration is moved to one of lower energy near it. One file per method.
//!
//! O. B. Bayazit (*Solving Motion Planning Problems by Iterative Relaxation of Constraints*, PhD thesis, Texas A&M University, 2003,
//! chapter V E) improves approximate solutions so: nodes near a protein's surface are pushed to local minima of the energy.

mod basin_hopping;
mod gradient;
mod lowest_neighbor;
#[cfg(test)]
mod tests;

methods! {
    /// The descents, as a problem file names them.
    pub enum DescentKind: dyn Descent {
        LowestNeighbor(lowest_neighbor::LowestNeighbor),
        Gradient(gradient::Gradient),
        BasinHopping(basin_hopping::BasinHopping), // new ones at the end, since ledgers know methods by number
    }
}

pub use basin_hopping::BasinHopping;
pub use gradient::Gradient;
pub use lowest_neighbor::LowestNeighbor;

use crate::context::Context;
use crate::methods::{Complaint, methods};
use crate::model::Scratch;
use crate::seed::Stream;

/// The descent by the gradient.
impl Default for DescentKind {
    fn default() -> DescentKind {
        DescentKind::Gradient(Gradient::default())
    }
}

/// A way of going down.
pub trait Descent {
    /// Moves `q`, which is within the bounds, to a configuration within them whose energy is not higher, and returns that energy. All
    /// randomness comes from `stream`.
    fn descend(
        &self,
        cx: &Context,
        stream: &mut Stream,
        q: &mut [f64],
        scratch: &mut Scratch,
    ) -> f64;

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }

    /// Whether the method is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    fn suits(&self, cx: &Context) -> Result<(), String>;
}

/// The most iterations of a descent.
const ITERATIONS_MAX: u32 = 1_000_000;

/// What is wrong with a number of iterations.
fn complaint_of_iterations(iterations: u32) -> Option<Complaint> {
    let fits = (1..=ITERATIONS_MAX).contains(&iterations);
    (!fits).then(|| Complaint::new("iterations", iterations, "1 to 1000000"))
}

/// A configuration in the middle of the space, to ask a model what it can.
fn middle(cx: &Context) -> Vec<f64> {
    let mut middle = vec![0.0; cx.space.len()];
    cx.space.of_cube(&vec![0.5; cx.space.cube_dimensions()], &mut middle);
    middle
}
