use super::rates_tests::drawn_robot;
use super::*;
use crate::numbers::Ordinal;
use crate::scene::Shape;
use crate::seed::{Purpose, Seed, Stream};
use crate::space::FactorKind;
use proptest::prelude::*;

fn pose(translation: [f64; 3]) -> Pose {
    Pose { translation, ..Pose::IDENTITY }
}

fn joint(parent: u32, kind: JointKind, before: [f64; 3]) -> Option<Joint> {
    let name = format!("on {parent}");
    Some(Joint { name, parent, kind, before: pose(before), after: Pose::IDENTITY })
}

/// A base with an arm that turns about z, a hand that slides along the arm's x, a fixed tool on the
/// hand, and a second arm on the base that turns on and on about x.
fn robot(motion: BaseJoint) -> Robot {
    let mut robot = Robot::rigid(motion, Vec::new());
    let limits = Limits { min: -1.0, max: 2.0 };
    let turning = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits: Some(limits) };
    let sliding = JointKind::Prismatic { axis: [1.0, 0.0, 0.0], limits };
    let spinning = JointKind::Revolute { axis: [1.0, 0.0, 0.0], limits: None };
    for (name, joint) in [
        ("arm", joint(0, turning, [1.0, 0.0, 0.0])),
        ("hand", joint(1, sliding, [2.0, 0.0, 0.0])),
        ("tool", joint(2, JointKind::Fixed, [0.0, 0.5, 0.0])),
        ("other", joint(0, spinning, [0.0, 0.0, 3.0])),
    ] {
        robot.links.push(Link { name: name.to_owned(), bodies: Vec::new(), joint });
    }
    robot
}

fn close(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).all(|i| (a[i] - b[i]).abs() < 1e-12)
}

#[test]
fn links_stand_where_their_joints_put_them() {
    let robot = robot(BaseJoint::Rigid2d);
    let mut poses = Vec::new();
    let quarter = std::f64::consts::FRAC_PI_2;
    // The base at (10, 20), turned by 90°: its x is the world's y.
    robot.link_poses(&[10.0, 20.0, quarter, quarter, 1.5, quarter], &mut poses);
    let origins: Vec<_> = poses.iter().map(|pose| pose.translation).collect();
    assert!(close(origins[0], [10.0, 20.0, 0.0]));
    assert!(close(origins[1], [10.0, 21.0, 0.0]));
    // The arm is turned once more: its x is the world's −x.
    assert!(close(origins[2], [10.0 - 3.5, 21.0, 0.0]));
    assert!(close(origins[3], [10.0 - 3.5, 20.5, 0.0]));
    assert!(close(origins[4], [10.0, 20.0, 3.0]));
    // The other arm's y, after a quarter turn about its x, is the world's z.
    assert!(close(poses[4].apply([0.0, 1.0, 0.0]), [10.0, 20.0, 4.0]));
}

#[test]
fn the_space_has_the_bases_values_and_then_the_joints() {
    let robot = robot(BaseJoint::Rigid3d);
    let space = robot.space([-1.0; 3], [1.0; 3], 0.5);
    let names: Vec<_> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "z", "qw", "qx", "qy", "qz", "on 0", "on 1", "on 0-2"]);
    let parts: Vec<_> = space.factors()[4..].iter().map(|part| (part.kind, part.weight)).collect();
    let limited = FactorKind::Real { min: -1.0, max: 2.0 };
    // Beyond the arm's joint: 2 to the hand's, up to 2 along it, 0.5 to the tool.
    assert_eq!(parts, [(limited, 4.5), (limited, 1.0), (FactorKind::Angle, 0.0)]);
    assert_eq!(robot.reach(), 5.5);
}

fn ball() -> Body {
    Body { shape: Shape::Sphere { radius: 0.1 }, pose: Pose::IDENTITY, solid: true }
}

#[test]
fn neighbours_fixed_links_and_links_across_an_empty_one_may_touch() {
    let mut robot = robot(BaseJoint::Fixed);
    for link in &mut robot.links {
        link.bodies = vec![ball()];
    }
    assert_eq!(robot.self_pairs().collect::<Vec<_>>(), [(0, 2), (0, 3), (1, 4), (2, 4), (3, 4)]);
    robot.links[1].bodies.clear();
    // Without the arm's body the hand is the base's neighbour.
    assert_eq!(robot.self_pairs().collect::<Vec<_>>(), [(2, 4), (3, 4)]);
    robot.may_touch = vec![(2, 4)];
    assert_eq!(robot.self_pairs().collect::<Vec<_>>(), [(3, 4)]);
}

/// A chain of links, each turning about z at the one before it, or fixed to it; those named have a ball.
fn chain_of(kinds: &[(bool, bool)]) -> Robot {
    let mut robot = Robot::rigid(BaseJoint::Fixed, vec![ball()]);
    let turning = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits: None };
    for (parent, (moves, has_ball)) in kinds.iter().enumerate() {
        let kind = if *moves { turning } else { JointKind::Fixed };
        robot.links.push(Link {
            name: format!("link {parent}"),
            bodies: if *has_ball { vec![ball()] } else { Vec::new() },
            joint: joint(parent as u32, kind, [0.0; 3]),
        });
    }
    robot
}

