use crate::model::bodies::validity::{Bounds, BoundsMeaning};
use crate::scene::{Body, Pose, Shape};

/// Bodies that keep a deformed robot within its bounds, as obstacles do: a box beyond each of their sides. None where the bounds hold the
/// robot's reference point alone.
///
/// The boxes begin farther out than the bounds by `clearance`, which shapes keep from obstacles, so that a shape may come up to the bounds
/// themselves. `axes` is along how many axes the robot is bounded, `reach` how far the robot reaches from its reference point at most. As long as that
/// point is within the bounds the robot is not beyond a box.
pub(super) fn sides(bounds: &Bounds, axes: usize, clearance: f64, reach: f64) -> Vec<Body> {
    if bounds.meaning != BoundsMeaning::Body {
        return Vec::new();
    }
    let extents = [0, 1, 2].map(|axis| match axis < axes {
        true => bounds.max[axis] - bounds.min[axis],
        false => 0.0,
    });
    let middle = [0, 1, 2].map(|axis| match axis < axes {
        true => bounds.min[axis] + extents[axis] / 2.0,
        false => 0.0,
    });
    let thickness = 2.0 * (reach + clearance) + extents.into_iter().fold(0.0, f64::max);
    let side = |axis: usize, sign: f64| {
        let mut size = extents.map(|extent| extent + 4.0 * thickness);
        size[axis] = thickness;
        let mut translation = middle;
        translation[axis] += sign * (extents[axis] / 2.0 + clearance + thickness / 2.0);
        Body {
            shape: Shape::Box { size },
            pose: Pose { translation, ..Pose::IDENTITY },
            solid: true,
        }
    };
    (0..axes).flat_map(|axis| [side(axis, -1.0), side(axis, 1.0)]).collect()
}
