//! Constraints: what the native structure holds together.
//!
//! U = Σ K {[(d − d₀)² + d_c²]^½ − d_c} over pairs at a distance d (M. Levitt, J. Mol. Biol. 170, 1983, as K. Nath's thesis,
//! ch. 3, has it), K = 100 kJ/(mol·Å) and d_c = 2 Å: harmonic near d₀, and of constant force far from it. Of a hydrogen
//! bond, d is the distance H···O and d₀ = 2 Å; of a disulphide, d is that of the two side chains' centroids and d₀ is what it
//! is in the source.

use crate::model::protein::placed::{Coordinates, Placed};

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

    /// A disulphide between two residues, the centroids of whose side chains are this far apart in the source, Å.
    pub fn disulphide(first: usize, second: usize, distance: f64) -> Constraint {
        Constraint { kind: ConstraintKind::Disulphide, first, second, distance }
    }
}

/// The constraints of one native structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraints {
    list: Vec<Constraint>,
}

impl Constraints {
    /// These, in this order.
    pub fn new(list: Vec<Constraint>) -> Constraints {
        Constraints { list }
    }

    /// All of them.
    pub fn list(&self) -> &[Constraint] {
        &self.list
    }

    /// Their energy, model kJ/mol.
    pub fn energy(&self, placed: &Placed) -> f64 {
        let distance = |a: &Coordinates, i: usize, b: &Coordinates, j: usize| {
            let (x, y, z) = (a.x[i] - b.x[j], a.y[i] - b.y[j], a.z[i] - b.z[j]);
            (x * x + y * y + z * z).sqrt()
        };
        let mut sum = 0.0;
        for Constraint { kind, first, second, distance: native } in &self.list {
            let d = match kind {
                ConstraintKind::HydrogenBond => distance(&placed.h, *first, &placed.o, *second),
                ConstraintKind::Disulphide => {
                    distance(&placed.centroid, *first, &placed.centroid, *second)
                }
            };
            let stretch = d - native;
            sum += STIFFNESS * ((stretch * stretch + SOFTNESS * SOFTNESS).sqrt() - SOFTNESS);
        }
        sum
    }
}
