use super::shapes::{ball, block, elbow, moved, round};
use super::{CLEARANCE, Scene, settings};
use crate::deformation::{Deform, Geometric, Obstacles, Refusal, SoftBody};
use crate::math;
use crate::model::deformable::GeometricSettings;
use crate::scene::Body;
use std::sync::Arc;

/// A closed room with walls around the origin.
fn room([x, y, z]: [f64; 3]) -> Vec<Body> {
    let wall = 0.5;
    let mut walls = Vec::new();
    for side in [-1.0, 1.0] {
        walls.push(block([wall, y + 1.0, z + 1.0], [side * (x + wall) / 2.0, 0.0, 0.0]));
        walls.push(block([x + 1.0, wall, z + 1.0], [0.0, side * (y + wall) / 2.0, 0.0]));
        walls.push(block([x + 1.0, y + 1.0, wall], [0.0, 0.0, side * (z + wall) / 2.0]));
    }
    walls
}

#[test]
fn a_rod_longer_than_the_room_is_refused() {
    let rod = || elbow(1.2, 0.15, 0.0, 12, 8);
    let limited = GeometricSettings { shortest: 0.8, longest: 1.25, ..settings() };
    // The rod is 2.4 long. It fits in a room as long as four fifths of that, and not in one half as long.
    let scene = Scene::new(rod(), room([2.2, 1.0, 1.0]), limited.clone());
    assert!(scene.deform(&moved(-1.2, 0.0, 0.0)).unwrap().energy > 1.0);
    let scene = Scene::new(rod(), room([1.2, 1.0, 1.0]), limited);
    for step in 0..5 {
        let refusal = scene.deform(&moved(-1.2 + 0.1 * f64::from(step), 0.05, 0.0)).unwrap_err();
        assert!(matches!(refusal, Refusal::Limits | Refusal::Collides | Refusal::SelfCollision));
    }
}

#[test]
fn a_rigid_material_is_refused() {
    let rigid = GeometricSettings { shortest: 1.0, longest: 1.0, rounds: 4, ..settings() };
    let scene = Scene::new(ball(1.0, 2), vec![round(1.0, [0.0; 3])], rigid);
    assert!(scene.deform(&moved(2.02, 0.0, 0.0)).is_ok());
    for depth in [0.01, 0.1, 0.5] {
        let refusal = scene.deform(&moved(2.0 - depth, 0.0, 0.0)).unwrap_err();
        assert!(matches!(refusal, Refusal::Limits | Refusal::Collides), "{refusal:?}");
    }
}

#[test]
fn tighter_limits_are_kept_by_moving_more_of_the_surface() {
    let at = |shortest, longest| {
        let settings = GeometricSettings { shortest, longest, ..settings() };
        let scene = Scene::new(ball(1.0, 3), vec![round(1.0, [0.0; 3])], settings);
        let deformed = scene.deform(&moved(1.7, 0.0, 0.0)).unwrap();
        (scene.edges(&deformed), deformed.energy)
    };
    let ([least, most], energy) = at(0.2, 3.0);
    assert!(least < 0.9 || most > 1.1, "{least} {most}");
    let ([least, most], more) = at(0.9, 1.1);
    assert!(
        least >= 0.9 - 1e-9 && most <= 1.1 + 1e-9 && more > energy,
        "{least} {most} {energy} {more}"
    );
}

#[test]
fn a_shape_that_meets_itself_is_refused_unless_it_may() {
    // A hairpin: a block pushes one arm into the other, which meets nothing.
    let hairpin = || elbow(2.0, 0.25, math::TURN / 2.0, 20, 10);
    let far = 0.76 + 0.25;
    let block = block([0.6, 2.0, 1.0], [0.4, -1.0 + 0.35, 0.0]);
    assert!(hairpin().vertices.iter().all(|vertex| vertex[1] < far + 0.05));
    let at = |refuse_self_collisions| {
        let settings = GeometricSettings {
            refuse_self_collisions,
            guide: 0.95,
            shortest: 0.2,
            longest: 4.0,
            ..settings()
        };
        let scene = Scene::new(hairpin(), vec![block.clone()], settings);
        scene.deform(&moved(0.0, 0.0, 0.0))
    };
    let (refused, accepted) = (at(true), at(false));
    assert_eq!(refused, Err(Refusal::SelfCollision));
    assert!(accepted.is_ok(), "{accepted:?}");
}

#[test]
fn the_energy_is_limited() {
    let body = SoftBody::new(ball(1.0, 2)).unwrap();
    let obstacles = Arc::new(Obstacles::new(&[round(1.0, [0.0; 3])]));
    let at = |highest| {
        let method =
            Geometric::new(&body, &settings(), highest, CLEARANCE, obstacles.clone()).unwrap();
        method.deform(&moved(1.8, 0.0, 0.0))
    };
    let energy = at(f64::INFINITY).unwrap().energy;
    assert!(energy > 0.1);
    assert_eq!(at(energy).unwrap().energy, energy);
    assert_eq!(at(0.99 * energy), Err(Refusal::Energy(energy)));
}

#[test]
fn settings_out_of_range_are_named() {
    let body = SoftBody::new(ball(1.0, 1)).unwrap();
    let error = |settings: GeometricSettings, energy: f64, clearance: f64| {
        let obstacles = Arc::new(Obstacles::new(&[]));
        Geometric::new(&body, &settings, energy, clearance, obstacles).err().unwrap_or_default()
    };
    let fine = settings();
    assert_eq!(error(fine.clone(), 1.0, 0.0), "");
    for (settings, expected) in [
        (
            GeometricSettings { shortest: 1.5, ..fine.clone() },
            "shortest: 1.5 found; a share from 0 to 1 expected",
        ),
        (
            GeometricSettings { shortest: f64::NAN, ..fine.clone() },
            "shortest: NaN found; a share from 0 to 1 expected",
        ),
        (
            GeometricSettings { longest: 0.9, ..fine.clone() },
            "longest: 0.9 found; a share of at least 1, at most 1000000, expected",
        ),
        (
            GeometricSettings { neighbourhood: -1.0, ..fine.clone() },
            "neighbourhood: -1 found; a length of at least 0 expected",
        ),
        (
            GeometricSettings { guide: 1.0, ..fine.clone() },
            "guide: 1 found; a scale above 0, below 1, expected",
        ),
        (GeometricSettings { rounds: 0, ..fine.clone() }, "rounds: 0 found; 1 to 1000 expected"),
    ] {
        assert_eq!(error(settings, 1.0, 0.0), expected);
    }
    assert_eq!(error(fine.clone(), -1.0, 0.0), "highest_energy: -1 found; at least 0 expected");
    assert_eq!(
        error(fine, 1.0, f64::INFINITY),
        "clearance: inf found; a length of at least 0 expected"
    );
}
