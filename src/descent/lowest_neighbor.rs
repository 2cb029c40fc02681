use super::{Descent, complaint_of_iterations, middle};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::scene::LENGTH_MAX;
use crate::seed::Stream;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The approximate gradient descent of O. B. Bayazit's thesis (2003, chapter V E 1): *"for each generated node, we uniformly sample n
/// nearby nodes, and select the lowest potential new node for iteration. We chose n = 2d … This process is repeated for K
/// iterations, or until a local minimum is reached (when all sampled nodes have higher potential)."*
///
/// Here d is the number of the space's dimensions, as there. Neither how near the nodes are nor K is said there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct LowestNeighbor {
    /// How near the sampled configurations are, in the metric of the space: uniformly distributed in the ball of this radius.
    pub radius: f64,
    /// K, the most iterations.
    pub iterations: u32,
}

impl Default for LowestNeighbor {
    fn default() -> LowestNeighbor {
        LowestNeighbor { radius: 0.5, iterations: 20 }
    }
}

impl Descent for LowestNeighbor {
    fn descend(
        &self,
        cx: &Context,
        stream: &mut Stream,
        q: &mut [f64],
        scratch: &mut Scratch,
    ) -> f64 {
        let dimensions = cx.space.cube_dimensions();
        let mut lowest = energy(cx, q, scratch);
        let (mut near, mut best) = (q.to_vec(), q.to_vec());
        for _ in 0..self.iterations {
            let before = lowest;
            for _ in 0..2 * dimensions {
                cx.space.step_within(q, self.radius, stream, &mut near);
                if !cx.space.within_bounds(&near) {
                    continue;
                }
                let found = energy(cx, &near, scratch);
                if found < lowest {
                    lowest = found;
                    best.copy_from_slice(&near);
                }
            }
            // No energy is NaN.
            if lowest >= before {
                break;
            }
            q.copy_from_slice(&best);
        }
        lowest
    }

    fn complaint(&self) -> Option<Complaint> {
        Complaint::of_length("radius", self.radius, LENGTH_MAX)
            .or_else(|| complaint_of_iterations(self.iterations))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        // An energy with derivatives is one; it may take long to find the first.
        let has_energy =
            cx.model.has_gradient() || cx.model.energy(&middle(cx), &mut Scratch::new()).is_some();
        match has_energy {
            true => Ok(()),
            false => Err("a descent found, a model with energies expected".to_owned()),
        }
    }
}

/// The energy of a model that has energies; that of an energy which is no number is above all others.
fn energy(cx: &Context, q: &[f64], scratch: &mut Scratch) -> f64 {
    let energy = cx.model.energy(q, scratch).unwrap_or(f64::INFINITY);
    if energy.is_nan() { f64::INFINITY } else { energy }
}
