//! Oriented bounding boxes in single precision, tested eight at once. The tests only say what double precision has to
//! look at closer.
//!
//! Coordinates are taken from an origin of each tree's own (`origin.rs`), the differences being formed in double
//! precision, so that they are as small as the scene at hand, wherever it stands.
//!
//! Rounding never makes two boxes seem apart that are not. Let the centre of a standing box be at c from its tree's origin,
//! its sides 2hₖ along its axes aₖ and its half diagonal h; let the boxes of the moving tree, their half diagonals
//! included, be within M of its origin, and this origin within T of the other along each axis, as seen from the
//! standing tree. With ε = 2⁻²⁴:
//!
//! - Placing a moving box puts its centre off by at most 12 ε M + 4 √3 ε T and its axes by 10 ε; the vector between the two
//!   centres is then off by at most 2 ε |c| + ε (14 M + 11 T).
//! - Along an axis aₖ of the standing box coordinates count with the axis' own components only, so that the gap is off by at
//!   most 8 ε Σᵢ|cᵢ aₖᵢ| + 4 ε hₖ + ε (56 M + 35 T).
//! - Along an axis of the moving box, or along one that is computed from both boxes, it is off by at most 17 ε |c| + 32 ε h +
//!   ε (34 M + 52 T), for an axis of unit length.
//!
//! What depends on M and T is in [`grain`], 128 ε (M + T), which is added once for a pair of frames. What depends on the
//! standing box is in its sides, which are larger by 16 ε (Σᵢ|cᵢ aₖᵢ| + hₖ) + 32 ε max(0, |c| − h), and for the axes of
//! the third kind in [`WIDE`] · h. So the margin of a pair depends on that pair alone, and a plate that is a million times larger
//! than the robot, but level with the axes, is told apart from it as well as a small one. Products and sums may be fused
//! (fused multiply-add), as they are with AVX2: a fused operation rounds once instead of twice, so that the bounds hold
//! all the more.

mod stand;

use super::frame::Frame;
use super::obb::Obb;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f32x16};
use parry3d_f64::math::Vector;

pub(super) use stand::{Gaps, Stands};

/// Coordinates are clamped to this, so that nothing overflows; boxes beyond count as meeting.
const FAR: f64 = 1e29;
/// A length beyond all others, of which some may still be added up.
const ENDLESS: f32 = 1e37;
/// A share of the half diagonal of a standing box, by which it is enlarged along axes that are not its own.
const WIDE: f32 = 1.0 / (1 << 18) as f32;
/// The rounding of a number in single precision, relative to the number.
const ROUNDING: f64 = 1.0 / (1u32 << 24) as f64;

/// A length greater than what rounding in these tests can add up to, but for what the standing boxes are enlarged by.
/// `scale` bounds the sum of two lengths: how far the moving boxes reach from their origin, and how far this origin is,
/// along any axis, from that of the standing tree.
pub(super) fn grain(scale: f64) -> f32 {
    if scale < FAR { (128.0 * ROUNDING * scale).max(1e-36) as f32 } else { ENDLESS }
}

/// A length, rounded upwards.
pub(super) fn above(length: f64) -> f32 {
    (length * (1.0 + 1e-6)) as f32
}

/// A box in the frame of its tree, with its centre as seen from the tree's origin.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct LightBox {
    /// Each unit axis, followed by half the side along it.
    axes: [[f32; 4]; 3],
    /// The centre, followed by half the diagonal.
    centre: [f32; 4],
}

impl LightBox {
    /// A box with coordinates from an origin.
    pub fn new(space: &Obb, origin: Vector) -> LightBox {
        let centre = space.centre - origin;
        let away = centre.length();
        let beyond = 32.0 * (away - space.radius).max(0.0);
        let half = space.half.to_array();
        let axes = [0, 1, 2].map(|i| {
            let along = (centre * space.axes[i]).abs().element_sum();
            let room = ROUNDING * (16.0 * (along + half[i]) + beyond);
            let fits = away + space.radius < FAR;
            with(space.axes[i], if fits { above(half[i] + room) } else { ENDLESS })
        });
        LightBox { axes, centre: with(within(centre), above(space.radius.min(2.0 * FAR))) }
    }

