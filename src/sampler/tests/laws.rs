//! Laws that every sampler keeps, on every robot.

use super::{SCENE, context, sampler, sets};
use crate::context::Context;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::roadmap::Configs;
use crate::sampler::{GaveUp, SamplerKind};
use crate::seed::Seed;
use std::path::Path;

/// The scene with another robot: a rod, and links of 0.3 that turn about z and, every other, about y.
fn scene(motion: &str, body: &str, links: usize) -> String {
    let mut text =
        SCENE.replace("rigid-3d", motion).replace("box = { size = [1.0, 0.2, 0.2] }", body);
    if motion.ends_with("2d") {
        text = text.replace("0.0, -2.0]", "0.0]").replace("4.0, 2.0]", "4.0]");
    }
    if motion == "fixed" {
        text = text.replace("[robot]", "[robot]\nbase = { position = [2.1, 2.65, 0.0] }");
    }
    for i in 1..links {
        let (axis, place) = (["0, 1, 0", "0, 0, 1"][i % 2], if i == 1 { 0.15 } else { 0.3 });
        text += &format!(
            "[[robot.links]]\nname = \"link{i}\"\n\
             bodies = [{{ shape = {{ box = {{ size = [0.26, 0.05, 0.05] }} }}, position = [0.15, 0, 0] }}]\n\
             joint = {{ kind = {{ revolute = {{ axis = [{axis}], degrees = [-150, 150] }} }}, \
             before = {{ position = [{place}, 0, 0] }} }}\n"
        );
    }
    text
}

fn robots() -> Vec<(&'static str, String)> {
    let (point, rod) = ("point = {}", "box = { size = [0.26, 0.05, 0.05] }");
    vec![
        ("a point in the plane", scene("translation-2d", point, 1)),
        ("a point", scene("translation-3d", point, 1)),
        ("a rod in the plane", scene("translation-2d", rod, 1)),
        ("a rod that turns in the plane", scene("rigid-2d", rod, 1)),
        ("a rod that does not turn", scene("translation-3d", rod, 1)),
        ("a rigid body", SCENE.to_owned()),
        ("two links on a base that stands", scene("fixed", rod, 2)),
        ("two links", scene("rigid-3d", rod, 2)),
        ("four links on a base in the plane", scene("rigid-2d", rod, 4)),
        ("four links", scene("rigid-3d", rod, 4)),
        ("ten links on a base that stands", scene("fixed", rod, 10)),
        ("ten links", scene("rigid-3d", rod, 10)),
    ]
}

/// Samplers as a problem file names them: one of each, and those whose settings change much.
fn samplers() -> Vec<SamplerKind> {
    let samplers = [
        "uniform = {}",
        "gaussian = { deviation = 0.3 }",
        "gaussian = { deviation = 0.3, bounds = true }",
        "bridge = { deviation = 0.5 }",
        "bridge = { deviation = 0.5, bounds = true }",
        "obprm = { step = 0.1 }",
        "obprm = { step = 0.1, start = \"colliding\", halvings = 0 }",
        "obprm = { step = 0.1, start = \"free\", bounds = true, steps = 50 }",
        "uobprm = { length = 0.5, step = 0.1 }",
        "uobprm = { length = 0.5, step = 0.1, bounds = true }",
        "uobprm = { length = 0.5, step = 0.1, adjusted_bounds = true }",
        "umaprm = { length = 1.0, step = 0.5, tolerance = 0.05 }",
        "umaprm = { length = 0.5, step = 0.25, tolerance = 0.1, bounds = true }",
        "grid = { cells = 3, block = 7 }",
        "halton = {}",
        "maprm = { step = 0.1, tolerance = 0.01 }",
        "maprm = { step = 0.2, tolerance = 0.02, directions = 4, bounds = true, steps = 50 }",
        "retraction = {}",
        "retraction = { step = 0.05, reach = 2.0, free = false }",
        "mix = [{ weight = 2, sampler = { bridge = { deviation = 0.5 } } }, { sampler = { halton = {} } }]",
    ];
    samplers.map(sampler).to_vec()
}

