//! The separating axis theorem for two triangles, four candidate axes at once.
//!
//! Every lane does the same operations of double precision in the same order, none of them fused, so that results
//! have the same bits whatever the instructions.

use crate::lanes::{Lanes, with_lanes};
use fearless_simd::f64x4;
use fearless_simd::prelude::*;
use parry3d_f64::math::Vector;

/// A triangle's corners.
pub(crate) type Triangle = [Vector; 3];

/// Whether two triangles meet, touching included. By the separating axis theorem two triangles are apart exactly if
/// one of 17 axes separates them: the two normals, the nine cross products of edges, and, for triangles in one
/// plane, the six cross products of an edge and its triangle's normal.
pub(super) fn triangles_meet(lanes: Lanes, first: &Triangle, second: &Triangle) -> bool {
    with_lanes!(lanes, simd => simd.vectorize(
        #[inline(always)]
        || {
            let apart = directions(
                simd,
                (first, second),
                #[inline(always)]
                |gaps, _| gaps.simd_gt(0.0).any_true().then_some(()),
            );
            apart.is_none()
        },
    ))
}

/// A unit vector from the second triangle towards the first along which there is a gap of more than `margin`, and that
/// gap. Only the 17 axes are tried, so that there may be none although the distance is more than `margin`.
pub(crate) fn separating_axis(
    lanes: Lanes,
    first: &Triangle,
    second: &Triangle,
    margin: f64,
) -> Option<(Vector, f64)> {
    with_lanes!(lanes, simd => simd.vectorize(
        #[inline(always)]
        || directions(
            simd,
            (first, second),
            #[inline(always)]
            |gaps, axes| beyond(margin, gaps, axes),
        ),
    ))
}

/// The first of four axes along which the gap is larger than the margin, and that gap.
#[inline(always)]
fn beyond<S: Simd>(margin: f64, gaps: f64x4<S>, axes: Axes<S>) -> Option<(Vector, f64)> {
    if !gaps.simd_gt(0.0).any_true() {
        return None;
    }
    let lengths = dot(&axes, &axes).sqrt();
    let beyond = gaps.simd_gt(lengths * margin).to_bitmask() & lengths.simd_gt(1e-140).to_bitmask();
    let found = beyond & gaps.simd_gt(0.0).to_bitmask();
    let lane = found.trailing_zeros() as usize;
    (lane < 4).then(|| {
        let axis = vector_at(&axes, lane);
        (axis / lengths[lane], gaps[lane] / lengths[lane])
    })
}

/// Vectors, one to a lane.
type Axes<S> = [f64x4<S>; 3];

#[inline(always)]
fn axes<S: Simd>(simd: S, [a, b, c, d]: [Vector; 4]) -> Axes<S> {
    [
        f64x4::load_array(simd, [a.x, b.x, c.x, d.x]),
        f64x4::load_array(simd, [a.y, b.y, c.y, d.y]),
        f64x4::load_array(simd, [a.z, b.z, c.z, d.z]),
    ]
}

#[inline(always)]
fn same<S: Simd>(simd: S, v: Vector) -> Axes<S> {
    [f64x4::splat(simd, v.x), f64x4::splat(simd, v.y), f64x4::splat(simd, v.z)]
}

#[inline(always)]
fn dot<S: Simd>(a: &Axes<S>, b: &Axes<S>) -> f64x4<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<S: Simd>([a, b, c]: &Axes<S>, [x, y, z]: &Axes<S>) -> Axes<S> {
    [*b * *z - *y * *c, *c * *x - *z * *a, *a * *y - *x * *b]
}

/// Calls `done` with four axes and the gaps along them, then with the next four, until it returns something. Axes point
/// from the second triangle to the first and have any length; gaps are multiplied by that length.
#[inline(always)]
fn directions<S: Simd, T>(
    simd: S,
    (first, second): (&Triangle, &Triangle),
    mut done: impl FnMut(f64x4<S>, Axes<S>) -> Option<T>,
) -> Option<T> {
    // Coordinates are taken from a corner, since differences of small numbers lose fewer digits.
    let origin = second[0];
    let first = [first[0] - origin, first[1] - origin, first[2] - origin];
    let second = [second[1] - origin, second[2] - origin];
    let [d, e, f] = [first[1] - first[0], first[2] - first[1], first[0] - first[2]];
    let [x, y, z] = [second[0], second[1] - second[0], -second[1]];
    let corners = [same(simd, first[0]), same(simd, first[1]), same(simd, first[2])];
    let others = [same(simd, second[0]), same(simd, second[1])];
    let normals = products(simd, [x, d, d, d], [y, e, x, y]);
    let normal = [vector_at(&normals, 0), vector_at(&normals, 1)];
    let mut next = normals;
    for four in 1.. {
        let (gaps, turned) = gaps(simd, next, &corners, &others);
        let found = done(gaps, turned);
        if found.is_some() {
            return found;
        }
        let [other, own] = normal;
        next = match four {
            1 => products(simd, [d, e, e, e], [z, x, y, z]),
            2 => products(simd, [f, f, f, d], [x, y, z, own]),
            3 => products(simd, [e, f, x, y], [own, own, other, other]),
            4 => products(simd, [z; 4], [other; 4]),
            _ => break,
        };
    }
    None
}

