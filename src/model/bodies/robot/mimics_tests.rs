//! Joints that follow others: where they stand, and that the bounds on motions hold for them.

use super::rates_tests::{MOTIONS, drawn_robot, keeps_its_bounds};
use super::*;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed, Stream};
use proptest::prelude::*;

/// A drawn tree of links in which most joints that turn about or slide along an axis follow one of the others.
pub(crate) fn drawn_with_mimics(stream: &mut Stream, motion: BaseJoint, links: u32) -> Robot {
    let mut robot = drawn_robot(stream, motion, links, links);
    let may = |link: &Link| {
        let kind = link.joint.as_ref().map(|joint| joint.kind);
        matches!(kind, Some(JointKind::Revolute { .. } | JointKind::Prismatic { .. }))
    };
    let able: Vec<usize> = (0..robot.links.len()).filter(|i| may(&robot.links[*i])).collect();
    let Some((first, rest)) = able.split_first() else { return robot };
    let mut followers = Vec::new();
    for link in rest.iter().copied() {
        if stream.unit() < 0.3 {
            continue;
        }
        let whole = [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0][stream.below(6) as usize];
        let multiplier = if stream.unit() < 0.5 { whole } else { 2.0 * stream.normal() };
        // Limits that leave some of the other joint's.
        let joint = robot.links[link].joint.as_mut().unwrap();
        if let JointKind::Revolute { limits: Some(limits), .. }
        | JointKind::Prismatic { limits, .. } = &mut joint.kind
        {
            *limits = Limits { min: -3.0 - stream.unit(), max: 3.0 + stream.unit() };
        }
        followers.push(Follower { link, followed: *first, multiplier, offset: stream.unit() });
    }
    couple(&mut robot.links, &followers).unwrap();
    assert_eq!(mimic_complaint(&robot.links), None);
    robot
}

proptest! {
    #[test]
    fn no_point_is_faster_or_leaves_a_chord_farther_than_the_bounds_say(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "mimics", Ordinal(ordinal)).stream(Purpose::Sampling);
        for motion in MOTIONS {
            let robot = drawn_with_mimics(&mut stream, motion, 8);
            keeps_its_bounds(&robot, &mut stream)?;
        }
    }

    /// By this bound motions are cut into steps.
    #[test]
    fn no_point_goes_farther_than_the_steps_allow(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "steps of mimics", Ordinal(ordinal)).stream(Purpose::Sampling);
        for motion in MOTIONS {
            let mut robot = drawn_with_mimics(&mut stream, motion, 8);
            for link in &mut robot.links {
                let shape = crate::scene::Shape::Sphere { radius: stream.unit() + 0.01 };
                link.bodies = vec![Body { shape, pose: Pose::IDENTITY, solid: true }];
            }
            let space = robot.space([-2.0; 3], [2.0; 3], 1.0);
            let ends = [0, 1].map(|_| {
                let mut q = vec![0.0; space.len()];
                space.sample_uniform(&mut stream, &mut q);
                q
            });
            let bound = robot.speeds().farthest(&robot, &ends[0], &ends[1]);
            let mut way = vec![0.0; robot.links.len()];
            let mut before: Vec<Pose> = Vec::new();
            for step in 0..=400 {
                let (mut q, mut poses) = (ends[0].clone(), Vec::new());
                space.interpolate(&ends[0], &ends[1], f64::from(step) / 400.0, &mut q);
                robot.link_poses(&q, &mut poses);
                for (index, link) in robot.links.iter().enumerate().filter(|_| step > 0) {
                    let crate::scene::Shape::Sphere { radius } = link.bodies[0].shape else { panic!() };
                    let at = |pose: &Pose| pose.to_parry().transform_point(parry3d_f64::math::Vector::X * radius);
                    way[index] += (at(&poses[index]) - at(&before[index])).length();
                }
                before = poses;
            }
            for length in way {
                prop_assert!(length <= bound * (1.0 + 1e-9) + 1e-9, "{} beyond {}", length, bound);
            }
        }
    }

    /// Within the limits of the joint that moves by itself every follower is within the limits that it had alone.
    #[test]
    fn limits_of_followers_narrow_those_of_the_joint_they_follow(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "narrowing", Ordinal(ordinal)).stream(Purpose::Sampling);
        let alone = drawn_robot(&mut stream, BaseJoint::Fixed, 4, 4);
        let mut robot = Robot::rigid(BaseJoint::Fixed, Vec::new());
        let axis = [0.0, 0.0, 1.0];
        let drawn = |stream: &mut Stream| {
            let ends = [4.0 * stream.normal(), 4.0 * stream.normal()];
            Limits { min: ends[0].min(ends[1]), max: ends[0].max(ends[1]) }
        };
        for name in ["first", "second", "third"] {
            let kind = JointKind::Prismatic { axis, limits: drawn(&mut stream) };
            let (before, after) = (Pose::IDENTITY, Pose::IDENTITY);
            let joint = Some(Joint { name: name.to_owned(), parent: 0, kind, before, after });
            robot.links.push(Link { name: name.to_owned(), bodies: Vec::new(), joint });
        }
        let before = robot.clone();
        let factor = |stream: &mut Stream| (stream.normal(), stream.normal());
        let ((m, o), (n, p)) = (factor(&mut stream), factor(&mut stream));
        // The third follows the second, which follows the first.
        let followers = [
            Follower { link: 3, followed: 2, multiplier: n, offset: p },
            Follower { link: 2, followed: 1, multiplier: m, offset: o },
        ];
        let limits = |link: &Link| match link.joint.as_ref().unwrap().kind {
            JointKind::Prismatic { limits, .. } => limits,
            other => panic!("{other:?}"),
        };
        let own: Vec<Limits> = before.links[1..].iter().map(limits).collect();
        let within = |value: f64, at: usize| own[at].min - 1e-9 <= value && value <= own[at].max + 1e-9;
        let all_within = |value: f64| {
            within(value, 0) && within(m * value + o, 1) && within(n * (m * value + o) + p, 2)
        };
        match couple(&mut robot.links, &followers) {
            Ok(_) => {
                let Limits { min, max } = limits(&robot.links[1]);
                prop_assert!(all_within(min) && all_within(max), "{} to {}", min, max);
                prop_assert_eq!(robot.space([0.0; 3], [1.0; 3], 1.0).len(), 1);
                // Nothing was lost.
                for _ in 0..50 {
                    let value = own[0].min + stream.unit() * (own[0].max - own[0].min);
                    prop_assert!(!all_within(value) || (min - 1e-6..=max + 1e-6).contains(&value));
                }
            }
            Err((_, message)) => {
                for i in 0..=1000 {
                    let value = own[0].min + f64::from(i) / 1000.0 * (own[0].max - own[0].min);
                    let strictly = |value: f64, at: usize| own[at].min < value && value < own[at].max;
                    let free = strictly(value, 0) && strictly(m * value + o, 1)
                        && strictly(n * (m * value + o) + p, 2);
                    prop_assert!(!free, "{} although {} is free", message, value);
                }
            }
        }
        prop_assert_eq!(alone.links.len(), 4);
    }
}

