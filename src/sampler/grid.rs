use super::shares::{Shares, default_block};
use super::{GaveUp, Sampler, default_attempts, zero};
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
/// A pass visits every cell once, at a point that is uniform in the cell. (If it were the cell's centre, a roadmap would
/// have only as many different values of each degree of freedom as there are cells along it, and later passes would
/// add nothing.) The order of the m cells is i ↦ (a i + c) mod m with a coprime to m; a and c are drawn for each pass.
/// Invalid points are passed over. `shares.rs` says how sets share points; a sequence there is one pass after the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Number of cells along every degree of freedom.
    pub cells: u32,
    /// Number of consecutive points that a set owns of each sequence; best the number of nodes per set.
    #[serde(default = "default_block")]
    pub block: u32,
    /// The most points tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Grid {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(cells: u32) -> Grid {
        Grid { cells, block: default_block(), attempts: default_attempts() }
    }
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
        zero("cells", self.cells)
            .or_else(|| zero("block", self.block))
            .or_else(|| zero("attempts", self.attempts))
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

/// Draws a number below `whole` that is coprime to it, by Euclid's algorithm on drawn numbers.
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
