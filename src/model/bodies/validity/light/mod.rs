//! Oriented bounding boxes in single precision, tested four at once. The tests only say what double precision has to
//! look at closer.
//!
//! Rounding never makes two boxes seem apart that are not: [`grain`] is added to the extent of every box. Let S be the
//! largest coordinate of the input, so that no centre and no shift is longer than 2 √3 S in the standing frame, and
//! ε = 2⁻²⁴. Placing a box puts its centre off by at most 48 ε S and its axes by 9 ε. With the rounding of the other
//! centre and of the difference, the vector between the two centres is off by 66 ε S, and its product with an axis by
//! 100 ε S more. A box extends at most 3 S along an axis, and the computed extent is off by 54 ε S. In all that is less
//! than 256 ε S, the grain. Products and sums may be fused (fused multiply-add), as they are with AVX2: a fused
//! operation rounds once instead of twice, so that the bounds hold all the more.

mod stand;

use super::frame::Frame;
use super::obb::Obb;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8};
use parry3d_f64::math::Vector;

pub(super) use stand::{Gaps, Stands};

/// Coordinates are clamped to this, so that nothing overflows; boxes beyond count as meeting.
const FAR: f64 = 1e29;

/// A length greater than what rounding in these tests can add up to, coordinates being at most `scale`.
pub(super) fn grain(scale: f64) -> f32 {
    if scale < FAR { (scale / f64::from(1 << 16)).max(1e-36) as f32 } else { 1e38 }
}

/// A length, rounded upwards.
pub(super) fn above(length: f64) -> f32 {
    (length * (1.0 + 1e-6)) as f32
}

/// A box in the frame of its tree.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct LightBox {
    /// Each unit axis, followed by half the side along it.
    axes: [[f32; 4]; 3],
    /// The centre, followed by half the diagonal.
    centre: [f32; 4],
}

impl LightBox {
    pub fn new(space: &Obb) -> LightBox {
        let half = space.half.to_array().map(|half| above(half.min(FAR)));
        let axes = [0, 1, 2].map(|i| with(space.axes[i], half[i]));
        let centre = within(space.centre);
        LightBox { axes, centre: with(centre, above(space.radius.min(2.0 * FAR))) }
    }

    /// Half its diagonal.
    #[inline(always)]
    pub fn radius(&self) -> f32 {
        self.centre[3]
    }
}

fn with(v: Vector, last: f32) -> [f32; 4] {
    [v.x as f32, v.y as f32, v.z as f32, last]
}

/// The point with coordinates clamped to what single precision can square.
#[inline(always)]
fn within(at: Vector) -> Vector {
    let far = Vector::splat(FAR);
    at.clamp(-far, far)
}

/// Numbers of four boxes, a box to a lane: at one time (four lanes), or at both ends of a chord of the motion (eight
/// lanes, those of the beginning first).
pub(super) trait Many<S: Simd>: SimdFloat<S, Element = f32, Block = f32x4<S>> {
    /// From the numbers at the beginning and at the end; with four lanes the latter are ignored.
    fn times(first: f32x4<S>, last: f32x4<S>) -> Self;
}

impl<S: Simd> Many<S> for f32x4<S> {
    #[inline(always)]
    fn times(first: f32x4<S>, _: f32x4<S>) -> f32x4<S> {
        first
    }
}

impl<S: Simd> Many<S> for f32x8<S> {
    #[inline(always)]
    fn times(first: f32x4<S>, last: f32x4<S>) -> f32x8<S> {
        first.combine(last)
    }
}

/// The coordinates of vectors, a vector to a lane.
pub(super) type Three<V> = [V; 3];

/// Calls `of` for each axis. Everything done with lanes must be inlined, the closure too, to use wide instructions.
#[inline(always)]
pub(super) fn three<T>(mut of: impl FnMut(usize) -> T) -> Three<T> {
    [of(0), of(1), of(2)]
}

