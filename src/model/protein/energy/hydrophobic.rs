//! The hydrophobic effect: side chains that shun water gain by being close.
//!
//! −20 kJ/mol per pair of side chains of A V I L M F W C P Y whose centroids are less than 6 Å apart, |i − j| ≥ 2. The papers
//! name such a term without its form, so the form is our own choice.

use crate::lanes::{Lanes, with_lanes};
use crate::model::protein::atoms::ResidueAtoms;
use crate::model::protein::placed::{Placed, Site};
use fearless_simd::f64x4;
use fearless_simd::prelude::*;

/// Closer than this, Å, two side chains are a pair.
const REACH: f64 = 6.0;
/// What a pair gains, kJ/mol.
const GAIN: f64 = -20.0;
/// Side chains that are looked at at once.
const LANES: usize = 4;

/// The hydrophobic side chains of a chain.
#[derive(Clone, Debug)]
pub struct Hydrophobic {
    residues: Vec<u32>,
    lanes: Lanes,
}

impl Hydrophobic {
    /// Of a chain.
    pub fn of(atoms: &[ResidueAtoms]) -> Hydrophobic {
        let counts = |atoms: &ResidueAtoms| atoms.is_hydrophobic && atoms.centroid.is_some();
        let residues = (0..).zip(atoms).filter(|(_, atoms)| counts(atoms));
        let residues = residues.map(|(residue, _)| residue).collect();
        Hydrophobic { residues, lanes: Lanes::widest() }
    }

    /// How many pairs there are.
    pub fn pairs(&self, placed: &Placed) -> usize {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.count(simd, placed)
        ))
    }

    #[inline(always)]
    fn count<S: Simd>(&self, simd: S, placed: &Placed) -> usize {
        // By fours; behind the last one are no numbers, which are close to nothing.
        let fours = self.residues.len().div_ceil(LANES);
        let mut at = vec![[[f64::NAN; LANES]; 3]; fours];
        for (number, residue) in self.residues.iter().enumerate() {
            let (four, lane, residue) = (number / LANES, number % LANES, *residue as usize);
            let centroid = placed.at(Site::Centroid, residue);
            at[four][0][lane] = centroid.x;
            at[four][1][lane] = centroid.y;
            at[four][2][lane] = centroid.z;
        }
        let mut count = 0;
        for (number, residue) in self.residues.iter().enumerate() {
            let (four, lane) = (number / LANES, number % LANES);
            let [x, y, z] = at[four];
            let one = [
                f64x4::splat(simd, x[lane]),
                f64x4::splat(simd, y[lane]),
                f64x4::splat(simd, z[lane]),
            ];
            // Of its own four those behind it, and not the neighbour along the chain.
            let is_neighbour = self.residues.get(number + 1) == Some(&(residue + 1));
            let skipped = lane + 1 + usize::from(is_neighbour);
            count += (close(simd, one, &at[four]) & (0xF << skipped) & 0xF).count_ones();
            let mut rest = &at[four + 1..];
            if let [first, others @ ..] = rest
                && skipped > LANES
            {
                count += (close(simd, one, first) & 0xE).count_ones();
                rest = others;
            }
            for others in rest {
                count += close(simd, one, others).count_ones();
            }
        }
        count as usize
    }

    /// The energy, model kJ/mol.
    pub fn energy(&self, placed: &Placed) -> f64 {
        GAIN * self.pairs(placed) as f64
    }

    /// Of these lanes.
    #[cfg(test)]
    pub(super) fn set_lanes(&mut self, lanes: Lanes) {
        self.lanes = lanes;
    }
}

/// Whether four centroids are close to one, by bits.
#[inline(always)]
fn close<S: Simd>(simd: S, [x, y, z]: [f64x4<S>; 3], others: &[[f64; LANES]; 3]) -> u64 {
    let dx = x - f64x4::load_array_ref(simd, &others[0]);
    let dy = y - f64x4::load_array_ref(simd, &others[1]);
    let dz = z - f64x4::load_array_ref(simd, &others[2]);
    let limit = f64x4::splat(simd, REACH * REACH);
    (dx * dx + dy * dy + dz * dz).simd_lt(limit).to_bitmask()
}
