//! Exact sums and own terms: plain loops, differences, limits, orders, lanes.

use super::super::{
    COULOMB, EnergySpec, HYDROPHOBIC_DEPTH, Own, OwnTerms, PairSum, ParameterSet, Particle, Parts,
    hydrophobic_radius,
};
use super::{Numbers, check_gradient, everything, ligand, particle, pose, protein, sum_of};
use crate::lanes::Lanes;
use crate::structure::Point;
use proptest::prelude::*;

/// The sum of a protein of one atom at the origin and a ligand of one atom at `at` on the x axis.
fn one_pair(spec: &EnergySpec, of_protein: Particle, of_ligand: Particle, at: f64) -> Parts {
    let sum = PairSum::new(spec, &[of_protein], &[Point::zeros()], &[of_ligand]);
    sum.parts(&[Point::new(at, 0.0, 0.0)])
}

/// The plain double loop, with every formula written anew.
fn plain(spec: &EnergySpec, particles: &[Particle], positions: &[Point], pose: &[Point]) -> Parts {
    let mut parts = Parts::default();
    let (inner, outer) = ((spec.cutoff - 2.0) * (spec.cutoff - 2.0), spec.cutoff * spec.cutoff);
    for (of_ligand, at) in ligand().iter().zip(pose) {
        for (of_protein, other) in particles.iter().zip(positions) {
            let square = (at - other).norm_squared();
            let switch = match square {
                _ if square <= inner => 1.0,
                _ if square >= outer => 0.0,
                _ => {
                    let left = outer - square;
                    let width = outer - inner;
                    left * left * (outer + 2.0 * square - 3.0 * inner) / (width * width * width)
                }
            };
            let pair = spec.parameters.pair(of_protein.element, of_ligand.element);
            let sixth = square * square * square;
            parts.van_der_waals += switch * (pair.a / (sixth * sixth) - pair.b / sixth);
            if let Some(factor) = spec.dielectric {
                let charges = of_protein.charge * of_ligand.charge;
                parts.coulomb += switch * COULOMB * charges / (factor * square);
            }
            if spec.hydrophobic && of_protein.is_hydrophobic && of_ligand.is_hydrophobic {
                let radii =
                    hydrophobic_radius(of_protein.element) + hydrophobic_radius(of_ligand.element);
                let ramp = (1.5 - (square.sqrt() - radii)).clamp(0.0, 1.0);
                parts.hydrophobic += HYDROPHOBIC_DEPTH * ramp;
            }
        }
    }
    parts
}

#[test]
fn sums_are_those_of_a_plain_loop() {
    let specs = [
        everything(),
        EnergySpec { cutoff: 6.0, ..everything() },
        EnergySpec { cutoff: 1000.0, parameters: ParameterSet::Uff, ..everything() },
        EnergySpec::default(),
    ];
    for spec in specs {
        let mut numbers = Numbers(7);
        let (particles, positions) = protein(&mut numbers);
        let sum = PairSum::new(&spec, &particles, &positions, &ligand());
        let mut nonzero = 0;
        for _ in 0..40 {
            let pose = pose(&mut numbers);
            let expected = plain(&spec, &particles, &positions, &pose);
            let found = sum.parts(&pose);
            for (found, expected) in [
                (found.van_der_waals, expected.van_der_waals),
                (found.coulomb, expected.coulomb),
                (found.hydrophobic, expected.hydrophobic),
            ] {
                nonzero += usize::from(expected != 0.0);
                let size = expected.abs().max(1.0);
                assert!((found - expected).abs() < 1e-10 * size, "{found} and {expected}");
            }
        }
        assert!(nonzero > 20, "{nonzero}");
    }
}

#[test]
fn gradients_are_differences() {
    for (cutoff, own) in [(8.0, Own::Repulsion), (12.0, Own::Whole)] {
        let spec = EnergySpec { cutoff, own, ..everything() };
        let (sum, mut numbers) = sum_of(&spec);
        let own = OwnTerms::new(&spec, &ligand(), &[[0, 3], [1, 4], [2, 5], [0, 5]]);
        let mut compared = 0;
        while compared < 10 {
            let pose = pose(&mut numbers);
            // Differences of very large energies say nothing about the slopes of the other atoms.
            if sum.energy(&pose).abs() > 1e4 || sum.energy(&pose) == 0.0 || own.energy(&pose) > 1e4
            {
                continue;
            }
            compared += 1;
            let mut gradient = vec![Point::zeros(); pose.len()];
            assert_eq!(sum.gradient(&pose, &mut gradient), sum.energy(&pose));
            check_gradient(&gradient, &pose, |pose| sum.energy(pose));
            // Own terms add theirs.
            let before = gradient.clone();
            assert_eq!(own.gradient(&pose, &mut gradient), own.energy(&pose));
            let added: Vec<Point> =
                gradient.iter().zip(&before).map(|(after, before)| after - before).collect();
            check_gradient(&added, &pose, |pose| own.energy(pose));
        }
    }
}

