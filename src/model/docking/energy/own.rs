//! The energy of a ligand's atoms among themselves.

use super::parameters::PairCoefficients;
use super::particle::Particle;
use super::spec::{EnergySpec, Own};
use super::sum::Parts;
use super::switch::{NEAREST_SQUARED, Switch};
use super::terms::{COULOMB, one_pair};
use crate::math;
use crate::structure::Point;

/// The terms of pairs of a ligand's own atoms, as [`Own`] says. They have the parameters, the cut-off and the dielectric of the terms
/// between ligand and protein; the hydrophobic term does not count here.
#[derive(Clone, Debug)]
pub struct OwnTerms {
    switch: Switch,
    repels_only: bool,
    pairs: Vec<Pair>,
}

/// A pair of atoms, and what its energy depends on.
#[derive(Clone, Copy, Debug)]
struct Pair {
    atoms: [usize; 2],
    coefficients: PairCoefficients,
    /// The square of the distance from which on the pair has no energy, in Å².
    reach: f64,
    /// By how much repulsion alone is raised, in kJ/mol, so that it ends at zero.
    depth: f64,
    /// The product of the charges times the constant over the factor of the dielectric, in kJ/mol Å².
    strength: f64,
}

impl OwnTerms {
    /// Of a ligand's particles, for these pairs of them. Pairs of particles that are not there do not count.
    pub fn new(spec: &EnergySpec, ligand: &[Particle], pairs: &[[usize; 2]]) -> OwnTerms {
        let repels_only = spec.own == Own::Repulsion;
        let strength = spec.dielectric.map_or(0.0, |factor| COULOMB / factor);
        let pair = |atoms: &[usize; 2]| {
            let [one, other] = [ligand.get(atoms[0])?, ligand.get(atoms[1])?];
            let coefficients = spec.parameters.pair(one.element, other.element);
            let PairCoefficients { a, b } = coefficients;
            // A/r¹² − B/r⁶ is least at r⁶ = 2A/B, where it is −B²/4A.
            let bottom = (b > 0.0).then(|| (cube_root(2.0 * a / b), b * b / (4.0 * a)));
            let (reach, depth) = bottom.filter(|_| repels_only).unwrap_or((f64::INFINITY, 0.0));
            let strength = one.charge * other.charge * strength;
            Some(Pair { atoms: *atoms, coefficients, reach, depth, strength })
        };
        let count = if spec.own == Own::None { 0 } else { pairs.len() };
        let pairs = pairs.iter().take(count).filter_map(pair).collect();
        OwnTerms { switch: Switch::new(spec.cutoff), repels_only, pairs }
    }

    /// The energy in kJ/mol with the ligand's atoms at these positions in Å.
    pub fn energy(&self, positions: &[Point]) -> f64 {
        self.parts(positions).total()
    }

    /// The same by its parts, whose sum is the energy to the last bit.
    pub fn parts(&self, positions: &[Point]) -> Parts {
        self.visit(positions, |_, _, _| ())
    }

    /// The energy, to the same bits; its derivative by the position of every atom of the ligand, in kJ/(mol Å), is added
    /// to `out`.
    pub fn gradient(&self, positions: &[Point], out: &mut [Point]) -> f64 {
        let parts = self.visit(positions, |[one, other], apart, derivative| {
            let step = apart * (2.0 * derivative);
            if let Some(out) = out.get_mut(one) {
                *out += step;
            }
            if let Some(out) = out.get_mut(other) {
                *out -= step;
            }
        });
        parts.total()
    }

    /// Sums the pairs, and says of each its atoms, the vector from the second to the first, and the derivative of its
    /// energy by the squared distance.
    fn visit(&self, positions: &[Point], mut visit: impl FnMut([usize; 2], Point, f64)) -> Parts {
        let mut parts = Parts::default();
        for Pair { atoms, coefficients, reach, depth, strength } in &self.pairs {
            let (Some(one), Some(other)) = (positions.get(atoms[0]), positions.get(atoms[1]))
            else {
                continue;
            };
            let apart = one - other;
            let squared = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
            // Written so that NaN is not passed over.
            if squared >= *reach {
                continue;
            }
            if self.repels_only {
                let (energy, derivative) = repulsion(*coefficients, *depth, squared);
                parts.van_der_waals += energy;
                visit(*atoms, apart, derivative);
                continue;
            }
            let (energies, derivative) = one_pair(self.switch, *coefficients, *strength, squared);
            parts.van_der_waals += energies[0];
            parts.coulomb += energies[1];
            visit(*atoms, apart, derivative);
        }
        parts
    }
}

/// The energy of a pair that is nearer than its minimum, raised by `depth`, and its derivative by the squared distance.
#[inline]
fn repulsion(PairCoefficients { a, b }: PairCoefficients, depth: f64, squared: f64) -> (f64, f64) {
    let inverse = 1.0 / squared.max(NEAREST_SQUARED);
    let sixth = inverse * inverse * inverse;
    let (repulsion, attraction) = (a * sixth * sixth, b * sixth);
    let derivative = (3.0 * attraction - 6.0 * repulsion) * inverse;
    let derivative = if squared > NEAREST_SQUARED { derivative } else { 0.0 };
    (repulsion - attraction + depth, derivative)
}

/// The cube root of a positive number.
fn cube_root(number: f64) -> f64 {
    math::exp(math::ln(number) / 3.0)
}
