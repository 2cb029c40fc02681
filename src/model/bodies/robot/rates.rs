//! How fast a motion carries a link and how much it bends the ways of its points.
//!
//! Along [`Space::interpolate`](crate::space::Space::interpolate), parametrised over `[0, 1]`, every value
//! changes at a constant rate, so that bounds on velocities and accelerations follow hop by hop along
//! the chain; `docs/validity.md` derives them.

use super::{Joint, JointKind, Robot};
use crate::math;
use crate::scene::Pose;
use crate::space::Motion;
use parry3d_f64::math::{Rotation, Vector};

/// Bounds on the motion of one frame as seen from another.
///
/// A point at distance at most `d` from the frame's origin moves no faster than `speed + spin · d`, and
/// the second derivative of its way is at most `bend + (twist + spin²) · d`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rates {
    /// Of the origin: its velocity.
    pub speed: f64,
    /// Of the origin: its acceleration.
    pub bend: f64,
    /// The angular velocity.
    pub spin: f64,
    /// The angular acceleration.
    pub twist: f64,
    /// Known of a rigid body, whose velocities are constant.
    pub steady: Option<Steady>,
}

/// A translation at constant velocity with a turn at constant angular velocity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steady {
    /// The axis of the turn in the moving frame, of unit length. With it the distance `d` of [`Rates`] may
    /// be that from the line through the origin along it.
    pub axis: Vector,
    /// Velocity of the origin in the frame that stands still.
    pub velocity: Vector,
    /// Angular velocity in the frame that stands still.
    pub turning: Vector,
}

/// One joint, in one of its two directions.
#[derive(Clone, Debug)]
struct Hop {
    /// How far the joint's frame is from where one comes from.
    before: f64,
    /// How far the frame that one comes to is from the joint's as moved.
    after: f64,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Fixed,
    /// Turns with the value of this index; whether the value wraps.
    Turn(usize, bool),
    /// Turns as the unit quaternion that begins at this index.
    Ball(usize),
    Slide(usize),
}

/// The joints between two frames.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    from_world: bool,
    hops: Vec<Hop>,
}

impl Robot {
    /// The chain from the world to a link.
    pub(crate) fn chain_to(&self, link: usize) -> Chain {
        let up = self.ancestry(link);
        Chain {
            from_world: true,
            hops: up.iter().rev().map(|link| self.hop(*link, true)).collect(),
        }
    }

    /// The chain from one link to another.
    pub(crate) fn chain_between(&self, from: usize, to: usize) -> Chain {
        let (up, down) = (self.ancestry(from), self.ancestry(to));
        let shared = up.iter().rev().zip(down.iter().rev()).take_while(|(a, b)| a == b).count();
        let up = up[..up.len() - shared].iter().map(|link| self.hop(*link, false));
        let down = down[..down.len() - shared].iter().rev().map(|link| self.hop(*link, true));
        Chain { from_world: false, hops: up.chain(down).collect() }
    }

    /// The links that have joints on the way from a link to the base, itself first.
    fn ancestry(&self, mut link: usize) -> Vec<usize> {
        let mut links = Vec::new();
        while let Some(joint) = &self.links[link].joint {
            links.push(link);
            link = joint.parent as usize;
        }
        links
    }

    fn hop(&self, link: usize, down: bool) -> Hop {
        let joint = |link: usize| -> Option<&Joint> { self.links[link].joint.as_ref() };
        let own = joint(link).expect("only links with joints are hopped over");
        let before: usize = (0..link).filter_map(joint).map(|joint| joint.kind.values()).sum();
        let value = self.motion.values() + before;
        let length = |pose: &Pose| Vector::from_array(pose.translation).length();
        let (before, after) = (length(&own.before), length(&own.after));
        let (before, after) = if down { (before, after) } else { (after, before) };
        let kind = match own.kind {
            JointKind::Fixed => Kind::Fixed,
            JointKind::Revolute { limits, .. } => Kind::Turn(value, limits.is_none()),
            JointKind::Prismatic { .. } => Kind::Slide(value),
            JointKind::Spherical => Kind::Ball(value),
        };
        Hop { before, after, kind }
    }
}

