//! Searches of trees against tests of every pair of elements.

use super::directions::triangles_meet;
use super::frame::{Frame, Stance};
use super::meet::{Group, Meeting};
use super::tests::{cuboid, cuboid_mesh, solid};
use super::{BodyValidity, Bounds, BoundsMeaning, MotionChecking};
use crate::lanes::Lanes;
use crate::model::bodies::robot::rates_tests::drawn_pose;
use crate::model::bodies::robot::{Link, Robot};
use crate::model::{Clearances, Scratch};
use crate::scene::{Body, Mesh, Shape};
use crate::seed::{Purpose, Seed, Stream};
use crate::space::BaseJoint;
use proptest::prelude::*;

/// Triangles of all sizes, some of them in one plane, some the same.
fn soup(stream: &mut Stream, count: u32) -> Body {
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    for i in 0..count {
        let size = if i % 7 == 0 { 1.0 } else { 0.2 };
        let at = [0; 3].map(|_| 2.0 * stream.unit() - 1.0);
        for _ in 0..3 {
            let mut corner = at.map(|x| x + size * stream.normal());
            if i % 5 == 0 {
                corner[2] = 0.25;
            }
            vertices.push(corner);
        }
    }
    let mut triangles: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    triangles.push(triangles[0]);
    Body {
        shape: Shape::Mesh(Mesh { vertices, triangles }),
        pose: drawn_pose(stream, 1.0),
        solid: false,
    }
}

proptest! {
    #[test]
    fn surfaces_meet_when_any_pair_of_their_triangles_does(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "trees", ordinal).stream(Purpose::Sampling);
        let still = [soup(&mut stream, 30), soup(&mut stream, 3)];
        let mover = [soup(&mut stream, 1), soup(&mut stream, 12)];
        let [still, mover] = [&still, &mover].map(|bodies| Group::new(bodies.iter()).unwrap());
        let meeting =
            Meeting { mover: &mover, mover_link: 0, still: &still, still_link: None, slack: 1e-11, lanes: Lanes::widest() };
        for _ in 0..10 {
            let mut stance = Stance { poses: vec![drawn_pose(&mut stream, 6.0)], ..Stance::default() };
            stance.update_frames();
            let frame = stance.frames[0];
            let any = mover.tree.elements.iter().any(|first| {
                let corners = first.corners.map(|corner| frame.point(corner));
                still.tree.elements.iter().any(|second| triangles_meet(Lanes::widest(), &corners, &second.corners))
            });
            prop_assert_eq!(meeting.surfaces_meet(&stance, &mut Vec::new()), any);
        }
    }

    /// Every box holds the boxes and elements below it, and the root holds every element once.
    #[test]
    fn boxes_hold_what_is_below_them(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "boxes", ordinal).stream(Purpose::Sampling);
        let shapes = [
            soup(&mut stream, 20),
            cuboid([1.0, 0.1, 2.0], [0.5, 0.0, 1.0]),
            solid(Shape::Cylinder { radius: 0.3, height: 2.0 }, [1.0, 0.0, 0.0]),
            solid(Shape::Point, [3.0, 2.0, 1.0]),
        ];
        let tree = Group::new(shapes.iter()).unwrap().tree;
        let mut leaves = Vec::new();
        let mut open = vec![(0u32, Vec::new())];
        while let Some((at, mut above)) = open.pop() {
            let node = &tree.nodes[at as usize];
            above.push(node.space);
            if node.is_leaf() {
                let element = &tree.elements[node.element as usize];
                for space in &above {
                    for (k, axis) in space.axes.iter().enumerate() {
                        let (low, high) = element.span(*axis);
                        let centre = axis.dot(space.centre);
                        prop_assert!(high - centre <= space.half[k] && centre - low <= space.half[k]);
                        prop_assert!(element.extent(*axis) <= high + 1e-12);
                    }
                }
                leaves.push(node.element);
            } else {
                open.push((node.left, above.clone()));
                open.push((node.left + 1, above));
            }
        }
        leaves.sort_unstable();
        prop_assert!(leaves.into_iter().eq(0..tree.elements.len() as u32));
    }

    /// The clearance is the least distance of all pairs, whatever the order of the search.
    #[test]
    fn the_clearance_is_the_least_of_all_pairs(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "clearance", ordinal).stream(Purpose::Sampling);
        let obstacles = [
            soup(&mut stream, 12),
            solid(Shape::Sphere { radius: 0.3 }, [-2.0, 0.0, 0.0]),
            solid(Shape::Cylinder { radius: 0.3, height: 1.0 }, [0.0, -2.0, 0.0]),
            // Twice the same: the first is named.
            cuboid([1.0, 0.5, 0.5], [2.0, 1.0, 0.0]),
            cuboid([1.0, 0.5, 0.5], [2.0, 1.0, 0.0]),
        ];
        let robot = [
            cuboid_mesh([0.8, 0.1, 0.1], [0.0; 3], true),
            solid(Shape::Capsule { radius: 0.1, height: 0.5 }, [0.3, 0.0, 0.0]),
        ];
        let robot = Robot::rigid(BaseJoint::Rigid3d, robot.to_vec());
        let bounds = Bounds { min: [-5.0; 3], max: [5.0; 3], meaning: BoundsMeaning::Reference };
        let space = robot.space(bounds.min, bounds.max, 1.0);
        let validity =
            BodyValidity::new(space.clone(), &robot, bounds, (MotionChecking::Swept, 0.1), &obstacles);
        let still = Group::new(obstacles.iter()).unwrap();
        let mover = Group::new(robot.bodies()).unwrap();
        let meeting =
            Meeting { mover: &mover, mover_link: 0, still: &still, still_link: None, slack: 0.0, lanes: Lanes::widest() };
        let mut q = vec![0.0; 7];
        for _ in 0..5 {
            space.sample_uniform(&mut stream, &mut q);
            let mut stance = Stance::default();
            robot.place(&q, &mut stance.poses);
            stance.update_frames();
            let frame: Frame = stance.frames[0];
            let mut least = (f64::INFINITY, 0);
            for second in &still.tree.elements {
                for first in &mover.tree.elements {
                    let corners = first.corners.map(|corner| frame.point(corner));
                    let way = meeting.nearest((first, &corners), second, &stance);
                    if way.distance < least.0 {
                        least = (way.distance, second.piece as usize);
                    }
                }
            }
            let found = validity.clearance(&q, &mut Scratch::new()).unwrap();
            prop_assert_eq!((found.distance, found.obstacle), least);
            prop_assert!(found.obstacle != 4);
            let apart: f64 = (0..3).map(|k| found.on_robot[k] - found.on_obstacle[k]).map(|x| x * x).sum();
            prop_assert!((apart.sqrt() - found.distance).abs() < 1e-9);
        }
    }
}

