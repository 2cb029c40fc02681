//! The terms of a pair of atoms, for eight atoms of the protein at once.

use super::cells::{Cells, LANES};
use super::parameters::{KCAL, PairCoefficients};
use super::switch::{NEAREST_SQUARED, Switch};
use crate::structure::Point;
use fearless_simd::f64x8;
use fearless_simd::prelude::*;

/// N_A e² / (4 π ε₀) in kJ Å / mol: the energy of two elementary charges 1 Å apart in vacuum. From CODATA 2018 and 2022,
/// which agree in all of these digits.
pub const COULOMB: f64 = 1389.35458;
/// The least energy of a hydrophobic pair in kJ/mol: AutoDock Vina's weight of −0.035069 kcal/mol.
pub const HYDROPHOBIC_DEPTH: f64 = -0.035069 * KCAL;
/// The distance of the atoms' surfaces in Å below which a hydrophobic pair has its least energy.
pub const HYDROPHOBIC_NEAR: f64 = 0.5;
/// The distance of the atoms' surfaces in Å from which on a hydrophobic pair has none.
pub const HYDROPHOBIC_FAR: f64 = 1.5;

/// What a term says of eight pairs: the energies in kJ/mol, and their derivatives by the squared distance.
pub(super) type Eight<S> = (f64x8<S>, f64x8<S>);

/// A term of pairs of one atom of the ligand with the atoms of the protein, in the order of their cells.
pub(super) trait Term {
    /// The energies of the eight pairs from number `first` on, at these squared distances, which are at least
    /// [`NEAREST_SQUARED`].
    fn eight<S: Simd>(&self, simd: S, first: usize, squared: f64x8<S>) -> Eight<S>;
}

/// A/r¹² − B/r⁶, switched off at the cut-off.
pub(super) struct VanDerWaalsTerm<'a> {
    pub switch: Switch,
    /// A of every atom of the protein, in kJ/mol Å¹².
    pub a: &'a [f64],
    /// B, in kJ/mol Å⁶.
    pub b: &'a [f64],
}

impl Term for VanDerWaalsTerm<'_> {
    #[inline(always)]
    fn eight<S: Simd>(&self, simd: S, first: usize, squared: f64x8<S>) -> Eight<S> {
        let number = |value: f64| f64x8::splat(simd, value);
        let a = f64x8::from_slice(simd, &self.a[first..first + LANES]);
        let b = f64x8::from_slice(simd, &self.b[first..first + LANES]);
        let (factor, slope) = self.switch.at_eight(simd, squared);
        let inverse = number(1.0) / squared;
        let sixth = inverse * inverse * inverse;
        let repulsion = a * sixth * sixth;
        let attraction = b * sixth;
        let energy = repulsion - attraction;
        let derivative = (number(3.0) * attraction - number(6.0) * repulsion) * inverse;
        (energy * factor, derivative * factor + energy * slope)
    }
}

/// q/r², q holding both charges and what they are multiplied by, switched off at the cut-off.
pub(super) struct CoulombTerm<'a> {
    pub switch: Switch,
    /// The charges of the atoms of the protein times [`COULOMB`] over the factor of the dielectric, in kJ/mol Å² per
    /// elementary charge.
    pub strengths: &'a [f64],
    /// The charge of the atom of the ligand in elementary charges.
    pub charge: f64,
}

impl Term for CoulombTerm<'_> {
    #[inline(always)]
    fn eight<S: Simd>(&self, simd: S, first: usize, squared: f64x8<S>) -> Eight<S> {
        let strength = f64x8::from_slice(simd, &self.strengths[first..first + LANES])
            * f64x8::splat(simd, self.charge);
        let (factor, slope) = self.switch.at_eight(simd, squared);
        let inverse = f64x8::splat(simd, 1.0) / squared;
        let energy = strength * inverse;
        (energy * factor, energy * slope - energy * inverse * factor)
    }
}

