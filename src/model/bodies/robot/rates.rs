//! How fast a motion carries a link and how much it bends the ways of its points.
//!
//! Along [`Space::interpolate`](crate::space::Space::interpolate), parametrised over `[0, 1]`, every value
//! changes at a constant rate, so that bounds on velocities and accelerations follow joint by joint along
//! the way from one link to another; `docs/validity.md` derives them.

use super::{JointKind, Robot};
use crate::math;
use crate::scene::Pose;
use crate::space::BaseJoint;
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

/// The joints of a robot, with what the bounds need of each: one entry per joint, from which the bounds
/// between any two links follow by walking along the tree.
#[derive(Clone, Debug)]
pub(crate) struct Hops {
    pub(super) motion: BaseJoint,
    /// The joint of link `i` stands at `i - 1`, since the base has none.
    of_links: Vec<Hop>,
}

/// One joint.
#[derive(Clone, Debug)]
pub(super) struct Hop {
    /// The parent link, whose index is less than that of the link that the joint moves.
    pub(super) parent: u32,
    /// Distance of the joint's origin from the parent link's.
    before: f64,
    /// Distance of the link's origin from the joint's as moved.
    after: f64,
    pub(super) kind: Kind,
    /// The joint's origin in the parent link's frame.
    pub(super) origin: Vector,
    /// The turn of the joint's frame as seen from the parent link's.
    pub(super) turn: Rotation,
    /// The axis about which the joint turns or along which it slides, in the parent link's frame; zero where there is none.
    pub(super) axis: Vector,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Fixed,
    /// Turns with the value of this index; whether the value wraps.
    Turn(usize, bool),
    /// Turns as the unit quaternion that begins at this index.
    Ball(usize),
    Slide(usize),
    /// Turns with a multiple of the value of this index; whether the value wraps.
    TurnOf(usize, bool, f64),
    /// Slides with a multiple of the value of this index, by an offset more.
    SlideOf(usize, f64, f64),
}

/// Outweighs the rounding in all of this.
pub(super) const ROUNDING: f64 = 1.0 + 1e-9;

impl Hops {
    /// The joints of a robot.
    pub fn new(robot: &Robot) -> Hops {
        let length = |pose: &Pose| Vector::from_array(pose.translation).length();
        let first = robot.motion.values();
        let mut value = first;
        let joints = robot.links[1..].iter().map(|link| {
            let joint = link.joint.as_ref().expect("every link but the base has a joint");
            let kind = match joint.kind {
                JointKind::Fixed | JointKind::Locked => Kind::Fixed,
                JointKind::Revolute { limits, .. } => Kind::Turn(value, limits.is_none()),
                JointKind::Prismatic { .. } => Kind::Slide(value),
                JointKind::Spherical => Kind::Ball(value),
                JointKind::RevoluteMimic { mimic, .. } => {
                    let wraps = robot.range(mimic.value).is_some_and(|range| range.is_none());
                    Kind::TurnOf(first + mimic.value as usize, wraps, mimic.multiplier)
                }
                JointKind::PrismaticMimic { mimic, .. } => {
                    Kind::SlideOf(first + mimic.value as usize, mimic.multiplier, mimic.offset)
                }
            };
            value += joint.kind.values();
            let (before, after) = (length(&joint.before), length(&joint.after));
            let at = joint.before.to_parry();
            let axis = match joint.kind {
                JointKind::Revolute { axis, .. }
                | JointKind::RevoluteMimic { axis, .. }
                | JointKind::Prismatic { axis, .. }
                | JointKind::PrismaticMimic { axis, .. } => at.rotation * Vector::from_array(axis),
                JointKind::Fixed | JointKind::Locked | JointKind::Spherical => Vector::ZERO,
            };
            let (origin, turn) = (at.translation, at.rotation);
            Hop { parent: joint.parent, before, after, kind, origin, turn, axis }
        });
        Hops { of_links: joints.collect(), motion: robot.motion }
    }

    pub(super) fn of_link(&self, link: usize) -> &Hop {
        &self.of_links[link - 1]
    }

