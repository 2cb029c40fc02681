//! Continuous collision detection against discrete checks at much finer steps.

use super::super::meet::{Group, Meeting};
use super::super::tests::{chain, cuboid, cuboid_mesh, solid};
use super::super::{BodyScratch, BodyValidity, Bounds, BoundsMeaning, MotionChecking, TOLERANCE};
use super::{Clock, Walls};
use crate::lanes::Lanes;
use crate::model::bodies::robot::{Follower, Joint, JointKind, Limits, Link, Rates, Robot, couple};
use crate::model::{Clearances, Model, Scratch};
use crate::numbers::Ordinal;
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::seed::{Purpose, Seed, Stream};
use crate::space::{BaseJoint, Space};
use proptest::prelude::*;

struct Scene {
    name: &'static str,
    space: Space,
    swept: BodyValidity,
    sampled: BodyValidity,
    /// The same as `swept`, with obstacles and triangles in reverse order, so that the trees differ.
    reversed: BodyValidity,
}

const RESOLUTION: f64 = 0.2;
/// How many times finer than the resolution the steps of the discrete checks are.
const FINER: u64 = 16;

fn scene(name: &'static str, robot: &Robot, obstacles: &[Body], meaning: BoundsMeaning) -> Scene {
    let bounds = Bounds { min: [-3.0; 3], max: [3.0; 3], meaning };
    let space = robot.space(bounds.min, bounds.max, 1.0);
    let [swept, sampled] = [MotionChecking::Swept, MotionChecking::Sampled]
        .map(|edges| BodyValidity::new(space.clone(), robot, bounds, edges, RESOLUTION, obstacles));
    let reversed: Vec<Body> = obstacles
        .iter()
        .rev()
        .map(|body| match &body.shape {
            Shape::Mesh(mesh) => {
                let triangles = mesh.triangles.iter().rev().copied().collect();
                let mesh = Mesh { triangles, ..mesh.clone() };
                Body { shape: Shape::Mesh(mesh), ..body.clone() }
            }
            _ => body.clone(),
        })
        .collect();
    let promise = MotionChecking::Swept;
    let reversed = BodyValidity::new(space.clone(), robot, bounds, promise, RESOLUTION, &reversed);
    Scene { name, space, swept, sampled, reversed }
}

fn turned(body: Body, rotation: [f64; 4]) -> Body {
    let length = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
    Body { pose: Pose { rotation: rotation.map(|x| x / length), ..body.pose }, ..body }
}

/// An arm with a slide and a tool, on a base that moves as told.
fn arm(motion: BaseJoint) -> Robot {
    let mut robot = chain(3, motion);
    let limits = Limits { min: 0.0, max: 0.8 };
    robot.links.push(Link {
        name: "slide".to_owned(),
        bodies: vec![solid(Shape::Capsule { radius: 0.08, height: 0.5 }, [0.3, 0.0, 0.0])],
        joint: Some(Joint {
            name: "slide".to_owned(),
            parent: 2,
            kind: JointKind::Prismatic { axis: [0.0, 0.6, 0.8], limits },
            before: Pose { translation: [0.9, 0.1, 0.0], ..Pose::IDENTITY },
            after: Pose { translation: [0.0, 0.2, 0.0], ..Pose::IDENTITY },
        }),
    });
    robot.links.push(Link {
        name: "tool".to_owned(),
        bodies: vec![solid(Shape::Cylinder { radius: 0.1, height: 0.6 }, [0.0, 0.0, 0.2])],
        joint: Some(Joint {
            name: "spin".to_owned(),
            parent: 3,
            kind: JointKind::Revolute { axis: [1.0, 0.0, 0.0], limits: None },
            before: Pose { translation: [0.3, 0.0, 0.3], ..Pose::IDENTITY },
            after: Pose::IDENTITY,
        }),
    });
    robot
}

