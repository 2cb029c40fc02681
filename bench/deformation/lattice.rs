//! Deformation by the bounding box, one setting beside another: where rays start, the order of ChainMail, relaxation.

use super::nets::surface;
use super::rows::median;
use super::shapes::ball;
use super::timing::cpu_seconds;
use roadmill::deformation::bounding_box::{BoundingBox, BoundingBoxWork, Rays};
use roadmill::deformation::{Obstacles, SoftBody};
use roadmill::model::deformable::{BoundingBoxSettings, ChainMailOrder, LatticeInterpolation};
use roadmill::scene::{Body, Mesh, Pose, Shape};
use std::sync::Arc;

/// How many poses of a robot are looked at in each scene.
const POSES: usize = 100;
/// How often the deformation at a pose is timed.
const REPETITIONS: usize = 3;

/// The rays, the order and the sweeps of relaxation that are compared.
const WAYS: [(&str, Rays, ChainMailOrder, u32); 4] = [
    ("rays from the box", Rays::FromBox, ChainMailOrder::Queue, 0),
    ("rays from the robot", Rays::FromRobot, ChainMailOrder::Queue, 0),
    ("most reached first", Rays::FromRobot, ChainMailOrder::MostReached, 0),
    ("ten sweeps of relaxation", Rays::FromRobot, ChainMailOrder::Queue, 10),
];

/// Deforms each robot at poses along a straight way in each scene, with each setting, and prints what it came to.
pub fn run() {
    println!(
        "| scene | robot | triangles | setting | deformed | refused | mean energy | rounds | neighbours looked at | points searched | ms, median |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for (scene, obstacles, way) in scenes() {
        let obstacles = Arc::new(Obstacles::new(&obstacles));
        for (name, body) in robots() {
            for (label, rays, order, relaxation) in WAYS {
                let settings = BoundingBoxSettings {
                    lattice: [13, 9, 7],
                    least: [0.4; 3],
                    greatest: [2.0; 3],
                    shear: 0.6,
                    order,
                    relaxation,
                    interpolation: LatticeInterpolation::Trilinear,
                };
                let deformer =
                    BoundingBox::new(&body, &settings, f64::INFINITY, 0.0, obstacles.clone());
                let deformer = deformer.expect("sound settings").with_rays(rays);
                // A robot that is free at rest everywhere has no row.
                if let Some(row) = measured(&deformer, way) {
                    let triangles = body.triangles().len();
                    println!("| {scene} | {name} | {triangles} | {label} | {row} |");
                }
            }
        }
    }
}

/// The cells of a row that the deformations along a way came to. Poses at which the robot is free at rest do not count.
fn measured(deformer: &BoundingBox, way: fn(f64) -> [f64; 3]) -> Option<String> {
    let (mut energies, mut times, mut refused) = (Vec::new(), Vec::new(), 0u64);
    let mut work = BoundingBoxWork::default();
    for index in 0..POSES {
        let translation = way(index as f64 / (POSES - 1) as f64);
        let pose = Pose { translation, ..Pose::IDENTITY };
        let mut own = BoundingBoxWork::default();
        let found = deformer.deform_counted(&pose, &mut own);
        match found {
            Ok(shape) if shape.energy == 0.0 => continue,
            Ok(shape) => energies.push(shape.energy),
            Err(_) => refused += 1,
        }
        work.rounds += own.rounds;
        work.narrowings += own.narrowings;
        work.searched += own.searched;
        let once = |_| {
            let begun = cpu_seconds();
            let found = deformer.deform_counted(&pose, &mut BoundingBoxWork::default());
            let seconds = cpu_seconds() - begun;
            // What was found is of no use, but the compiler must not leave it out.
            drop(std::hint::black_box(found));
            seconds
        };
        times.push(median((0..REPETITIONS).map(once).collect()));
    }
    if times.is_empty() {
        return None;
    }
    let count = energies.len();
    let all = (count as u64 + refused).max(1);
    Some(format!(
        "{count} | {refused} | {:.1} | {:.1} | {} | {} | {:.2}",
        energies.iter().sum::<f64>() / count.max(1) as f64,
        f64::from(work.rounds) / all as f64,
        work.narrowings / all,
        work.searched / all,
        1e3 * median(times)
    ))
}

/// A ball of two resolutions, by which the lattice's share of the time can be told from that of the triangles, and a brick.
fn robots() -> Vec<(&'static str, SoftBody)> {
    let brick = |point: [f64; 3]| {
        let beyond = [0, 1, 2].map(|axis| point[axis].abs() - [1.0, 0.7, 0.5][axis]);
        beyond.into_iter().fold(f64::NEG_INFINITY, f64::max)
    };
    let round = |point| ball(point, 1.0);
    vec![
        ("ball", soft(0.19, &round)),
        ("coarse ball", soft(0.8, &round)),
        ("brick", soft(0.145, &brick)),
    ]
}

fn soft(width: f64, distance: &dyn Fn([f64; 3]) -> f64) -> SoftBody {
    let net = surface(width, [1.1; 3], distance);
    let corner = |corner: usize| u32::try_from(corner).expect("few vertices");
    let triangles = net.triangles.iter().map(|corners| corners.map(corner)).collect();
    SoftBody::new(Mesh { vertices: net.vertices, triangles }).expect("a closed surface")
}

/// The scenes: a name, the obstacles, and the way of the robot's frame by a share from 0 to 1.
type Scene = (&'static str, Vec<Body>, fn(f64) -> [f64; 3]);

fn scenes() -> Vec<Scene> {
    let body = |shape: Shape, translation: [f64; 3]| Body {
        shape,
        pose: Pose { translation, ..Pose::IDENTITY },
        solid: true,
    };
    let sphere = |radius: f64, at: [f64; 3]| body(Shape::Sphere { radius }, at);
    let bar = |size: [f64; 3], at: [f64; 3]| body(Shape::Box { size }, at);
    let across = |share: f64| [4.0 * share - 2.0, 0.1 * share, 0.05];
    vec![
        ("a ball", vec![sphere(0.8, [0.0, 0.0, 1.2])], |share| [0.3 * share, 0.1, share - 0.9]),
        (
            "a plate with a hole of 1.6",
            vec![
                bar([0.2, 2.0, 4.0], [0.0, -1.8, 0.0]),
                bar([0.2, 1.6, 1.2], [0.0, 0.0, -1.4]),
                bar([0.2, 2.0, 4.0], [0.0, 1.8, 0.0]),
                bar([0.2, 1.6, 1.2], [0.0, 0.0, 1.4]),
            ],
            across,
        ),
        (
            "four spheres around a gap",
            vec![
                sphere(1.0, [0.0, 1.7, 0.0]),
                sphere(0.9, [0.0, -1.6, 0.2]),
                sphere(1.1, [0.1, 0.0, 1.8]),
                sphere(0.8, [-0.1, 0.1, -1.5]),
            ],
            across,
        ),
    ]
}
