//! The bounds on velocities and second derivatives against motions as they are.

use super::*;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed, Stream};
use crate::space::Space;
use parry3d_f64::math::{Pose as ParryPose, Vector};
use proptest::prelude::*;

/// Somewhere in a cube, turned uniformly.
pub(crate) fn drawn_pose(stream: &mut Stream, size: f64) -> Pose {
    let rotation = crate::space::canonical([0; 4].map(|_| stream.normal())).unwrap();
    Pose { translation: [0; 3].map(|_| size * (2.0 * stream.unit() - 1.0)), rotation }
}

/// A tree of links with joints of every kind, askew in every way. The parent of each is one of the `near` links
/// before it: with 1 the tree is a serial chain.
pub(crate) fn drawn_robot(stream: &mut Stream, motion: BaseJoint, links: u32, near: u32) -> Robot {
    let mut robot = Robot::rigid(motion, Vec::new());
    for index in 1..links {
        let axis = Vector::new(stream.normal(), stream.normal(), stream.normal()).normalize();
        let (axis, limits) = (axis.to_array(), Limits { min: -2.0, max: 1.5 });
        let kind = match 1 + (index - 1) % 5 + (6.0 * stream.unit()) as u32 {
            2 | 7 => JointKind::Fixed,
            3 | 6 => JointKind::Prismatic { axis, limits },
            4 | 5 => JointKind::Revolute { axis, limits: None },
            8 | 9 => JointKind::Spherical,
            _ => JointKind::Revolute { axis, limits: Some(limits) },
        };
        let joint = Joint {
            name: format!("joint {index}"),
            parent: index - 1 - (stream.unit() * f64::from(near.min(index))) as u32,
            kind,
            before: drawn_pose(stream, 1.0),
            after: drawn_pose(stream, 0.5),
        };
        let link = Link { name: format!("{index}"), bodies: Vec::new(), joint: Some(joint) };
        robot.links.push(link);
    }
    robot
}

pub(crate) const MOTIONS: [BaseJoint; 5] = [
    BaseJoint::Fixed,
    BaseJoint::Translation2d,
    BaseJoint::Rigid2d,
    BaseJoint::Translation3d,
    BaseJoint::Rigid3d,
];

/// A link's frame as seen from another or from the world.
fn seen(
    robot: &Robot,
    space: &Space,
    ends: [&[f64]; 2],
    t: f64,
    pair: (Option<usize>, usize),
) -> ParryPose {
    let mut q = ends[0].to_vec();
    space.interpolate(ends[0], ends[1], t, &mut q);
    let mut poses = Vec::new();
    robot.link_poses(&q, &mut poses);
    let to = poses[pair.1].to_parry();
    pair.0.map_or(to, |from| poses[from].to_parry().inv_mul(&to))
}

/// A drawn motion of the robot against the bounds: of every pair of links, and of every link in the world.
pub(super) fn keeps_its_bounds(robot: &Robot, stream: &mut Stream) -> Result<(), TestCaseError> {
    let hops = Hops::new(robot);
    let space = robot.space([-2.0; 3], [2.0; 3], 1.0);
    let (mut a, mut b) = (vec![0.0; space.len()], vec![0.0; space.len()]);
    space.sample_uniform(stream, &mut a);
    space.sample_uniform(stream, &mut b);
    for to in 0..robot.links.len() {
        for from in std::iter::once(None).chain((0..to).map(Some)) {
            let rates = hops.rates(from, to, (&a, &b), &mut Vec::new());
            let point = Vector::new(stream.normal(), stream.normal(), stream.normal());
            let d = rates.distance(point);
            let (s, t) = (stream.unit(), stream.unit());
            let (s, t) = (s.min(t), s.max(t));
            let share = stream.unit();
            let at = |t: f64| seen(robot, &space, [&a, &b], t, (from, to)).transform_point(point);
            let (first, last) = (at(s), at(t));
            let time = t - s;
            prop_assert!((last - first).length() <= rates.speed_at(d) * time + 1e-9);
            let straight = first + (last - first) * share;
            let left = (at(s + time * share) - straight).length();
            let bound = rates.bend_at(d) * time * time / 8.0;
            prop_assert!(left <= bound + 1e-9, "{} to {}: {} beyond {}", s, t, left, bound);
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn no_point_is_faster_or_leaves_a_chord_farther_than_the_bounds_say(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "rates", Ordinal(ordinal)).stream(Purpose::Sampling);
        for motion in MOTIONS {
            let robot = drawn_robot(&mut stream, motion, 6, 6);
            keeps_its_bounds(&robot, &mut stream)?;
        }
    }
}

/// The bounds are reached where everything lies as badly as it may.
#[test]
fn the_bounds_are_no_larger_than_they_must_be() {
    let turning = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits: None };
    let mut robot = Robot::rigid(BaseJoint::Rigid2d, Vec::new());
    let before = Pose { translation: [1.0, 0.0, 0.0], ..Pose::IDENTITY };
    let name = "elbow".to_owned();
    let joint = Joint { name, parent: 0, kind: turning, before, after: Pose::IDENTITY };
    robot.links.push(Link { name: "arm".to_owned(), bodies: Vec::new(), joint: Some(joint) });
    let (a, b) = ([0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0]);
    let hops = Hops::new(&robot);
    let rates_of = |from, to| hops.rates(from, to, (&a, &b), &mut Vec::new());
    let rates = rates_of(None, 0);
    assert!((rates.speed_at(2.0) - 0.2).abs() < 1e-6 && (rates.bend_at(2.0) - 0.02).abs() < 1e-6);
    // Above the origin nothing turns.
    assert_eq!(rates.distance(Vector::new(0.0, 0.0, 3.0)), 0.0);
    let rates = rates_of(None, 1);
    assert!((rates.speed_at(1.0) - 0.2).abs() < 1e-6 && (rates.bend_at(1.0) - 0.02).abs() < 1e-6);
    let rates = rates_of(Some(0), 1);
    assert_eq!((rates.speed_at(1.0), rates.bend_at(1.0)), (0.0, 0.0));
}