/// The same in which the second joint, the slide and the tool follow the first and the last by themselves, with a finger
/// on the tool that turns on with it, thrice as fast.
fn followers(motion: BaseJoint) -> Robot {
    let mut robot = arm(motion);
    let axis = [0.0, 0.6, 0.8];
    robot.links.push(Link {
        name: "finger".to_owned(),
        bodies: vec![solid(Shape::Capsule { radius: 0.05, height: 0.6 }, [0.0, 0.0, 0.4])],
        joint: Some(Joint {
            name: "finger".to_owned(),
            parent: 4,
            kind: JointKind::Revolute { axis, limits: None },
            before: Pose { translation: [0.4, 0.0, 0.2], ..Pose::IDENTITY },
            after: Pose::IDENTITY,
        }),
    });
    let follower =
        |link, followed, multiplier, offset| Follower { link, followed, multiplier, offset };
    let all = [follower(2, 1, -1.7, 0.3), follower(3, 1, 0.13, 0.4), follower(5, 4, 3.0, 0.5)];
    couple(&mut robot.links, &all).expect("joints that can follow");
    robot
}

fn scenes() -> Vec<Scene> {
    let mixed = [
        solid(Shape::Sphere { radius: 0.8 }, [2.0, 0.0, 1.0]),
        turned(
            solid(Shape::Capsule { radius: 0.4, height: 2.0 }, [-2.0, 0.0, 0.0]),
            [1.0, 1.0, 0.0, 0.0],
        ),
        cuboid_mesh([0.6, 0.9, 3.0], [0.0, 2.0, 0.0], true),
        turned(
            solid(Shape::Cylinder { radius: 0.7, height: 1.5 }, [0.0, -2.0, 0.0]),
            [1.0, 0.3, 0.5, 0.0],
        ),
        turned(cuboid([0.1, 1.5, 1.5], [0.5, 0.0, 2.0]), [1.0, 0.2, 0.2, 0.4]),
    ];
    let ell = [
        cuboid_mesh([1.2, 0.2, 0.2], [0.0; 3], true),
        cuboid([0.2, 0.9, 0.2], [0.5, 0.4, 0.0]),
        solid(Shape::Sphere { radius: 0.2 }, [-0.7, 0.0, 0.1]),
        solid(Shape::Cylinder { radius: 0.15, height: 0.5 }, [0.5, 0.8, 0.2]),
    ];
    let ball = [solid(Shape::Sphere { radius: 0.3 }, [0.1, 0.0, 0.0])];
    let dot = [solid(Shape::Point, [0.0; 3])];
    use BoundsMeaning::{Body as All, Reference};
    vec![
        scene("rigid-3d", &Robot::rigid(BaseJoint::Rigid3d, ell.to_vec()), &mixed, All),
        scene("rigid-2d", &Robot::rigid(BaseJoint::Rigid2d, ell.to_vec()), &mixed, All),
        scene(
            "meshes",
            &Robot::rigid(BaseJoint::Rigid3d, ell[..1].to_vec()),
            &mixed[2..3],
            Reference,
        ),
        scene("ball", &Robot::rigid(BaseJoint::Translation3d, ball.to_vec()), &mixed, All),
        scene("point", &Robot::rigid(BaseJoint::Translation2d, dot.to_vec()), &mixed, Reference),
        scene("fixed chain", &chain(4, BaseJoint::Fixed), &mixed[..3], All),
        scene("fixed arm", &arm(BaseJoint::Fixed), &mixed, All),
        scene("flying arm", &arm(BaseJoint::Rigid3d), &mixed[1..], Reference),
        scene("planar arm", &arm(BaseJoint::Rigid2d), &mixed[3..], Reference),
        scene("fixed arm of followers", &followers(BaseJoint::Fixed), &mixed, All),
        scene("flying arm of followers", &followers(BaseJoint::Rigid3d), &mixed[1..], Reference),
    ]
}