#[inline(always)]
pub(super) fn dot<S: Simd, V: Many<S>>(a: &Three<V>, b: &Three<V>) -> V {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

/// Vectors that do not depend on time, at each of the times.
#[inline(always)]
pub(super) fn all_times<S: Simd, V: Many<S>>([x, y, z]: &Three<f32x4<S>>) -> Three<V> {
    [V::block_splat(*x), V::block_splat(*y), V::block_splat(*z)]
}

/// A point in every lane, with its positions at the one time or at both.
#[inline(always)]
pub(super) fn points<S: Simd, V: Many<S>>(simd: S, [first, last]: [Vector; 2]) -> Three<V> {
    let (first, last) = (within(first), within(last));
    [number(simd, first.x, last.x), number(simd, first.y, last.y), number(simd, first.z, last.z)]
}

#[inline(always)]
fn number<S: Simd, V: Many<S>>(simd: S, first: f64, last: f64) -> V {
    V::times(f32x4::splat(simd, first as f32), f32x4::splat(simd, last as f32))
}

/// A frame in every lane, at the one time or at both.
#[derive(Clone, Copy)]
pub(super) struct Frames<V> {
    /// The rows of the rotation matrix.
    turn: [Three<V>; 3],
    shift: Three<V>,
}

impl<V> Frames<V> {
    #[inline(always)]
    pub fn new<S: Simd>(simd: S, [first, last]: [&Frame; 2]) -> Frames<V>
    where
        V: Many<S>,
    {
        let (one, other) = (first.turn.transpose(), last.turn.transpose());
        let turn = [
            points(simd, [one.x_axis, other.x_axis]),
            points(simd, [one.y_axis, other.y_axis]),
            points(simd, [one.z_axis, other.z_axis]),
        ];
        Frames { turn, shift: points(simd, [first.shift, last.shift]) }
    }
}

/// Four boxes, a box to a lane.
#[derive(Clone, Copy)]
pub(super) struct Four<S: Simd> {
    pub centre: Three<f32x4<S>>,
    pub axes: [Three<f32x4<S>>; 3],
    /// Half their sides.
    pub half: Three<f32x4<S>>,
    /// Half their diagonals.
    pub radius: f32x4<S>,
}

impl<S: Simd> Four<S> {
    #[inline(always)]
    pub fn new(simd: S, [a, b, c, d]: [&LightBox; 4]) -> Four<S> {
        let first = columns(simd, [&a.axes[0], &b.axes[0], &c.axes[0], &d.axes[0]]);
        let second = columns(simd, [&a.axes[1], &b.axes[1], &c.axes[1], &d.axes[1]]);
        let third = columns(simd, [&a.axes[2], &b.axes[2], &c.axes[2], &d.axes[2]]);
        let centre = columns(simd, [&a.centre, &b.centre, &c.centre, &d.centre]);
        Four::of([first, second, third], centre)
    }

    /// One box in all lanes.
    #[inline(always)]
    pub fn same(simd: S, LightBox { axes, centre }: &LightBox) -> Four<S> {
        let axes = [splat(simd, &axes[0]), splat(simd, &axes[1]), splat(simd, &axes[2])];
        Four::of(axes, splat(simd, centre))
    }

    #[inline(always)]
    fn of([a, b, c]: [[f32x4<S>; 4]; 3], [x, y, z, radius]: [f32x4<S>; 4]) -> Four<S> {
        let axes = [[a[0], a[1], a[2]], [b[0], b[1], b[2]], [c[0], c[1], c[2]]];
        Four { centre: [x, y, z], axes, half: [a[3], b[3], c[3]], radius }
    }
}

#[inline(always)]
fn splat<S: Simd>(simd: S, [x, y, z, w]: &[f32; 4]) -> [f32x4<S>; 4] {
    [f32x4::splat(simd, *x), f32x4::splat(simd, *y), f32x4::splat(simd, *z), f32x4::splat(simd, *w)]
}

/// The transposed matrix.
#[inline(always)]
fn columns<S: Simd>(simd: S, [a, b, c, d]: [&[f32; 4]; 4]) -> [f32x4<S>; 4] {
    let (a, c) = (f32x4::load_array_ref(simd, a), f32x4::load_array_ref(simd, c));
    let (b, d) = (f32x4::load_array_ref(simd, b), f32x4::load_array_ref(simd, d));
    let (odd, even) = (a.zip_low(c), b.zip_low(d));
    let (x, y) = (odd.zip_low(even), odd.zip_high(even));
    let (odd, even) = (a.zip_high(c), b.zip_high(d));
    [x, y, odd.zip_low(even), odd.zip_high(even)]
}

#[cfg(test)]
pub(super) mod tests;