/// Outweighs the rounding in all of this.
const ROUNDING: f64 = 1.0 + 1e-9;

impl Chain {
    /// Bounds on the motion from `a` to `b`.
    pub(crate) fn rates(&self, motion: Motion, a: &[f64], b: &[f64]) -> Rates {
        let mut rates = if self.from_world { of_base(motion, a, b) } else { Rates::default() };
        for Hop { before, after, kind } in &self.hops {
            rates.steady = None;
            rates.carry(*before);
            match *kind {
                Kind::Fixed => {}
                Kind::Turn(value, wraps) => {
                    let change = b[value] - a[value];
                    let rate = if wraps { math::wrap_angle(change) } else { change };
                    rates.turn(rate.abs() * ROUNDING);
                }
                Kind::Ball(value) => {
                    let (from, to) = (rotation_at(a, value), rotation_at(b, value));
                    rates.turn(turn_between(from, to).1 * ROUNDING);
                }
                Kind::Slide(value) => {
                    rates.carry(a[value].abs().max(b[value].abs()));
                    let rate = (b[value] - a[value]).abs() * ROUNDING;
                    rates.bend += 2.0 * rates.spin * rate;
                    rates.speed += rate;
                }
            }
            rates.carry(*after);
        }
        rates
    }
}

impl Rates {
    /// Moves the origin by a length within the moving frame.
    fn carry(&mut self, length: f64) {
        self.speed += self.spin * length;
        self.bend += self.turn_bend() * length;
    }

    /// Turns the frame about an axis that is fixed to it.
    fn turn(&mut self, rate: f64) {
        self.twist += self.spin * rate;
        self.spin += rate;
    }

    /// The share of the second derivative that grows with the distance.
    pub fn turn_bend(&self) -> f64 {
        self.twist + self.spin * self.spin
    }

    /// The distance `d` of a point of the moving frame.
    pub fn distance(&self, point: Vector) -> f64 {
        match &self.steady {
            Some(steady) => steady.axis.cross(point).length(),
            None => point.length(),
        }
    }

    /// A bound on the velocity at the distance `d`.
    pub fn speed_at(&self, d: f64) -> f64 {
        self.speed + self.spin * d
    }

    /// A bound on the second derivative at the distance `d`.
    pub fn bend_at(&self, d: f64) -> f64 {
        self.bend + self.turn_bend() * d
    }
}

/// The unit quaternion `w x y z` that begins at an index.
fn rotation_at(q: &[f64], at: usize) -> Rotation {
    Rotation::from_xyzw(q[at + 1], q[at + 2], q[at + 3], q[at])
}

/// The shortest turn from one rotation to another: its axis, which stays where it is in both frames, and
/// its angle.
fn turn_between(from: Rotation, to: Rotation) -> (Vector, f64) {
    let between = from.conjugate() * to;
    let sign = if between.w < 0.0 { -1.0 } else { 1.0 };
    let part = Vector::new(between.x, between.y, between.z) * sign;
    let sine = part.length();
    let axis = if sine > 0.0 { part / sine } else { Vector::Z };
    (axis, 2.0 * math::atan2(sine, between.w.abs()))
}

fn of_base(motion: Motion, a: &[f64], b: &[f64]) -> Rates {
    let mut velocity = [0.0; 3];
    for axis in 0..motion.translations() {
        velocity[axis] = b[axis] - a[axis];
    }
    let velocity = Vector::from_array(velocity);
    let (axis, turning) = match motion {
        Motion::Fixed | Motion::Translation2d | Motion::Translation3d => (Vector::Z, Vector::ZERO),
        Motion::Rigid2d => (Vector::Z, Vector::Z * math::wrap_angle(b[2] - a[2])),
        Motion::Rigid3d => {
            let (from, to) = (rotation_at(a, 3), rotation_at(b, 3));
            let (axis, angle) = turn_between(from, to);
            (axis, from * axis * angle)
        }
    };
    Rates {
        speed: velocity.length() * ROUNDING,
        spin: turning.length() * ROUNDING,
        steady: Some(Steady { axis, velocity, turning }),
        ..Rates::default()
    }
}
