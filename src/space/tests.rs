use super::*;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed};
use proptest::prelude::*;

fn spaces() -> Vec<Space> {
    [BaseJoint::Translation2d, BaseJoint::Rigid2d, BaseJoint::Translation3d, BaseJoint::Rigid3d]
        .map(|motion| rigid_space(motion, [-1.0, -2.0, -3.0], [1.0, 2.0, 5.0], 0.7))
        .to_vec()
}

fn draw(space: &Space, ordinal: u64) -> Vec<f64> {
    let mut q = vec![0.0; space.len()];
    let mut stream = Seed::of_set(3, "space tests", Ordinal(ordinal)).stream(Purpose::Sampling);
    space.sample_uniform(&mut stream, &mut q);
    q
}

proptest! {
    #[test]
    fn samples_are_in_bounds_and_in_stored_form(ordinal in any::<u64>()) {
        for space in spaces() {
            let q = draw(&space, ordinal);
            prop_assert!(space.within_bounds(&q));
            let mut stored = q.clone();
            space.canonicalize(&mut stored).unwrap();
            for (a, b) in q.iter().zip(&stored) {
                prop_assert!((a - b).abs() <= 1e-15, "{q:?} {stored:?}");
            }
        }
    }

    /// In plain units of the factors, it is what [`Space::along`] is in those of the metric.
    #[test]
    fn moved_goes_where_along_goes(ordinal in any::<u64>(), length in 0.0f64..2.0) {
        for space in spaces() {
            let q = draw(&space, ordinal);
            let mut stream = Seed::of_set(3, "moved", Ordinal(ordinal)).stream(Purpose::Sampling);
            let direction = space.direction(&mut stream);
            let by: Vec<f64> = space.factors().iter().zip(&direction.factors).flat_map(|(factor, components)| {
                let count = if factor.kind == FactorKind::Rotation { 3 } else { 1 };
                let share = length / direction.size / factor.weight;
                components.iter().take(count).map(move |component| component * share).collect::<Vec<_>>()
            }).collect();
            prop_assert_eq!(by.len(), space.cube_dimensions());
            let (mut along, mut moved) = (q.clone(), q.clone());
            space.along(&q, &direction, length, &mut along);
            space.moved(&q, &by, &mut moved);
            for (a, b) in along.iter().zip(&moved) {
                prop_assert!((a - b).abs() < 1e-12);
            }
            space.clamp(&mut moved);
            prop_assert!(space.within_bounds(&moved));
        }
    }

    #[test]
    fn distance_is_a_metric(ordinal in 0..u64::MAX - 3) {
        for space in spaces() {
            let [a, b, c] = [0, 1, 2].map(|i| draw(&space, ordinal + i));
            prop_assert_eq!(space.distance(&a, &b).to_bits(), space.distance(&b, &a).to_bits());
            prop_assert!(space.distance(&a, &a) < 1e-7);
            prop_assert!(
                space.distance(&a, &c) <= space.distance(&a, &b) + space.distance(&b, &c) + 1e-9
            );
        }
    }

    #[test]
    fn the_cheap_bound_never_hides_a_neighbour(ordinal in 0..u64::MAX - 1, scale in 0.0f64..1.0) {
        for space in spaces() {
            let (a, far) = (draw(&space, ordinal), draw(&space, ordinal + 1));
            // Nearly equal rotations are where rounding bites.
            let mut b = vec![0.0; space.len()];
            space.interpolate(&a, &far, scale * scale * scale * scale * 1e-3, &mut b);
            for b in [&b, &far] {
                let distance = space.distance(&a, b);
                prop_assert_eq!(space.distance_unless_above(&a, b, distance), Some(distance));
            }
        }
    }

    #[test]
    fn interpolation_runs_at_constant_speed(ordinal in 0..u64::MAX - 1, t in 0.0f64..1.0) {
        for space in spaces() {
            let (a, b) = (draw(&space, ordinal), draw(&space, ordinal + 1));
            let mut between = vec![0.0; space.len()];
            space.interpolate(&a, &b, t, &mut between);
            let whole = space.distance(&a, &b);
            prop_assert!((space.distance(&a, &between) - t * whole).abs() < 1e-6);
            prop_assert!((space.distance(&between, &b) - (1.0 - t) * whole).abs() < 1e-6);
        }
    }
}

#[test]
fn uniform_rotations_follow_the_haar_measure() {
    // Kolmogorov–Smirnov: the angle θ of a uniform rotation has P(angle ≤ θ) = (θ − sin θ) / π,
    // and each axis component is uniform on [-1, 1]. Level 0.001: 1.95 / √n.
    let count = 20_000;
    let mut stream = Seed::of_set(1, "haar", Ordinal(0)).stream(Purpose::Sampling);
    let (mut angles, mut components) = (Vec::new(), Vec::new());
    let space = rigid_space(BaseJoint::Rigid3d, [0.0; 3], [1.0; 3], 1.0);
    let mut q = [0.0; 7];
    for _ in 0..count {
        space.sample_uniform(&mut stream, &mut q);
        let [_, _, _, w, x, y, z] = q;
        let angle = 2.0 * math::acos(w);
        angles.push((angle - math::sin(angle)) / std::f64::consts::PI);
        components.push((z / (x * x + y * y + z * z).sqrt() + 1.0) / 2.0);
    }
    for mut sample in [angles, components] {
        sample.sort_by(f64::total_cmp);
        let gap = sample.iter().enumerate().fold(0.0f64, |gap, (i, value)| {
            let (below, above) = (i as f64 / count as f64, (i + 1) as f64 / count as f64);
            gap.max((value - below).abs()).max((above - value).abs())
        });
        assert!(gap < 1.95 / f64::from(count).sqrt(), "gap {gap}");
    }
}

