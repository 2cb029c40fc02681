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
    vec![SamplerKind::Uniform(Uniform::default())]
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
