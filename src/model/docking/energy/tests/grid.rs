//! Grids beside exact sums.

use super::super::{EnergySpec, Grid, Lookup, PairSum, capped};
use super::{check_gradient, everything, ligand, pose, sum_of};
use crate::lanes::Lanes;
use crate::structure::Point;

const LOOKUPS: [Lookup; 4] =
    [Lookup::Nearest, Lookup::Trilinear, Lookup::Reciprocal, Lookup::Tricubic];

/// A grid about a face of the cube, and its values.
fn grid(sum: &PairSum, spacing: f64, lookup: Lookup) -> (Grid, Vec<f32>) {
    let corners = [Point::new(16.0, -3.1, 4.0), Point::new(25.7, 4.0, -3.2)];
    let grid = Grid::new(sum, corners, spacing, lookup).unwrap();
    let mut values = vec![0.0; grid.values_len()];
    grid.fill(sum, &mut values);
    (grid, values)
}

#[test]
fn a_grid_is_exact_at_its_points() {
    for spec in [everything(), EnergySpec::default()] {
        let (sum, _) = sum_of(&spec);
        for lookup in LOOKUPS {
            let (grid, values) = grid(&sum, 0.5, lookup);
            let [along_x, along_y, along_z] = grid.counts();
            assert_eq!([along_x, along_y, along_z], [21, 16, 16]);
            let mut compared = 0;
            for place in (0..along_x * along_y * along_z).step_by(7) {
                let place =
                    [place % along_x, place / along_x % along_y, place / (along_x * along_y)];
                let at = grid.point(place);
                assert_eq!(grid.nearest_point(at), Some(place));
                for atom in 0..sum.ligand_atoms() {
                    let parts = sum.of_atom(atom, at).0;
                    let exact = parts.total();
                    // Clashes are cut off or lose what single precision cannot hold.
                    if exact > 1e4 {
                        continue;
                    }
                    compared += 1;
                    let found = grid.at_point(&values, &sum, atom, place);
                    assert!(
                        (found - exact).abs() < 1e-5 * exact.abs().max(100.0),
                        "{found} {exact}"
                    );
                    // What is read there is the same, but for the rounding of the place.
                    let read = grid.of_atom(&values, &sum, atom, at).0;
                    assert!((found - read).abs() < 1e-5 * exact.abs().max(100.0), "{found} {read}");
                }
            }
            assert!(compared > 1000, "{compared}");
        }
    }
}

#[test]
fn gradients_of_grids_are_differences() {
    let (sum, mut numbers) = sum_of(&everything());
    for lookup in [Lookup::Trilinear, Lookup::Reciprocal, Lookup::Tricubic] {
        let (grid, values) = grid(&sum, 0.375, lookup);
        for _ in 0..30 {
            // Off the faces of cells, by more than the differences' steps.
            let [x, y, z] =
                grid.counts().map(|count| (numbers.next() * (count - 1) as f64) as usize);
            let part = Point::repeat(0.5) + numbers.point(0.45);
            let at = grid.point([x, y, z]) + part * grid.spacing();
            let pose = vec![at; sum.ligand_atoms()];
            let mut gradient = pose.clone();
            let energy = grid.gradient(&values, &sum, &pose, &mut gradient);
            assert_eq!(energy, grid.energy(&values, &sum, &pose));
            // Deep inside everything is cut off.
            if energy < 1e4 {
                check_gradient(&gradient, &pose, |pose| grid.energy(&values, &sum, pose));
            }
        }
    }
    // The slope of the nearest point is that between its neighbours.
    let (grid, values) = grid(&sum, 0.5, Lookup::Nearest);
    let (place, atom) = ([15, 5, 5], 3);
    let mut expected = Point::zeros();
    for axis in 0..3 {
        let at = |step: usize| {
            let mut place = place;
            place[axis] = place[axis] + step - 1;
            grid.at_point(&values, &sum, atom, place)
        };
        expected[axis] = at(2) - at(0);
    }
    let near = grid.point(place) + Point::new(0.1, -0.2, 0.05);
    let mut gradient = vec![Point::zeros(); 6];
    grid.gradient(&values, &sum, &[near; 6], &mut gradient);
    assert!((gradient[atom] - expected).norm() < 1e-9 * expected.norm(), "{gradient:?}");
}

#[test]
fn reciprocals_are_nearer_to_the_sum_than_energies() {
    let (sum, mut numbers) = sum_of(&EnergySpec::default());
    let mut poses: Vec<(Vec<Point>, f64)> = Vec::new();
    while poses.len() < 60 {
        let centre = Point::new(21.5, 0.5, 0.5) + numbers.point(2.0);
        let pose: Vec<Point> = ligand().iter().map(|_| centre + numbers.point(1.5)).collect();
        let energy = sum.energy(&pose);
        if energy < 20.0 {
            poses.push((pose, energy));
        }
    }
    let median = |lookup: Lookup| {
        let (grid, values) = grid(&sum, 0.375, lookup);
        let error =
            |(pose, energy): &(Vec<Point>, f64)| (grid.energy(&values, &sum, pose) - energy).abs();
        let mut errors: Vec<f64> = poses.iter().map(error).collect();
        errors.sort_by(f64::total_cmp);
        errors[errors.len() / 2]
    };
    let [nearest, trilinear, reciprocal, tricubic] = LOOKUPS.map(median);
    assert!(tricubic < reciprocal && 2.0 * reciprocal < trilinear && 2.0 * reciprocal < nearest);
}

