//! Verdicts do not depend on the unit of length nor on where a scene stands, and the tests that they take hardly do.

use super::tests::{chain, cuboid, cuboid_mesh, solid};
use super::{BodyScratch, BodyValidity, Bounds, BoundsMeaning, MotionChecking};
use crate::model::bodies::robot::Robot;
use crate::model::bodies::robot::rates_tests::drawn_pose;
use crate::model::{Clearances, Model, Scratch, Validity};
use crate::numbers::Ordinal;
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::seed::{Purpose, Seed, Stream};
use crate::space::{BaseJoint, Space};
use proptest::prelude::*;

/// A robot among obstacles, before it is made ready.
#[derive(Clone)]
struct Scene {
    robot: Robot,
    obstacles: Vec<Body>,
    bounds: Bounds,
    resolution: f64,
}

fn scaled_body(body: &Body, factor: f64) -> Body {
    let all = |lengths: [f64; 3]| lengths.map(|length| length * factor);
    let shape = match &body.shape {
        Shape::Point => Shape::Point,
        Shape::Box { size } => Shape::Box { size: all(*size) },
        Shape::Sphere { radius } => Shape::Sphere { radius: radius * factor },
        Shape::Cylinder { radius, height } => {
            Shape::Cylinder { radius: radius * factor, height: height * factor }
        }
        Shape::Capsule { radius, height } => {
            Shape::Capsule { radius: radius * factor, height: height * factor }
        }
        Shape::Mesh(mesh) => {
            let vertices = mesh.vertices.iter().map(|vertex| all(*vertex)).collect();
            Shape::Mesh(Mesh { vertices, ..mesh.clone() })
        }
    };
    Body { shape, pose: Pose { translation: all(body.pose.translation), ..body.pose }, ..*body }
}

fn moved_body(body: &Body, by: [f64; 3]) -> Body {
    let translation = [0, 1, 2].map(|axis| body.pose.translation[axis] + by[axis]);
    Body { pose: Pose { translation, ..body.pose }, ..body.clone() }
}

impl Scene {
    /// A rigid robot of one body, which turns, beside one obstacle.
    fn pair(robot: &Body, obstacle: &Body) -> Scene {
        let meaning = BoundsMeaning::Reference;
        Scene {
            robot: Robot::rigid(BaseJoint::Rigid3d, vec![robot.clone()]),
            obstacles: vec![obstacle.clone()],
            bounds: Bounds { min: [-4.0; 3], max: [4.0; 3], meaning },
            resolution: 0.05,
        }
    }

    /// The scene of a rigid robot in another unit of length.
    fn scaled(&self, factor: f64) -> Scene {
        let mut robot = self.robot.clone();
        for body in &mut robot.links[0].bodies {
            *body = scaled_body(body, factor);
        }
        let Bounds { min, max, meaning } = self.bounds;
        let [min, max] = [min, max].map(|corner| corner.map(|x| x * factor));
        Scene {
            robot,
            obstacles: self.obstacles.iter().map(|body| scaled_body(body, factor)).collect(),
            bounds: Bounds { min, max, meaning },
            resolution: self.resolution * factor,
        }
    }

    /// The scene at another place; `in_frame` says whether the robot's bodies move in the robot's frame, so that its
    /// configurations stay the same, or its configurations do.
    fn moved(&self, by: [f64; 3], in_frame: bool) -> Scene {
        let mut scene = self.clone();
        scene.obstacles = self.obstacles.iter().map(|body| moved_body(body, by)).collect();
        if in_frame {
            for body in &mut scene.robot.links[0].bodies {
                *body = moved_body(body, by);
            }
            return scene;
        }
        let Scene { bounds, robot, .. } = &mut scene;
        for place in [&mut bounds.min, &mut bounds.max, &mut robot.base.translation] {
            *place = [0, 1, 2].map(|axis| place[axis] + by[axis]);
        }
        scene
    }

    /// The scene with every body larger or smaller, where it stands.
    fn grown(&self, share: f64) -> BodyValidity {
        let mut scene = self.clone();
        for body in scene.robot.links[0].bodies.iter_mut().chain(&mut scene.obstacles) {
            let translation = body.pose.translation;
            *body = scaled_body(body, share);
            body.pose.translation = translation;
        }
        scene.ready().1
    }

    fn ready(&self) -> (Space, BodyValidity) {
        let Scene { robot, obstacles, bounds, resolution } = self;
        let space = robot.space(bounds.min, bounds.max, 1.0);
        let (edges, step) = (MotionChecking::Swept, *resolution);
        let validity = BodyValidity::new(space.clone(), robot, *bounds, edges, step, obstacles);
        (space, validity)
    }
}

