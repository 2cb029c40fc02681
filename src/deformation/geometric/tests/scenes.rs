use super::shapes::{ball, block, elbow, four_balls, moved, plate_with_hole, round};
use super::{Scene, settings};
use crate::deformation::{Deformed, Refusal};
use crate::math;
use crate::model::deformable::GeometricSettings;
use crate::scene::Pose;
use proptest::prelude::*;

#[test]
fn a_robot_that_is_free_keeps_its_shape() {
    let scene = Scene::new(ball(1.0, 2), vec![round(1.0, [0.0; 3])], settings());
    let deformed = scene.deform(&moved(2.02, 0.0, 0.0)).unwrap();
    assert_eq!(deformed.energy, 0.0);
    assert_eq!(deformed.vertices, scene.body.vertices());
}

#[test]
fn a_ball_gives_way_to_a_ball_and_only_where_it_must() {
    let scene = Scene::new(ball(1.0, 3), vec![round(1.0, [0.0; 3])], settings());
    let mut last = 0.0;
    for step in 0..8 {
        let deformed = scene.deform(&moved(1.95 - 0.1 * f64::from(step), 0.0, 0.0)).unwrap();
        assert!(deformed.energy > last, "{}", deformed.energy);
        last = deformed.energy;
        let rest = scene.body.vertices();
        let behind = |(now, rest): (&[f64; 3], &[f64; 3])| rest[0] < 0.3 || now == rest;
        assert!(deformed.vertices.iter().zip(rest).all(behind));
        // Nothing is pushed farther than the balls overlap, and the clearance.
        let depth = 0.05 + 0.1 * f64::from(step) + 0.02;
        let far = |(now, rest): (&[f64; 3], &[f64; 3])| (now[0] - rest[0]).abs() < depth + 0.05;
        assert!(deformed.vertices.iter().zip(rest).all(far));
    }
}

#[test]
fn the_shape_follows_the_pose() {
    let scene = Scene::new(ball(1.0, 3), vec![round(1.0, [0.0; 3])], settings());
    let pose = |step: i32| moved(1.6 - 1e-4 * f64::from(step), 0.0, 0.0);
    let shapes: Vec<Deformed> = (0..20).map(|step| scene.deform(&pose(step)).unwrap()).collect();
    for step in 1..20 {
        let [before, now] = [step - 1, step].map(|at| (pose(at), &shapes[at as usize]));
        let far = scene.step((&before.0, before.1), (&now.0, now.1));
        // A vertex that is raised because a triangle beside it collides moves faster than the pose.
        assert!(far < 1e-3, "{step} {far}");
    }
}

#[test]
fn collisions_far_apart_do_not_influence_one_another() {
    let plates =
        [block([4.0, 4.0, 0.2], [0.0, 0.0, 0.9]), block([4.0, 4.0, 0.2], [0.0, 0.0, -0.95])];
    let deform = |plates: &[crate::scene::Body]| {
        let scene = Scene::new(ball(1.0, 3), plates.to_vec(), settings());
        (scene.deform(&moved(0.1, 0.2, 0.0)).unwrap(), scene)
    };
    let (both, scene) = deform(&plates);
    let (above, _) = deform(&plates[..1]);
    let (below, _) = deform(&plates[1..]);
    for (at, rest) in scene.body.vertices().iter().enumerate() {
        let alone = if rest[2] > 0.0 { &above } else { &below };
        assert_eq!(both.vertices[at], alone.vertices[at]);
    }
    assert!(above.energy > 1.0 && below.energy > 1.0 && scene.volume(&both) < 0.96);
}

#[test]
fn one_region_between_plates_is_divided_or_guided() {
    // Around the whole ball no direction frees both sides.
    let plates =
        vec![block([4.0, 4.0, 0.2], [0.0, 0.0, 0.9]), block([4.0, 4.0, 0.2], [0.0, 0.0, -0.95])];
    let scene =
        Scene::new(ball(1.0, 2), plates, GeometricSettings { neighbourhood: 4.0, ..settings() });
    scene.deform(&moved(0.1, 0.2, 0.0)).unwrap();
}

#[test]
fn a_ball_is_squeezed_through_four_balls() {
    let scene = Scene::new(ball(0.8, 3), four_balls(), settings());
    let pose = |step: i32| moved(0.1 * f64::from(step), 0.0, 0.0);
    let shapes: Vec<Deformed> = (-12..=12).map(|step| scene.deform(&pose(step)).unwrap()).collect();
    assert_eq!((shapes[0].energy, shapes[24].energy), (0.0, 0.0));
    assert!(shapes[12].energy > 20.0, "{}", shapes[12].energy);
    for at in 1..25 {
        let [before, now] = [at - 1, at].map(|at| (pose(at as i32 - 12), &shapes[at]));
        let far = scene.step((&before.0, before.1), (&now.0, now.1));
        assert!(far < 0.3, "{at} {far}");
    }
}

#[test]
fn a_thin_plate_does_not_cut_a_robot() {
    // The middle of the ball is half a radius from the plate, and what had come through it comes back.
    let scene = Scene::new(ball(1.0, 3), vec![block([0.05, 6.0, 6.0], [0.0; 3])], settings());
    let deformed = scene.deform(&moved(-0.5, 0.0, 0.0)).unwrap();
    assert!(deformed.vertices.iter().all(|vertex| vertex[0] < 0.5));
}

#[test]
fn an_obstacle_within_the_robot_is_no_collision_of_triangles_but_is_met() {
    let scene = Scene::new(ball(1.0, 3), vec![round(0.1, [0.0; 3])], settings());
    // Near the surface the ball wraps itself around the obstacle; in the middle there is no way out.
    let deformed = scene.deform(&moved(-0.84, 0.0, 0.0)).unwrap();
    assert!(scene.volume(&deformed) < 1.0);
    assert_eq!(scene.deform(&moved(0.0, 0.0, 0.0)), Err(Refusal::Collides));
}

#[test]
fn an_elbow_goes_through_a_hole_that_is_smaller() {
    // The hole is 0.5 wide, the elbow 0.6 thick.
    let scene =
        Scene::new(elbow(2.0, 0.3, 1.5, 20, 12), plate_with_hole(0.5, 6.0, 0.2), settings());
    for step in 0..=10 {
        let deformed = scene.deform(&moved(-1.4 + 0.1 * f64::from(step), 0.0, 0.0)).unwrap();
        assert!(deformed.energy > 0.5 && scene.volume(&deformed) > 0.85);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn no_accepted_shape_collides(
        place in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0],
        angle in 0.0..6.2f64,
        neighbourhood in 0.0..1.5f64,
        guide in 0.3..0.9f64,
    ) {
        let mut bodies = four_balls();
        bodies.push(block([0.4, 3.0, 0.2], [0.7, 0.3, 0.2]));
        let settings = GeometricSettings { neighbourhood, guide, rounds: 6, ..settings() };
        let scene = Scene::new(elbow(0.8, 0.3, 1.0, 8, 10), bodies, settings);
        let rotation = [math::cos(angle / 2.0), math::sin(angle / 2.0) * 0.6, 0.0, math::sin(angle / 2.0) * 0.8];
        let pose = Pose { translation: place, rotation };
        // `deform` judges what it returns.
        let (one, other) = (scene.deform(&pose), scene.deform(&pose));
        prop_assert_eq!(one, other);
    }
}
