//! Where a chain is at one time of a motion, and how fast.

use super::chain::{Chain, STRIDE, Turning};
use super::points::{Four, Points, cross, dot, minus, same};
use super::straight::Straight;
use crate::math;
use crate::structure::Point;
use fearless_simd::prelude::*;
use nalgebra::Matrix3;

/// A frame that moves: its origin is a residue's Cα, and it turns with the bonds before that residue's phi.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    rotation: Matrix3<f64>,
    origin: Point,
    /// The origin's velocity by the time of the motion, which runs from 0 to 1. Å.
    velocity: Point,
    /// The angular velocity, in radians.
    spin: Point,
}

/// A frame in all lanes.
pub(super) struct Frames<S: Simd> {
    axes: [Four<S>; 3],
    origin: Four<S>,
    velocity: Four<S>,
    spin: Four<S>,
}

impl Frame {
    /// A point as seen from the frame.
    #[cfg(test)]
    pub fn sees(&self, point: &Point) -> Point {
        self.rotation.tr_mul(&(point - self.origin))
    }

    #[inline(always)]
    pub fn in_lanes<S: Simd>(&self, simd: S) -> Frames<S> {
        Frames {
            axes: [0, 1, 2].map(
                #[inline(always)]
                |axis| same(simd, &self.rotation.column(axis).into()),
            ),
            origin: same(simd, &self.origin),
            velocity: same(simd, &self.velocity),
            spin: same(simd, &self.spin),
        }
    }
}

impl<S: Simd> Frames<S> {
    /// Points and their velocities as seen from the frame.
    #[inline(always)]
    pub fn see(&self, points: &Four<S>, velocities: &Four<S>) -> [Four<S>; 2] {
        let away = minus(points, &self.origin);
        let drift = minus(&minus(velocities, &self.velocity), &cross(&self.spin, &away));
        let [x, y, z] = &self.axes;
        [[dot(x, &away), dot(y, &away), dot(z, &away)], [dot(x, &drift), dot(y, &drift), dot(z, &drift)]]
    }
}

/// A chain at one time.
#[derive(Clone, Debug, Default)]
pub(super) struct Sample {
    /// The points, Cα atoms first, as seen from the bonds before the first torsion.
    pub points: Points,
    /// Their velocities.
    pub velocities: Points,
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
    /// Where a point is carried to, and its velocity.
    fn carry(&self, point: &Point) -> [Point; 2] {
        let at = self.rotation * point + self.shift;
        [at, self.spin.cross(&at) + self.drift]
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
        self.points.resize(chain.points());
        self.velocities.resize(chain.points());
        self.frames.clear();
        for (residue, link) in chain.links.iter().enumerate() {
            let alpha = body.carry(&link.alpha);
            self.put(residue, alpha);
            if residue % STRIDE == 0 {
                let Body { rotation, spin, .. } = body;
                let [origin, velocity] = alpha;
                self.frames.push(Frame { rotation, origin, velocity, spin });
            }
            let pass = |body: &mut Body, turning: &Turning| {
                let angle = motion.torsion(turning.number, time) - turning.source;
                body.pass(turning, angle, motion.turns[turning.number]);
            };
            if let Some(phi) = &link.phi {
                pass(&mut body, phi);
            }
            if let (Some(side_chain), Some(point)) = (&link.side_chain, chain.side_chain(residue)) {
                self.put(point, body.carry(side_chain));
            }
            if let Some(psi) = &link.psi {
                pass(&mut body, psi);
            }
        }
    }

    fn put(&mut self, point: usize, [at, velocity]: [Point; 2]) {
        self.points.put(point, at);
        self.velocities.put(point, velocity);
    }

    /// The frame of a residue, a multiple of [`STRIDE`].
    pub fn frame(&self, residue: usize) -> &Frame {
        &self.frames[residue / STRIDE]
    }
}