/// One of each kind, of about the same size.
fn kinds() -> Vec<Body> {
    vec![
        solid(Shape::Point, [0.1, 0.0, 0.0]),
        cuboid([0.9, 0.6, 0.4], [0.1, 0.0, 0.0]),
        solid(Shape::Sphere { radius: 0.5 }, [0.1, 0.0, 0.0]),
        solid(Shape::Cylinder { radius: 0.3, height: 0.9 }, [0.1, 0.0, 0.0]),
        solid(Shape::Capsule { radius: 0.25, height: 0.7 }, [0.1, 0.0, 0.0]),
        cuboid_mesh([0.8, 0.7, 0.5], [0.1, 0.0, 0.0], true),
    ]
}

/// Every kind of robot beside every kind of obstacle, which is turned in some way.
fn pairs(stream: &mut Stream) -> Vec<Scene> {
    let mut pairs = Vec::new();
    for robot in kinds() {
        for obstacle in &kinds()[1..] {
            let pose = Pose { translation: obstacle.pose.translation, ..drawn_pose(stream, 1.0) };
            pairs.push(Scene::pair(&robot, &Body { pose, ..obstacle.clone() }));
        }
    }
    pairs
}

/// A configuration of a free rigid body that may well touch what stands about the origin.
fn drawn_configuration(stream: &mut Stream) -> Vec<f64> {
    let Pose { translation, rotation } = drawn_pose(stream, 1.1);
    [&translation[..], &rotation[..]].concat()
}

fn in_unit(q: &[f64], factor: f64) -> Vec<f64> {
    q.iter().enumerate().map(|(i, value)| if i < 3 { value * factor } else { *value }).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Doubling and halving is exact, so that even what is between touching and not touching stays what it is.
    #[test]
    fn powers_of_two_change_no_verdict_and_no_digit(
        ordinal in any::<u64>(), power in prop::sample::select(vec![-90, -40, -17, -1, 1, 23, 60, 90]),
    ) {
        let mut stream = Seed::of_set(5, "units", Ordinal(ordinal)).stream(Purpose::Sampling);
        let factor = (0..i32::abs(power)).fold(1.0, |f, _| if power > 0 { f * 2.0 } else { f / 2.0 });
        let scratch = &mut Scratch::new();
        for scene in pairs(&mut stream) {
            let ((_, one), (_, other)) = (scene.ready(), scene.scaled(factor).ready());
            for _ in 0..4 {
                let [a, b] = [0; 2].map(|_| drawn_configuration(&mut stream));
                let [c, d] = [&a, &b].map(|q| in_unit(q, factor));
                prop_assert_eq!(one.validity(&a, scratch), other.validity(&c, scratch));
                let free = one.motion(&a, &b, 1, scratch).is_some();
                prop_assert_eq!(free, other.motion(&c, &d, 1, scratch).is_some());
                let near = [one.clearance(&a, scratch), other.clearance(&c, scratch)];
                let [near, other_near] = near.map(|found| found.unwrap().distance);
                prop_assert_eq!((near * factor).to_bits(), other_near.to_bits());
            }
        }
    }

    /// Other units round, which may only matter where a hundred-millionth part of the size does.
    #[test]
    fn a_change_of_unit_changes_no_verdict(ordinal in any::<u64>(), power in -6i32..=6) {
        let mut stream = Seed::of_set(5, "decimals", Ordinal(ordinal)).stream(Purpose::Sampling);
        let factor = format!("1e{power}").parse().unwrap();
        let scratch = &mut Scratch::new();
        for scene in pairs(&mut stream) {
            let (less, more) = (scene.grown(1.0 - 1e-8), scene.grown(1.0 + 1e-8));
            let (_, other) = scene.scaled(factor).ready();
            for _ in 0..4 {
                let q = drawn_configuration(&mut stream);
                let expected = less.validity(&q, scratch);
                if more.validity(&q, scratch) == expected {
                    prop_assert_eq!(other.validity(&in_unit(&q, factor), scratch), expected);
                }
            }
        }
    }

    /// So does another place, by half a unit in the last place of every coordinate, which a size of 1 is told from by 1e-8.
    #[test]
    fn another_place_changes_no_verdict(ordinal in any::<u64>(), power in 0i32..=6) {
        let mut stream = Seed::of_set(5, "places", Ordinal(ordinal)).stream(Purpose::Sampling);
        let far: f64 = format!("1e{power}").parse().unwrap();
        let scratch = &mut Scratch::new();
        for mut scene in pairs(&mut stream) {
            scene.bounds.meaning = BoundsMeaning::Reference;
            let by = [0; 3].map(|_| (2.0 * stream.unit() - 1.0) * far);
            let share = 1e-8 + 16.0 * f64::EPSILON * far;
            let (less, more) = (scene.grown(1.0 - share), scene.grown(1.0 + share));
            let (_, other) = scene.moved(by, false).ready();
            for _ in 0..4 {
                let q = drawn_configuration(&mut stream);
                let expected = less.validity(&q, scratch);
                if more.validity(&q, scratch) == expected {
                    let moved: Vec<f64> =
                        q.iter().enumerate().map(|(i, x)| if i < 3 { x + by[i] } else { *x }).collect();
                    prop_assert_eq!(other.validity(&moved, scratch), expected);
                }
            }
        }
    }
}