    /// Its centre as seen from its origin, and half its diagonal.
    #[cfg(test)]
    pub fn ball(&self) -> (Vector, f64) {
        let [x, y, z, radius] = self.centre.map(f64::from);
        (Vector::new(x, y, z), radius)
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

/// Numbers of eight boxes, a box to a lane: at one time (eight lanes), or at both ends of a chord of the motion (sixteen
/// lanes, those of the beginning first).
pub(super) trait Many<S: Simd>: SimdFloat<S, Element = f32> {
    /// From the numbers at the beginning and at the end; with eight lanes the latter are ignored.
    fn times(first: f32x8<S>, last: f32x8<S>) -> Self;

    /// From numbers that do not depend on time.
    fn always(of: f32x8<S>) -> Self;
}

impl<S: Simd> Many<S> for f32x8<S> {
    #[inline(always)]
    fn times(first: f32x8<S>, _: f32x8<S>) -> f32x8<S> {
        first
    }

    #[inline(always)]
    fn always(of: f32x8<S>) -> f32x8<S> {
        of
    }
}

impl<S: Simd> Many<S> for f32x16<S> {
    #[inline(always)]
    fn times(first: f32x8<S>, last: f32x8<S>) -> f32x16<S> {
        first.combine(last)
    }

    #[inline(always)]
    fn always(of: f32x8<S>) -> f32x16<S> {
        of.combine(of)
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
pub(super) fn all_times<S: Simd, V: Many<S>>([x, y, z]: &Three<f32x8<S>>) -> Three<V> {
    [V::always(*x), V::always(*y), V::always(*z)]
}

/// A point in every lane, with its positions at the one time or at both.
#[inline(always)]
pub(super) fn points<S: Simd, V: Many<S>>(simd: S, [first, last]: [Vector; 2]) -> Three<V> {
    let (first, last) = (within(first), within(last));
    [number(simd, first.x, last.x), number(simd, first.y, last.y), number(simd, first.z, last.z)]
}

#[inline(always)]
fn number<S: Simd, V: Many<S>>(simd: S, first: f64, last: f64) -> V {
    V::times(f32x8::splat(simd, first as f32), f32x8::splat(simd, last as f32))
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

/// The numbers of eight boxes, those of one kind side by side, as [`Eight`] has them.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct PackedBoxes([[f32; 8]; 16]);

impl PackedBoxes {
    pub fn new(boxes: [&LightBox; 8]) -> PackedBoxes {
        let number = |one: &LightBox, at: usize| match at / 4 {
            3 => one.centre[at % 4],
            axis => one.axes[axis][at % 4],
        };
        PackedBoxes(std::array::from_fn(|at| boxes.map(|one| number(one, at))))
    }
}

/// Eight boxes, a box to a lane.
#[derive(Clone, Copy)]
pub(super) struct Eight<S: Simd> {
    pub centre: Three<f32x8<S>>,
    pub axes: [Three<f32x8<S>>; 3],
    /// Half their sides.
    pub half: Three<f32x8<S>>,
    /// Half their diagonals.
    pub radius: f32x8<S>,
}

impl<S: Simd> Eight<S> {
    #[inline(always)]
    pub fn new(simd: S, [a, b, c, d, e, f, g, h]: [&LightBox; 8]) -> Eight<S> {
        let first = [&a.axes[0], &b.axes[0], &c.axes[0], &d.axes[0]];
        let first = both(
            columns(simd, first),
            columns(simd, [&e.axes[0], &f.axes[0], &g.axes[0], &h.axes[0]]),
        );
        let second = [&a.axes[1], &b.axes[1], &c.axes[1], &d.axes[1]];
        let second = both(
            columns(simd, second),
            columns(simd, [&e.axes[1], &f.axes[1], &g.axes[1], &h.axes[1]]),
        );
        let third = [&a.axes[2], &b.axes[2], &c.axes[2], &d.axes[2]];
        let third = both(
            columns(simd, third),
            columns(simd, [&e.axes[2], &f.axes[2], &g.axes[2], &h.axes[2]]),
        );
        let centre = [&a.centre, &b.centre, &c.centre, &d.centre];
        let centre = both(
            columns(simd, centre),
            columns(simd, [&e.centre, &f.centre, &g.centre, &h.centre]),
        );
        Eight::of([first, second, third], centre)
    }

    /// Boxes that were packed before.
    #[inline(always)]
    pub fn load(simd: S, PackedBoxes(packed): &PackedBoxes) -> Eight<S> {
        let of = four_rows;
        Eight::of(
            [of(simd, packed, 0), of(simd, packed, 4), of(simd, packed, 8)],
            of(simd, packed, 12),
        )
    }

    /// One box in all lanes.
    #[inline(always)]
    pub fn same(simd: S, LightBox { axes, centre }: &LightBox) -> Eight<S> {
        let axes = [splat(simd, &axes[0]), splat(simd, &axes[1]), splat(simd, &axes[2])];
        Eight::of(axes, splat(simd, centre))
    }

    #[inline(always)]
    fn of([a, b, c]: [[f32x8<S>; 4]; 3], [x, y, z, radius]: [f32x8<S>; 4]) -> Eight<S> {
        let axes = [[a[0], a[1], a[2]], [b[0], b[1], b[2]], [c[0], c[1], c[2]]];
        Eight { centre: [x, y, z], axes, half: [a[3], b[3], c[3]], radius }
    }
}

#[inline(always)]
fn four_rows<S: Simd>(simd: S, rows: &[[f32; 8]; 16], at: usize) -> [f32x8<S>; 4] {
    [
        f32x8::load_array_ref(simd, &rows[at]),
        f32x8::load_array_ref(simd, &rows[at + 1]),
        f32x8::load_array_ref(simd, &rows[at + 2]),
        f32x8::load_array_ref(simd, &rows[at + 3]),
    ]
}

#[inline(always)]
fn splat<S: Simd>(simd: S, [x, y, z, w]: &[f32; 4]) -> [f32x8<S>; 4] {
    [f32x8::splat(simd, *x), f32x8::splat(simd, *y), f32x8::splat(simd, *z), f32x8::splat(simd, *w)]
}

#[inline(always)]
fn both<S: Simd>([a, b, c, d]: [f32x4<S>; 4], [e, f, g, h]: [f32x4<S>; 4]) -> [f32x8<S>; 4] {
    [a.combine(e), b.combine(f), c.combine(g), d.combine(h)]
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
