//! Where a chain is at one time of a motion, and how fast.

use super::chain::{Chain, STRIDE, Turning};
use super::straight::Straight;
use crate::math;
use crate::structure::Point;
use nalgebra::Matrix3;

/// A position with its derivative by the time of the motion, which runs from 0 to 1. Å.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub at: Point,
    pub velocity: Point,
}

/// A frame that moves: its origin is a residue's Cα, and it turns with the bonds before that residue's phi.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    rotation: Matrix3<f64>,
    origin: Moving,
    /// The angular velocity, in radians.
    spin: Point,
}

impl Frame {
    /// A point as seen from the frame.
    pub fn sees(&self, point: &Moving) -> Moving {
        let away = point.at - self.origin.at;
        let drift = point.velocity - self.origin.velocity - self.spin.cross(&away);
        Moving { at: self.rotation.tr_mul(&away), velocity: self.rotation.tr_mul(&drift) }
    }
}

/// A chain at one time.
#[derive(Clone, Debug, Default)]
pub(super) struct Sample {
    /// The points, Cα atoms first, as seen from the bonds before the first torsion.
    pub points: Vec<Moving>,
    /// The frames of the residues that are multiples of [`STRIDE`].
    frames: Vec<Frame>,
}

/// A body on its way: x ↦ rotation · x + shift, with the velocity spin × x + drift of what it carries to x.
struct Body {
    rotation: Matrix3<f64>,
    shift: Point,
    spin: Point,
    drift: Point,
}

impl Body {
    fn carry(&self, point: &Point) -> Moving {
        let at = self.rotation * point + self.shift;
        Moving { at, velocity: self.spin.cross(&at) + self.drift }
    }

    /// Passes a torsion that has turned by `angle` and turns by `rate`.
    fn pass(&mut self, turning: &Turning, angle: f64, rate: f64) {
        let axis = self.rotation * turning.axis;
        let through = self.rotation * turning.through + self.shift;
        self.rotation *= rotation(&turning.axis, math::sin(angle), math::cos(angle));
        self.shift = through - self.rotation * turning.through;
        let spin = axis * rate;
        self.spin += spin;
        self.drift -= spin.cross(&through);
    }
}

/// Rotation about a vector of unit length by the angle that has this sine and cosine (Rodrigues).
fn rotation(axis: &Point, sin: f64, cos: f64) -> Matrix3<f64> {
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let t = 1.0 - cos;
    Matrix3::new(
        cos + t * x * x,
        t * x * y - sin * z,
        t * x * z + sin * y,
        t * x * y + sin * z,
        cos + t * y * y,
        t * y * z - sin * x,
        t * x * z - sin * y,
        t * y * z + sin * x,
        cos + t * z * z,
    )
}

impl Sample {
    /// Places the chain at a time of a motion.
    pub fn place(&mut self, chain: &Chain, motion: &Straight, time: f64) {
        let mut body = Body {
            rotation: Matrix3::identity(),
            shift: Point::zeros(),
            spin: Point::zeros(),
            drift: Point::zeros(),
        };
        let nowhere = Moving { at: Point::zeros(), velocity: Point::zeros() };
        self.points.clear();
        self.points.resize(chain.points(), nowhere);
        self.frames.clear();
        for (residue, link) in chain.links.iter().enumerate() {
            let alpha = body.carry(&link.alpha);
            self.points[residue] = alpha;
            if residue % STRIDE == 0 {
                let Body { rotation, spin, .. } = body;
                self.frames.push(Frame { rotation, origin: alpha, spin });
            }
            let pass = |body: &mut Body, turning: &Turning| {
                let angle = motion.torsion(turning.number, time) - turning.source;
                body.pass(turning, angle, motion.turns[turning.number]);
            };
            if let Some(phi) = &link.phi {
                pass(&mut body, phi);
            }
            if let (Some(side_chain), Some(point)) = (&link.side_chain, chain.side_chain(residue)) {
                self.points[point] = body.carry(side_chain);
            }
            if let Some(psi) = &link.psi {
                pass(&mut body, psi);
            }
        }
    }

    /// The frame of a residue, a multiple of [`STRIDE`].
    pub fn frame(&self, residue: usize) -> &Frame {
        &self.frames[residue / STRIDE]
    }
}
