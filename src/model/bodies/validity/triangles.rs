//! The nearest points of triangles, segments and points.

use super::directions::{Triangle, triangles_meet};
use crate::lanes::Lanes;
use parry3d_f64::math::Vector;

/// The nearest points of two convex hulls of three corners, which may coincide: the one of the first hull, then the
/// one of the second; if the hulls meet, the same point twice. Ties go to pairs of edges before pairs of a face and
/// a corner, and among these to the first in the order of corners.
pub(crate) fn nearest_points(
    lanes: Lanes,
    first: &Triangle,
    second: &Triangle,
) -> (Vector, Vector) {
    let flat = |t: &Triangle| {
        let (u, v) = (t[1] - t[0], t[2] - t[0]);
        u.cross(v).length() <= 1e-14 * u.length() * v.length()
    };
    let (flat1, flat2) = (flat(first), flat(second));
    // Two hulls without an area are segments or points: whether they meet shows in the distance of their edges.
    let meet = !(flat1 && flat2) && hulls_meet(lanes, first, second, (flat1, flat2));
    if meet && let Some(point) = pierced(first, second, flat2).or(pierced(second, first, flat1)) {
        return (point, point);
    }
    let mut best = (f64::INFINITY, Vector::ZERO, Vector::ZERO);
    let mut offer = |p: Vector, q: Vector| {
        let square = (p - q).length_squared();
        if square < best.0 {
            best = (square, p, q);
        }
    };
    for i in 0..3 {
        for j in 0..3 {
            let (p, q) =
                nearest_on_segments(first[i], first[(i + 1) % 3], second[j], second[(j + 1) % 3]);
            offer(p, q);
        }
    }
    if !flat2 {
        for p in first {
            if let Some(q) = foot(*p, second) {
                offer(*p, q);
            }
        }
    }
    if !flat1 {
        for q in second {
            if let Some(p) = foot(*q, first) {
                offer(p, *q);
            }
        }
    }
    let (_, p, q) = best;
    if meet { (q, q) } else { (p, q) }
}

/// A point where an edge of the first hull goes through the second; none if the second has no area (`flat`).
fn pierced(first: &Triangle, second: &Triangle, flat: bool) -> Option<Vector> {
    let normal = (second[1] - second[0]).cross(second[2] - second[0]);
    let above = first.map(|corner| normal.dot(corner - second[0]));
    (0..3).filter(|_| !flat).find_map(|i| {
        let j = (i + 1) % 3;
        let crosses = (above[i] <= 0.0) != (above[j] <= 0.0);
        let point = first[i] + (first[j] - first[i]) * (above[i] / (above[i] - above[j]));
        (crosses && foot(point, second).is_some()).then_some(point)
    })
}

fn hulls_meet(
    lanes: Lanes,
    first: &Triangle,
    second: &Triangle,
    (flat1, flat2): (bool, bool),
) -> bool {
    if !flat1 && !flat2 {
        return triangles_meet(lanes, first, second);
    }
    // The separating axis theorem for a triangle and a segment or a point: the triangle's normal, the cross
    // products of edges, and, where all lies in one plane, those of edges and normal.
    let (triangle, segment) = if flat2 { (first, second) } else { (second, first) };
    let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    let apart = |axis: Vector| {
        let [a, b, c] = triangle.map(|corner| axis.dot(corner - triangle[0]));
        let [d, e, f] = segment.map(|corner| axis.dot(corner - triangle[0]));
        a.min(b).min(c) > d.max(e).max(f) || d.min(e).min(f) > a.max(b).max(c)
    };
    let edges = |t: &Triangle| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (edges1, edges2) = (edges(triangle), edges(segment));
    !(apart(normal)
        || edges1.iter().any(|edge1| edges2.iter().any(|edge2| apart(edge1.cross(*edge2))))
        || edges1.iter().chain(&edges2).any(|edge| apart(edge.cross(normal))))
}

/// Where the perpendicular from a point meets a triangle, if it does.
fn foot(p: Vector, [a, b, c]: &Triangle) -> Option<Vector> {
    let (u, v, w) = (*b - *a, *c - *a, p - *a);
    let normal = u.cross(v);
    let square = normal.length_squared();
    let (beta, gamma) = (w.cross(v).dot(normal), u.cross(w).dot(normal));
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= square;
    inside.then(|| p - normal * (w.dot(normal) / square))
}

/// The nearest points of the segments `a b` and `c d` (C. Ericson, *Real-time collision detection*,
/// 2005, section 5.1.9).
fn nearest_on_segments(a: Vector, b: Vector, c: Vector, d: Vector) -> (Vector, Vector) {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, vv, vw) = (u.length_squared(), v.length_squared(), v.dot(w));
    if uu <= 0.0 {
        let t = if vv > 0.0 { (vw / vv).clamp(0.0, 1.0) } else { 0.0 };
        return (a, c + v * t);
    }
    let uw = u.dot(w);
    if vv <= 0.0 {
        return (a + u * (-uw / uu).clamp(0.0, 1.0), c);
    }
    let uv = u.dot(v);
    let denominator = uu * vv - uv * uv;
    let mut s = 0.0;
    if denominator > 0.0 {
        s = ((uv * vw - uw * vv) / denominator).clamp(0.0, 1.0);
    }
    let mut t = (uv * s + vw) / vv;
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = ((uv * t - uw) / uu).clamp(0.0, 1.0);
    }
    (a + u * s, c + v * t)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::model::bodies::validity::directions::separating_axis;
    use parry3d_f64::math::Pose;
    use parry3d_f64::query::{self, PointQuery};
    use parry3d_f64::shape;
    use proptest::prelude::*;

    pub(in crate::model::bodies::validity) fn point() -> impl Strategy<Value = Vector> {
        (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| Vector::new(x, y, z))
    }

    pub(in crate::model::bodies::validity) fn parry(t: &Triangle) -> shape::Triangle {
        shape::Triangle::new(t[0], t[1], t[2])
    }

    proptest! {
        /// Against parry's distance, of triangles, segments and points.
        #[test]
        fn the_nearest_points_are_as_far_apart_as_parry_says(
            corners in proptest::collection::vec(point(), 6), shift in point(), made in 0usize..9,
        ) {
            let (a, b) = (made % 3, made / 3);
            let hull = |from: usize, kind: usize| match kind {
                0 => [corners[from], corners[from + 1], corners[from + 2]],
                1 => [corners[from], corners[from + 1], corners[from]],
                _ => [corners[from]; 3],
            };
            let first = hull(0, a);
            let second = hull(3, b).map(|corner| corner + shift);
            let still = Pose::IDENTITY;
            let expected = query::distance(&still, &parry(&first), &still, &parry(&second)).unwrap();
            let found = nearest_points(Lanes::widest(), &first, &second);
            let inside = |p: Vector, t: &Triangle| parry(t).distance_to_local_point(p, true) < 1e-6;
            prop_assert!(inside(found.0, &first) && inside(found.1, &second));
            let expected = expected.distance;
            let distance = (found.0 - found.1).length();
            prop_assert!((distance - expected).abs() < 1e-6, "{} not {}", distance, expected);
            if let Some((axis, gap)) = separating_axis(Lanes::widest(), &first, &second, 0.0) {
                prop_assert!(gap <= distance + 1e-12);
                prop_assert!((axis.length() - 1.0).abs() < 1e-12);
            }
        }
    }
}
