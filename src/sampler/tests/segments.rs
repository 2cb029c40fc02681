//! The law of the uniform sampling framework: crossings are uniform by area in the space's metric, as far as segments may start
//! wherever they reach the surface from.

use super::{context, plane, sampler, sets, statistics};
use crate::context::Context;
use crate::internal::wire;
use crate::math;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::roadmap::Configs;
use crate::sampler::segments::Segments;
use crate::sampler::segments::obstacle_surface::{ObstacleSurface, starts_near_obstacles};
use crate::sampler::{SamplerKind, Uobprm};
use crate::seed::{Purpose, Seed};
use crate::space::Space;
use crate::uniformity::{Hotelling, Shares};
use statistics::{fits, follows};
use std::collections::VecDeque;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A block near the left bound.
const BLOCK: [f64; 4] = [0.2, 4.0, 4.0, 2.0];
const LENGTH: f64 = 1.0;

/// The test of 40 runs of segments with these starts: that each side of the block is hit as often as it is long.
fn test_of_sides(cx: &Context, starts: &Space) -> Hotelling {
    let space = &cx.space;
    let segments =
        Segments { space, starts: starts.clone(), length: LENGTH, step: 0.1, attempts: 100_000 };
    let runs: Vec<[usize; 4]> = (0..40)
        .map(|run| {
            let mut stream = Seed::of_set(7, "bounds", Ordinal(run)).stream(Purpose::Sampling);
            let (mut configs, mut scratch) = (Configs::new(2), Scratch::new());
            let mut target = ObstacleSurface::new(cx, false);
            let done = segments.sample(&mut target, &mut stream, 50, &mut scratch, &mut configs);
            assert_eq!(done, Ok(()));
            let mut counts = [0; 4];
            for q in configs.iter() {
                let [left, bottom, width, height] = BLOCK;
                let gaps =
                    [left - q[0], q[0] - left - width, bottom - q[1], q[1] - bottom - height];
                let (side, _) = gaps.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
                counts[side] += 1;
            }
            counts
        })
        .collect();
    Shares::of(&runs, &[2.0, 2.0, 4.0, 4.0]).unwrap().test.unwrap()
}

/// Segments have to start beyond the bounds. Algorithm 7 as it is printed keeps them within the bounds, as if nothing had been done.
#[test]
fn sides_near_the_bounds_are_hit_less_often_unless_segments_start_beyond_the_bounds() {
    let cx = plane(30.0, 9.0, &[BLOCK]);
    let touching = cx.model.touching_box().unwrap();
    let near = |found: f64, expected: f64| (found - expected).abs() < 1e-9;
    assert!(near(touching[0][0], 0.2) && near(touching[1][1], 6.0), "{touching:?}");

    let printed = cx.space.narrowed(touching, LENGTH);
    for unjust in [&cx.space, &printed] {
        let test = test_of_sides(&cx, unjust);
        assert!(test.probability < 1e-6, "{test:?}");
    }
    let widened = cx.space.widened(LENGTH);
    let adjusted = starts_near_obstacles(&cx, LENGTH, false);
    for just in [&widened, &adjusted] {
        let test = test_of_sides(&cx, just);
        assert!(test.probability > 0.001, "{test:?}");
    }
    // A sixth of the room is left.
    let size = |space: &Space| space.diameter();
    assert!(size(&adjusted) < 0.4 * size(&widened));
    // Where bounds are obstacles, surfaces are at the bounds as well.
    assert_eq!(starts_near_obstacles(&cx, LENGTH, true).factors(), widened.factors());
}