fn finger(parent: u32, kind: JointKind, y: f64) -> Link {
    let before = Pose { translation: [0.0, y, 0.0], ..Pose::IDENTITY };
    let name = format!("finger at {y}");
    let joint = Joint { name: name.clone(), parent, kind, before, after: Pose::IDENTITY };
    Link { name, bodies: Vec::new(), joint: Some(joint) }
}

/// Two fingers that close toward one another, of which the second comes before the first that it follows.
fn gripper() -> Robot {
    let mut robot = Robot::rigid(BaseJoint::Fixed, Vec::new());
    let limits = Limits { min: -0.5, max: 2.0 };
    let kind = JointKind::Prismatic { axis: [0.0, 1.0, 0.0], limits };
    robot.links.push(finger(0, kind, 1.0));
    robot.links.push(finger(0, kind, -1.0));
    let follower = Follower { link: 1, followed: 2, multiplier: -1.0, offset: 0.25 };
    let notes = couple(&mut robot.links, &[follower]).unwrap();
    assert!(notes[0].contains("`finger at -1` moves from -0.5 to 0.75"), "{notes:?}");
    robot
}

#[test]
fn a_follower_stands_where_the_other_joints_value_puts_it() {
    let robot = gripper();
    let space = robot.space([0.0; 3], [1.0; 3], 1.0);
    assert_eq!(space.dofs().iter().map(|dof| &*dof.name).collect::<Vec<_>>(), ["finger at -1"]);
    let mut poses = Vec::new();
    robot.link_poses(&[0.5], &mut poses);
    assert_eq!(poses[1].translation, [0.0, 1.0 - 0.5 + 0.25, 0.0]);
    assert_eq!(poses[2].translation, [0.0, -0.5, 0.0]);
    // Both fingers move a unit for a unit, side by side.
    assert_eq!(space.factors()[0].weight, 1.0);
}

