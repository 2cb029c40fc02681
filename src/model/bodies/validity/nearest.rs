//! The distance between two elements, and their nearest points.

use super::convex;
use super::element::Element;
use super::frame::Stance;
use super::meet::Meeting;
use super::triangles::nearest_points;
use parry3d_f64::math::Vector;

/// The shortest segment between two elements, in the frame of the standing one.
pub(super) struct ShortestWay {
    /// Its length; 0 where the elements meet.
    pub distance: f64,
    pub on_mover: Vector,
    pub on_still: Vector,
    /// A unit vector from the standing element towards the moving one, a separating axis along which the gap is the
    /// distance; zero where they meet.
    pub axis: Vector,
}

impl ShortestWay {
    /// From the nearest points of two hulls, given that the elements reach `thick` and `other_thick` beyond them.
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
    /// The shortest segment between an element of the moving group, with its corners at `corners` as seen from the
    /// standing group, and an element of the standing group.
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

    /// The same where one of the two, or both, is a cylinder; `round` is the answer for the capsules around them.
    fn nearest_flat(
        &self,
        element: &Element,
        other: &Element,
        stance: &Stance,
        round: ShortestWay,
    ) -> ShortestWay {
        let (at, other_at) = (stance.pose(Some(self.mover_link)), stance.pose(self.still_link));
        let (one, one_at, thick) = self.mover.support(element, &at);
        let (two, two_at, other_thick) = self.still.support(other, &other_at);
        let Some((p, q)) = convex::nearest((&one, &one_at), (&two, &two_at)) else {
            return ShortestWay { distance: 0.0, axis: Vector::ZERO, ..round };
        };
        let nearest = (other_at.inverse_transform_point(p), other_at.inverse_transform_point(q));
        let way = ShortestWay::between(nearest, thick, other_thick);
        // A cylinder is at least as far away as the capsule around it.
        ShortestWay { distance: way.distance.max(round.distance), ..way }
    }
}
