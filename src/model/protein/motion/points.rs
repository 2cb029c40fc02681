//! Points by coordinate, so that four are in lanes at once.
//!
//! Everything done with lanes must be inlined, closures too, to use wide instructions.

use crate::structure::Point;
use fearless_simd::f64x4;
use fearless_simd::prelude::*;

/// Numbers in a lane each.
pub(super) const LANES: usize = 4;

/// Vectors, one in a lane each.
pub(super) type Four<S> = [f64x4<S>; 3];

/// Points, or velocities of points.
#[derive(Clone, Debug, Default)]
pub(super) struct Points([Vec<f64>; 3]);

impl Points {
    /// Makes room for this many, and for those that are in lanes with the last. What was there stays.
    pub fn resize(&mut self, count: usize) {
        self.0.iter_mut().for_each(|axis| resize(axis, count));
    }

    pub fn at(&self, point: usize) -> Point {
        let [x, y, z] = &self.0;
        Point::new(x[point], y[point], z[point])
    }

    pub fn put(&mut self, point: usize, value: Point) {
        let [x, y, z] = &mut self.0;
        (x[point], y[point], z[point]) = (value.x, value.y, value.z);
    }

    /// The point and the three behind it.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S, point: usize) -> Four<S> {
        let [x, y, z] = &self.0;
        [load(simd, x, point), load(simd, y, point), load(simd, z, point)]
    }

    /// Puts the point and the three behind it.
    #[inline(always)]
    pub fn store<S: Simd>(&mut self, point: usize, value: &Four<S>) {
        let [x, y, z] = &mut self.0;
        store(x, point, value[0]);
        store(y, point, value[1]);
        store(z, point, value[2]);
    }

    pub fn fill(&mut self, value: f64) {
        self.0.iter_mut().for_each(|axis| axis.fill(value));
    }
}

/// Makes room for this many numbers, and for those that are in lanes with the last.
pub(super) fn resize(numbers: &mut Vec<f64>, count: usize) {
    numbers.resize(count + LANES, 0.0);
}

/// A number and the three behind it.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, numbers: &[f64], at: usize) -> f64x4<S> {
    f64x4::load_array_ref(simd, numbers[at..].first_chunk().expect("there is room"))
}

#[inline(always)]
pub(super) fn store<S: Simd>(numbers: &mut [f64], at: usize, value: f64x4<S>) {
    *numbers[at..].first_chunk_mut().expect("there is room") = value.to_array();
}

#[inline(always)]
pub(super) fn same<S: Simd>(simd: S, value: &Point) -> Four<S> {
    [f64x4::splat(simd, value.x), f64x4::splat(simd, value.y), f64x4::splat(simd, value.z)]
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: &Four<S>, b: &Four<S>) -> f64x4<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross<S: Simd>([a, b, c]: &Four<S>, [x, y, z]: &Four<S>) -> Four<S> {
    [*b * *z - *c * *y, *c * *x - *a * *z, *a * *y - *b * *x]
}

#[inline(always)]
pub(super) fn minus<S: Simd>(a: &Four<S>, b: &Four<S>) -> Four<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn plus<S: Simd>(a: &Four<S>, b: &Four<S>) -> Four<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn times<S: Simd>(a: &Four<S>, by: f64x4<S>) -> Four<S> {
    [a[0] * by, a[1] * by, a[2] * by]
}