fn sample(cx: &Context, sampler: &SamplerKind, ordinal: u64, scratch: &mut Scratch) -> Configs {
    sets(cx, sampler, ordinal..ordinal + 1, 12, scratch)
}

#[test]
fn every_sampler_gives_every_robot_milestones_that_are_valid_and_in_stored_form() {
    for (robot, scene) in robots() {
        println!("{robot}"); // of a failure within
        let cx = context(&scene);
        for sampler in samplers() {
            let method = sampler.method();
            assert_eq!((method.complaint(), method.suits(&cx)), (None, Ok(())), "{sampler:?}");
            let configs = sample(&cx, &sampler, 3, &mut Scratch::new());
            assert_eq!(configs.len(), 12);
            for q in configs.iter() {
                assert!(cx.model.is_valid(q, &mut Scratch::new()), "{sampler:?}, {robot}");
                let mut stored = q.to_vec();
                cx.space.canonicalize(&mut stored).unwrap();
                let same = q.iter().zip(&stored).all(|(a, b)| (a - b).abs() < 1e-15);
                assert!(same, "{sampler:?}, {robot}: {q:?}");
            }
            let again = sample(&cx, &sampler, 3, &mut Scratch::new());
            assert_eq!(configs, again, "{sampler:?}, {robot}");
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
        let mut other = Configs::new(cx.space.len());
        let seed = Seed::of_set(8, "laws", Ordinal(0));
        sampler.method().sample(&cx, &seed, 12, &mut warm, &mut other).unwrap();
        assert_ne!(first, other, "another base seed: {sampler:?}");
    }
}

/// Either obstacles fill the whole room, or, for samplers near obstacles, there is next to nothing to collide with.
#[test]
fn a_sampler_that_can_find_nothing_gives_up() {
    let full = context(&SCENE.replace("radius = 1.0", "radius = 9.0"));
    let empty = context(
        &SCENE.replace("radius = 1.0", "radius = 1e-9").replace("radius = 0.5", "radius = 1e-9"),
    );
    for (cx, text) in [
        (&full, "uniform = { attempts = 50 }"),
        (&full, "grid = { cells = 3, attempts = 50, block = 7 }"),
        (&full, "halton = { attempts = 50 }"),
        (&full, "gaussian = { deviation = 0.3, attempts = 50 }"),
        (
            &full,
            "maprm = { step = 0.1, tolerance = 0.01, directions = 4, steps = 3, attempts = 50 }",
        ),
        (&full, "umaprm = { length = 0.2, step = 0.1, tolerance = 0.01, attempts = 50 }"),
        (&full, "mix = [{ sampler = { uniform = { attempts = 50 } } }]"),
        (&empty, "bridge = { deviation = 0.1, attempts = 50 }"),
        (&empty, "obprm = { step = 0.01, start = \"colliding\", attempts = 50 }"),
        (&empty, "uobprm = { length = 0.02, step = 0.01, attempts = 50 }"),
    ] {
        let mut configs = Configs::new(cx.space.len());
        let (mut scratch, seed) = (Scratch::new(), Seed::of_set(7, "laws", Ordinal(0)));
        let sampler = sampler(text);
        let error = sampler.method().sample(cx, &seed, 1, &mut scratch, &mut configs).unwrap_err();
        assert_eq!(error, GaveUp { attempts: 50 }, "{text}");
        let asked = scratch.take_asked().configurations;
        // MAPRM may check up to 3 steps of a push and 3 steps in each of 4 directions for every attempt.
        let most = if text.starts_with("maprm") { 50 * (3 + 4 * 3) } else { u64::MAX };
        assert!((50..=most).contains(&asked), "{text}: {asked}");
    }
}

#[test]
fn samplers_say_what_they_cannot_work_with() {
    let nothing = "[space]\nmotion = \"rigid-3d\"\nmin = [0, 0, 0]\nmax = [4, 4, 4]\nbounds = \"body\"\n\
                   [robot]\nbodies = [{ shape = { sphere = { radius = 0.1 } } }]\n";
    let ten = scene("rigid-3d", "point = {}", 10);
    let fifty = scene("rigid-3d", "point = {}", 50);
    for (scene, text, expected) in [
        (nothing, "gaussian = { deviation = 1 }", "nothing to collide with"),
        (nothing, "bridge = { deviation = 1 }", "nothing to collide with"),
        (nothing, "obprm = { step = 1 }", "nothing to collide with"),
        (nothing, "uobprm = { length = 1, step = 1 }", "nothing to collide with"),
        (nothing, "maprm = { step = 1, tolerance = 0.1 }", "nothing to collide with"),
        (
            nothing,
            "umaprm = { length = 1, step = 1, tolerance = 0.1 }",
            "obstacles, or `bounds = true`, expected",
        ),
        (
            nothing,
            "mix = [{ sampler = { bridge = { deviation = 1 } } }]",
            "nothing to collide with",
        ),
        (&ten, "grid = { cells = 5 }", "a grid of 5 cells along 15 dimensions found; at most"),
        (&fifty, "halton = {}", "halton for 55 degrees of freedom found; at most 40 expected"),
        (SCENE, "gaussian = { deviation = nan }", "deviation = NaN found; a length above 0"),
        (SCENE, "bridge = { deviation = -1 }", "deviation = -1 found; a length above 0"),
        (SCENE, "obprm = { step = 0 }", "step = 0 found; a length above 0, at most 1e30, expected"),
        (SCENE, "obprm = { step = 1, halvings = 31 }", "halvings = 31 found; 0 to 30 expected"),
        (SCENE, "obprm = { step = 1, steps = 0 }", "steps = 0 found; at least 1"),
        (SCENE, "obprm = { step = 1, start = \"both\" }", "unknown variant `both`"),
        (SCENE, "uobprm = { length = 1, step = 2 }", "step = 2 found; a millionth"),
        (
            SCENE,
            "maprm = { step = inf, tolerance = 1 }",
            "step = inf found; a length above 0, at most 1e30, expected",
        ),
        (SCENE, "maprm = { step = 1, tolerance = 2 }", "tolerance = 2 found; a billionth"),
        (
            SCENE,
            "maprm = { step = 1, tolerance = 1, directions = 3 }",
            "directions = 3 found; an even number",
        ),
        (SCENE, "maprm = { step = 1, tolerance = 1, steps = 0 }", "steps = 0 found; at least 1"),
        (SCENE, "umaprm = { length = 1, step = 2, tolerance = 1 }", "step = 2 found; a millionth"),
        (
            SCENE,
            "umaprm = { length = 1, step = 0.1, tolerance = 0.2 }",
            "tolerance = 0.2 found; a billionth",
        ),
        (
            SCENE,
            "umaprm = { length = 1, step = 0.1, tolerance = 0.01, attempts = 0 }",
            "attempts = 0 found; at least 1",
        ),
        (SCENE, "grid = { cells = 0 }", "cells = 0 found; at least 1"),
        (SCENE, "grid = { cells = 2, block = 0 }", "block = 0 found; at least 1"),
        (SCENE, "halton = { attempts = 0 }", "attempts = 0 found; at least 1"),
        (SCENE, "mix = []", "mix = [] found; at least one sampler"),
        (
            SCENE,
            "mix = [{ weight = 0, sampler = { uniform = {} } }]",
            "weight = 0 found; more than 0",
        ),
        (SCENE, "mix = [{ sampler = { uniform = { attempts = 0 } } }]", "attempts = 0 found"),
    ] {
        let problem = format!("{scene}\n[[strategies]]\nlabel = \"a\"\nsampler = {{ {text} }}\n");
        let error = Problem::parse(Path::new("scene.toml"), &problem).unwrap_err().to_string();
        assert!(error.starts_with("scene.toml:") && error.contains(expected), "{text}: {error}");
    }
}
