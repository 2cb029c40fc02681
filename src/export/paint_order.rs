//! The painter's algorithm: solids are painted from the farthest to the nearest, so that each covers what
//! it hides (M. E. Newell, R. G. Newell and T. L. Sancha 1972).

use super::solid::Solid;
use super::vector::dot;
use super::view::View;

/// How far, in the scene's unit, a point may lie on the inner side of a face and still be outside by
/// rounding.
const MARGIN: f64 = 1e-9;

/// The order in which solids are painted, as indices of `solids`.
///
/// Of two solids that overlap in the picture, the farther one comes first if a face of the box around
/// either separates them. All other pairs, and solids that hide one another in a cycle, are ordered by
/// the mean distance of their points from the eye.
pub(super) fn paint_order(view: &View, solids: &[&Solid]) -> Vec<usize> {
    let frames: Vec<Frame> = solids.iter().map(|solid| frame_px(view, solid)).collect();
    let depth: Vec<f64> = solids
        .iter()
        .map(|solid| {
            let sum: f64 = solid.points.iter().map(|p| dot(view.toward, *p)).sum();
            sum / solid.points.len() as f64
        })
        .collect();
    // Per solid, those that must be painted after it, and how many must still be painted before it.
    let mut painted_after = vec![Vec::new(); solids.len()];
    let mut waits_for = vec![0usize; solids.len()];
    for a in 0..solids.len() {
        for b in a + 1..solids.len() {
            if !overlap(&frames[a], &frames[b]) {
                continue;
            }
            let nearer = nearer(view, solids[a], solids[b]);
            if nearer > 0.0 {
                painted_after[b].push(a);
                waits_for[a] += 1;
            } else if nearer < 0.0 {
                painted_after[a].push(b);
                waits_for[b] += 1;
            }
        }
    }
    let mut left: Vec<usize> = (0..solids.len()).collect();
    let mut order = Vec::new();
    while !left.is_empty() {
        let place = (0..left.len())
            .min_by(|i, j| {
                let (i, j) = (left[*i], left[*j]);
                let ready = (waits_for[i] > 0).cmp(&(waits_for[j] > 0));
                ready.then(depth[i].total_cmp(&depth[j])).then(i.cmp(&j))
            })
            .expect("some are left");
        let next = left.remove(place);
        for later in &painted_after[next] {
            waits_for[*later] = waits_for[*later].saturating_sub(1);
        }
        order.push(next);
    }
    order
}

/// An axis-aligned rectangle in the picture, in pixels: its least and its largest corner.
type Frame = [[f64; 2]; 2];

fn overlap(a: &Frame, b: &Frame) -> bool {
    (0..2).all(|axis| a[0][axis] <= b[1][axis] && b[0][axis] <= a[1][axis])
}

fn frame_px(view: &View, solid: &Solid) -> Frame {
    let mut frame = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for point in &solid.points {
        let at = view.px(*point);
        for axis in 0..2 {
            frame[0][axis] = frame[0][axis].min(at[axis]);
            frame[1][axis] = frame[1][axis].max(at[axis]);
        }
    }
    frame
}

/// Positive where `a` is nearer to the eye than `b`, negative where `b` is, 0 where no face separates
/// them. Where several do, the face that looks most directly at or away from the eye decides.
fn nearer(view: &View, a: &Solid, b: &Solid) -> f64 {
    let mut best = 0.0f64;
    for (solid, other, sign) in [(a, b, -1.0), (b, a, 1.0)] {
        for (normal, offset) in &solid.planes {
            let squarely = dot(*normal, view.toward) * sign;
            if squarely.abs() > best.abs()
                && other.points.iter().all(|p| dot(*normal, *p) >= offset - MARGIN)
            {
                best = squarely;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::solid::solids;
    use crate::export::view::Direction;
    use crate::scene::{Body, Pose, Shape};

    fn block(size: [f64; 3], translation: [f64; 3], view: &View) -> Solid {
        let pose = Pose { translation, ..Pose::IDENTITY };
        let body = Body { shape: Shape::Box { size }, pose, solid: true };
        solids(&body, &Pose::IDENTITY, view).remove(0)
    }

    /// The middle of the plate is nearer to the eye than the block, which is painted later all the same: the plate's
    /// upper face separates the two.
    #[test]
    fn a_block_on_a_plate_is_painted_after_the_plate() {
        let view = View::new(Some(Direction::default()), &[[0.0; 3], [10.0; 3]]);
        let [x, y, _] = view.toward;
        let plate = block([20.0, 20.0, 0.1], [4.0 * x, 4.0 * y, -0.05], &view);
        let on_it = block([1.0; 3], [0.0, 0.0, 0.5], &view);
        let depth = |solid: &Solid| solid.points.iter().map(|p| dot(view.toward, *p)).sum::<f64>();
        assert!(depth(&plate) > depth(&on_it));
        assert_eq!(paint_order(&view, &[&plate, &on_it]), [0, 1]);
        assert_eq!(paint_order(&view, &[&on_it, &plate]), [1, 0]);
    }

    /// Where nothing overlaps in the picture, the farther one is painted first.
    #[test]
    fn blocks_beside_each_other_are_painted_by_depth() {
        let view = View::new(Some(Direction::default()), &[[0.0; 3], [10.0; 3]]);
        let place = |right: f64, toward: f64| {
            let at = [0, 1, 2].map(|i| right * view.right[i] + toward * view.toward[i]);
            block([1.0; 3], at, &view)
        };
        let (near, far) = (place(-5.0, 3.0), place(5.0, -3.0));
        assert_eq!(paint_order(&view, &[&near, &far]), [1, 0]);
        assert_eq!(paint_order(&view, &[&far, &near]), [0, 1]);
    }
}
