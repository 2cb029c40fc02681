//! Whether a polygon crosses itself. One that only touches itself does not: polygons with holes are often stored
//! with a bridge from the outer boundary to each hole, which is walked there and back.

use super::{Point, distance, orientation};

/// Two sides that cross, each by its first corner. What crosses by no more than `touch` only touches.
pub(super) fn first(points: &[Point], touch: f64) -> Option<(usize, usize)> {
    let count = points.len();
    let ends = |side: usize| [points[side], points[(side + 1) % count]];
    let range = |side: usize, axis: usize| {
        let [a, b] = ends(side).map(|end| end[axis]);
        (a.min(b), a.max(b))
    };
    // Sides in the order in which a line moving along x meets them: only those that it meets at the same time
    // can cross.
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| range(*a, 0).0.total_cmp(&range(*b, 0).0));
    for (place, side) in order.iter().enumerate() {
        let end = range(*side, 0).1;
        let (low, high) = range(*side, 1);
        for other in order[place + 1..].iter().take_while(|other| range(**other, 0).0 <= end) {
            let (other_low, other_high) = range(*other, 1);
            if other_low <= high
                && low <= other_high
                && (cross(ends(*side), ends(*other), touch)
                    || crosses_at_start(points, *side, *other, touch)
                    || crosses_at_start(points, *other, *side, touch))
            {
                return Some((*side.min(other), *side.max(other)));
            }
        }
    }
    None
}

/// Whether two sides cross, each between the ends of the other and by more than `touch`.
fn cross([a, b]: [Point; 2], [c, d]: [Point; 2], touch: f64) -> bool {
    let (to_c, to_d) = (orientation(a, b, c), orientation(a, b, d));
    let (to_a, to_b) = (orientation(c, d, a), orientation(c, d, b));
    let (deep, other_deep) = (touch * distance(a, b), touch * distance(c, d));
    opposite(to_c, to_d, deep) && opposite(to_a, to_b, other_deep)
}

/// Whether the boundary crosses the side that begins at `other` where `side` begins: at a corner that lies within
/// the other side, or on its first end.
fn crosses_at_start(points: &[Point], side: usize, other: usize, touch: f64) -> bool {
    let count = points.len();
    let around = |corner: usize| {
        let [before, after] = [(corner + count - 1) % count, (corner + 1) % count];
        [points[before], points[corner], points[after]]
    };
    let ([before, corner, after], [before_other, c, d]) = (around(side), around(other));
    if corner == c {
        // Crossing is mutual, so that one order of the two sides is enough.
        let inside = |point| in_sector([before, corner, after], point);
        return match (inside(before_other), inside(d)) {
            (Some(one), Some(two)) => one != two,
            // Along one of the sides: the boundary runs beside itself.
            _ => false,
        };
    }
    let within = orientation(c, d, corner) == 0.0
        && corner != d
        && (0..2).all(|axis| (c[axis].min(d[axis])..=c[axis].max(d[axis])).contains(&corner[axis]));
    let deep = touch * distance(c, d);
    within && opposite(orientation(c, d, before), orientation(c, d, after), deep)
}

/// Whether the direction from `corner` to `point` is to the left of the way from `before` over `corner` to `after`,
/// where a polygon that is walked counter-clockwise has its inside; `None` along one of the two.
pub(super) fn in_sector([before, corner, after]: [Point; 3], point: Point) -> Option<bool> {
    let along = |end: Point| {
        let u = [end[0] - corner[0], end[1] - corner[1]];
        let v = [point[0] - corner[0], point[1] - corner[1]];
        orientation(corner, end, point) == 0.0 && u[0] * v[0] + u[1] * v[1] >= 0.0
    };
    if along(before) || along(after) {
        return None;
    }
    let left_of_way_out = orientation(corner, after, point) > 0.0;
    let left_of_way_in = orientation(before, corner, point) > 0.0;
    Some(if orientation(before, corner, after) > 0.0 {
        left_of_way_in && left_of_way_out
    } else {
        left_of_way_in || left_of_way_out
    })
}

/// Whether two triangles, walked counter-clockwise, overlap by more than `touch`: by these also a boundary is found
/// out that runs along itself and leaves to the other side, or goes round twice.
pub(super) fn overlap(points: &[Point], triangles: &[[usize; 3]], touch: f64) -> bool {
    let mut all: Vec<[Point; 3]> = triangles.iter().map(|ear| ear.map(|i| points[i])).collect();
    all.retain(|[a, b, c]| orientation(*a, *b, *c) > 0.0);
    let range = |triangle: &[Point; 3], axis: usize| {
        let values = triangle.map(|corner| corner[axis]);
        (values[0].min(values[1]).min(values[2]), values[0].max(values[1]).max(values[2]))
    };
    all.sort_by(|a, b| range(a, 0).0.total_cmp(&range(b, 0).0));
    all.iter().enumerate().any(|(place, one)| {
        let (end, (low, high)) = (range(one, 0).1, range(one, 1));
        let beside = all[place + 1..].iter().take_while(|other| range(other, 0).0 <= end);
        let mut met = beside.filter(|other| {
            let (other_low, other_high) = range(other, 1);
            other_low <= high && low <= other_high
        });
        met.any(|other| !parts(one, other, touch) && !parts(other, one, touch))
    })
}

/// Whether a side of the first triangle has the second one on its outer side.
fn parts(one: &[Point; 3], other: &[Point; 3], touch: f64) -> bool {
    (0..3).any(|side| {
        let (from, to) = (one[side], one[(side + 1) % 3]);
        let most = touch * distance(from, to);
        other.iter().all(|corner| orientation(from, to, *corner) <= most)
    })
}

fn opposite(a: f64, b: f64, deep: f64) -> bool {
    (a > deep && b < -deep) || (a < -deep && b > deep)
}