    /// Bounds on the motion of the link `to` from the configuration `a` to `b`, as seen from the link
    /// `from`, or from the world.
    ///
    /// The joints are taken in the order of the way: up from `from` to the nearest common ancestor of the
    /// two, then down to `to`. Every sum of the bounds is rounded in that order, and verdicts depend on
    /// how. `descent` is working memory.
    pub fn rates(
        &self,
        from: Option<usize>,
        to: usize,
        (a, b): (&[f64], &[f64]),
        descent: &mut Vec<usize>,
    ) -> Rates {
        let (mut rates, mut up) = match from {
            None => (of_base(self.motion, a, b), 0),
            Some(from) => (Rates::default(), from),
        };
        // A parent has a lower index than its children, so of two different links the one of the higher index
        // is no ancestor of the other. To replace it by its parent ends at the nearest common ancestor.
        let mut down = to;
        descent.clear();
        while up != down {
            if up > down {
                let hop = self.of_link(up);
                rates.pass(hop, hop.after, hop.before, (a, b));
                up = hop.parent as usize;
            } else {
                descent.push(down);
                down = self.of_link(down).parent as usize;
            }
        }
        for link in descent.iter().rev() {
            let hop = self.of_link(*link);
            rates.pass(hop, hop.before, hop.after, (a, b));
        }
        rates
    }

    /// How many joints are stored.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.of_links.len()
    }
}

impl Rates {
    /// Passes a joint, whose origin is at a distance `before` from where one comes from, and as moved at a
    /// distance `after` from where one goes to.
    fn pass(&mut self, hop: &Hop, before: f64, after: f64, (a, b): (&[f64], &[f64])) {
        self.steady = None;
        self.carry(before);
        match hop.kind {
            Kind::Fixed => {}
            Kind::Turn(value, wraps) => {
                let change = b[value] - a[value];
                let rate = if wraps { math::wrap_angle(change) } else { change };
                self.turn(rate.abs() * ROUNDING);
            }
            Kind::Ball(value) => {
                let (from, to) = (rotation_at(a, value), rotation_at(b, value));
                self.turn(turn_between(from, to).1 * ROUNDING);
            }
            Kind::Slide(value) => self
                .slide(a[value].abs().max(b[value].abs()), (b[value] - a[value]).abs() * ROUNDING),
            // A value that follows another changes at a constant rate, too, since it is linear in it.
            Kind::TurnOf(value, wraps, multiplier) => {
                let change = b[value] - a[value];
                let rate = if wraps { math::wrap_angle(change) } else { change };
                self.turn((multiplier * rate).abs() * ROUNDING);
            }
            Kind::SlideOf(value, multiplier, offset) => {
                let [from, to] = [a, b].map(|q| (multiplier * q[value] + offset).abs());
                let rate = (multiplier * (b[value] - a[value])).abs() * ROUNDING;
                self.slide(from.max(to), rate);
            }
        }
        self.carry(after);
    }

    /// Moves the origin by a length within the moving frame.
    fn carry(&mut self, length: f64) {
        self.speed += self.spin * length;
        self.bend += self.turn_bend() * length;
    }

    /// Slides the frame along an axis that is fixed to it, no farther than `most` from where the slide begins.
    fn slide(&mut self, most: f64, rate: f64) {
        self.carry(most);
        self.bend += 2.0 * self.spin * rate;
        self.speed += rate;
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
pub(super) fn rotation_at(q: &[f64], at: usize) -> Rotation {
    Rotation::from_xyzw(q[at + 1], q[at + 2], q[at + 3], q[at])
}

/// The shortest turn from one rotation to another: its axis, which stays where it is in both frames, and
/// its angle.
pub(super) fn turn_between(from: Rotation, to: Rotation) -> (Vector, f64) {
    let between = from.conjugate() * to;
    let sign = if between.w < 0.0 { -1.0 } else { 1.0 };
    let part = Vector::new(between.x, between.y, between.z) * sign;
    let sine = part.length();
    let axis = if sine > 0.0 { part / sine } else { Vector::Z };
    (axis, 2.0 * math::atan2(sine, between.w.abs()))
}

pub(super) fn of_base(motion: BaseJoint, a: &[f64], b: &[f64]) -> Rates {
    let mut velocity = [0.0; 3];
    for axis in 0..motion.translations() {
        velocity[axis] = b[axis] - a[axis];
    }
    let velocity = Vector::from_array(velocity);
    let (axis, turning) = match motion {
        BaseJoint::Fixed | BaseJoint::Translation2d | BaseJoint::Translation3d => {
            (Vector::Z, Vector::ZERO)
        }
        BaseJoint::Rigid2d => (Vector::Z, Vector::Z * math::wrap_angle(b[2] - a[2])),
        BaseJoint::Rigid3d => {
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
