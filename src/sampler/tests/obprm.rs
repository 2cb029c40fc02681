//! Samplers that walk or lie on the surface of obstacles: OBPRM and UOBPRM.

use super::statistics::{fits, follows};
use super::{context, plane, points, sampler, sets};
use crate::math;
use crate::model::Scratch;

/// Distance of a point outside of a box from its surface, and the number of the side it is nearest to:
/// left, right, bottom, top.
fn beside([x, y]: [f64; 2], [left, bottom, width, height]: [f64; 4]) -> (f64, usize) {
    let gaps = [left - x, x - left - width, bottom - y, y - bottom - height];
    let (side, _) = gaps.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
    let outside = |low: f64, high: f64| low.max(high).max(0.0);
    let (dx, dy) = (outside(gaps[0], gaps[1]), outside(gaps[2], gaps[3]));
    ((dx * dx + dy * dy).sqrt(), side)
}

/// From a uniform point in a box, in a uniform direction: a walk leaves by a side with the probability of
/// the angle under which the point sees it.
#[test]
fn obprm_leaves_a_box_by_the_sides_that_its_law_says_and_stays_near() {
    let obstacle = [3.0, 4.0, 2.0, 1.0];
    let cx = plane(8.0, 9.0, &[obstacle]);
    let text = "obprm = { start = \"colliding\", step = 0.32, halvings = 5 }";
    let mut counts = [0; 4];
    for point in points(&cx, text, 4000) {
        let (distance, side) = beside(point, obstacle);
        assert!(distance > 0.0 && distance <= 0.01, "{point:?}");
        counts[side] += 1;
    }
    let mut seen = [0.0; 4];
    let steps = 100;
    for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
        let share = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
        let (x, y) = (2.0 * share(i), share(j));
        let under = |far: f64, a: f64, b: f64| math::atan2(a, far) + math::atan2(b, far);
        let angles = [
            under(x, y, 1.0 - y),
            under(2.0 - x, y, 1.0 - y),
            under(y, x, 2.0 - x),
            under(1.0 - y, x, 2.0 - x),
        ];
        for (seen, angle) in seen.iter_mut().zip(angles) {
            *seen += angle;
        }
    }
    fits(&counts, &seen);
}

/// A ball among free space, seen from all sides: by symmetry the milestones of both directions are uniform
/// on its surface, so each coordinate is (Archimedes).
#[test]
fn obprm_milestones_lie_on_a_ball() {
    let cx = context(
        "[space]\nmotion = \"translation-3d\"\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\n\
         bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n\
         [[obstacles]]\nshape = { sphere = { radius = 1.0 } }\n",
    );
    for (start, uniform) in [("colliding", true), ("free", false), ("either", false)] {
        let text = format!("obprm = {{ start = \"{start}\", step = 0.128, halvings = 5 }}");
        let configs = sets(&cx, &sampler(&text), 0..1, 2000, &mut Scratch::new());
        let mut octants = [0; 8];
        for q in configs.iter() {
            let far = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt() - 1.0;
            assert!(far > 0.0 && far <= 0.004, "{start}: {far}");
            octants[(0..3).map(|i| usize::from(q[i] > 0.0) << i).sum::<usize>()] += 1;
        }
        fits(&octants, &[1.0; 8]);
        // Not so from the free side, where the corners of the room see the ball more often.
        if uniform {
            follows(configs.iter().map(|q| q[2]).collect(), |z| (z + 1.0) / 2.0);
        }
    }
}

/// With bounds that count as obstacles free configurations also walk up to the bounds.
#[test]
fn obprm_milestones_lie_at_bounds_that_count_as_obstacles() {
    let cx = plane(4.0, 4.0, &[]);
    let text = "obprm = { step = 0.128, halvings = 7, bounds = true }";
    let mut sides = [0; 4];
    for [x, y] in points(&cx, text, 1000) {
        let gaps = [x, 4.0 - x, y, 4.0 - y];
        let (side, gap) = gaps.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert!((0.0..=0.001).contains(gap), "{x} {y}");
        sides[side] += 1;
    }
    fits(&sides, &[1.0; 4]);
}

/// Uniform on the surface: as many milestones as the sides are long, each within a step of it, and evenly
/// along the long side, although the box stands closer to the bounds than a segment is long.
#[test]
fn uobprm_milestones_are_uniform_on_a_surface() {
    let obstacle = [0.2, 4.0, 4.0, 2.0];
    let cx = plane(8.0, 9.0, &[obstacle]);
    let found = points(&cx, "uobprm = { length = 1.0, step = 0.02 }", 3000);
    let mut counts = [0; 4];
    let mut along = Vec::new();
    for point in found {
        let (distance, side) = beside(point, obstacle);
        assert!(distance > 0.0 && distance <= 0.02, "{point:?}");
        counts[side] += 1;
        // The ends, where what is kept may stand beside the corner, are left out.
        let share = (point[0] - 0.3) / 3.8;
        if side > 1 && (0.0..1.0).contains(&share) {
            along.push(share);
        }
    }
    fits(&counts, &[2.0, 2.0, 4.0, 4.0]);
    follows(along, |share| share);
}