#[test]
fn adjusted_bounds_are_a_setting_that_changes_nothing_while_it_is_not_used() {
    let plain = Uobprm::new(0.8, 0.1);
    assert_eq!(wire::encode(&plain), wire::encode(&(0.8, 0.1, false, plain.attempts)));
    let bounded = Uobprm { bounds: true, ..plain.clone() };
    assert_eq!(wire::encode(&bounded), wire::encode(&(0.8, 0.1, true, plain.attempts)));
    for (text, is_said) in [
        ("uobprm = { length = 0.8, step = 0.1 }", false),
        ("uobprm = { length = 0.8, step = 0.1, adjusted_bounds = true }", true),
        ("uobprm = { length = 0.8, step = 0.1, bounds = true, adjusted_bounds = true }", true),
    ] {
        let sampler = sampler(text);
        assert_eq!(wire::decode::<SamplerKind>(&wire::encode(&sampler)).unwrap(), sampler);
        assert_eq!(toml::to_string(&sampler).unwrap().contains("adjusted"), is_said);
    }
    let mut bytes = wire::encode(&plain);
    bytes[16] = 4;
    assert!(wire::decode::<Uobprm>(&bytes).is_err());
    // The same law, by fewer segments.
    let cx = plane(30.0, 9.0, &[BLOCK]);
    let asked = |text: &str| {
        let mut scratch = Scratch::new();
        sets(&cx, &sampler(text), 0..1, 300, &mut scratch);
        scratch.take_asked().configurations as f64
    };
    let usual = asked("uobprm = { length = 1.0, step = 0.1 }");
    let adjusted = asked("uobprm = { length = 1.0, step = 0.1, adjusted_bounds = true }");
    assert!(adjusted < 0.4 * usual, "{adjusted} of {usual}");
}

/// The box in which the base touches obstacles, against collisions.
#[test]
fn outside_of_the_touching_box_nothing_collides() {
    let cx = context(super::SCENE);
    let [low, high] = cx.model.touching_box().unwrap();
    let mut stream = Seed::of_set(7, "touching", Ordinal(0)).stream(Purpose::Sampling);
    let (mut q, mut invalid) = (vec![0.0; 7], 0);
    for _ in 0..600 {
        cx.space.sample_uniform(&mut stream, &mut q);
        if !(0..3).all(|i| (low[i]..=high[i]).contains(&q[i])) {
            // The rod may leave the bounds, but touches nothing.
            let reasons = cx.model.reasons(&q, false);
            assert!(reasons.iter().all(|reason| !reason.to_string().contains("collides")));
            invalid += usize::from(!reasons.is_empty());
        }
    }
    assert!(invalid > 0);
}

/// A rod that turns in the plane before a wall. It touches the wall where its middle is at a distance h(θ) from it. The
/// surface is as long between two angles as the curve (h(θ), w θ), w being the weight of a turn in the metric.
#[test]
fn a_rod_that_turns_touches_a_wall_by_the_area_in_the_metric() {
    for weight in [0.3, 0.6] {
        let cx = context(&format!(
            "[space]\nmotion = \"rigid-2d\"\nmin = [0, 0]\nmax = [3, 3]\nbounds = \"reference\"\n\
             rotation_length = {weight}\n\
             [robot]\nbodies = [{{ shape = {{ box = {{ size = [1.0, 0.001, 0.2] }} }} }}]\n\
             [[obstacles]]\nshape = {{ box = {{ size = [1, 9, 1] }} }}\nposition = [2.5, 1.5, 0]\n"
        ));
        let text = "uobprm = { length = 0.2, step = 0.02 }";
        let configs = sets(&cx, &sampler(text), 0..1, 1500, &mut Scratch::new());
        // h = |cos θ| / 2, so that the curve's length is the integral of √(w² + sin² θ / 4).
        let steps = 2000;
        let mut lengths = vec![0.0];
        for i in 0..steps {
            let sine = 0.5 * math::sin((f64::from(i) + 0.5) / f64::from(steps) * FRAC_PI_2);
            lengths.push(lengths[i as usize] + (weight * weight + sine * sine).sqrt());
        }
        let law = |angle: f64| {
            let place = (angle / FRAC_PI_2 * f64::from(steps)) as usize;
            lengths[place.min(steps as usize)] / lengths[steps as usize]
        };
        let folded = configs.iter().map(|q| {
            let angle = q[2].abs();
            if angle > FRAC_PI_2 { 2.0 * FRAC_PI_2 - angle } else { angle }
        });
        follows(folded.collect(), law);
    }
}

