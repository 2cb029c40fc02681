//! The linkage of a protein's backbone: phi and psi turn, everything else is as in the source structure.
//!
//! Residues are counted from 0 along the chain. Torsion phi of a residue turns everything after the bond N–CA, and psi
//! everything after CA–C. The first residue has no phi, the last no psi, and a proline's phi is fixed (K. Nath's thesis,
//! ch. 3, has both turn in every residue, and says nothing of these). Omega, all bond lengths and all bond angles are
//! fixed at the source's.
//!
//! A body of the linkage is what moves as one. Body 0 is what no torsion moves; torsion number k (from 0) moves all bodies
//! from k + 1 on. An atom's position is its position in the source, turned by the torsions before it, the last first,
//! each about its axis in the source by its difference to the source's value. So the source's torsions give back the
//! source's positions to the bit.

use crate::math;
use crate::structure::{Point, Residue, peptides, torsion};
use nalgebra::{Matrix3, Unit};

/// Which torsion of a residue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorsionKind {
    /// About N–CA: C(i−1), N, CA, C.
    Phi,
    /// About CA–C: N, CA, C, N(i+1).
    Psi,
}

/// A torsion that turns.
#[derive(Clone, Debug)]
pub struct Torsion {
    /// The residue whose torsion it is, counted from 0.
    pub residue: usize,
    /// Which one.
    pub kind: TorsionKind,
    /// The axis in the source, along the bond away from the N terminus.
    pub axis: Unit<Point>,
    /// A point of the axis in the source, Å.
    pub through: Point,
    /// The source's value in radians, in [−π, π).
    pub source: f64,
}

/// An atom of the linkage: where it is in the source, and the body that carries it along.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// The position in the source, Å.
    pub position: Point,
    /// The number of torsions before it.
    pub body: usize,
}

/// The linkage.
#[derive(Clone, Debug)]
pub struct Linkage {
    /// The torsions, from the N terminus to the C terminus: the degrees of freedom.
    pub torsions: Vec<Torsion>,
    /// The residues after which the chain is broken, counted from 0, ascending.
    pub gaps: Vec<usize>,
}

/// A body's motion from the source: x ↦ rotation · x + translation.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// The rotation.
    pub rotation: Matrix3<f64>,
    /// The translation, Å.
    pub translation: Point,
}

impl Motion {
    /// Where a position of the source goes.
    pub fn apply(&self, position: &Point) -> Point {
        self.rotation * position + self.translation
    }
}

/// Rotation about a unit vector by the angle that has this sine and cosine (Rodrigues).
fn rotation(axis: &Unit<Point>, sin: f64, cos: f64) -> Matrix3<f64> {
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let t = 1.0 - cos;
    Matrix3::new(
        cos + t * x * x,
        t * x * y - sin * z,
        t * x * z + sin * y,
        t * x * y + sin * z,
        cos + t * y * y,
        t * y * z - sin * x,
        t * x * z - sin * y,
        t * y * z + sin * x,
        cos + t * z * z,
    )
}

/// Below this sine of the angle C(i−1)–N–CA the three count as in a line.
const IN_LINE: f64 = 1e-3;

/// The first residue, counted from 0, whose N stands in a line with its CA and the C of the residue before it. Phi is not
/// defined there, nor is the frame in which motions see what follows the peptide bond. Residues that lack one of the three
/// are passed over.
pub fn in_line(residues: &[Residue]) -> Option<usize> {
    let is_in_line = |pair: &[Residue]| {
        let [c, n, ca] = [pair[0].position("C")?, pair[1].position("N")?, pair[1].position("CA")?];
        let (back, forth) = (c - n, ca - n);
        let sine = back.cross(&forth).norm() / (back.norm() * forth.norm());
        // The sine is no number where two of them are in one place.
        Some(sine.is_nan() || sine < IN_LINE)
    };
    let before = residues.windows(2).position(|pair| is_in_line(pair) == Some(true))?;
    Some(before + 1)
}

impl Linkage {
    /// The linkage of a chain all of whose residues have N, CA and C. `None` where one has not, where a coordinate is no
    /// number, or where atoms stand on one another. What follows a gap moves as one with what is before it.
    pub fn of(residues: &[Residue]) -> Option<Linkage> {
        let backbone: Vec<[Point; 3]> = residues
            .iter()
            .map(|residue| {
                let [n, ca, c] = ["N", "CA", "C"].map(|name| residue.position(name));
                let atoms = [n?, ca?, c?];
                atoms.iter().flatten().all(|value| value.is_finite()).then_some(atoms)
            })
            .collect::<Option<_>>()?;
        let gaps: Vec<usize> = peptides::gaps(residues).iter().map(|gap| gap.before).collect();
        let is_broken = |after: usize| gaps.binary_search(&after).is_ok();
        let mut torsions = Vec::new();
        for (residue, [n, ca, c]) in backbone.iter().enumerate() {
            let is_proline =
                residues[residue].amino_acid == Some(crate::structure::AminoAcid::Proline);
            let mut add = |kind, from: &Point, to: &Point, source| {
                let axis = Unit::try_new(to - from, 1e-3)?;
                torsions.push(Torsion { residue, kind, axis, through: *from, source });
                Some(())
            };
            if residue > 0 && !is_proline && !is_broken(residue - 1) {
                add(TorsionKind::Phi, n, ca, torsion(&backbone[residue - 1][2], n, ca, c))?;
            }
            if let Some([next, ..]) = backbone.get(residue + 1)
                && !is_broken(residue)
            {
                add(TorsionKind::Psi, ca, c, torsion(n, ca, c, next))?;
            }
        }
        Some(Linkage { torsions, gaps })
    }

    /// The source's torsions.
    pub fn source(&self) -> Vec<f64> {
        self.torsions.iter().map(|torsion| torsion.source).collect()
    }

    /// The body that carries an atom of a residue.
    pub fn body(&self, residue: usize, atom: &str) -> usize {
        // N and its hydrogen, or deuterium, are before phi; O is after psi, OXT and all else between.
        let is_before = |torsion: &Torsion| match torsion.residue.cmp(&residue) {
            std::cmp::Ordering::Less => true,
            std::cmp::Ordering::Greater => false,
            std::cmp::Ordering::Equal => match torsion.kind {
                TorsionKind::Phi => !matches!(atom, "N" | "H" | "HN" | "D" | "DN" | "CA"),
                TorsionKind::Psi => matches!(atom, "O"),
            },
        };
        self.torsions.partition_point(is_before)
    }

    /// The motion of every body, from the source, at the configuration `q`: one more than there are torsions.
    pub fn motions(&self, q: &[f64]) -> Vec<Motion> {
        let mut last = Motion { rotation: Matrix3::identity(), translation: Point::zeros() };
        let mut motions = Vec::with_capacity(q.len() + 1);
        motions.push(last);
        for (torsion, value) in self.torsions.iter().zip(q) {
            let angle = value - torsion.source;
            let turn = rotation(&torsion.axis, math::sin(angle), math::cos(angle));
            let shift = torsion.through - turn * torsion.through;
            last = Motion {
                rotation: last.rotation * turn,
                translation: last.rotation * shift + last.translation,
            };
            motions.push(last);
        }
        motions
    }
}
