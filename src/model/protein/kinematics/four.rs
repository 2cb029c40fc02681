//! Vectors and frames of four segments of a chain, a segment to a lane.
//!
//! Everything done with lanes must be inlined, closures too, to use wide instructions.

use super::super::placed::SEGMENTS;
use super::frames::Frame;
use crate::structure::Point;
use fearless_simd::f64x4;
use fearless_simd::prelude::*;
use std::ops::{Add, Mul, Sub};

/// A number of each segment.
pub(super) type Four = [f64; SEGMENTS];

/// A number of each segment for phi, and then one for psi.
pub(super) type Eight = [f64; 2 * SEGMENTS];

/// A vector of each segment, by coordinate.
pub(super) type FourPoints = [Four; 3];

/// A vector in each lane.
#[derive(Clone, Copy)]
pub(super) struct Vectors<S: Simd> {
    pub x: f64x4<S>,
    pub y: f64x4<S>,
    pub z: f64x4<S>,
}

impl<S: Simd> Vectors<S> {
    #[inline(always)]
    pub fn load(simd: S, [x, y, z]: &FourPoints) -> Vectors<S> {
        let load = f64x4::load_array_ref;
        Vectors { x: load(simd, x), y: load(simd, y), z: load(simd, z) }
    }

    #[inline(always)]
    fn same(simd: S, of: &Point) -> Vectors<S> {
        Vectors {
            x: f64x4::splat(simd, of.x),
            y: f64x4::splat(simd, of.y),
            z: f64x4::splat(simd, of.z),
        }
    }

    #[inline(always)]
    fn of(simd: S, [a, b, c, d]: [&Point; SEGMENTS]) -> Vectors<S> {
        Vectors {
            x: f64x4::load_array(simd, [a.x, b.x, c.x, d.x]),
            y: f64x4::load_array(simd, [a.y, b.y, c.y, d.y]),
            z: f64x4::load_array(simd, [a.z, b.z, c.z, d.z]),
        }
    }

    /// The vector of a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Point {
        Point::new(self.x[lane], self.y[lane], self.z[lane])
    }
}

impl<S: Simd> Add for Vectors<S> {
    type Output = Vectors<S>;

    #[inline(always)]
    fn add(self, other: Vectors<S>) -> Vectors<S> {
        Vectors { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<S: Simd> Sub for Vectors<S> {
    type Output = Vectors<S>;

    #[inline(always)]
    fn sub(self, other: Vectors<S>) -> Vectors<S> {
        Vectors { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<S: Simd> Mul<f64x4<S>> for Vectors<S> {
    type Output = Vectors<S>;

    #[inline(always)]
    fn mul(self, by: f64x4<S>) -> Vectors<S> {
        Vectors { x: self.x * by, y: self.y * by, z: self.z * by }
    }
}

/// Three orthogonal unit vectors and a CA in each lane.
#[derive(Clone, Copy)]
pub(super) struct Frames<S: Simd> {
    pub x: Vectors<S>,
    pub y: Vectors<S>,
    pub z: Vectors<S>,
    pub ca: Vectors<S>,
}

impl<S: Simd> Frames<S> {
    /// The same frame in every lane.
    #[inline(always)]
    pub fn same(simd: S, Frame { axes: [x, y, z], ca }: &Frame) -> Frames<S> {
        let same = Vectors::same;
        Frames { x: same(simd, x), y: same(simd, y), z: same(simd, z), ca: same(simd, ca) }
    }

    #[inline(always)]
    pub fn of(simd: S, [a, b, c, d]: &[Frame; SEGMENTS]) -> Frames<S> {
        let of = Vectors::of;
        Frames {
            x: of(simd, [&a.axes[0], &b.axes[0], &c.axes[0], &d.axes[0]]),
            y: of(simd, [&a.axes[1], &b.axes[1], &c.axes[1], &d.axes[1]]),
            z: of(simd, [&a.axes[2], &b.axes[2], &c.axes[2], &d.axes[2]]),
            ca: of(simd, [&a.ca, &b.ca, &c.ca, &d.ca]),
        }
    }

    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Frame {
        let axes = [self.x.lane(lane), self.y.lane(lane), self.z.lane(lane)];
        Frame { axes, ca: self.ca.lane(lane) }
    }

    /// Turns about the third vector.
    #[inline(always)]
    pub fn turn(&mut self, [sin, cos]: [f64x4<S>; 2]) {
        let (x, y) = (self.x, self.y);
        self.x = x * cos + y * sin;
        self.y = y * cos - x * sin;
    }

    /// Turns about the first vector.
    #[inline(always)]
    pub fn tilt(&mut self, simd: S, [sin, cos]: &[Four; 2]) {
        let (sin, cos) = (f64x4::load_array_ref(simd, sin), f64x4::load_array_ref(simd, cos));
        let (y, z) = (self.y, self.z);
        self.y = y * cos + z * sin;
        self.z = z * cos - y * sin;
    }

    /// Where positions are that are seen from here.
    #[inline(always)]
    pub fn at(&self, simd: S, local: &FourPoints) -> Vectors<S> {
        let Vectors { x, y, z } = Vectors::load(simd, local);
        self.ca + ((self.x * x + self.y * y) + self.z * z)
    }
}