/// Links across more than one link without bodies are tested, unless the joints between these do not move.
#[test]
fn one_empty_link_at_most_makes_neighbours() {
    let pairs = |kinds: &[(bool, bool)]| chain_of(kinds).self_pairs().collect::<Vec<_>>();
    let (empty, solid) = ((true, false), (true, true));
    let (fixed_empty, fixed_solid) = ((false, false), (false, true));
    assert_eq!(pairs(&[empty, solid]), []);
    assert_eq!(pairs(&[empty, empty, solid]), [(0, 3)]);
    assert_eq!(pairs(&[empty, empty, empty, solid, solid]), [(0, 4), (0, 5)]);
    // Links that are fixed to one another count as one.
    assert_eq!(pairs(&[empty, fixed_empty, solid]), []);
    assert_eq!(pairs(&[fixed_empty, empty, solid]), []);
    assert_eq!(pairs(&[empty, fixed_empty, empty, solid]), [(0, 4)]);
    // A body fixed to a link without one is that link's: what it carries is not the base's neighbour.
    assert_eq!(pairs(&[empty, fixed_solid]), []);
    assert_eq!(pairs(&[empty, fixed_solid, solid]), [(0, 3)]);
}

/// Two links that hang on the same link without bodies are no neighbours.
#[test]
fn links_on_the_same_empty_link_must_not_touch() {
    let mut robot = chain_of(&[(true, false), (true, true)]);
    let turning = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits: None };
    let name = "other".to_owned();
    robot.links.push(Link { name, bodies: vec![ball()], joint: joint(1, turning, [0.0; 3]) });
    assert_eq!(robot.self_pairs().collect::<Vec<_>>(), [(2, 3)]);
}

/// A tree of links of which most have a ball somewhere.
fn with_balls(stream: &mut Stream, links: u32, near: u32) -> Robot {
    let mut robot = drawn_robot(stream, BaseJoint::Rigid3d, links, near);
    for link in &mut robot.links {
        if stream.unit() < 0.7 {
            let translation = [0; 3].map(|_| stream.normal());
            let shape = Shape::Sphere { radius: stream.unit() };
            link.bodies.push(Body { shape, pose: pose(translation), solid: true });
        }
    }
    robot
}

/// A bound on the distance of all points of a link, and of the links that it carries, from its origin: looks for the
/// children of every link anew.
fn reach_of_link(robot: &Robot, link: usize) -> f64 {
    let own = robot.links[link].bodies.iter().map(|body| body.shape.reach(&body.pose));
    let own = own.fold(0.0, f64::max);
    let children = robot.links.iter().enumerate().filter_map(|(index, child)| {
        let joint = child.joint.as_ref().filter(|joint| joint.parent as usize == link)?;
        Some(length(&joint.before) + reach_of_joint(robot, index, joint))
    });
    children.fold(own, f64::max)
}

/// The same of the points that a joint moves, from the joint's origin.
fn reach_of_joint(robot: &Robot, link: usize, joint: &Joint) -> f64 {
    let slide = match joint.kind {
        JointKind::Prismatic { limits, .. } => limits.min.abs().max(limits.max.abs()),
        _ => 0.0,
    };
    slide + length(&joint.after) + reach_of_link(robot, link)
}

fn length(pose: &Pose) -> f64 {
    let [x, y, z] = pose.translation;
    (x * x + y * y + z * z).sqrt()
}

proptest! {
    /// Bit for bit, since weights of the metric decide which nodes are neighbours.
    #[test]
    fn reaches_found_from_the_leaves_on_are_those_found_from_the_base(
        ordinal in any::<u64>(), links in 1..40u32, near in 1..40u32,
    ) {
        let mut stream = Seed::of_set(5, "reaches", Ordinal(ordinal)).stream(Purpose::Sampling);
        let robot = with_balls(&mut stream, links, near);
        prop_assert_eq!(robot.reach().to_bits(), reach_of_link(&robot, 0).to_bits());
        let space = robot.space([-1.0; 3], [1.0; 3], 0.5);
        let joints = robot.links.iter().enumerate().filter_map(|(index, link)| {
            let joint = link.joint.as_ref().filter(|joint| joint.kind.moves())?;
            let slides = matches!(joint.kind, JointKind::Prismatic { .. });
            Some(if slides { 1.0 } else { reach_of_joint(&robot, index, joint) })
        });
        let expected: Vec<u64> = joints.map(f64::to_bits).collect();
        let base = space.factors().len() - expected.len();
        let found = space.factors()[base..].iter().map(|part| part.weight.to_bits());
        prop_assert_eq!(found.collect::<Vec<_>>(), expected);
    }

    #[test]
    fn pairs_that_may_touch_are_left_out_in_whatever_order_they_are_listed(
        ordinal in any::<u64>(), links in 2..40u32, listed in 0..60usize,
    ) {
        let mut stream = Seed::of_set(5, "may touch", Ordinal(ordinal)).stream(Purpose::Sampling);
        let mut robot = with_balls(&mut stream, links, 3);
        let all: Vec<(usize, usize)> = robot.self_pairs().collect();
        let mut drawn = || (f64::from(links) * stream.unit()) as u32;
        let pairs = (0..listed).map(|_| (drawn(), drawn()));
        robot.may_touch = pairs.map(|(a, b)| (a.min(b), a.max(b))).collect();
        let may = |(low, high): &(usize, usize)| {
            robot.may_touch.contains(&(*low as u32, *high as u32))
        };
        let expected: Vec<(usize, usize)> = all.into_iter().filter(|pair| !may(pair)).collect();
        prop_assert_eq!(robot.self_pairs().collect::<Vec<_>>(), expected);
    }
}