#[test]
fn what_cannot_follow_says_so() {
    let about = JointKind::Revolute { axis: [1.0, 0.0, 0.0], limits: None };
    let sliding =
        JointKind::Prismatic { axis: [1.0, 0.0, 0.0], limits: Limits { min: 1.0, max: 2.0 } };
    let couple_all = |kinds: &[JointKind], followers: &[(usize, usize, f64)]| {
        let mut robot = Robot::rigid(BaseJoint::Fixed, Vec::new());
        robot.links.extend(kinds.iter().map(|kind| finger(0, *kind, 0.0)));
        let follower = |(link, followed, multiplier): &(usize, usize, f64)| Follower {
            link: *link,
            followed: *followed,
            multiplier: *multiplier,
            offset: 0.0,
        };
        let followers: Vec<Follower> = followers.iter().map(follower).collect();
        couple(&mut robot.links, &followers).map(|notes| (robot, notes))
    };
    let refused = |kinds: &[JointKind], followers: &[(usize, usize, f64)]| {
        couple_all(kinds, followers).map(|_| ()).unwrap_err()
    };
    let (index, message) = refused(&[about, about], &[(1, 2, 1.0), (2, 1, 1.0)]);
    assert_eq!((index, message.starts_with("it follows itself")), (0, true));
    let (_, message) = refused(&[about, JointKind::Fixed], &[(1, 2, 1.0)]);
    assert!(message.contains("a joint that turns about or slides along an axis expected"));
    let (_, message) = refused(&[JointKind::Spherical, about], &[(1, 2, 1.0)]);
    assert!(message.starts_with("it is none that turns"), "{message}");
    let (_, message) = refused(&[sliding, sliding], &[(1, 2, -1.0)]);
    assert!(message.starts_with("no value of `finger at 0` from 1 to 2"), "{message}");
    let (_, message) = refused(&[about, about], &[(1, 2, 1e6)]);
    assert!(message.contains("at most"), "{message}");
    // A whole number of turns for every turn goes on and on; half a turn does not.
    let (robot, notes) = couple_all(&[about, about], &[(1, 2, -2.0)]).unwrap();
    assert_eq!((robot.links[2].joint.as_ref().unwrap().kind, notes.len()), (about, 0));
    let (robot, notes) = couple_all(&[about, about], &[(1, 2, 0.5)]).unwrap();
    assert!(notes[0].contains("instead of on and on"), "{notes:?}");
    let kind = robot.links[2].joint.as_ref().unwrap().kind;
    let pi = std::f64::consts::PI;
    assert!(
        matches!(kind, JointKind::Revolute { limits: Some(Limits { min, max }), .. } if min == -pi && max == pi)
    );
}

proptest! {
    /// Links stand where they stood with the joint at the value at which it is locked, and no pair of links is tested
    /// that was not, nor left out unless its links never move against one another.
    #[test]
    fn locked_joints_stay_where_they_are(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "locks", Ordinal(ordinal)).stream(Purpose::Sampling);
        for motion in MOTIONS {
            let mut robot = drawn_with_mimics(&mut stream, motion, 10);
            for link in &mut robot.links {
                let shape = crate::scene::Shape::Sphere { radius: 1.0 };
                link.bodies = vec![Body { shape, pose: Pose::IDENTITY, solid: true }];
            }
            let space = robot.space([-2.0; 3], [2.0; 3], 1.0);
            let mut q = vec![0.0; space.len()];
            space.sample_uniform(&mut stream, &mut q);
            let (mut values, mut kept) = (vec![None], q[..motion.values()].to_vec());
            let mut at = motion.values();
            for joint in robot.links.iter().filter_map(|link| link.joint.as_ref()) {
                let count = joint.kind.values();
                let locks = stream.unit() < 0.5;
                if locks && count == 4 {
                    q[at..at + 4].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
                }
                values.push((locks && count > 0).then(|| q[at]));
                if !locks {
                    kept.extend(&q[at..at + count]);
                }
                at += count;
            }
            let (mut locked, mut free) = (robot.clone(), Vec::new());
            lock(&mut locked.links, &values);
            prop_assert_eq!(mimic_complaint(&locked.links), None);
            prop_assert_eq!(locked.space([-2.0; 3], [2.0; 3], 1.0).len(), kept.len());
            robot.link_poses(&q, &mut free);
            let mut held = Vec::new();
            locked.link_poses(&kept, &mut held);
            for (one, other) in free.iter().zip(&held) {
                let between = one.to_parry().inv_mul(&other.to_parry());
                prop_assert!(between.translation.length() < 1e-9);
                prop_assert!((between.rotation.w.abs() - 1.0).abs() < 1e-9);
            }
            let (all, left): (Vec<_>, Vec<_>) = (robot.self_pairs().collect(), locked.self_pairs().collect());
            for pair in &left {
                prop_assert!(all.contains(pair), "{:?} was not tested before", pair);
            }
            for (low, high) in all.into_iter().filter(|pair| !left.contains(pair)) {
                // Their relative pose is the same at any other configuration.
                let mut other = vec![0.0; kept.len()];
                locked.space([-2.0; 3], [2.0; 3], 1.0).sample_uniform(&mut stream, &mut other);
                let mut moved = Vec::new();
                locked.link_poses(&other, &mut moved);
                let seen = |poses: &[Pose]| poses[low].to_parry().inv_mul(&poses[high].to_parry());
                let change = (seen(&held).translation - seen(&moved).translation).length();
                prop_assert!(change < 1e-9, "{} and {} move against one another", low, high);
            }
        }
    }
}