/// Motions between valid configurations, some short and some across.
fn motions(scene: &Scene, stream: &mut Stream, count: usize) -> Vec<(Vec<f64>, Vec<f64>)> {
    let scratch = &mut Scratch::new();
    let mut found = Vec::new();
    let (mut a, mut b) = (vec![0.0; scene.space.len()], vec![0.0; scene.space.len()]);
    while found.len() < count {
        scene.space.sample_uniform(stream, &mut a);
        if scene.swept.is_valid(&a, scratch) {
            if found.len() % 2 == 0 {
                scene.space.step(&a, 2.0, stream, &mut b);
            } else {
                scene.space.sample_uniform(stream, &mut b);
            }
            if scene.swept.is_valid(&b, scratch) {
                found.push((a.clone(), b.clone()));
            }
        }
    }
    found
}

impl BodyValidity {
    /// Whether some two surfaces come, at one of a few samples of a swept motion, so near that they may come
    /// within the tolerance between two of them, or the robot so near to its bounds.
    fn comes_near(&self, a: &[f64], b: &[f64], scratch: &mut Scratch) -> bool {
        let samples = self.steps(a, b, 1) * 64;
        let time = 1.0 / samples as f64;
        let finest = self.resolution / TOLERANCE as f64;
        let BodyScratch { timeline, stacks, .. } = scratch.of_model();
        let clock = &mut Clock::new(&self.space, &self.robot, (a, b), samples, timeline);
        let reach = |group: &Group, rates: &Rates| {
            group.tree.elements.iter().fold(0.0f64, |most, e| most.max(e.reach(rates)))
        };
        (0..=samples).any(|sample| {
            let stance = clock.at(sample);
            self.meetings().any(|meeting| {
                let Meeting { mover_link, still_link, .. } = meeting;
                let rates = self.hops.rates(still_link, mover_link, (a, b), &mut stacks.descent);
                let tolerance = 0.5 * time * rates.speed_at(reach(meeting.mover, &rates));
                let way = meeting.nearer(stance, &mut stacks.pairs, None);
                way.is_some_and(|best| best.clearance.distance <= tolerance + finest + self.slack)
            }) || self.bounds.meaning == BoundsMeaning::Body
                && self.links.iter().any(|moving| {
                    let rates = self.hops.rates(None, moving.link, (a, b), &mut stacks.descent);
                    let space = &moving.group.tree.nodes[0].space;
                    let far = space.radius + rates.distance(space.centre);
                    let between = 0.5 * time * rates.speed_at(far);
                    let room = rates.bend_at(far) * time * time / 8.0 + between + self.slack;
                    let Walls { min, max, axes } = self.walls();
                    let [min, max] = [min.map(|x| x + room), max.map(|x| x - room)];
                    let narrower = Walls { min, max, axes };
                    !narrower.hold(&moving.group.tree, &stance.frames[moving.link])
                })
        })
    }
}

/// No motion is accepted that is blocked at finer steps, and none is refused unless something is near.
#[test]
fn swept_motions_are_free_between_the_steps() {
    let scratch = &mut Scratch::new();
    let (mut accepted, mut free, mut refused) = (0, 0, 0);
    for scene in scenes() {
        let mut stream = Seed::of_set(5, scene.name, Ordinal(0)).stream(Purpose::Sampling);
        for (a, b) in motions(&scene, &mut stream, 150) {
            let swept = scene.swept.motion(&a, &b, 1, scratch).is_some();
            let steps = FINER * scene.swept.steps(&a, &b, 1);
            let finer = scene.swept.free_at_steps(&a, &b, steps, scratch.of_model());
            assert!(finer || !swept, "{}: {a:?} to {b:?} is not free", scene.name);
            let reversed = scene.reversed.motion(&a, &b, 1, scratch).is_some();
            assert_eq!(reversed, swept, "{}: {a:?} to {b:?} with other trees", scene.name);
            accepted += usize::from(swept);
            free += usize::from(finer);
            if finer && !swept {
                refused += 1;
                let near = scene.swept.comes_near(&a, &b, scratch);
                assert!(near, "{}: {a:?} to {b:?} keeps away from all", scene.name);
            }
        }
    }
    println!("{accepted} accepted, {free} free, {refused} refused");
    assert!(
        accepted > 300 && scenes().len() * 150 - free > 200,
        "{accepted} accepted, {free} free"
    );
    assert!(refused * 100 <= free, "{refused} of {free} refused");
}