/// AutoDock Vina's hydrophobic term: its depth where surfaces are at most 0.5 Å apart, none from 1.5 Å on, a straight
/// line between.
pub(super) struct HydrophobicTerm<'a> {
    /// The radii of the atoms of the protein, in Å.
    pub radii: &'a [f64],
    /// The radius of the atom of the ligand, in Å.
    pub radius: f64,
}

impl Term for HydrophobicTerm<'_> {
    #[inline(always)]
    fn eight<S: Simd>(&self, simd: S, first: usize, squared: f64x8<S>) -> Eight<S> {
        let number = |value: f64| f64x8::splat(simd, value);
        let radii = f64x8::from_slice(simd, &self.radii[first..first + LANES]);
        let distance = squared.sqrt();
        let left = number(HYDROPHOBIC_FAR + self.radius) + radii - distance;
        let width = number(HYDROPHOBIC_FAR - HYDROPHOBIC_NEAR);
        let depth = number(HYDROPHOBIC_DEPTH) / width;
        let share = left.max(number(0.0)).min(width);
        let is_between = left.simd_gt(number(0.0)) & left.simd_lt(width);
        let derivative = number(-0.5) * depth / distance;
        (depth * share, is_between.select(derivative, number(0.0)))
    }
}

/// The sum of a term over the points of cells for an atom at `at`: its energy in kJ/mol, and the derivative by the atom's
/// position in kJ/(mol Å).
///
/// Every lane sums its own pairs in the order of the runs; then the lanes are summed, the first one first. So the bits
/// are those of eight sums, whatever the processor does at once.
#[inline(always)]
pub(super) fn sum<S: Simd>(
    simd: S,
    cells: &Cells,
    reach: f64,
    at: Point,
    term: &impl Term,
) -> (f64, Point) {
    let number = |value: f64| f64x8::splat(simd, value);
    let zero = number(0.0);
    let (nearest, two) = (number(NEAREST_SQUARED), number(2.0));
    let [x, y, z] = [number(at.x), number(at.y), number(at.z)];
    let mut sums = [zero; 4];
    let [xs, ys, zs] = &cells.at;
    cells.runs(
        at,
        0.0,
        reach,
        #[inline(always)]
        |run| {
            for first in run.step_by(LANES) {
                let x = x - f64x8::from_slice(simd, &xs[first..first + LANES]);
                let y = y - f64x8::from_slice(simd, &ys[first..first + LANES]);
                let z = z - f64x8::from_slice(simd, &zs[first..first + LANES]);
                let squared = x * x + y * y + z * z;
                let (energy, derivative) = term.eight(simd, first, squared.max(nearest));
                // Nearer atoms count as being at one distance, so that nothing changes with their position.
                let derivative = squared.simd_gt(nearest).select(two * derivative, zero);
                sums[0] += energy;
                sums[1] += derivative * x;
                sums[2] += derivative * y;
                sums[3] += derivative * z;
            }
        },
    );
    let [energy, x, y, z] =
        sums.map(|lanes| lanes.as_slice().iter().fold(0.0, |sum, lane| sum + lane));
    (energy, Point::new(x, y, z))
}

/// The 12-6 and Coulomb energy of one pair, and its derivative by the squared distance, as the terms above give them.
pub(super) fn one_pair(
    switch: Switch,
    PairCoefficients { a, b }: PairCoefficients,
    strength: f64,
    squared: f64,
) -> ([f64; 2], f64) {
    let x = squared.max(NEAREST_SQUARED);
    let inverse = 1.0 / x;
    let sixth = inverse * inverse * inverse;
    let (factor, slope) = switch.at(x);
    let [repulsion, attraction] = [a * sixth * sixth, b * sixth];
    let energies = [repulsion - attraction, strength * inverse];
    let together = energies[0] + energies[1];
    let derivative = (3.0 * attraction - 6.0 * repulsion - energies[1]) * inverse;
    let derivative =
        if squared > NEAREST_SQUARED { derivative * factor + together * slope } else { 0.0 };
    (energies.map(|energy| energy * factor), derivative)
}
