//! The origins from which trees of boxes take their coordinates in single precision.

use super::element::Element;
use parry3d_f64::math::Vector;

/// The origin of the obstacles: the middle of what is small among them, since large boxes need no fine coordinates, but
/// not outside of the box from `low` to `high`, in which the robot is.
///
/// The middle is the weighted median along each axis, an element's weight being one by its size. A ground plate that is a
/// million times larger than the other obstacles counts for nothing beside them, wherever its own middle is.
pub(super) fn among(elements: &[Element], [low, high]: [Vector; 2]) -> Vector {
    let sized = elements.iter().map(|element| {
        let [a, b, c] = element.corners;
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        let size = (most - least).max_element() + element.radius;
        let weight = if size > 0.0 { 1.0 / size } else { 0.0 };
        ((least + most).to_array(), weight)
    });
    let sized: Vec<([f64; 3], f64)> = sized.collect();
    let whole: f64 = sized.iter().map(|(_, weight)| weight).sum();
    let median = [0, 1, 2].map(|axis: usize| {
        let mut along: Vec<(f64, f64)> =
            sized.iter().map(|(sum, weight)| (0.5 * sum[axis], *weight)).collect();
        along.sort_unstable_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut before = 0.0;
        let at = along.iter().find(|(_, weight)| {
            before += weight;
            2.0 * before >= whole
        });
        at.map_or(0.0, |(at, _)| *at)
    });
    Vector::from_array(median).clamp(low, high)
}

#[cfg(test)]
mod tests {
    use super::super::element::elements;
    use super::super::tests::cuboid;
    use super::*;

    #[test]
    fn the_origin_is_among_the_small_obstacles_and_near_the_robot() {
        let small = (0..5).map(|i| cuboid([0.1; 3], [7e5 + f64::from(i), 2.0, 0.0]));
        let plate = cuboid([4e6, 4e6, 1.0], [0.0, 0.0, -1.0]);
        let bodies: Vec<_> = small.chain([plate]).collect();
        let elements: Vec<Element> =
            bodies.iter().enumerate().flat_map(|(i, body)| elements(body, i as u32)).collect();
        let everywhere = [Vector::splat(-1e7), Vector::splat(1e7)];
        let origin = among(&elements, everywhere);
        assert!((origin - Vector::new(7e5 + 2.0, 2.0, 0.0)).length() < 0.2, "{origin:?}");
        let plate_alone = &elements[5 * 12..];
        let beside = [Vector::splat(3e5), Vector::splat(3e5 + 1.0)];
        assert!(among(plate_alone, beside).cmpge(beside[0]).all());
        assert!(among(plate_alone, beside).cmple(beside[1]).all());
    }
}
