//! Laws that every sampler keeps.

use super::*;
use crate::problem::Problem;
use crate::seed::Seed;
use std::path::Path;

const SCENE: &str = r#"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [4.0, 4.0, 4.0]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.0, 0.2, 0.2] } } }]
[[obstacles]]
shape = { sphere = { radius = 1.0 } }
position = [2.0, 2.0, 2.0]
"#;

fn context(scene: &str) -> Context {
    Problem::parse(Path::new("scene.toml"), scene).unwrap().context()
}

/// One of each sampler, with its default settings.
fn samplers() -> Vec<SamplerKind> {
    let gaussian = |bounds| Gaussian { deviation: 0.3, bounds, attempts: 1_000_000 };
    vec![
        SamplerKind::Uniform(Uniform::default()),
        SamplerKind::Gaussian(gaussian(false)),
        SamplerKind::Gaussian(gaussian(true)),
    ]
}

fn sample(cx: &Context, sampler: &SamplerKind, ordinal: u64, scratch: &mut Scratch) -> Configs {
    let mut configs = Configs::new(cx.space.len());
    let seed = Seed::of_set(7, "laws", ordinal);
    sampler.method().sample(cx, &seed, 40, scratch, &mut configs).unwrap();
    configs
}

#[test]
fn milestones_are_in_bounds_valid_and_in_stored_form() {
    let cx = context(SCENE);
    for sampler in samplers() {
        for ordinal in 0..5 {
            let configs = sample(&cx, &sampler, ordinal, &mut Scratch::new());
            assert_eq!(configs.len(), 40);
            for q in configs.iter() {
                assert!(cx.space.within_bounds(q), "{sampler:?}");
                assert!(cx.validity.valid(q, &mut Scratch::new()), "{sampler:?}");
                let mut stored = q.to_vec();
                cx.space.canonicalize(&mut stored).unwrap();
                assert!(cx.space.distance(q, &stored) < 1e-7, "{sampler:?}");
                let first = q[3..].iter().find(|value| **value != 0.0);
                assert!(first.is_some_and(|value| *value > 0.0), "{sampler:?}");
            }
        }
    }
}

#[test]
fn milestones_follow_from_the_seed_and_from_nothing_that_is_remembered() {
    let cx = context(SCENE);
    let mut warm = Scratch::new();
    for sampler in samplers() {
        let first = sample(&cx, &sampler, 0, &mut Scratch::new());
        assert_ne!(first, sample(&cx, &sampler, 1, &mut warm), "{sampler:?}");
        assert_eq!(first, sample(&cx, &sampler, 0, &mut warm), "{sampler:?}");
        for rubbish in 0..20 {
            warm.poison(rubbish);
            assert_eq!(first, sample(&cx, &sampler, 0, &mut warm), "{sampler:?}");
        }
    }
}

#[test]
fn a_sampler_that_can_find_nothing_gives_up() {
    // The ball fills the room.
    let cx = context(&SCENE.replace("radius = 1.0", "radius = 9.0"));
    let sampler = Uniform { attempts: 500 };
    let mut configs = Configs::new(cx.space.len());
    let mut scratch = Scratch::new();
    let seed = Seed::of_set(7, "laws", 0);
    let error = sampler.sample(&cx, &seed, 1, &mut scratch, &mut configs).unwrap_err();
    assert_eq!(error, GaveUp { attempts: 500 });
    assert_eq!(scratch.take_asked().configurations, 500);
}

/// A half space is free, the rest an obstacle: what the Gaussian sampler does near a wide flat wall
/// depends on the distance from it alone. A pair with its first configuration at distance x is kept with
/// the probability that the other lies beyond the wall, P(|d| · |cos| > x), with d normal and cos, in the
/// plane, that of a uniform direction. Kolmogorov–Smirnov at level 0.001 against that law, integrated.
#[test]
fn gaussian_milestones_have_the_distances_from_a_wall_that_the_law_says() {
    let scene = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [20, 20]\n\
                 bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n\
                 [[obstacles]]\nshape = { box = { size = [10, 20, 1] } }\nposition = [15, 10, 0]\n";
    let cx = context(scene);
    let sampler = Gaussian { deviation: 1.0, bounds: false, attempts: 1_000_000 };
    let mut configs = Configs::new(2);
    let count = 4000;
    let seed = Seed::of_set(3, "gaussian law", 0);
    sampler.sample(&cx, &seed, count, &mut Scratch::new(), &mut configs).unwrap();
    // Far from the other bounds, where pairs are dropped.
    let far = configs.iter().filter(|q| (5.0..15.0).contains(&q[1]) && q[0] > 5.0);
    let mut distances: Vec<f64> = far.map(|q| 10.0 - q[0]).collect();
    distances.sort_by(f64::total_cmp);
    // P(x) = ∫ 2φ(d) (2/π) acos(x/d) / 2 dd for d > x, by the midpoint rule.
    let kept = |x: f64| -> f64 {
        let steps = 400;
        (0..steps)
            .map(|i| {
                let d = x + (i as f64 + 0.5) * 6.0 / f64::from(steps);
                crate::math::exp(-d * d / 2.0) * crate::math::acos(x / d)
            })
            .sum()
    };
    let grid: Vec<f64> = (0..500).map(|i| kept((f64::from(i) + 0.5) * 0.01)).collect();
    let whole: f64 = grid.iter().sum();
    let law = |x: f64| grid[..((x / 0.01) as usize).min(500)].iter().sum::<f64>() / whole;
    let n = distances.len();
    let gap = distances
        .iter()
        .enumerate()
        .fold(0.0f64, |gap, (i, x)| gap.max((law(*x) - i as f64 / n as f64).abs()));
    assert!(n > 1000 && distances[0] >= 0.0);
    assert!(gap < 1.95 / (n as f64).sqrt() + 0.005, "gap {gap} of {n}");
}

#[test]
fn steps_have_the_length_asked_for() {
    let cx = context(SCENE);
    let mut stream = Seed::of_set(3, "steps", 0).stream(crate::seed::Purpose::Sampling);
    let (mut q, mut far) = (vec![0.0; 7], vec![0.0; 7]);
    for i in 0..200 {
        cx.space.sample_uniform(&mut stream, &mut q);
        let length = 0.01 * f64::from(i);
        cx.space.step(&q, length, &mut stream, &mut far);
        let distance = cx.space.distance(&q, &far);
        assert!(distance <= length + 1e-7, "{distance} {length}");
        // Within half a turn of the rotation nothing wraps.
        if length < 1.5 {
            assert!((distance - length).abs() < 1e-7, "{distance} {length}");
        }
    }
}
