//! Samplers that draw pairs of configurations: Gaussian and bridge test.

use super::statistics::follows;
use super::{plane, points};
use crate::math;

/// P(|d cos φ| > x) for d normal with deviation 1 and φ uniform: the share of pairs in the plane whose
/// second configuration lies more than x beyond the first in a given direction or its opposite. By the
/// midpoint rule over d.
fn reaches(x: f64) -> f64 {
    let steps = 400;
    let sum = (0..steps).map(|i| {
        let d = x + (f64::from(i) + 0.5) * 6.0 / f64::from(steps);
        math::exp(-d * d / 2.0) * math::acos(x / d)
    });
    sum.sum::<f64>() * 6.0 / f64::from(steps)
}

/// The distribution function whose density is proportional to `density` on 0 to `most`, by the midpoint
/// rule and linear between.
fn integrated(most: f64, density: impl Fn(f64) -> f64) -> impl Fn(f64) -> f64 {
    let steps = 400;
    let mut sums = vec![0.0];
    for i in 0..steps {
        sums.push(sums[i] + density((i as f64 + 0.5) * most / steps as f64));
    }
    move |x| {
        let place = (x / most).clamp(0.0, 1.0) * steps as f64;
        let below = (place as usize).min(steps - 1);
        (sums[below] + (sums[below + 1] - sums[below]) * (place - below as f64)) / sums[steps]
    }
}

/// A half space is free, the rest an obstacle: what the Gaussian sampler does near a wide flat wall
/// depends on the distance from it alone. A pair with its free end at distance x is kept with the
/// probability that the other lies beyond the wall.
#[test]
fn gaussian_milestones_have_the_distances_from_a_wall_that_the_law_says() {
    let cx = plane(20.0, 20.0, &[[10.0, 0.0, 10.0, 20.0]]);
    let found = points(&cx, "gaussian = { deviation = 1.0 }", 4000);
    // Far from the other bounds, where pairs are dropped.
    let far = found.iter().filter(|[x, y]| (5.0..15.0).contains(y) && *x > 5.0);
    follows(far.map(|[x, _]| 10.0 - x).collect(), integrated(5.0, reaches));
}

/// A passage of width 1 between two half spaces. The middle of a pair is uniform like its ends; at x from
/// one wall and 1 − x from the other it is kept if half the pair reaches the farther one, on either side.
#[test]
fn bridge_milestones_have_the_places_in_a_passage_that_the_law_says() {
    let cx = plane(21.0, 20.0, &[[0.0, 0.0, 10.0, 20.0], [11.0, 0.0, 10.0, 20.0]]);
    let found = points(&cx, "bridge = { deviation = 1.0 }", 4000);
    assert!(found.iter().all(|[x, _]| (10.0..11.0).contains(x)));
    let far = found.iter().filter(|[_, y]| (5.0..15.0).contains(y));
    let law = integrated(1.0, |x| reaches(2.0 * x.max(1.0 - x)));
    follows(far.map(|[x, _]| x - 10.0).collect(), law);
}
