//! Links that obstacles must stay away from, beside distances that are known.

use super::tests::{chain, cuboid, cuboid_mesh, solid};
use super::*;
use crate::model::bodies::robot::Robot;
use crate::model::{Clearances, Model, Reason, Scratch};
use crate::numbers::Ordinal;
use crate::scene::{Body, Shape};
use crate::seed::{Purpose, Seed};
use crate::space::BaseJoint;
use proptest::prelude::*;

fn validity(robot: &Robot, padding: f64, obstacles: &[Body]) -> BodyValidity {
    let robot = Robot {
        padding: if padding > 0.0 { vec![padding; robot.links.len()] } else { Vec::new() },
        ..robot.clone()
    };
    let bounds = Bounds { min: [-5.0; 3], max: [5.0; 3], meaning: BoundsMeaning::Reference };
    let space = robot.space(bounds.min, bounds.max, 1.0);
    BodyValidity::new(space, &robot, bounds, MotionChecking::Swept, 0.05, obstacles)
}

fn shapes() -> Vec<Body> {
    vec![
        cuboid([0.5, 0.6, 0.7], [0.0; 3]),
        cuboid_mesh([0.7, 0.3, 0.5], [0.1, 0.0, 0.0], true),
        cuboid_mesh([0.7, 0.3, 0.5], [0.0, 0.1, 0.0], false),
        solid(Shape::Sphere { radius: 0.4 }, [0.1, 0.0, 0.0]),
        solid(Shape::Capsule { radius: 0.2, height: 0.8 }, [0.0; 3]),
        solid(Shape::Cylinder { radius: 0.3, height: 0.6 }, [0.0, 0.1, 0.0]),
    ]
}

/// A sphere of radius r that is d away from a face, an edge or a corner: known without any search.
#[test]
fn a_padded_robot_keeps_the_distance_that_is_asked_for() {
    let at = |body: Body, padding: f64, q: [f64; 3]| {
        let robot = Robot::rigid(BaseJoint::Translation3d, vec![body]);
        let model = validity(&robot, padding, &[cuboid([2.0; 3], [0.0; 3])]);
        model.is_valid(&q, &mut Scratch::new())
    };
    let ball = || solid(Shape::Sphere { radius: 0.25 }, [0.0; 3]);
    let point = || solid(Shape::Point, [0.0; 3]);
    let small = || cuboid([0.5; 3], [0.0; 3]);
    let mesh = || cuboid_mesh([0.5; 3], [0.0; 3], true);
    let rod = || solid(Shape::Cylinder { radius: 0.25, height: 0.5 }, [0.0; 3]);
    // 0.5 away from the face x = 1.
    for body in [ball(), small(), mesh(), rod()] {
        assert!(at(body.clone(), 0.499_999, [1.75, 0.1, 0.2]));
        assert!(!at(body.clone(), 0.500_001, [1.75, 0.1, 0.2]));
        assert!(!at(body.clone(), 0.0, [1.2, 0.1, 0.2]));
        // Inside of the obstacle nothing is valid, however small the body beside it.
        assert!(!at(body, 0.01, [0.0; 3]));
    }
    assert!(at(point(), 0.499_999, [1.5, 0.1, 0.2]) && !at(point(), 0.500_001, [1.5, 0.1, 0.2]));
    // Beyond an edge of the obstacle by 3 and 4 tenths: 0.5 away, not 0.4 as of a box that is larger by as much.
    for body in [small(), mesh()] {
        assert!(at(body.clone(), 0.499_999, [1.55, 1.65, 0.0]));
        assert!(!at(body, 0.500_001, [1.55, 1.65, 0.0]));
    }
    // Beyond a corner by 2, 3 and 6 tenths: 0.7 away.
    for body in [small(), mesh()] {
        assert!(at(body.clone(), 0.699_999, [1.45, 1.55, 1.85]));
        assert!(!at(body, 0.700_001, [1.45, 1.55, 1.85]));
    }
    // The rod's rim beyond an edge of the obstacle, by 3 tenths aside and 4 above.
    assert!(at(rod(), 0.499_999, [1.55, 0.0, 1.65]) && !at(rod(), 0.500_001, [1.55, 0.0, 1.65]));
}

