//! Where atoms are, and how energies change with configurations.

use super::{biotin, docking, problem};
use crate::model::Scratch;
use crate::model::docking::kinematics::{BASE, Linkage};
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed, Stream};
use crate::space::BaseJoint;
use crate::structure::Point;

fn linkage() -> (Linkage, Vec<Point>) {
    let docking = docking(&biotin(""));
    (docking.linkage(), docking.ligand().positions().unwrap())
}

fn stream(number: u64) -> Stream {
    Seed::of_set(7, "ligand", Ordinal(number)).stream(Purpose::Sampling)
}

fn placed(linkage: &Linkage, q: &[f64]) -> Vec<Point> {
    let mut positions = Vec::new();
    linkage.place(q, &mut Vec::new(), &mut positions);
    positions
}

#[test]
fn the_given_configuration_is_the_given_pose() {
    let (linkage, given) = linkage();
    let found = placed(&linkage, &linkage.given());
    assert_eq!(linkage.links(), 5);
    for (found, given) in found.iter().zip(&given) {
        assert!((found - given).norm() < 1e-12, "{found} instead of {given}");
    }
}

/// Bonds keep their lengths, so do the angles between them, and rings all distances.
#[test]
fn pieces_stay_rigid_and_bonds_keep_their_lengths() {
    let docking = docking(&biotin(""));
    let (linkage, given) = linkage();
    let (mut stream, space) = (stream(0), problem(&biotin("")).context().space().clone());
    let mut q = vec![0.0; BASE + 5];
    for _ in 0..50 {
        space.sample_uniform(&mut stream, &mut q);
        let found = placed(&linkage, &q);
        let same = |a: usize, b: usize| {
            let (now, then) = ((found[a] - found[b]).norm(), (given[a] - given[b]).norm());
            assert!((now - then).abs() < 1e-9, "atoms {a} and {b}: {now} instead of {then}");
        };
        docking.ligand().bonds().iter().for_each(|bond| same(bond.atoms[0], bond.atoms[1]));
        for piece in linkage.pieces() {
            piece.iter().for_each(|a| piece.iter().for_each(|b| same(*a, *b)));
        }
        // Two bonds that share an atom span a triangle, whose third side is fixed, too.
        for one in docking.ligand().bonds() {
            for other in docking.ligand().bonds() {
                let shared = one.atoms.iter().find(|atom| other.atoms.contains(atom));
                if let (Some(shared), true) = (shared, one != other) {
                    let end = |atoms: [usize; 2]| atoms.into_iter().find(|atom| atom != shared);
                    same(end(one.atoms).unwrap(), end(other.atoms).unwrap());
                }
            }
        }
    }
}

#[test]
fn no_atom_moves_farther_than_the_bound() {
    let (linkage, _) = linkage();
    let space = problem(&biotin("")).context().space().clone();
    let mut stream = stream(1);
    let (mut a, mut b, mut q) = (vec![0.0; 12], vec![0.0; 12], vec![0.0; 12]);
    for _ in 0..100 {
        space.sample_uniform(&mut stream, &mut a);
        space.sample_uniform(&mut stream, &mut b);
        let bound = linkage.longest_way(&a, &b, BaseJoint::Rigid3d.angle_between(&a, &b));
        let mut before = placed(&linkage, &a);
        let mut ways = vec![0.0; before.len()];
        for step in 1..=200 {
            space.interpolate(&a, &b, f64::from(step) / 200.0, &mut q);
            let now = placed(&linkage, &q);
            for (way, (now, before)) in ways.iter_mut().zip(now.iter().zip(&before)) {
                *way += (now - before).norm();
            }
            before = now;
        }
        let longest = ways.iter().copied().fold(0.0, f64::max);
        assert!(longest <= bound, "{longest} Å, at most {bound} expected");
    }
}

/// The gradient by the configuration is what differences of energies say, for exact sums and for the grid.
#[test]
fn gradients_are_those_of_differences() {
    for (grid, tolerance) in [
        ("grid = { lookup = \"exact\" }\n", 1e-4),
        ("grid = { lookup = \"reciprocal\", spacing = 0.5 }\n", 1e-3),
    ] {
        let cx = problem(&biotin(grid)).context();
        let (space, model, scratch) = (cx.space(), cx.model(), &mut Scratch::new());
        let mut stream = stream(2);
        let size = space.cube_dimensions();
        let (mut gradient, mut q, mut near) = (vec![0.0; size], vec![0.0; 12], vec![0.0; 12]);
        let mut looked_at = 0;
        while looked_at < 20 {
            space.sample_uniform(&mut stream, &mut q);
            let energy = model.gradient(&q, &mut gradient, scratch).unwrap();
            // In a collision the energy changes by orders of magnitude within a difference.
            if energy > 1000.0 {
                continue;
            }
            looked_at += 1;
            assert!((energy - model.energy(&q, scratch).unwrap()).abs() < 1e-9);
            for number in 0..size {
                let step = 1e-6;
                let mut at = |by: f64| {
                    let mut vector = vec![0.0; size];
                    vector[number] = by;
                    space.moved(&q, &vector, &mut near);
                    model.energy(&near, scratch).unwrap()
                };
                let difference = (at(step) - at(-step)) / (2.0 * step);
                let scale = 1.0 + gradient.iter().map(|x| x.abs()).fold(0.0, f64::max);
                assert!(
                    (difference - gradient[number]).abs() < tolerance * scale,
                    "{number}: {difference}, but {} by the gradient ({grid})",
                    gradient[number]
                );
            }
        }
    }
}
