//! Where segments meet surfaces.

use super::element::Round;
use parry3d_f64::math::Vector;

/// How far outside a triangle a segment may pass to meet it still, as a share of the triangle, so that none slips through between
/// two neighbours.
const EDGE: f64 = 1e-12;

/// Whether the segment meets a box, up to rounding; what is next to it counts as meeting.
pub(super) fn line_meets_box(from: Vector, to: Vector, low: Vector, high: Vector) -> bool {
    let (centre, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let (way, middle) = ((to - from) / 2.0, (from + to) / 2.0 - centre);
    let reach = half + Vector::splat(1e-12 * (centre.abs() + half + middle.abs()).max_element());
    // The separating axes across the segment (C. Ericson, Real-time collision detection, 2005, section 5.3.3).
    let (across, size) = (middle.cross(way).abs(), way.abs());
    across.x <= reach.y * size.z + reach.z * size.y
        && across.y <= reach.x * size.z + reach.z * size.x
        && across.z <= reach.x * size.y + reach.y * size.x
}

/// The share of the segment at which it crosses a triangle (T. Möller, B. Trumbore, *Fast, minimum storage ray–triangle
/// intersection*, 1997). A segment in the triangle's plane crosses none: the triangles beside it on a closed surface tell.
pub(super) fn facet(from: Vector, to: Vector, [a, b, c]: &[Vector; 3]) -> Option<f64> {
    let (way, u, v) = (to - from, *b - *a, *c - *a);
    let across = way.cross(v);
    let volume = u.dot(across);
    if volume == 0.0 {
        return None;
    }
    let start = from - *a;
    let one = start.dot(across) / volume;
    let turned = start.cross(u);
    let other = way.dot(turned) / volume;
    let share = v.dot(turned) / volume;
    let inside = one >= -EDGE && other >= -EDGE && one + other <= 1.0 + EDGE;
    (inside && (-EDGE..=1.0 + EDGE).contains(&share)).then(|| share.clamp(0.0, 1.0))
}

/// The shares of the segment, in the shape's frame, at which it enters a round shape and leaves it.
pub(super) fn round(from: Vector, to: Vector, round: &Round) -> [Option<f64>; 2] {
    let way = to - from;
    let mut within = Span::NONE;
    // The line within the side, and, at round ends, within the balls: the shape is convex, so that the line is within it between the
    // least and the greatest of these.
    if round.flat.is_some() || round.half > 0.0 {
        let flat = |p: Vector| Vector::new(p.x, p.y, 0.0);
        let side = Span::within_ball(flat(from), flat(way), round.radius);
        within = side.and(Span::between(from.z, way.z, round.half));
    }
    if round.flat.is_none() {
        for end in [-round.half, round.half] {
            within = within.or(Span::within_ball(from - Vector::Z * end, way, round.radius));
        }
    }
    let on_segment = |share: f64| (0.0..=1.0).contains(&share).then_some(share);
    if within.first > within.last {
        return [None; 2];
    }
    [on_segment(within.first), on_segment(within.last)]
}

/// A part of a line, from a share of a segment to another; none, if the first is the greater.
#[derive(Clone, Copy)]
struct Span {
    first: f64,
    last: f64,
}

impl Span {
    const NONE: Span = Span { first: f64::INFINITY, last: f64::NEG_INFINITY };
    const ALL: Span = Span { first: f64::NEG_INFINITY, last: f64::INFINITY };

    /// Where `from + share · way` is within a ball, or a disc, about the origin.
    fn within_ball(from: Vector, way: Vector, radius: f64) -> Span {
        let (a, b) = (way.length_squared(), from.dot(way));
        if a <= 0.0 {
            let inside = from.length_squared() <= radius * radius;
            return if inside { Span::ALL } else { Span::NONE };
        }
        let nearest = from - way * (b / a);
        let left = radius * radius - nearest.length_squared();
        if left < 0.0 {
            return Span::NONE;
        }
        let reach = (left / a).sqrt();
        Span { first: -b / a - reach, last: -b / a + reach }
    }

    /// Where `from + share · way` is no larger than `half`.
    fn between(from: f64, way: f64, half: f64) -> Span {
        if way == 0.0 {
            return if from.abs() <= half { Span::ALL } else { Span::NONE };
        }
        let (one, other) = ((-half - from) / way, (half - from) / way);
        Span { first: one.min(other), last: one.max(other) }
    }

    fn and(self, other: Span) -> Span {
        let both = Span { first: self.first.max(other.first), last: self.last.min(other.last) };
        if both.first > both.last { Span::NONE } else { both }
    }

    fn or(self, other: Span) -> Span {
        Span { first: self.first.min(other.first), last: self.last.max(other.last) }
    }
}