/// Known distances: a ball beside a box, a rod above a cylinder's flat end.
#[test]
fn distances_are_what_they_are() {
    let obstacles = [
        cuboid([1.0, 1.0, 1.0], [0.0; 3]),
        solid(Shape::Cylinder { radius: 0.5, height: 1.0 }, [3.0, 0.0, 0.0]),
    ];
    let ball = Link {
        name: "ball".to_owned(),
        bodies: vec![solid(Shape::Sphere { radius: 0.25 }, [0.0; 3])],
        joint: None,
    };
    let robot = Robot::rigid(BaseJoint::Translation3d, ball.bodies);
    let bounds = Bounds { min: [-5.0; 3], max: [5.0; 3], meaning: BoundsMeaning::Reference };
    let space = robot.space(bounds.min, bounds.max, 1.0);
    let validity =
        BodyValidity::new(space.clone(), &robot, bounds, (MotionChecking::Swept, 0.1), &obstacles);
    let clearance = |q: [f64; 3]| validity.clearance(&q, &mut Scratch::new()).unwrap();
    let beside = clearance([0.0, 1.0, 0.2]);
    assert_eq!((beside.distance, beside.obstacle), (0.25, 0));
    assert_eq!((beside.on_robot, beside.on_obstacle), ([0.0, 0.75, 0.2], [0.0, 0.5, 0.2]));
    // Were the cylinder a capsule, it would reach up to 1.
    let above = clearance([3.3, 0.0, 1.0]);
    assert!((above.distance - 0.25).abs() < 1e-9 && above.obstacle == 1, "{above:?}");
    assert_eq!(clearance([3.0, 0.4, 0.0]).distance, 0.0);
    let validity = BodyValidity::new(space, &robot, bounds, (MotionChecking::Swept, 0.1), &[]);
    assert_eq!(validity.clearance(&[0.0; 3], &mut Scratch::new()), None);
}
