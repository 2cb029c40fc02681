//! Constraints: what the native structure holds together.
//!
//! U = Σ K {[(d − d₀)² + d_c²]^½ − d_c} over pairs at a distance d (M. Levitt, J. Mol. Biol. 170, 1983, as K. Nath's thesis,
//! ch. 3, has it), K = 100 kJ/(mol·Å) and d_c = 2 Å: harmonic near d₀, and of constant force far from it. Of a hydrogen
//! bond, d is the distance H···O and d₀ = 2 Å; of a disulphide, d is that of the two side chains' centroids and d₀ is what it
//! is in the source.

use crate::lanes::{Lanes, with_lanes};
use crate::model::protein::KT;
use crate::model::protein::placed::{Placed, Site};
use fearless_simd::f64x4;
use fearless_simd::prelude::*;

/// K, in kJ/(mol·Å).
const STIFFNESS: f64 = 100.0;
/// d_c, in Å.
const SOFTNESS: f64 = 2.0;
/// d₀ of a hydrogen bond, in Å.
const HYDROGEN_BOND: f64 = 2.0;

/// Which atoms a constraint holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ConstraintKind {
    /// The amide hydrogen of the first residue and the carbonyl oxygen of the second.
    HydrogenBond,
    /// The centroids of the side chains of two cysteines.
    Disulphide,
}

/// A constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// Which atoms it holds.
    pub kind: ConstraintKind,
    /// The residue of the hydrogen, or the first cysteine, counted from 0.
    pub first: usize,
    /// The residue of the oxygen, or the second cysteine.
    pub second: usize,
    /// d₀, Å.
    pub distance: f64,
}

impl Constraint {
    /// A hydrogen bond from the amide of a residue to the carbonyl of another.
    pub fn hydrogen_bond(donor: usize, acceptor: usize) -> Constraint {
        let kind = ConstraintKind::HydrogenBond;
        Constraint { kind, first: donor, second: acceptor, distance: HYDROGEN_BOND }
    }

    /// The first and the second derivative of a constraint's energy by its length, where that is `stretch` Å more than the native
    /// one: in kT/Å and kT/Å². The second is positive everywhere.
    pub fn derivatives(stretch: f64) -> (f64, f64) {
        let root = (stretch * stretch + SOFTNESS * SOFTNESS).sqrt();
        let unit = STIFFNESS / KT;
        (unit * stretch / root, unit * (SOFTNESS * SOFTNESS) / (root * root * root))
    }

    /// A disulphide between two residues, the centroids of whose side chains are this far apart in the source, Å.
    pub fn disulphide(first: usize, second: usize, distance: f64) -> Constraint {
        Constraint { kind: ConstraintKind::Disulphide, first, second, distance }
    }
}

/// The constraints of one native structure.
#[derive(Clone, Debug)]
pub struct Constraints {
    list: Vec<Constraint>,
    lanes: Lanes,
}

impl Default for Constraints {
    fn default() -> Constraints {
        Constraints::new(Vec::new())
    }
}

impl Constraints {
    /// These, in this order.
    pub fn new(list: Vec<Constraint>) -> Constraints {
        Constraints { list, lanes: Lanes::widest() }
    }

    /// All of them.
    pub fn list(&self) -> &[Constraint] {
        &self.list
    }

    /// Their energy, model kJ/mol. Of the terms number k, k + 4, k + 8, … are added up, for k = 0, 1, 2, 3, and then the sums
    /// for 0 and 1, those for 2 and 3, and these two.
    pub fn energy(&self, placed: &Placed) -> f64 {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.sum(simd, placed)
        ))
    }

    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, placed: &Placed) -> f64 {
        let number = f64x4::splat;
        let mut sums = number(simd, 0.0);
        // From the second atom to the first, and d₀.
        let apart = |constraint: &Constraint| {
            let Constraint { kind, first: i, second: j, distance } = *constraint;
            let (a, b) = match kind {
                ConstraintKind::HydrogenBond => (Site::H, Site::O),
                ConstraintKind::Disulphide => (Site::Centroid, Site::Centroid),
            };
            let between = placed.at(a, i) - placed.at(b, j);
            [between.x, between.y, between.z, distance]
        };
        for four in self.list.chunks(4) {
            // What is missing in the last four is at its native distance, and its term is 0.
            let [a, b, c, d] = [0, 1, 2, 3].map(|lane| four.get(lane).map_or([0.0; 4], apart));
            let row = |row: usize| f64x4::load_array(simd, [a[row], b[row], c[row], d[row]]);
            let (x, y, z) = (row(0), row(1), row(2));
            let distance = (x * x + y * y + z * z).sqrt();
            let stretch = distance - row(3);
            let softness = number(simd, SOFTNESS);
            let term = (stretch * stretch + softness * softness).sqrt() - softness;
            sums += number(simd, STIFFNESS) * term;
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }

    /// Of these lanes.
    #[cfg(test)]
    pub(super) fn set_lanes(&mut self, lanes: Lanes) {
        self.lanes = lanes;
    }
}
