//! The bounds on motions against a construction that writes down the joints between two links before it adds
//! anything up. Verdicts depend on how sums are rounded, so that every bit counts.

use super::rates::{ROUNDING, Rates, of_base, rotation_at, turn_between};
use super::rates_tests::{MOTIONS, drawn_robot};
use super::*;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed};
use parry3d_f64::math::Vector;
use proptest::prelude::*;

/// A joint in one of its two directions: the link that it moves, and whether the way leads down to that link.
type Hop = (usize, bool);

/// The joints on the way from a link to the base, named by the links that they move.
fn ancestry(robot: &Robot, mut link: usize) -> Vec<usize> {
    let mut links = Vec::new();
    while let Some(joint) = &robot.links[link].joint {
        links.push(link);
        link = joint.parent as usize;
    }
    links
}

/// The joints between two links, or between the world and a link.
fn hops_between(robot: &Robot, from: Option<usize>, to: usize) -> Vec<Hop> {
    let up = from.map_or_else(Vec::new, |from| ancestry(robot, from));
    let down = ancestry(robot, to);
    let shared = up.iter().rev().zip(down.iter().rev()).take_while(|(a, b)| a == b).count();
    let up = up[..up.len() - shared].iter().map(|link| (*link, false));
    let down = down[..down.len() - shared].iter().rev().map(|link| (*link, true));
    up.chain(down).collect()
}

fn reference(robot: &Robot, from: Option<usize>, to: usize, [a, b]: [&[f64]; 2]) -> Rates {
    let mut rates = if from.is_none() { of_base(robot.motion, a, b) } else { Rates::default() };
    for (link, down) in hops_between(robot, from, to) {
        let joint = |link: usize| robot.links[link].joint.as_ref();
        let own = joint(link).unwrap();
        let before: usize = (0..link).filter_map(joint).map(|joint| joint.kind.values()).sum();
        let value = robot.motion.values() + before;
        let length = |pose: &Pose| Vector::from_array(pose.translation).length();
        let ends = [length(&own.before), length(&own.after)];
        let [first, last] = if down { ends } else { [ends[1], ends[0]] };
        rates.steady = None;
        carry(&mut rates, first);
        match own.kind {
            JointKind::Fixed | JointKind::Locked => {}
            JointKind::Revolute { limits, .. } => {
                let change = b[value] - a[value];
                let rate = if limits.is_none() { math::wrap_angle(change) } else { change };
                turn(&mut rates, rate.abs() * ROUNDING);
            }
            JointKind::Spherical => {
                let (from, to) = (rotation_at(a, value), rotation_at(b, value));
                turn(&mut rates, turn_between(from, to).1 * ROUNDING);
            }
            JointKind::RevoluteMimic { .. } | JointKind::PrismaticMimic { .. } => {
                unreachable!("these robots have none")
            }
            JointKind::Prismatic { .. } => {
                carry(&mut rates, a[value].abs().max(b[value].abs()));
                let rate = (b[value] - a[value]).abs() * ROUNDING;
                rates.bend += 2.0 * rates.spin * rate;
                rates.speed += rate;
            }
        }
        carry(&mut rates, last);
    }
    rates
}

fn carry(rates: &mut Rates, length: f64) {
    rates.speed += rates.spin * length;
    rates.bend += (rates.twist + rates.spin * rates.spin) * length;
}

fn turn(rates: &mut Rates, rate: f64) {
    rates.twist += rates.spin * rate;
    rates.spin += rate;
}

fn bits(rates: &Rates) -> Vec<u64> {
    let Rates { speed, bend, spin, twist, steady } = rates;
    let steady = steady.iter().flat_map(|steady| [steady.axis, steady.velocity, steady.turning]);
    let numbers = [*speed, *bend, *spin, *twist].into_iter();
    numbers.chain(steady.flat_map(|vector| vector.to_array())).map(f64::to_bits).collect()
}

proptest! {
    #[test]
    fn bounds_found_on_the_way_are_those_of_the_joints_written_down(
        ordinal in any::<u64>(), links in 1..40u32, near in 1..40u32,
    ) {
        let mut stream = Seed::of_set(5, "rates, bit for bit", Ordinal(ordinal)).stream(Purpose::Sampling);
        // Where another way left it.
        let descent = &mut vec![usize::MAX; 3];
        for motion in MOTIONS {
            let robot = drawn_robot(&mut stream, motion, links, near);
            let hops = Hops::new(&robot);
            prop_assert_eq!(hops.len() + 1, robot.links.len());
            let space = robot.space([-2.0; 3], [2.0; 3], 1.0);
            let (mut a, mut b) = (vec![0.0; space.len()], vec![0.0; space.len()]);
            space.sample_uniform(&mut stream, &mut a);
            space.sample_uniform(&mut stream, &mut b);
            for to in 0..robot.links.len() {
                for from in std::iter::once(None).chain((0..robot.links.len()).map(Some)) {
                    let expected = reference(&robot, from, to, [&a, &b]);
                    let found = hops.rates(from, to, (&a, &b), descent);
                    prop_assert_eq!(bits(&found), bits(&expected), "{:?} to {}", from, to);
                }
            }
        }
    }
}
