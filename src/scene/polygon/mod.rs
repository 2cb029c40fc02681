//! Polygons cut into triangles.
//!
//! A fan from the first corner stays wherever it covers the polygon, as it does every convex one. Else ears are cut
//! off (G. H. Meisters, "Polygons have ears", 1975), in the coordinate plane in which the polygon is largest, by
//! exact orientations of its corners: which triangles come out follows from the corners alone.

mod crossings;
mod ears;
#[cfg(test)]
mod tests;

use crate::math;
use robust::{Coord, orient2d};

/// What counts as touching in a polygon, as a share of its size: the decimals of a file place corners no better.
const TOUCH: f64 = 1e-6;
/// How far a corner of a polygon that is not convex may be from the polygon's plane, as a share of its size.
const PLANAR: f64 = 1e-2;
/// The most corners of a polygon that is not convex: the time grows with their square.
const CORNERS_MAX: usize = 1 << 13;

/// A corner in the coordinate plane in which its polygon is largest.
type Point = [f64; 2];

/// Appends the triangles of a polygon, whose corners index `vertices`: two fewer than it has corners, or fewer still
/// where corners are repeated.
///
/// # Errors
/// A polygon that crosses itself, or one that is not convex and not planar or has very many corners. Says what was
/// found; which face of which file that is, the caller knows.
pub(super) fn cut(
    corners: &[u32],
    vertices: &[[f64; 3]],
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), String> {
    let at = |corner: u32| vertices[corner as usize];
    let Some(axis) =
        (corners.len() > 3).then(|| largest_axis(corners.iter().map(|c| at(*c)))).flatten()
    else {
        triangles.extend(fan(corners));
        return Ok(());
    };
    let flat = |corner: u32| [at(corner)[(axis + 1) % 3], at(corner)[(axis + 2) % 3]];
    let points: Vec<Point> = corners.iter().map(|corner| flat(*corner)).collect();
    let touch = TOUCH * size(&points);
    if is_fan(&points, touch) {
        triangles.extend(fan(corners));
        return Ok(());
    }
    // Repeated corners have no direction of their own.
    let mut ring = corners.to_vec();
    ring.dedup_by_key(|corner| at(*corner).map(|value| (value + 0.0).to_bits()));
    while ring.len() > 1 && at(ring[0]) == at(ring[ring.len() - 1]) {
        ring.pop();
    }
    let found = ring.len();
    if found > CORNERS_MAX {
        return Err(format!(
            "a face with {found} corners that is not convex; at most {CORNERS_MAX} corners, or triangles, expected"
        ));
    }
    check_planar(&ring.iter().map(|corner| at(*corner)).collect::<Vec<_>>(), axis)?;
    let mut points: Vec<Point> = ring.iter().map(|corner| flat(*corner)).collect();
    if twice_area(&points) < 0.0 {
        // Seen from the other side the corners go round the other way.
        points.iter_mut().for_each(|[x, y]| std::mem::swap(x, y));
    }
    if let Some((a, b)) = crossings::first(&points, touch) {
        let side = |from: usize| {
            let (from, to) = (at(ring[from]), at(ring[(from + 1) % found]));
            format!("{from:?} to {to:?}")
        };
        let (a, b) = (side(a), side(b));
        return Err(format!("a face that crosses itself: its sides {a} and {b} cross"));
    }
    let ears = ears::cut_off(&points, touch);
    let Some(ears) = ears.filter(|ears| !crossings::overlap(&points, ears, touch)) else {
        return Err(format!("a face with {found} corners that crosses or touches itself"));
    };
    triangles.extend(ears.into_iter().map(|ear| ear.map(|corner| ring[corner])));
    Ok(())
}

/// The triangles of a polygon, all of which have its first corner; none if it has fewer than 3 corners.
pub(in crate::scene) fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    (2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]])
}