/// Two rods a quarter of their length apart, in units from ten micrometres to a kilometre.
#[test]
fn thin_rods_are_apart_in_every_unit() {
    let rod = solid(Shape::Cylinder { radius: 0.5, height: 1.0 }, [0.0; 3]);
    let half = 0.5f64.sqrt();
    let lying = Pose { rotation: [half, half, 0.0, 0.0], ..Pose::IDENTITY };
    let scene = Scene::pair(&rod, &Body { pose: lying, ..rod.clone() });
    for power in -9..=9 {
        let factor: f64 = format!("1e{power}").parse().unwrap();
        let (_, validity) = scene.scaled(factor).ready();
        // One stands upright above the other, which lies along y.
        for (gap, expected) in [(0.25, Validity::Valid), (-0.01, Validity::Invalid)] {
            let q = in_unit(&[0.3, 0.0, 1.0 + gap, 1.0, 0.0, 0.0, 0.0], factor);
            assert_eq!(validity.validity(&q, &mut Scratch::new()), expected, "{gap} at 1e{power}");
        }
    }
}

/// Walls, posts and pipes in a room of 16 by 10 by 4, with coordinates that are multiples of 1/8.
fn yard(robot: Robot) -> Scene {
    let mut obstacles = Vec::new();
    for i in 0..24u32 {
        let at = [
            1.0 + 2.0 * f64::from(i % 8),
            1.5 + 3.0 * f64::from(i / 8),
            0.5 * f64::from(i % 4) - 0.75,
        ];
        obstacles.push(match i % 5 {
            0 => cuboid([0.25, 2.0, 1.0], at),
            1 => cuboid_mesh([1.5, 0.125, 1.5], at, true),
            2 => solid(Shape::Cylinder { radius: 0.25, height: 2.0 }, at),
            3 => solid(Shape::Capsule { radius: 0.125, height: 1.5 }, at),
            _ => solid(Shape::Sphere { radius: 0.375 }, at),
        });
    }
    let bounds =
        Bounds { min: [0.0, 0.0, -2.0], max: [16.0, 10.0, 2.0], meaning: BoundsMeaning::Body };
    Scene { robot, obstacles, bounds, resolution: 0.0625 }
}

/// An ell of two boxes and a mesh.
fn ell() -> Vec<Body> {
    vec![
        cuboid([1.0, 0.125, 0.125], [0.0; 3]),
        cuboid_mesh([0.125, 0.5, 0.125], [0.5, 0.25, 0.0], true),
    ]
}

/// What some motions come to: their verdicts, those of their ends, and the tests that they take.
fn judged(scene: &Scene, motions: &[[Vec<f64>; 2]], by: [f64; 3]) -> (Vec<(Validity, bool)>, u64) {
    let (space, validity) = scene.ready();
    let scratch = &mut Scratch::new();
    let axes = space.len().min(scene.robot.motion.translations());
    let moved = |q: &Vec<f64>| -> Vec<f64> {
        q.iter().enumerate().map(|(i, x)| if i < axes { x + by[i] } else { *x }).collect()
    };
    let verdicts = motions.iter().map(|[a, b]| {
        let (a, b) = (moved(a), moved(b));
        (validity.validity(&a, scratch), validity.motion(&a, &b, 1, scratch).is_some())
    });
    let verdicts = verdicts.collect();
    let work = scratch.of_model::<BodyScratch>().take_work();
    (verdicts, work.balls + work.placed + work.boxes + work.looks + work.pairs + work.advances)
}

/// Motions between valid configurations, half of them short.
fn drawn_motions(scene: &Scene, name: &str, count: usize) -> Vec<[Vec<f64>; 2]> {
    let (space, validity) = scene.ready();
    let mut stream = Seed::of_set(5, name, Ordinal(0)).stream(Purpose::Sampling);
    let scratch = &mut Scratch::new();
    let mut motions = Vec::new();
    let (mut a, mut b) = (vec![0.0; space.len()], vec![0.0; space.len()]);
    while motions.len() < count {
        space.sample_uniform(&mut stream, &mut a);
        if motions.len() % 2 == 0 {
            space.step(&a, 1.5, &mut stream, &mut b);
        } else {
            space.sample_uniform(&mut stream, &mut b);
        }
        if [&a, &b].into_iter().all(|q| validity.is_valid(q, scratch)) {
            motions.push([a.clone(), b.clone()]);
        }
    }
    motions
}

