//! The shortest way between two elements.

use super::element::Element;
use super::frame::Stance;
use super::meet::Meeting;
use super::triangles::nearest_points;
use parry3d_f64::math::Vector;
use parry3d_f64::query::ClosestPoints;
use parry3d_f64::query::details::closest_points_support_map_support_map;

/// The shortest way between two elements, in the frame of the one that stands still.
pub(super) struct ShortestWay {
    /// 0 where they meet.
    pub distance: f64,
    pub on_mover: Vector,
    pub on_still: Vector,
    /// From the one that stands still to the other, of unit length: along it they are apart by the
    /// distance. Zero where they meet.
    pub axis: Vector,
}

impl ShortestWay {
    /// From the nearest points of what is inside, and how much thicker the two are.
    fn between((p, q): (Vector, Vector), thick: f64, other_thick: f64) -> ShortestWay {
        let between = (p - q).length();
        let axis = if between > 0.0 { (p - q) / between } else { Vector::ZERO };
        let on_mover = p - axis * thick.min(between);
        let distance = between - thick - other_thick;
        if distance <= 0.0 {
            return ShortestWay { distance: 0.0, on_mover, on_still: on_mover, axis: Vector::ZERO };
        }
        ShortestWay { distance, on_mover, on_still: q + axis * other_thick, axis }
    }
}

impl Meeting<'_> {
    /// The shortest way between an element that has its corners at `corners` and one that stands still.
    pub fn nearest(
        &self,
        (element, corners): (&Element, &[Vector; 3]),
        other: &Element,
        stance: &Stance,
    ) -> ShortestWay {
        let nearest = nearest_points(self.lanes, corners, &other.corners);
        let round = ShortestWay::between(nearest, element.radius, other.radius);
        if element.flat || other.flat {
            self.nearest_flat(element, other, stance, round)
        } else {
            round
        }
    }

    /// Of two elements of which one is a cylinder; `round` is what it would be, were it a capsule.
    fn nearest_flat(
        &self,
        element: &Element,
        other: &Element,
        stance: &Stance,
        round: ShortestWay,
    ) -> ShortestWay {
        let (at, other_at) = (stance.pose(Some(self.mover_link)), stance.pose(self.still_link));
        let (hull, other_hull) = (element.triangle(), other.triangle());
        let (one, one_at, thick) = self.mover.support(element, &hull, &at);
        let (two, two_at, other_thick) = self.still.support(other, &other_hull, &other_at);
        let between = one_at.inv_mul(&two_at);
        let found = closest_points_support_map_support_map(&between, one, two, f64::MAX);
        let ClosestPoints::WithinMargin(p, q) = found else {
            return ShortestWay { distance: 0.0, axis: Vector::ZERO, ..round };
        };
        let (p, q) = (one_at.transform_point(p), two_at.transform_point(q));
        let nearest = (other_at.inverse_transform_point(p), other_at.inverse_transform_point(q));
        let way = ShortestWay::between(nearest, thick, other_thick);
        // What a capsule is apart, the cylinder within it is too.
        ShortestWay { distance: way.distance.max(round.distance), ..way }
    }
}
