//! Energies beside plain loops, differences, limits, and a program of another hand.

mod grid;
mod parameters;
mod reference;
mod sums;
mod typing;

use super::{EnergySpec, PairSum, Particle};
use crate::ligand::Element;
use crate::structure::Point;

/// Numbers in [0, 1) that look random, the same ones every time (D. H. Lehmer's generator with the factor of S. K. Park and
/// K. W. Miller 1988).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0
    }

    /// A point in a cube about the origin of this half edge.
    fn point(&mut self, half: f64) -> Point {
        let mut coordinate = || half * (2.0 * self.next() - 1.0);
        Point::new(coordinate(), coordinate(), coordinate())
    }
}

fn element(symbol: &str) -> Element {
    Element::of_symbol(symbol).unwrap()
}

fn particle(symbol: &str, charge: f64, is_hydrophobic: bool) -> Particle {
    Particle { element: element(symbol), charge, is_hydrophobic }
}

/// All terms.
fn everything() -> EnergySpec {
    EnergySpec { dielectric: Some(4.0), hydrophobic: true, ..EnergySpec::default() }
}

/// Atoms at random in a cube of 40 Å, no two of them closer than 1.2 Å, so dense as those of a protein: with charges, a metal,
/// and hydrophobic ones.
fn protein(numbers: &mut Numbers) -> (Vec<Particle>, Vec<Point>) {
    let kinds = [
        particle("C", 0.0, true),
        particle("C", 0.0, false),
        particle("N", 1.0, false),
        particle("O", -0.5, false),
        particle("O", 0.0, false),
        particle("S", 0.0, false),
        particle("Zn", 2.0, false),
        particle("Cl", -1.0, true),
    ];
    let mut positions: Vec<Point> = Vec::new();
    while positions.len() < 1500 {
        let point = numbers.point(20.0);
        if positions.iter().all(|other| (other - point).norm() > 1.2) {
            positions.push(point);
        }
    }
    let particles = (0..positions.len()).map(|atom| kinds[atom * 5 % kinds.len()]).collect();
    (particles, positions)
}

/// A ligand with every kind of term.
fn ligand() -> Vec<Particle> {
    vec![
        particle("C", 0.1, true),
        particle("C", -0.2, false),
        particle("O", -0.5, false),
        particle("N", 0.7, false),
        particle("F", -0.1, true),
        particle("Br", 0.0, true),
    ]
}

/// A position of the ligand's atoms somewhere in the cube or beyond it.
fn pose(numbers: &mut Numbers) -> Vec<Point> {
    let centre = numbers.point(26.0);
    ligand().iter().map(|_| centre + numbers.point(3.0)).collect()
}

/// The sum of the protein and the ligand above.
fn sum_of(spec: &EnergySpec) -> (PairSum, Numbers) {
    let mut numbers = Numbers(7);
    let (particles, positions) = protein(&mut numbers);
    (PairSum::new(spec, &particles, &positions, &ligand()), numbers)
}

/// Holds a gradient against differences of the energy: each within a millionth of the larger, or of 1 kJ/(mol Å).
fn check_gradient(gradient: &[Point], positions: &[Point], energy: impl Fn(&[Point]) -> f64) {
    for (atom, found) in gradient.iter().enumerate() {
        for axis in 0..3 {
            let step = 1e-5;
            let moved = |by: f64| {
                let mut positions = positions.to_vec();
                positions[atom][axis] += by;
                energy(&positions)
            };
            // Of the fourth order, as repulsions bend strongly.
            let expected = (8.0 * (moved(step) - moved(-step))
                - (moved(2.0 * step) - moved(-2.0 * step)))
                / (12.0 * step);
            let size = found[axis].abs().max(expected.abs()).max(1.0);
            assert!(
                (found[axis] - expected).abs() < 1e-6 * size,
                "atom {atom}, axis {axis}: {} and {expected}",
                found[axis]
            );
        }
    }
}
