//! The distributions of samplers whose law is known: Kolmogorov–Smirnov and chi-square at level 0.001 over
//! fixed seeds, and counts that are exact.

use super::tests::{context, sampler, sets};
use super::*;
use crate::math;
use crate::seed::{Purpose, Seed};
use crate::space::{Motion, rigid_space};
use std::f64::consts::PI;

/// A point in the plane, in a box from the origin, among boxes given as x, y, width, height.
pub(super) fn plane(width: f64, height: f64, boxes: &[[f64; 4]]) -> Context {
    let mut scene = format!(
        "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [{width}, {height}]\n\
         bounds = \"reference\"\n[robot]\nbodies = [{{ shape = {{ point = {{}} }} }}]\n"
    );
    for [x, y, width, height] in boxes {
        scene += &format!(
            "[[obstacles]]\nshape = {{ box = {{ size = [{width}, {height}, 1] }} }}\n\
             position = [{}, {}, 0]\n",
            x + width / 2.0,
            y + height / 2.0
        );
    }
    context(&scene)
}

pub(super) fn points(cx: &Context, text: &str, count: usize) -> Vec<[f64; 2]> {
    let configs = sets(cx, &sampler(text), 0..1, count, &mut Scratch::new());
    configs.iter().map(|q| [q[0], q[1]]).collect()
}

/// Kolmogorov and Smirnov: the sample has the distribution function `law`.
pub(super) fn follows(mut sample: Vec<f64>, law: impl Fn(f64) -> f64) {
    sample.sort_by(f64::total_cmp);
    let n = sample.len() as f64;
    let gap = sample.iter().enumerate().fold(0.0f64, |gap, (i, x)| {
        let law = law(*x);
        gap.max((law - i as f64 / n).abs()).max((law - (i as f64 + 1.0) / n).abs())
    });
    assert!(n >= 1000.0 && gap < 1.95 / n.sqrt(), "gap {gap} of {n}");
}

/// Chi-square: the counts come from the probabilities.
pub(super) fn fits(counts: &[usize], probabilities: &[f64]) {
    let n: usize = counts.iter().sum();
    let whole: f64 = probabilities.iter().sum();
    let square: f64 = counts
        .iter()
        .zip(probabilities)
        .map(|(count, probability)| {
            let expected = n as f64 * probability / whole;
            assert!(expected > 5.0);
            (*count as f64 - expected) * (*count as f64 - expected) / expected
        })
        .sum();
    // The quantile 0.999 (E. B. Wilson, M. M. Hilferty 1931).
    let freedom = counts.len() as f64 - 1.0;
    let share = 2.0 / (9.0 * freedom);
    let root = 1.0 - share + 3.09 * share.sqrt();
    let most = freedom * root * root * root;
    assert!(square < most, "{square} of {most}: {counts:?} for {probabilities:?}");
}

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

