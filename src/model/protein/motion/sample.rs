//! Where a chain is at one time of a motion, and how fast.

use super::chain::{Chain, STRIDE, Turning};
use super::points::{Four, Points, cross, dot, minus, same};
use super::straight::Straight;
use crate::model::protein::placed::{Placed, Site};
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
            axes: [
                same(simd, &self.rotation.column(0).into()),
                same(simd, &self.rotation.column(1).into()),
                same(simd, &self.rotation.column(2).into()),
            ],
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
        [
            [dot(x, &away), dot(y, &away), dot(z, &away)],
            [dot(x, &drift), dot(y, &drift), dot(z, &drift)],
        ]
    }
}

/// A chain at one time.
#[derive(Clone, Debug, Default)]
pub(super) struct Sample {
    /// The points, Cα atoms first, in the source's frame but from the chain's origin.
    pub points: Points,
    /// Their velocities.
    pub velocities: Points,
    /// The frames of the residues that are multiples of [`STRIDE`].
    frames: Vec<Frame>,
}

/// Working memory for placing.
#[derive(Clone, Debug, Default)]
pub(super) struct Stage {
    torsions: Vec<f64>,
    placed: Option<Placed>,
}

impl Stage {
    /// Fills it with what could mislead.
    pub fn poison(&mut self) {
        self.torsions.push(f64::NAN);
        self.placed.iter_mut().for_each(Placed::poison);
    }
}

/// How what is carried moves: a point at x has the velocity spin × x + drift.
#[derive(Clone, Copy)]
struct Twist {
    spin: Point,
    drift: Point,
}

impl Twist {
    fn velocity(&self, at: &Point) -> Point {
        self.spin.cross(at) + self.drift
    }

    /// Passes a torsion about a bond that begins or ends at `through`.
    fn pass(&mut self, turning: &Option<Turning>, motion: &Straight, bond: Point, through: &Point) {
        let Some(Turning { number, inverse }) = turning else { return };
        let spin = bond * (inverse * motion.turns[*number]);
        self.spin += spin;
        self.drift -= spin.cross(through);
    }
}

impl Sample {
    /// Places the chain at a time of a motion.
    pub fn place(&mut self, chain: &Chain, motion: &Straight, time: f64, stage: &mut Stage) {
        stage.torsions.clear();
        stage.torsions.extend(motion.torsions(time));
        let mut placed = stage.placed.take();
        // Memory of another chain is no use.
        if placed.as_ref().is_none_or(|placed| placed.len() != chain.links.len()) {
            placed = None;
        }
        let mut placed = placed.unwrap_or_else(|| chain.conformer.placed());
        chain.conformer.place(&stage.torsions, &mut placed);
        self.points.resize(chain.points());
        self.velocities.resize(chain.points());
        self.frames.clear();
        let mut twist = Twist { spin: Point::zeros(), drift: Point::zeros() };
        for (residue, link) in chain.links.iter().enumerate() {
            let at = |site, residue| placed.at(site, residue) - chain.origin;
            let (n, alpha) = (at(Site::N, residue), at(Site::CA, residue));
            let c = at(Site::C, residue);
            let velocity = twist.velocity(&alpha);
            self.put(residue, alpha, velocity);
            if residue % STRIDE == 0 {
                let rotation = match residue.checked_sub(1) {
                    // What is before the first torsion stands still.
                    None => Matrix3::identity(),
                    Some(before) => axes(&(alpha - n), &(at(Site::C, before) - n)),
                };
                let spin = twist.spin;
                self.frames.push(Frame { rotation, origin: alpha, velocity, spin });
            }
            twist.pass(&link.phi, motion, alpha - n, &alpha);
            if let Some(point) = chain.side_chain(residue) {
                let centroid = at(Site::Centroid, residue);
                self.put(point, centroid, twist.velocity(&centroid));
            }
            twist.pass(&link.psi, motion, c - alpha, &alpha);
        }
        stage.placed = Some(placed);
    }

    fn put(&mut self, point: usize, at: Point, velocity: Point) {
        self.points.put(point, at);
        self.velocities.put(point, velocity);
    }

    /// The frame of a residue, a multiple of [`STRIDE`].
    pub fn frame(&self, residue: usize) -> &Frame {
        &self.frames[residue / STRIDE]
    }
}

/// The axes of a frame in which two vectors stand still: the columns.
fn axes(one: &Point, other: &Point) -> Matrix3<f64> {
    let x = one / one.norm();
    let z = one.cross(other);
    let z = z / z.norm();
    Matrix3::from_columns(&[x, z.cross(&x), z])
}