#[test]
fn own_terms_are_those_of_pairs_with_a_protein() {
    let spec = EnergySpec { hydrophobic: false, own: Own::Whole, ..everything() };
    for distance in [0.01, 0.5, 3.0, 11.0, 13.0] {
        let [one, other] = [particle("N", 0.4, false), particle("Cl", -0.7, false)];
        let expected = one_pair(&spec, one, other, distance);
        let own = OwnTerms::new(&spec, &[one, other], &[[0, 1]]);
        let found = own.parts(&[Point::zeros(), Point::new(distance, 0.0, 0.0)]);
        for (found, expected) in
            [(found.van_der_waals, expected.van_der_waals), (found.coulomb, expected.coulomb)]
        {
            assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} and {expected}");
        }
    }
    // Pairs that are not there do not count, nor do positions.
    let own = OwnTerms::new(&spec, &ligand(), &[[0, 60]]);
    assert_eq!(own.energy(&[Point::zeros(); 6]), 0.0);
    let own = OwnTerms::new(&spec, &ligand(), &[[0, 5]]);
    assert_eq!(own.gradient(&[Point::zeros()], &mut [Point::zeros()]), 0.0);
}

/// Repulsion alone is the whole 12-6 term raised by its depth, up to the minimum, where it ends without a step or a bend.
#[test]
fn repulsion_ends_at_the_minimum() {
    let pair = [particle("C", 0.3, false), particle("O", -0.3, false)];
    let terms = |own| {
        let spec = EnergySpec { own, cutoff: 100.0, dielectric: None, ..everything() };
        OwnTerms::new(&spec, &pair, &[[0, 1]])
    };
    let (whole, repulsion) = (terms(Own::Whole), terms(Own::Repulsion));
    let at = |terms: &OwnTerms, x: f64| terms.energy(&[Point::zeros(), Point::new(x, 0.0, 0.0)]);
    // AutoDock 4.1: R = (4.0 + 3.2) / 2.
    let (bottom, depth) = (3.6, -at(&whole, 3.6));
    assert!(depth > 0.5, "{depth}");
    for x in [0.5, 2.0, 3.0, 3.5, bottom - 1e-6] {
        let expected = at(&whole, x) + depth;
        let found = at(&repulsion, x);
        assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{found} at {x}");
    }
    assert!(at(&repulsion, bottom - 1e-4) < 1e-6);
    assert_eq!([bottom + 1e-6, 5.0, 50.0].map(|x| at(&repulsion, x)), [0.0; 3]);
    assert_eq!(at(&terms(Own::None), 0.5), 0.0);
}

#[test]
fn near_atoms_have_finite_energies_and_far_ones_none() {
    let spec = everything();
    let [one, other] = [particle("C", 0.5, true), particle("C", -0.5, true)];
    let touching = one_pair(&spec, one, other, 0.0);
    assert_eq!(touching, one_pair(&spec, one, other, 0.05));
    let apart = one_pair(&spec, one, other, 0.1).total();
    assert!((touching.total() - apart).abs() < 1e-12 * apart);
    assert!(touching.van_der_waals > 1e15 && touching.total().is_finite());
    assert_eq!(touching.coulomb, -0.25 * COULOMB / 4.0 / 0.01);
    let sum = PairSum::new(&spec, &[one], &[Point::zeros()], &[other]);
    let mut gradient = [Point::zeros()];
    sum.gradient(&[Point::new(0.05, 0.0, 0.0)], &mut gradient);
    assert_eq!(gradient, [Point::zeros()]);
    for far in [12.0, 12.5, 500.0, 1e300] {
        assert_eq!(one_pair(&spec, one, other, far).total(), 0.0, "{far}");
    }
    // At the minimum: the depth alone.
    let least = one_pair(&EnergySpec::default(), one, other, 4.0).total();
    assert!((least + 0.150 * 4.184).abs() < 1e-12, "{least}");
    // No atom, no energy; what is no position has none either.
    let empty = PairSum::new(&spec, &[], &[], &[other]);
    assert_eq!(empty.energy(&[Point::zeros()]), 0.0);
    assert!(sum.energy(&[Point::new(f64::NAN, 0.0, 0.0)]).is_nan());
    assert!(sum.energy(&[Point::new(f64::INFINITY, 0.0, 0.0)]).is_nan());
}