/// The axis along which the polygon is seen largest; `None` if it has no area from anywhere.
///
/// By the triangles of its fan, each counted as positive: of a polygon that crosses itself the parts do not cancel.
fn largest_axis(mut corners: impl Iterator<Item = [f64; 3]>) -> Option<usize> {
    let first = corners.next()?;
    let mut before = corners.next()?;
    let mut seen = [0.0; 3];
    for corner in corners {
        let normal = cross(minus(before, first), minus(corner, first));
        for axis in 0..3 {
            seen[axis] += normal[axis].abs();
        }
        before = corner;
    }
    let axis = (0..3).fold(0, |most, axis| if seen[axis] > seen[most] { axis } else { most });
    (seen[axis] > 0.0 && seen[axis].is_finite()).then_some(axis)
}

/// Whether the fan from the first corner covers the polygon: its triangles all turn the same way, to within `touch`,
/// and together turn less than once round that corner.
fn is_fan(points: &[Point], touch: f64) -> bool {
    let first = points[0];
    // Seen from itself a corner has no direction.
    if points[2..points.len() - 1].contains(&first) {
        return false;
    }
    let sides = || points[1..].windows(2).map(|side| (side[0], side[1]));
    let turn = |(a, b)| orientation(first, a, b);
    let area: f64 = sides().map(turn).sum();
    let wrong = |(a, b)| {
        let turn = orientation(first, a, b);
        let longest = distance(first, a).max(distance(first, b)).max(distance(a, b));
        turn * area <= 0.0 && turn.abs() > touch * longest
    };
    if sides().any(wrong) {
        return false;
    }
    // Two triangles turn less than half round each.
    if points.len() == 4 {
        return true;
    }
    let angle = |(a, b): (Point, Point)| {
        let (u, v) = ([a[0] - first[0], a[1] - first[1]], [b[0] - first[0], b[1] - first[1]]);
        math::atan2(orientation(first, a, b).abs(), u[0] * v[0] + u[1] * v[1])
    };
    sides().map(angle).sum::<f64>() < math::TURN - TOUCH
}

/// Complains of a corner that is far from the polygon's plane: the plane through the mean of the corners at right
/// angles to the sum of the fan's triangles, each turned so that it is seen from the positive side of `axis`.
fn check_planar(corners: &[[f64; 3]], axis: usize) -> Result<(), String> {
    let mut normal = [0.0; 3];
    for side in corners[1..].windows(2) {
        let own = cross(minus(side[0], corners[0]), minus(side[1], corners[0]));
        let sign = if own[axis] < 0.0 { -1.0 } else { 1.0 };
        normal = [0, 1, 2].map(|i| normal[i] + sign * own[i]);
    }
    let length = dot(normal, normal).sqrt();
    let count = corners.len() as f64;
    let mean = [0, 1, 2].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / count);
    let off = |corner: &[f64; 3]| (dot(minus(*corner, mean), normal) / length).abs();
    let farthest = corners.iter().map(off).fold(0.0, f64::max);
    let from_mean = corners.iter().map(|corner| minus(*corner, mean));
    let size = 2.0 * from_mean.map(|d| dot(d, d).sqrt()).fold(0.0, f64::max);
    if farthest > PLANAR * size {
        return Err(format!(
            "a face with {count} corners that is neither convex nor planar: a corner is {farthest:.3e} from the \
             plane of the others; at most {:.3e}, a hundredth of the face's size, or triangles expected",
            PLANAR * size
        ));
    }
    Ok(())
}

/// Positive if the way from `a` over `b` to `c` turns left, zero if the three lie in a line: the sign is exact.
fn orientation(a: Point, b: Point, c: Point) -> f64 {
    let coord = |[x, y]: Point| Coord { x, y };
    orient2d(coord(a), coord(b), coord(c))
}

fn twice_area(points: &[Point]) -> f64 {
    points[1..].windows(2).map(|side| orientation(points[0], side[0], side[1])).sum()
}

/// The diagonal of the box around the points.
fn size(points: &[Point]) -> f64 {
    let edge = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    distance([0.0; 2], [edge(0), edge(1)])
}

fn distance(a: Point, b: Point) -> f64 {
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    (x * x + y * y).sqrt()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