#[test]
fn bad_configurations_are_named() {
    let space = rigid_space(BaseJoint::Rigid3d, [0.0; 3], [1.0; 3], 1.0);
    let error = space.canonicalize(&mut [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).unwrap_err();
    assert!(error.contains("quaternion"), "{error}");
    let error = space.canonicalize(&mut [0.0, f64::NAN, 0.0, 1.0, 0.0, 0.0, 0.0]).unwrap_err();
    assert!(error.contains("value of y"), "{error}");
    let mut q = [-0.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0];
    space.canonicalize(&mut q).unwrap();
    assert_eq!(q.map(f64::to_bits), [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0].map(f64::to_bits));
}

#[test]
fn values_of_the_same_name_are_told_apart() {
    let names = ["x", "y", "j", "x", "j-2", "j", "j", "y"];
    let dofs = names.map(|name| Dof { name: name.to_owned(), unit: "length" });
    let kind = FactorKind::Real { min: 0.0, max: 1.0 };
    let factors = (0..names.len()).map(|at| Factor { kind, at, weight: 1.0 }).collect();
    let space = Space::new(factors, dofs.to_vec(), 2);
    let found: Vec<&str> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
    assert_eq!(found, ["x", "y", "j", "x-2", "j-2", "j-3", "j-4", "y-2"]);
}

/// What the length and the angle of displacements are defined by, on samples that include every kind of factor.
fn some_spaces() -> Vec<Space> {
    let factor = |kind, at, weight| Factor { kind, at, weight };
    let real = FactorKind::Real { min: -2.0, max: 3.0 };
    let factors = vec![
        factor(real, 0, 1.0),
        factor(FactorKind::Angle, 1, 0.3),
        factor(FactorKind::Rotation, 2, 2.0),
        factor(FactorKind::Rotation, 6, 0.5),
        factor(real, 10, 0.0),
    ];
    let dof = |at| Dof { name: format!("v{at}"), unit: "1" };
    let linkage = Space::new(factors, (0..11).map(dof).collect(), 1);
    spaces().into_iter().chain([linkage]).collect()
}

proptest! {
    #[test]
    fn a_displacement_leads_where_it_points(ordinal in 0..u64::MAX - 1) {
        for space in some_spaces() {
            let (a, b) = (draw(&space, ordinal), draw(&space, ordinal + 1));
            let displacement = space.displacement(&a, &b);
            let distance = space.distance(&a, &b);
            prop_assert!((displacement.length() - distance).abs() < 1e-6);
            let mut there = vec![0.0; space.len()];
            // Through the same configurations as the shortest motion.
            for t in [0.3, 0.7, 1.0] {
                let mut between = vec![0.0; space.len()];
                space.interpolate(&a, &b, t, &mut between);
                space.along(&a, &displacement, t * displacement.length(), &mut there);
                prop_assert!(space.distance(&there, &between) < 1e-6);
            }
        }
    }

    #[test]
    fn angles_are_those_of_the_weighted_tangent_vectors(ordinal in 0..u64::MAX - 2) {
        for space in some_spaces() {
            let [a, b, c] = [0, 1, 2].map(|i| draw(&space, ordinal + i));
            let [u, v] = [&b, &c].map(|to| space.displacement(&a, to));
            let angle = u.angle(&v).expect("they have lengths");
            prop_assert_eq!(Some(angle.to_bits()), v.angle(&u).map(f64::to_bits));
            // By the law of cosines, from the lengths of the two and of their difference.
            let third = u.factors.iter().flatten().zip(v.factors.iter().flatten());
            let third = third.map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
            let cosine = (u.size * u.size + v.size * v.size - third) / (2.0 * u.size * v.size);
            prop_assert!((math::cos(angle) - cosine).abs() < 1e-9);
            // A vector points where it points, and its opposite half a turn away.
            let back = Direction {
                factors: u.factors.iter().map(|part| part.map(|value| -3.0 * value)).collect(),
                size: 3.0 * u.size,
            };
            prop_assert_eq!(u.angle(&u), Some(0.0));
            prop_assert!((u.angle(&back).expect("a direction") - PI).abs() < 1e-12);
        }
    }
}

#[test]
fn what_turns_the_short_way_points_the_short_way() {
    let space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [9.0; 3], 2.0);
    let from = [1.0, 1.0, 3.0];
    let angle = |to: [f64; 3], other: [f64; 3]| {
        let toward = |to: &[f64; 3]| space.displacement(&from, to);
        toward(&to).angle(&toward(&other)).expect("both have a length").to_degrees()
    };
    // On past π and back to less are opposite turns.
    assert!((angle([1.0, 1.0, -3.0], [1.0, 1.0, 2.9]) - 180.0).abs() < 1e-9);
    assert!(angle([1.0, 1.0, -3.0], [1.0, 1.0, 3.1]) < 1e-9);
    // A turn by half a radian weighs as much as a length of 1.
    assert!((angle([2.0, 1.0, 3.0], [2.0, 1.0, 2.5]) - 45.0).abs() < 1e-9);
    assert_eq!(space.displacement(&from, &from).angle(&space.displacement(&from, &[2.0; 3])), None);
}
