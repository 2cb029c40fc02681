//! Triangles cut off a polygon, one corner after the other.

use super::crossings::in_sector;
use super::{Point, distance, orientation};

/// How strict the look at a corner is.
#[derive(Clone, Copy, PartialEq)]
enum Look {
    /// The corner's triangle has an area, and nothing of the polygon is in it or on it.
    Exact,
    /// It may also be flat: a corner in the middle of a side, or the tip of a line there and back.
    Flat,
    /// It may overlap what is beside it as far as counts as touching.
    Touching,
}

/// The triangles of a polygon that is walked counter-clockwise, by the indices of its corners in the order of the
/// polygon; `None` if no triangle can be cut off any more.
///
/// From the first corner on the polygon is walked round and round, and each ear that is met is cut off: a corner
/// whose triangle with its two neighbours holds no other corner.
pub(super) fn cut_off(points: &[Point], touch: f64) -> Option<Vec<[usize; 3]>> {
    let count = points.len();
    let mut ring = Ring {
        points,
        touch,
        before: (0..count).map(|i| (i + count - 1) % count).collect(),
        after: (0..count).map(|i| (i + 1) % count).collect(),
    };
    let mut triangles = Vec::with_capacity(count.saturating_sub(2));
    // Corners that were looked at and are no ears. Cutting off an ear changes its neighbours only.
    let mut refused = vec![false; count];
    let (mut left, mut corner, mut passed) = (count, 0, 0);
    let mut look = Look::Exact;
    // A polygon that does not cross itself needs few more looks than three per corner.
    let mut looks = 16 * count + 1000;
    while left > 3 {
        let is_ear = !refused[corner] && {
            looks = looks.checked_sub(1)?;
            ring.is_ear(corner, look)
        };
        let after = ring.after[corner];
        if is_ear {
            let before = ring.before[corner];
            triangles.push([before, corner, after]);
            ring.after[before] = after;
            ring.before[after] = before;
            (refused[before], refused[after]) = (false, false);
            (left, passed, look) = (left - 1, 0, Look::Exact);
            // The neighbour is left out for once: else all triangles would share one corner and become thin.
            corner = ring.after[after];
            continue;
        }
        refused[corner] = true;
        corner = after;
        passed += 1;
        if passed > left {
            look = match look {
                Look::Exact => Look::Flat,
                Look::Flat => Look::Touching,
                Look::Touching => return None,
            };
            refused.fill(false);
            passed = 0;
        }
    }
    let last = [ring.before[corner], corner, ring.after[corner]];
    let [a, b, c] = last.map(|i| points[i]);
    if orientation(a, b, c) < -touch * longest([a, b, c]) {
        return None;
    }
    triangles.push(last);
    Some(triangles)
}

/// What is left of a polygon: each corner knows its neighbours.
struct Ring<'a> {
    points: &'a [Point],
    touch: f64,
    before: Vec<usize>,
    after: Vec<usize>,
}

impl Ring<'_> {
    fn is_ear(&self, corner: usize, look: Look) -> bool {
        let (before, after) = (self.before[corner], self.after[corner]);
        let triangle @ [a, b, c] = [before, corner, after].map(|i| self.points[i]);
        let turn = orientation(a, b, c);
        let turns = match look {
            Look::Flat if turn == 0.0 => return true,
            Look::Exact | Look::Flat => turn > 0.0,
            Look::Touching => turn >= -self.touch * longest(triangle),
        };
        if !turns {
            return false;
        }
        let mut other = self.after[after];
        while other != before {
            if self.is_in_the_way(other, triangle, look) {
                return false;
            }
            other = self.after[other];
        }
        true
    }

    /// Whether another corner keeps the triangle from being cut off.
    fn is_in_the_way(&self, other: usize, triangle @ [a, b, c]: [Point; 3], look: Look) -> bool {
        let point = self.points[other];
        let outside = |axis: usize| {
            let values = triangle.map(|corner| corner[axis]);
            point[axis] < values[0].min(values[1]).min(values[2])
                || point[axis] > values[0].max(values[1]).max(values[2])
        };
        if outside(0) || outside(1) || point == a || point == c {
            return false;
        }
        let depths = [(a, b), (b, c), (c, a)].map(|(from, to)| {
            let room = if look == Look::Touching { self.touch * distance(from, to) } else { 0.0 };
            orientation(from, to, point) - room
        });
        if point == b {
            // The boundary comes by the tip a second time: it must not go into the triangle.
            let neighbors = [self.before[other], self.after[other]].map(|i| self.points[i]);
            return neighbors.iter().any(|next| in_sector(triangle, *next) == Some(true));
        }
        match look {
            Look::Touching => depths.iter().all(|depth| *depth > 0.0),
            _ => depths.iter().all(|depth| *depth >= 0.0),
        }
    }
}

fn longest([a, b, c]: [Point; 3]) -> f64 {
    distance(a, b).max(distance(b, c)).max(distance(c, a))
}