/// The tip of an arm of two links before a wall: where it touches is a closed curve on the torus of its two angles, and
/// milestones are uniform by its length in the metric, in which the first joint weighs more than the second.
#[test]
fn an_arm_touches_a_wall_by_the_length_in_the_metric() {
    let joint = |before: f64| {
        format!(
            "joint = {{ kind = {{ revolute = {{ axis = [0, 0, 1] }} }}, before = {{ position = [{before}, 0, 0] }} }}\n"
        )
    };
    let cx = context(&format!(
        "[space]\nmotion = \"fixed\"\nmin = [-3, -3, -3]\nmax = [3, 3, 3]\nbounds = \"body\"\n\
         [robot]\nbodies = []\n[[robot.links]]\nname = \"upper\"\nbodies = []\n{}\
         [[robot.links]]\nname = \"lower\"\n\
         bodies = [{{ shape = {{ point = {{}} }}, position = [1, 0, 0] }}]\n{}\
         [[obstacles]]\nshape = {{ box = {{ size = [1, 9, 1] }} }}\nposition = [1.7, 0, 0]\n",
        joint(0.0),
        joint(1.0)
    ));
    // cos θ₁ + cos (θ₁ + θ₂) = 1.2, by φ = θ₁ + θ₂, there and back.
    let most = 2.0 * math::atan2((0.4f64).sqrt(), (0.6f64).sqrt());
    let half = 1000;
    let curve: Vec<[f64; 2]> = (0..2 * half)
        .map(|i| {
            // Denser at the ends, where the curve turns back.
            let phase = TAU * f64::from(i) / f64::from(2 * half);
            let sum = most * math::cos(phase);
            let first = math::acos(1.2 - math::cos(sum)) * if i < half { 1.0 } else { -1.0 };
            [first, math::wrap_angle(sum - first)]
        })
        .collect();
    let arcs = 8;
    let mut along = vec![0.0];
    for i in 0..curve.len() {
        let next = &curve[(i + 1) % curve.len()];
        along.push(along[i] + cx.space.distance(&curve[i], next));
    }
    let whole = along[curve.len()];
    let weights: Vec<f64> = cx.space.factors().iter().map(|factor| factor.weight).collect();
    assert!(weights[0] > 1.5 * weights[1]);
    let text = "uobprm = { length = 0.4, step = 0.02 }";
    let mut counts = vec![0; arcs];
    for q in sets(&cx, &sampler(text), 0..1, 600, &mut Scratch::new()).iter() {
        let nearest = (0..curve.len()).min_by(|i, j| {
            cx.space.distance(q, &curve[*i]).total_cmp(&cx.space.distance(q, &curve[*j]))
        });
        let nearest = nearest.unwrap();
        assert!(cx.space.distance(q, &curve[nearest]) < 0.03);
        counts[(along[nearest] / whole * arcs as f64) as usize % arcs] += 1;
    }
    fits(&counts, &vec![1.0; arcs]);
}

/// Several crossings of one segment come in the segment's order, and a sliver between two steps is not seen.
#[test]
fn a_segment_gives_all_its_crossings() {
    let cx = plane(9.0, 9.0, &[[1.0, -5.0, 1.0, 20.0], [4.0, -5.0, 1.0, 20.0]]);
    let segments = Segments {
        space: &cx.space,
        starts: cx.space.clone(),
        length: 9.0,
        step: 0.01,
        attempts: 10,
    };
    let mut stream = Seed::of_set(7, "crossings", Ordinal(0)).stream(Purpose::Sampling);
    let mut most = 0;
    for _ in 0..300 {
        let mut found = VecDeque::new();
        let mut target = ObstacleSurface::new(&cx, false);
        segments.lay(&mut target, &mut stream, &mut Scratch::new(), &mut found);
        let sides: Vec<f64> = found.iter().map(|q| q[0]).collect();
        let rises = sides.is_sorted() || sides.is_sorted_by(|a, b| a >= b);
        assert!(rises, "{sides:?}");
        most = most.max(sides.len());
    }
    assert_eq!(most, 4);
}
