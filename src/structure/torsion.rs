use super::Point;
use crate::math;

/// The torsion angle of four points in radians, in [−π, π), positive where the far bond is turned clockwise as seen along
/// the middle one (IUPAC-IUB 1970).
pub fn torsion(a: &Point, b: &Point, c: &Point, d: &Point) -> f64 {
    let (first, middle, last) = (b - a, c - b, d - c);
    let (n1, n2) = (first.cross(&middle), middle.cross(&last));
    math::wrap_angle(math::atan2(middle.norm() * first.dot(&n2), n1.dot(&n2)))
}