#[inline(always)]
fn products<S: Simd>(simd: S, p: [Vector; 4], q: [Vector; 4]) -> Axes<S> {
    cross(&axes(simd, p), &axes(simd, q))
}

#[inline(always)]
fn vector_at<S: Simd>([x, y, z]: &Axes<S>, lane: usize) -> Vector {
    Vector::new(x[lane], y[lane], z[lane])
}

/// The gaps along four axes, and the axes turned so that they point from the second triangle to the first. The first
/// corner of the second triangle is the origin.
#[inline(always)]
fn gaps<S: Simd>(
    simd: S,
    axes: Axes<S>,
    first: &[Axes<S>; 3],
    second: &[Axes<S>; 2],
) -> (f64x4<S>, Axes<S>) {
    let [a, b, c] = [dot(&axes, &first[0]), dot(&axes, &first[1]), dot(&axes, &first[2])];
    let [e, f] = [dot(&axes, &second[0]), dot(&axes, &second[1])];
    let zero = f64x4::splat(simd, 0.0);
    let above = a.min(b).min(c) - e.max(f).max(zero);
    let below = e.min(f).min(zero) - a.max(b).max(c);
    let upright = above.simd_ge(below);
    let turned = [
        upright.select(axes[0], -axes[0]),
        upright.select(axes[1], -axes[1]),
        upright.select(axes[2], -axes[2]),
    ];
    (upright.select(above, below), turned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::bodies::validity::triangles::tests::{parry, point};
    use parry3d_f64::math::Pose;
    use parry3d_f64::query;
    use proptest::prelude::*;

    proptest! {
        /// Against parry's test of convex shapes; all lanes find the same axis.
        #[test]
        fn triangles_meet_when_parry_says_so(
            corners in proptest::collection::vec(point(), 6), margin in 0.0f64..0.3,
        ) {
            let first = [corners[0], corners[1], corners[2]];
            let second = [corners[3], corners[4], corners[5]];
            let still = Pose::IDENTITY;
            let expected = query::intersection_test(&still, &parry(&first), &still, &parry(&second));
            let expected = expected.unwrap().intersecting;
            let mut axes = Vec::new();
            for lanes in Lanes::all() {
                prop_assert_eq!(triangles_meet(lanes, &first, &second), expected);
                prop_assert_eq!(triangles_meet(lanes, &second, &first), expected);
                prop_assert_eq!(separating_axis(lanes, &first, &second, 0.0).is_none(), expected);
                // Triangles that share a corner or an edge meet.
                prop_assert!(triangles_meet(lanes, &first, &[corners[0], corners[4], corners[5]]));
                prop_assert!(triangles_meet(lanes, &first, &[corners[0], corners[1], corners[5]]));
                let found = separating_axis(lanes, &first, &second, margin);
                axes.push(found.map(|(axis, gap)| (axis.to_array().map(f64::to_bits), gap.to_bits())));
            }
            prop_assert!(axes.windows(2).all(|pair| pair[0] == pair[1]));
        }

        #[test]
        fn triangles_in_one_plane_are_told_apart(x in -4.0f64..4.0, y in -4.0f64..4.0) {
            let first = [Vector::ZERO, Vector::X, Vector::Y];
            let second = first.map(|corner| corner + Vector::new(x, y, 0.0));
            // Two equal triangles shifted in their plane overlap where |shift| is small in the norm of
            // the hexagon that their difference spans.
            let norm = x.abs().max(y.abs()).max((x + y).abs());
            prop_assume!((norm - 1.0).abs() > 1e-9);
            for lanes in Lanes::all() {
                prop_assert_eq!(triangles_meet(lanes, &first, &second), norm < 1.0);
            }
        }
    }
}