#[test]
fn sampled_motions_are_what_their_steps_are() {
    let scratch = &mut Scratch::new();
    for scene in scenes() {
        let mut stream = Seed::of_set(5, scene.name, Ordinal(1)).stream(Purpose::Sampling);
        for (a, b) in motions(&scene, &mut stream, 100) {
            let steps = scene.sampled.steps(&a, &b, 1);
            let expected = scene.sampled.free_at_steps(&a, &b, steps, scratch.of_model());
            assert_eq!(
                scene.sampled.motion(&a, &b, 1, scratch).is_some(),
                expected,
                "{}",
                scene.name
            );
        }
    }
}

proptest! {
    /// What lies in a scratch changes no verdict, of any robot.
    #[test]
    fn motions_are_judged_alike_cold_warm_and_poisoned(ordinal in any::<u64>()) {
        let (mut warm, mut poisoned) = (Scratch::new(), Scratch::new());
        let scenes = scenes();
        let scene = &scenes[ordinal as usize % scenes.len()];
        let mut stream = Seed::of_set(5, "scratch", Ordinal(ordinal)).stream(Purpose::Sampling);
        for (i, (a, b)) in motions(scene, &mut stream, 5).into_iter().enumerate() {
            for validity in [&scene.swept, &scene.sampled] {
                let cold = validity.motion(&a, &b, 1, &mut Scratch::new()).is_some();
                poisoned.poison(ordinal.wrapping_mul(i as u64 + 3));
                prop_assert_eq!(validity.motion(&a, &b, 1, &mut warm).is_some(), cold);
                prop_assert_eq!(validity.motion(&a, &b, 1, &mut poisoned).is_some(), cold);
                let cold = validity.clearance(&a, &mut Scratch::new());
                poisoned.poison(ordinal.wrapping_add(i as u64));
                prop_assert_eq!(validity.clearance(&a, &mut poisoned), cold);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn all_lanes_judge_alike(ordinal in any::<u64>()) {
        let mut scenes = scenes();
        let at = ordinal as usize % scenes.len();
        let scene = &mut scenes[at];
        let mut stream = Seed::of_set(5, "lanes", Ordinal(ordinal)).stream(Purpose::Sampling);
        let motions = motions(scene, &mut stream, 20);
        let scratch = &mut Scratch::new();
        let mut judged = Lanes::all().into_iter().map(|lanes| {
            (scene.swept.lanes, scene.sampled.lanes) = (lanes, lanes);
            let mut judge = |(a, b): &(Vec<f64>, Vec<f64>)| {
                let [swept, sampled] =
                    [&scene.swept, &scene.sampled].map(|validity| validity.motion(a, b, 1, scratch).is_some());
                (swept, sampled, scene.swept.validity(a, scratch), scene.swept.clearance(a, scratch))
            };
            motions.iter().map(&mut judge).collect::<Vec<_>>()
        });
        let first = judged.next();
        for other in judged {
            prop_assert_eq!(Some(&other), first.as_ref());
        }
    }
}

/// A wall thinner than anything, and a robot that jumps over it from one step to the next.
#[test]
fn nothing_slips_between_two_steps() {
    let robot = Robot::rigid(BaseJoint::Rigid3d, vec![cuboid([0.01, 0.02, 0.01], [0.0; 3])]);
    let wall = [cuboid_mesh([0.001, 7.0, 7.0], [0.0; 3], true)];
    let scene = scene("thin", &robot, &wall, BoundsMeaning::Body);
    let scratch = &mut Scratch::new();
    let a = [-0.05, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let b = [0.05, 0.5, 0.0, 0.8, 0.6, 0.0, 0.0];
    assert!(scene.swept.motion(&a, &b, 1, scratch).is_none());
    // Half way it stands in the wall, a step before and after it does not.
    assert!(scene.sampled.free_at_steps(&a, &b, 3, scratch.of_model()));
    assert!(scene.swept.motion(&a, &[-0.05, 1.0, 1.0, 0.8, 0.6, 0.0, 0.0], 1, scratch).is_some());
}
