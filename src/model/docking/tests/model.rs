//! What the model promises, as every model does.

use super::{biotin, docking_of, problem};
use crate::model::{CellLimits, Cost, Scratch, Validity};
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed};
use crate::structure::Point;

const COARSE: &str = "grid = { spacing = 0.5 }\n";

#[test]
fn the_given_pose_is_valid_and_low() {
    let problem = problem(&biotin(COARSE));
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let given = cx.model().native().expect("it is within the box");
    assert_eq!(cx.model().validity(given, scratch), Validity::Valid);
    let energy = cx.model().energy(given, scratch).unwrap();
    let exact = cx.model().ligand().unwrap().exact(given);
    assert!(energy < -50.0 && exact.sum() < -50.0, "{energy} and {exact:?}");
    // Within the protein's wall nothing is valid.
    let atom = cx.model().ligand().unwrap().protein()[0];
    let mut inside = given.to_vec();
    inside[..3].copy_from_slice(atom.as_slice());
    assert_ne!(cx.model().validity(&inside, scratch), Validity::Valid);
    inside[0] = 1000.0;
    assert_eq!(cx.model().validity(&inside, scratch), Validity::OutOfBounds);
    assert!(!cx.model().reasons(&inside, false).is_empty());
}

/// What a motion costs is the same to the bit from either end, whatever the scratch holds.
#[test]
fn motions_cost_the_same_from_either_end_with_any_scratch() {
    let cx = problem(&biotin("highest = 1e6\nstep = 1.0\ngrid = { spacing = 1.0 }\n")).context();
    let mut stream = Seed::of_set(3, "motion", Ordinal(0)).stream(Purpose::Sampling);
    let (mut a, mut b) = (vec![0.0; 12], vec![0.0; 12]);
    let (clean, dirty) = (&mut Scratch::new(), &mut Scratch::new());
    let mut found = 0;
    for rubbish in 0..300 {
        cx.space().sample_uniform(&mut stream, &mut a);
        cx.space().step(&a, 3.0, &mut stream, &mut b);
        dirty.poison(rubbish);
        let there = cx.model().motion(&a, &b, 1, clean);
        let back = cx.model().motion(&b, &a, 1, dirty);
        let (Some(Cost::Directed(there)), Some(Cost::Directed(back))) = (there, back) else {
            assert_eq!(there, back);
            continue;
        };
        found += 1;
        assert_eq!((there.forward, there.backward), (back.backward, back.forward));
        assert_eq!(there.peak, back.peak);
        let energy = |q: &[f64], scratch: &mut Scratch| cx.model().energy(q, scratch).unwrap();
        let rise = energy(&b, clean) - energy(&a, clean);
        assert!(
            ((there.forward - there.backward) * 2.479 - rise).abs() < 1e-6 * (1.0 + rise.abs())
        );
        assert!(there.peak >= energy(&a, clean).max(energy(&b, clean)));
    }
    assert!(found > 20, "{found} motions");
}

/// Low cells are low, those at the boundary have a high neighbour, and all there are, are found.
#[test]
fn low_cells_are_low() {
    let cx = problem(&biotin("grid = { spacing = 1.0 }\n")).context();
    let ligand = cx.model().ligand().unwrap();
    let limits = CellLimits { low: -1.0, high: 0.0 };
    let cells = ligand.low_cells(0, limits);
    assert!(cells.at_boundary.len() > 20 && cells.inside.len() > 20, "{cells:?}");
    let energy = |at: &Point| ligand.atom_energy(0, at);
    let beside = |at: &Point| {
        (0..6).any(|side| {
            let mut near = *at;
            near[side / 2] += if side % 2 == 0 { cells.spacing } else { -cells.spacing };
            energy(&near) >= limits.high
        })
    };
    for at in &cells.at_boundary {
        assert!(energy(at) <= limits.low && beside(at), "{at}");
    }
    for at in &cells.inside {
        assert!(energy(at) <= limits.low, "{at}");
    }
}

/// The force is against the gradient, and as large as is allowed at most.
#[test]
fn forces_are_capped_and_keep_their_direction() {
    let problem = problem(&biotin("grid = { lookup = \"exact\" }\n"));
    let cx = problem.context();
    let ligand = cx.model().ligand().unwrap();
    let mut q = docking_of(&problem).given();
    q[0] += 0.3;
    let free = ligand.force(&q, f64::INFINITY);
    let mut gradient = vec![0.0; cx.space().cube_dimensions()];
    cx.model().gradient(&q, &mut gradient, &mut Scratch::new()).unwrap();
    for axis in 0..3 {
        assert!((free[axis] + gradient[axis]).abs() < 1e-9 * (1.0 + free.norm()));
    }
    let capped = ligand.force(&q, free.norm() / 10.0);
    assert!((capped - free / 10.0).norm() < 1e-9 * free.norm());
}

/// The residues that are exposed are on the outside: tryptophan 108 of streptavidin is buried in the binding site, the chain's end is not.
#[test]
fn residues_at_the_surface_are_exposed() {
    let cx = problem(&biotin(COARSE)).context();
    let names: Vec<&str> =
        cx.model().ligand().unwrap().exposed().iter().map(|of| of.name.as_str()).collect();
    assert!(!names.contains(&"A TRP 108"), "{names:?}");
    assert!(names.contains(&"A GLY 99") || names.contains(&"A THR 66"), "{names:?}");
    assert!((30..100).contains(&names.len()), "{}", names.len());
}
