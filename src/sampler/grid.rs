use super::shares::{Shares, default_block, no_block};
use super::{GaveUp, Sampler, default_attempts, no_attempts};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Grid sampling (S. M. LaValle, M. S. Branicky, S. R. Lindemann, *On the relationship between classical
/// grid search and probabilistic roadmaps*, 2004): cells of equal measure, the same number along every
/// degree of freedom (rotations: along each of the three numbers that name one,
/// [`Space::of_cube`](crate::space::Space::of_cube)), visited in a shuffled order.
///
/// A pass visits every cell once. Its point is uniform in the cell: always the same place would leave a
/// roadmap with as many different values of each degree of freedom as there are cells, and later passes
/// with nothing new. The order is i ↦ (a i + c) mod m with a prime to m, drawn for the pass. Invalid points
/// are passed over. `shares.rs` says how sets share a pass; a sequence there is pass after pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Cells along every degree of freedom.
    pub cells: u32,
    /// Points that a set takes at a time: best the nodes per set.
    #[serde(default = "default_block")]
    pub block: u32,
    /// The most points tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

/// The most cells: a roadmap never has as many nodes, so that a grid of more is never completed.
const CELLS_MAX: u64 = u32::MAX as u64;

impl Grid {
    /// Cells of the whole grid, if not too many.
    fn cells_in(&self, dimensions: usize) -> Option<u64> {
        let mut whole: u64 = 1;
        for _ in 0..dimensions {
            whole = whole.checked_mul(u64::from(self.cells)).filter(|cells| *cells <= CELLS_MAX)?;
        }
        Some(whole)
    }
}

impl Sampler for Grid {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let dimensions = cx.space.cube_dimensions();
        let whole = self.cells_in(dimensions).expect("a checked problem's grid is small enough");
        let along = u64::from(self.cells);
        let shares = Shares { block: self.block, attempts: self.attempts };
        shares.sample(cx, seed, count, scratch, out, |sequence| {
            let sequence = *sequence;
            move |number, point: &mut [f64]| {
                let (pass, number) = (sequence.common(number / whole), number % whole);
                let mut stream = pass.stream(Purpose::Sampling);
                let (factor, start) = (coprime(whole, &mut stream), stream.below(whole));
                // Below 2⁶⁴, since the grid has fewer than 2³² cells.
                let mut cell = (factor * number + start) % whole;
                let mut stream = pass.common(number).stream(Purpose::Sampling);
                for coordinate in point {
                    *coordinate = ((cell % along) as f64 + stream.unit()) / along as f64;
                    cell /= along;
                }
            }
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.cells == 0 {
            return Some(("cells", "0".to_owned(), "at least 1"));
        }
        no_block(self.block).or_else(|| no_attempts(self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        let dimensions = cx.space.cube_dimensions();
        if self.cells_in(dimensions).is_none() {
            let found = format!("a grid of {} cells along {dimensions} dimensions", self.cells);
            return Err(format!("{found} found; at most {CELLS_MAX} cells in all expected"));
        }
        Ok(())
    }
}

/// A number below `whole` without a common divisor with it, drawn.
fn coprime(whole: u64, stream: &mut Stream) -> u64 {
    loop {
        let (mut a, mut b) = (whole, stream.below(whole));
        let drawn = b;
        while b > 0 {
            (a, b) = (b, a % b);
        }
        if a == 1 {
            return drawn;
        }
    }
}
