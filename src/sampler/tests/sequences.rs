//! Samplers whose sets share out one sequence of points: Halton and grid.

use super::statistics::follows;
use super::{context, plane, sampler, sets};
use crate::math;
use crate::model::Scratch;
use std::f64::consts::PI;

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