#[test]
fn atoms_outside_of_a_grid_have_their_exact_sums() {
    let (sum, mut numbers) = sum_of(&everything());
    for lookup in LOOKUPS {
        let (grid, values) = grid(&sum, 0.5, lookup);
        let mut compared = 0;
        while compared < 20 {
            let pose = pose(&mut numbers);
            if pose.iter().any(|at| grid.nearest_point(*at).is_some()) {
                continue;
            }
            compared += 1;
            let mut gradients = [vec![Point::zeros(); 6], vec![Point::zeros(); 6]];
            let found = grid.gradient(&values, &sum, &pose, &mut gradients[0]);
            let exact = sum.gradient(&pose, &mut gradients[1]);
            assert!((found - exact).abs() <= 1e-9 * exact.abs(), "{found} {exact}");
            assert_eq!(gradients[0], gradients[1]);
        }
        assert!(grid.energy(&values, &sum, &[Point::repeat(f64::NAN); 6]).is_nan());
    }
}

#[test]
fn clashes_are_high_and_finite() {
    let (sum, _) = sum_of(&everything());
    for lookup in LOOKUPS {
        let (grid, values) = grid(&sum, 0.375, lookup);
        assert!(values.iter().all(|value| value.is_finite()));
        for step in 0..2000 {
            let at = Point::new(16.0 + 0.001 * f64::from(step), 0.3, 0.1);
            let mut gradient = vec![Point::zeros(); 6];
            let energy = grid.gradient(&values, &sum, &[at; 6], &mut gradient);
            assert!(energy.is_finite() && gradient.iter().flatten().all(|slope| slope.is_finite()));
            if sum.energy(&[at; 6]) > 1e5 {
                assert!(energy > 1e3, "{lookup:?} {energy} {}", sum.energy(&[at; 6]));
            }
        }
    }
}

#[test]
fn values_depend_neither_on_lanes_nor_on_who_fills_which_layer() {
    let (mut sum, _) = sum_of(&everything());
    for lookup in LOOKUPS {
        let (grid, expected) = grid(&sum, 0.5, lookup);
        for lanes in Lanes::all() {
            sum.lanes = lanes;
            let mut values = vec![f32::NAN; grid.values_len()];
            let layers = values.chunks_exact_mut(grid.layer_len()).enumerate();
            for (layer, out) in layers.collect::<Vec<_>>().into_iter().rev() {
                grid.fill_layer(&sum, layer, out);
            }
            assert_eq!(values, expected);
        }
    }
}

#[test]
fn grids_that_cannot_be_are_refused() {
    let (sum, _) = sum_of(&everything());
    let make = |size: f64, spacing: f64| {
        Grid::new(&sum, [Point::zeros(), Point::repeat(size)], spacing, Lookup::default())
    };
    assert!(make(10.0, 0.375).is_some());
    assert_eq!(make(0.0, 0.375).unwrap().counts(), [2; 3]);
    for (size, spacing) in [
        (f64::NAN, 0.375),
        (f64::INFINITY, 0.375),
        (10.0, f64::NAN),
        (10.0, 0.0),
        (10.0, 3.0),
        (2000.0, 0.375),
        (1e300, 0.375),
    ] {
        assert!(make(size, spacing).is_none(), "{size} {spacing}");
    }
}

#[test]
fn forces_keep_their_direction() {
    let force = Point::new(3.0, -4.0, 12.0);
    assert_eq!(capped(force, 13.5), force);
    assert!((capped(force, 1.0) - force / 13.0).norm() < 1e-15);
    assert_eq!(capped(Point::zeros(), 1.0), Point::zeros());
    assert!((capped(force * 1e200, 1.0) - force / 13.0).norm() < 1e-15);
    let (sum, mut numbers) = sum_of(&everything());
    let (grid, values) = grid(&sum, 0.5, Lookup::Reciprocal);
    let centre = Point::new(20.5, 0.5, 0.5);
    for _ in 0..50 {
        let pose: Vec<Point> = ligand().iter().map(|_| centre + numbers.point(2.0)).collect();
        let mut gradient = vec![Point::zeros(); 6];
        grid.gradient(&values, &sum, &pose, &mut gradient);
        let whole = -gradient.iter().sum::<Point>();
        let force = grid.force(&values, &sum, &pose, 5.0);
        assert!(force.norm() < 5.0 + 1e-9);
        assert!(force.cross(&whole).norm() <= 1e-9 * whole.norm() * force.norm().max(1.0));
        assert!(force.dot(&whole) >= 0.0);
    }
}