#[test]
fn a_reason_names_the_padding_and_other_links_and_bounds_come_as_near_as_they_like() {
    let robot = Robot::rigid(BaseJoint::Translation3d, vec![cuboid([0.5; 3], [0.0; 3])]);
    let model = validity(&robot, 0.5, &[cuboid([2.0; 3], [0.0; 3])]);
    let reasons = model.reasons(&[1.5, 0.0, 0.0], true);
    let [reason @ Reason::Collision { depth, padding, direction, .. }] = &reasons[..] else {
        panic!("{reasons:?}")
    };
    assert!((depth - 0.25).abs() < 1e-3 && *padding == 0.5 && *direction == [1.0, 0.0, 0.0]);
    let text = reason.to_string();
    assert!(
        text.contains("the robot with its padding of 0.500 collides with obstacles[0]"),
        "{text}"
    );
    // At the bounds of the body itself.
    let bounds = Bounds { min: [-5.0; 3], max: [5.0; 3], meaning: BoundsMeaning::Body };
    let robot = Robot { padding: vec![0.5], ..robot };
    let space = robot.space(bounds.min, bounds.max, 1.0);
    let far = [cuboid([1.0; 3], [-4.0; 3])];
    let model = BodyValidity::new(space, &robot, bounds, MotionChecking::Swept, 0.05, &far);
    assert!(model.is_valid(&[4.75, 4.75, 4.75], &mut Scratch::new()));
    // A chain that is folded together so that links are near one another, but do not touch.
    let chain = chain(4, BaseJoint::Fixed);
    let [bare, padded] = [0.0, 0.3].map(|padding| validity(&chain, padding, &far));
    let mut stream = Seed::of_set(7, "folded", Ordinal(0)).stream(Purpose::Sampling);
    let mut q = vec![0.0; bare.space.len()];
    let mut differing = 0;
    for _ in 0..200 {
        bare.space.sample_uniform(&mut stream, &mut q);
        let is_valid = bare.is_valid(&q, &mut Scratch::new());
        // The obstacle is out of reach, padding included.
        assert_eq!(padded.is_valid(&q, &mut Scratch::new()), is_valid, "{q:?}");
        differing += u32::from(!is_valid);
    }
    assert!((1..200).contains(&differing), "{differing}");
}

proptest! {
    /// Valid with a padding is what is farther away than that, by the clearance that is computed without any.
    #[test]
    fn padding_and_clearance_agree(ordinal in any::<u64>(), padding in 0.01f64..0.8) {
        let mut stream = Seed::of_set(5, "padding", Ordinal(ordinal)).stream(Purpose::Sampling);
        for own in shapes() {
            for other in shapes() {
                let robot = Robot::rigid(BaseJoint::Rigid3d, vec![own.clone()]);
                let bare = validity(&robot, 0.0, std::slice::from_ref(&other));
                let padded = validity(&robot, padding, std::slice::from_ref(&other));
                let (mut q, scratch) = (vec![0.0; 7], &mut Scratch::new());
                for _ in 0..4 {
                    bare.space.sample_uniform(&mut stream, &mut q);
                    // Nearer, or few would be within the padding.
                    (0..3).for_each(|axis| q[axis] *= 0.3);
                    let free = bare.is_valid(&q, scratch);
                    let away = bare.clearance(&q, scratch).expect("an obstacle").distance;
                    prop_assume!((away - padding).abs() > 1e-7);
                    let valid = padded.is_valid(&q, scratch);
                    prop_assert_eq!(valid, free && away > padding, "{:?} and {:?} at {:?}: {}", &own, &other, &q, away);
                    let left = padded.clearance(&q, scratch).expect("an obstacle").distance;
                    if valid {
                        prop_assert!((left - (away - padding)).abs() < 1e-6, "{} of {}", left, away);
                    }
                    prop_assert_eq!(padded.reasons(&q, false).is_empty(), valid);
                }
            }
        }
    }

    /// Motions that are proved free keep the distance at every time that is looked at; those that are refused come nearer
    /// than the padding and the tolerance.
    #[test]
    fn motions_keep_the_distance(ordinal in any::<u64>(), padding in 0.02f64..0.3, arm in any::<bool>()) {
        let obstacles: Vec<Body> = shapes()
            .into_iter()
            .zip([[2.0, 0.0, 0.0], [-2.0, 0.0, 0.5], [0.0, 2.0, 0.0], [0.0, -2.0, 0.0], [1.5, 1.5, 0.0], [-1.5, 1.5, 0.0]])
            .map(|(mut body, at)| {
                (0..3).for_each(|axis| body.pose.translation[axis] += at[axis]);
                body
            })
            .collect();
        let robot = match arm {
            true => chain(3, BaseJoint::Fixed),
            false => Robot::rigid(BaseJoint::Rigid3d, shapes()),
        };
        let model = validity(&robot, padding, &obstacles);
        let bare = validity(&robot, 0.0, &obstacles);
        let mut stream = Seed::of_set(9, "padded motions", Ordinal(ordinal)).stream(Purpose::Sampling);
        let scratch = &mut Scratch::new();
        let dofs = model.space.len();
        let (mut a, mut b, mut between) = (vec![0.0; dofs], vec![0.0; dofs], vec![0.0; dofs]);
        for _ in 0..6 {
            model.space.sample_uniform(&mut stream, &mut a);
            model.space.sample_uniform(&mut stream, &mut b);
            if !(model.is_valid(&a, scratch) && model.is_valid(&b, scratch)) {
                continue;
            }
            let is_free = model.motion(&a, &b, 1, scratch).is_some();
            let way = model.space.way(&a, &b);
            let mut least = f64::INFINITY;
            let (mut own_free, steps) = (true, 400);
            for i in 0..=steps {
                way.at(f64::from(i) / f64::from(steps), &mut between);
                own_free &= bare.is_valid(&between, scratch);
                least = least.min(bare.clearance(&between, scratch).expect("obstacles").distance);
            }
            if is_free {
                prop_assert!(own_free && least >= padding - 1e-9, "{} within {}", least, padding);
            } else {
                // Between two of the steps no point moves farther than this.
                let step = model.steps(&a, &b, 1) as f64 * 0.05 / f64::from(steps);
                prop_assert!(!own_free || arm || least <= padding + step + 1e-5, "{} within {}", least, padding);
            }
        }
    }
}
