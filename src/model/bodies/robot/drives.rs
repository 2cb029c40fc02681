//! What each joint adds to the velocity of a link as seen from another.
//!
//! Along [`Space::interpolate`](crate::space::Space::interpolate), parametrised over `[0, 1]`, a joint turns or slides at
//! a constant rate about or along an axis that stands still in the parent link's frame. Where the links stand at some
//! time of a motion then says how fast the points of one of them move as seen from another at that time: the sum of what
//! the joints between the two add, the way of [`Hops::rates`] being walked.

use super::rates::{Hop, Hops, Kind, of_base, rotation_at, turn_between};
use crate::math;
use parry3d_f64::math::Vector;

/// What one joint, or the base, adds to the velocity of a point at `p` in the world: `slide + turn × (p − origin)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drive {
    /// The link in whose frame the vectors are given; `None` for the base, whose velocities are given in the world's frame,
    /// and whose origin is that of link 0.
    pub parent: Option<u32>,
    /// A point on the axis of the turn.
    pub origin: Vector,
    /// Angular velocity.
    pub turn: Vector,
    /// Velocity of a slide.
    pub slide: Vector,
}

impl Hops {
    /// What the joints between two links add to the velocities of the points of the link `to` as seen from the link
    /// `from`, or from the world, during the motion from the configuration `a` to `b`. It replaces what is in `drives`.
    pub fn drives(
        &self,
        from: Option<usize>,
        to: usize,
        (a, b): (&[f64], &[f64]),
        drives: &mut Vec<Drive>,
    ) {
        drives.clear();
        let (mut up, mut down) = (from.unwrap_or(0), to);
        if from.is_none()
            && let Some(steady) = of_base(self.motion, a, b).steady
        {
            let (turn, slide) = (steady.turning, steady.velocity);
            drives.push(Drive { parent: None, origin: Vector::ZERO, turn, slide });
        }
        while up != down {
            if up > down {
                let hop = self.of_link(up);
                drives.extend(hop.drive(-1.0, (a, b)));
                up = hop.parent as usize;
            } else {
                let hop = self.of_link(down);
                drives.extend(hop.drive(1.0, (a, b)));
                down = hop.parent as usize;
            }
        }
    }
}

impl Hop {
    /// What the joint adds, times `sign`; `None` where it stands still.
    fn drive(&self, sign: f64, (a, b): (&[f64], &[f64])) -> Option<Drive> {
        let change = |value: usize, wraps: bool| {
            let change = b[value] - a[value];
            if wraps { math::wrap_angle(change) } else { change }
        };
        let (turn, slide) = match self.kind {
            Kind::Fixed => return None,
            Kind::Turn(value, wraps) => (self.axis * change(value, wraps), Vector::ZERO),
            Kind::TurnOf(value, wraps, multiplier) => {
                (self.axis * (multiplier * change(value, wraps)), Vector::ZERO)
            }
            Kind::Ball(value) => {
                let (from, to) = (rotation_at(a, value), rotation_at(b, value));
                let (axis, angle) = turn_between(from, to);
                (self.turn * (from * axis * angle), Vector::ZERO)
            }
            Kind::Slide(value) => (Vector::ZERO, self.axis * change(value, false)),
            Kind::SlideOf(value, multiplier, _) => {
                (Vector::ZERO, self.axis * (multiplier * change(value, false)))
            }
        };
        let (turn, slide) = (turn * sign, slide * sign);
        Some(Drive { parent: Some(self.parent), origin: self.origin, turn, slide })
    }
}