/// Of a uniform point of the unit sphere every coordinate is uniform (Archimedes); here x, y and the turn,
/// in the metric.
#[test]
fn directions_are_uniform_in_the_metric() {
    let space = rigid_space(Motion::Rigid2d, [0.0; 3], [1.0; 3], 0.4);
    let mut stream = Seed::of_set(3, "directions", 0).stream(Purpose::Sampling);
    let mut coordinates = [(); 3].map(|()| Vec::new());
    for _ in 0..4000 {
        let mut q = [0.0; 3];
        space.step(&[0.0; 3], 1.0, &mut stream, &mut q);
        let shares = [q[0], q[1], 0.4 * q[2]];
        coordinates.iter_mut().zip(shares).for_each(|(sample, share)| sample.push(share));
    }
    coordinates.into_iter().for_each(|sample| follows(sample, |share| (share + 1.0) / 2.0));
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

/// Of 8 · 9 consecutive points each of 8 by 9 boxes holds one, over the union of the sets.
#[test]
fn halton_points_fill_boxes_evenly_over_the_union_of_sets() {
    let cx = plane(8.0, 9.0, &[]);
    for (ordinals, block) in [(0..6, 12), (5..14, 8), (1 << 40..(1 << 40) + 72, 1)] {
        let kind = sampler(&format!("halton = {{ block = {block} }}"));
        let configs = sets(&cx, &kind, ordinals, block, &mut Scratch::new());
        let mut boxes = [[0; 8]; 9];
        configs.iter().for_each(|q| boxes[q[1] as usize][q[0] as usize] += 1);
        assert_eq!(boxes, [[1; 8]; 9]);
    }
}

/// Star discrepancy in the square mean (T. T. Warnock 1972).
fn discrepancy(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mut single = 0.0;
    let mut pairs = 0.0;
    for p in points {
        single += p.iter().map(|x| (1.0 - x * x) / 2.0).product::<f64>();
        for other in points {
            pairs += p.iter().zip(other).map(|(a, b)| 1.0 - a.max(*b)).product::<f64>();
        }
    }
    (1.0 / 9.0 - 2.0 / n * single + pairs / (n * n)).sqrt()
}

/// Also where two thirds of the space are blocked, so that the sets pass over most points.
#[test]
fn halton_and_grid_sets_are_together_more_even_than_uniform_ones() {
    let blocked = [[1.0, 0.0, 2.0, 1.0]];
    for (width, obstacles) in [(1.0, &blocked[..0]), (3.0, &blocked[..])] {
        let cx = plane(width, 1.0, obstacles);
        let of = |text| {
            let configs = sets(&cx, &sampler(text), 0..24, 20, &mut Scratch::new());
            discrepancy(&configs.iter().map(|q| [q[0], q[1]]).collect::<Vec<_>>())
        };
        let uniform = of("uniform = {}");
        for text in ["halton = { block = 20 }", "grid = { cells = 22, block = 20 }"] {
            let even = of(text);
            assert!(even < uniform / 2.0, "{text}, width {width}: {even}, uniform {uniform}");
        }
    }
}

/// In every pass each cell is hit once, by a point that is uniform in it.
#[test]
fn grid_sets_together_hit_every_cell_equally() {
    let cx = plane(12.0, 12.0, &[]);
    let kind = sampler("grid = { cells = 12, block = 16 }");
    let configs = sets(&cx, &kind, 0..36, 16, &mut Scratch::new());
    for pass in 0..4 {
        let mut cells = [[0; 12]; 12];
        for q in configs.iter().skip(pass * 144).take(144) {
            cells[q[1] as usize][q[0] as usize] += 1;
        }
        assert_eq!(cells, [[1; 12]; 12]);
    }
    let places = configs.values().map(|value| value - value.floor());
    follows(places.collect(), |place| place);
}

/// Rotations are spread by the Haar measure: the angle θ has P(angle ≤ θ) = (θ − sin θ) / π.
#[test]
fn halton_and_grid_rotations_follow_the_haar_measure() {
    let cx = context(
        "[space]\nmotion = \"rigid-3d\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nbounds = \"reference\"\n\
         [robot]\nbodies = [{ shape = { box = { size = [1, 1, 1] } } }]\n",
    );
    for text in ["halton = {}", "grid = { cells = 4 }"] {
        let configs = sets(&cx, &sampler(text), 0..40, 50, &mut Scratch::new());
        let angles = configs.iter().map(|q| 2.0 * math::acos(q[3])).collect();
        follows(angles, |angle| (angle - math::sin(angle)) / PI);
    }
}

#[test]
fn mixed_samplers_have_their_weights_and_their_own_streams() {
    let Mix(shares) = Mix(vec![
        Share { weight: 1.0, sampler: sampler("uniform = {}") },
        Share { weight: 2.5, sampler: sampler("halton = {}") },
        Share { weight: 0.5, sampler: sampler("gaussian = { deviation = 0.3 }") },
    ]);
    let mix = Mix(shares.clone());
    let mut counts = [0; 3];
    for ordinal in 0..80 {
        let seed = Seed::of_set(7, "mix", ordinal);
        let drawn = mix.counts(&seed, 50);
        assert_eq!(drawn.iter().sum::<usize>(), 50);
        counts.iter_mut().zip(drawn).for_each(|(count, drawn)| *count += drawn);
    }
    fits(&counts, &[1.0, 2.5, 0.5]);

    let cx = plane(4.0, 4.0, &[[1.0, 1.0, 1.0, 1.0]]);
    let seed = Seed::of_set(7, "mix", 3);
    let (mut whole, mut parts) = (Configs::new(2), Configs::new(2));
    mix.sample(&cx, &seed, 50, &mut Scratch::new(), &mut whole).unwrap();
    for (index, (share, count)) in shares.iter().zip(mix.counts(&seed, 50)).enumerate() {
        let seed = seed.part(index as u64);
        let method = share.sampler.method();
        method.sample(&cx, &seed, count, &mut Scratch::new(), &mut parts).unwrap();
    }
    assert_eq!(whole, parts);
}