fn assert_alike(name: &str, tests: u64, other_tests: u64) {
    assert!(tests > 1000, "{name}: {tests}");
    let alike = 2 * other_tests <= 3 * tests && 2 * tests <= 3 * other_tests;
    assert!(alike, "{name}: {other_tests} tests, {tests} where nothing was changed");
}

/// The same scene at map coordinates, or farther away than anybody would put it.
#[test]
fn a_scene_far_away_has_the_same_verdicts_for_the_same_work() {
    let arm = chain(4, BaseJoint::Fixed);
    for (name, robot) in [
        ("planar", Robot::rigid(BaseJoint::Rigid2d, ell())),
        ("flying", Robot::rigid(BaseJoint::Rigid3d, ell())),
        ("arm", Robot { base: Pose { translation: [4.0, 3.0, 0.5], ..Pose::IDENTITY }, ..arm }),
    ] {
        let mut scene = yard(robot);
        if scene.robot.motion == BaseJoint::Fixed {
            // The arm stands where an obstacle would be.
            scene.obstacles.retain(|body| body.pose.translation[0] > 5.0);
            scene.obstacles.push(cuboid([0.5, 0.5, 0.5], [6.0, 5.0, 0.5]));
            scene.bounds.meaning = BoundsMeaning::Reference;
        }
        let motions = drawn_motions(&scene, name, 120);
        let (verdicts, tests) = judged(&scene, &motions, [0.0; 3]);
        assert!(verdicts.iter().any(|(_, free)| *free) && verdicts.iter().any(|(_, free)| !free));
        for by in [[524_288.0, 4_194_304.0, 0.0], [-1e6, 3e5, 0.0], [1e8, -1e8, 0.0]] {
            // Planar robots stay in the plane, others go up as well.
            let height = if scene.robot.motion == BaseJoint::Rigid2d { 0.0 } else { 65_536.0 };
            let by = [by[0], by[1], height];
            let (far, far_tests) = judged(&scene.moved(by, false), &motions, by);
            assert_eq!(far, verdicts, "{name} at {by:?}");
            assert_alike(name, tests, far_tests);
        }
    }
}

/// Robot and obstacles drawn in coordinates of their own, far from the point by which the robot is placed.
#[test]
fn a_robot_far_from_its_reference_point_has_the_same_verdicts_for_the_same_work() {
    let mut scene = yard(Robot::rigid(BaseJoint::Translation3d, ell()));
    scene.bounds.meaning = BoundsMeaning::Reference;
    let motions = drawn_motions(&scene, "drawn far away", 120);
    let (verdicts, tests) = judged(&scene, &motions, [0.0; 3]);
    for by in [[524_288.0, 4_194_304.0, 65_536.0], [-3e6, 0.0, 1e5]] {
        let (far, far_tests) = judged(&scene.moved(by, true), &motions, [0.0; 3]);
        assert_eq!(far, verdicts, "{by:?}");
        assert_alike("drawn far away", tests, far_tests);
    }
}

/// A ground plate that reaches as far as the walls or to the horizon, and bounds that do.
#[test]
fn a_huge_plate_costs_what_a_small_one_costs() {
    for motion in [BaseJoint::Rigid2d, BaseJoint::Rigid3d] {
        let scene = |side: f64, wide: bool| {
            let mut scene = yard(Robot::rigid(motion, ell()));
            // Not in the middle of the scene.
            scene.obstacles.push(cuboid([side, side, 0.5], [0.3 * side, -0.2 * side, -2.25]));
            if wide {
                scene.bounds.min[0] -= side;
                scene.bounds.max[1] += 2.0 * side;
            }
            scene
        };
        let small = scene(40.0, false);
        let motions = drawn_motions(&small, "plate", 120);
        let (verdicts, tests) = judged(&small, &motions, [0.0; 3]);
        for (side, wide) in [(4e4, false), (4e6, false), (4e6, true)] {
            let (huge, huge_tests) = judged(&scene(side, wide), &motions, [0.0; 3]);
            // Wider bounds forbid less.
            assert!(wide || huge == verdicts, "{motion:?} {side}");
            assert_alike(&format!("{motion:?} {side} {wide}"), tests, huge_tests);
        }
    }
}