#[test]
fn terms_are_switched_off_between_ten_and_twelve() {
    let spec = EnergySpec { dielectric: Some(1.0), ..EnergySpec::default() };
    let whole = EnergySpec { cutoff: 1000.0, ..spec.clone() };
    let [one, other] = [particle("O", 1.0, false), particle("O", 1.0, false)];
    let share = |at: f64| {
        one_pair(&spec, one, other, at).coulomb / one_pair(&whole, one, other, at).coulomb
    };
    assert!((share(9.999) - 1.0).abs() < 1e-12 && (share(10.0) - 1.0).abs() < 1e-12);
    // Half way in the squared distance the cubic is one half.
    assert!((share(122.0_f64.sqrt()) - 0.5).abs() < 1e-12);
    let shares: Vec<f64> = (0..=20).map(|step| share(10.0 + 0.1 * f64::from(step))).collect();
    assert!(shares.windows(2).all(|two| two[1] < two[0]) && shares[20] == 0.0);
    // The slope ends with the energy.
    let sum = PairSum::new(&spec, &[one], &[Point::zeros()], &[other]);
    let mut gradient = [Point::zeros()];
    sum.gradient(&[Point::new(11.999_999, 0.0, 0.0)], &mut gradient);
    assert!(gradient[0].x < 0.0 && gradient[0].x > -1e-4, "{gradient:?}");
}

#[test]
fn the_hydrophobic_ramp_is_vinas() {
    let spec = EnergySpec { hydrophobic: true, ..EnergySpec::default() };
    let [one, other] = [particle("C", 0.0, true), particle("Br", 0.0, true)];
    // Radii 1.9 and 2.0 Å: whole up to 4.4 Å, half at 4.9 Å, none from 5.4 Å on.
    for (at, share) in [(2.0, 1.0), (4.399_999, 1.0), (4.9, 0.5), (5.4, 0.0), (8.0, 0.0)] {
        let found = one_pair(&spec, one, other, at).hydrophobic;
        assert!((found + 0.035_069 * 4.184 * share).abs() < 1e-12, "{at}: {found}");
    }
    let polar = particle("C", 0.0, false);
    assert_eq!(one_pair(&spec, polar, other, 4.0).hydrophobic, 0.0);
    assert_eq!(one_pair(&spec, one, polar, 4.0).hydrophobic, 0.0);
}

#[test]
fn no_lanes_change_a_bit() {
    let (mut sum, mut numbers) = sum_of(&everything());
    let poses: Vec<Vec<Point>> = (0..20).map(|_| pose(&mut numbers)).collect();
    let mut results: Vec<Vec<(f64, Vec<Point>)>> = Vec::new();
    for lanes in Lanes::all() {
        sum.lanes = lanes;
        let one = |pose: &Vec<Point>| {
            let mut gradient = vec![Point::zeros(); pose.len()];
            (sum.gradient(pose, &mut gradient), gradient)
        };
        results.push(poses.iter().map(one).collect());
    }
    assert!(results.iter().all(|result| *result == results[0]));
}

#[test]
fn scattered_atoms_are_found() {
    // Cells would be without number if they kept their size.
    let far = Point::new(90_000.0, -90_000.0, 90_000.0);
    let one = particle("C", 0.0, false);
    let sum = PairSum::new(&EnergySpec::default(), &[one, one], &[far, -far], &[one]);
    for at in [far, -far] {
        let found = sum.energy(&[at + Point::new(0.0, 4.0, 0.0)]);
        assert!((found + 0.150 * 4.184).abs() < 1e-9, "{found}");
    }
    assert_eq!(sum.energy(&[Point::zeros()]), 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn the_order_of_the_proteins_atoms_does_not_matter(seed in 1_u64..1_000_000) {
        let mut numbers = Numbers(seed);
        let (mut particles, mut positions) = protein(&mut Numbers(7));
        let first = PairSum::new(&everything(), &particles, &positions, &ligand());
        for last in (1..particles.len()).rev() {
            let other = (numbers.next() * (last + 1) as f64) as usize;
            particles.swap(last, other);
            positions.swap(last, other);
        }
        let second = PairSum::new(&everything(), &particles, &positions, &ligand());
        for _ in 0..10 {
            let pose = pose(&mut numbers);
            let [first, second] = [first.energy(&pose), second.energy(&pose)];
            prop_assert!((first - second).abs() <= 1e-9 * first.abs().max(1e-3));
        }
    }
}
