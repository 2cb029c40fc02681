//! What every push promises: what it gives is valid, and within the stated distance of the configuration that it was pushed from.

use super::{Push, Pushed, Run, Search, is_held, thinned};
use crate::model::Scratch;
use crate::problem::Problem;
use crate::seed::{Purpose, Seed};
use proptest::prelude::*;
use std::path::Path;

/// Shipped problems: a linkage in the plane, one in space, rigid bodies in both.
const PROBLEMS: [&str; 5] = ["stick4", "gantry", "maze", "maze3d", "hook"];

fn problem(name: &str) -> Problem {
    let problem = Problem::load(Path::new(&format!("problems/{name}.toml")));
    problem.unwrap_or_else(|error| panic!("{error}"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20, ..ProptestConfig::default() })]

    #[test]
    fn what_is_pushed_is_valid_and_near(
        name in prop::sample::select(&PROBLEMS[..]),
        push in prop::sample::select(vec![Push::Simple, Push::Shortest, Push::Workspace, Push::Retraction, Push::All]),
        (seed, effort, steps) in (0u64..10_000, 0u32..3, 1u32..12),
    ) {
        let problem = problem(name);
        let (cx, scratch) = (problem.context(), &mut Scratch::new());
        let mut stream = Seed::of_evaluator(seed, name).stream(Purpose::Sampling);
        // A short straight stretch from anywhere.
        let (mut q, mut end) = (vec![0.0; cx.space.len()], vec![0.0; cx.space.len()]);
        cx.space.sample_uniform(&mut stream, &mut q);
        cx.space.step(&q, 0.1 * cx.space.diameter(), &mut stream, &mut end);
        let colliding: Vec<Vec<f64>> = (0..6)
            .map(|index| {
                let mut between = q.clone();
                cx.space.interpolate(&q, &end, f64::from(index) / 5.0, &mut between);
                cx.space.canonicalize(&mut between).unwrap();
                between
            })
            .filter(|q| !cx.model.is_valid(q, scratch))
            .collect();
        let step = 0.01 * cx.space.diameter();
        let reach = step * f64::from(steps);
        let run = Run { before: None, colliding: &colliding, after: Some(&end) };
        let mut search = Search { cx: &cx, scratch, stream, step, reach, effort };
        let found = push.push(&run, &mut search);
        for Pushed { from, q } in &found {
            prop_assert!(cx.model.is_valid(q, &mut Scratch::new()));
            prop_assert!(cx.space.distance(&colliding[*from], q) <= reach);
            let mut stored = q.clone();
            cx.space.canonicalize(&mut stored).unwrap();
            let is_stored = q.iter().zip(&stored).all(|(a, b)| (a - b).abs() < 1e-15);
            prop_assert!(is_stored, "{q:?} is not in stored form");
        }
        prop_assert!(found.windows(2).all(|pair| pair[0].from <= pair[1].from));
    }
}

/// A ball in a channel between two walls, which is open to both sides.
const CHANNEL: &str = r#"
[space]
motion = "translation-2d"
min = [0, 0]
max = [20, 20]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.5 } } }]
[[obstacles]]
shape = { box = { size = [8, 1, 2] } }
position = [10, 8.9, 0]
[[obstacles]]
shape = { box = { size = [8, 1, 2] } }
position = [10, 11.1, 0]
"#;

fn searched<T>(q: &[f64], look: impl FnOnce(&mut Search) -> T) -> T {
    let problem = Problem::parse(Path::new("channel.toml"), CHANNEL);
    let problem = problem.unwrap_or_else(|error| panic!("{error}"));
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    assert_eq!(q.len(), cx.space.len());
    let stream = Seed::of_evaluator(1, "channel").stream(Purpose::Sampling);
    look(&mut Search { cx: &cx, scratch, stream, step: 0.1, reach: 2.0, effort: 0 })
}

#[test]
fn a_configuration_between_two_walls_is_held_and_one_beside_a_wall_is_not() {
    for (q, expected) in [([10.0, 10.0], true), ([10.0, 12.5], false), ([3.0, 10.0], false)] {
        assert_eq!(searched(&q, |search| is_held(&q, search)), expected, "{q:?}");
    }
    // Bounds are no obstacles.
    let corner = [0.6, 0.6];
    assert!(!searched(&corner, |search| is_held(&corner, search)));
}

#[test]
fn the_shortest_push_leaves_a_wall_by_its_nearer_side() {
    // In the lower wall, whose sides are at 8.4 and 9.4: from 9.3 the ball's nearer way out leads up, to 9.9.
    let colliding: Vec<Vec<f64>> = (0..5).map(|i| vec![9.0 + 0.4 * f64::from(i), 9.3]).collect();
    let found = searched(&colliding[0], |search| {
        let run = Run { before: None, colliding: &colliding, after: None };
        Push::Shortest.push(&run, search)
    });
    assert_eq!(found.len(), 5);
    for Pushed { from, q } in found {
        assert!(q[1] >= 9.9 && q[1] < 9.95, "{q:?}");
        assert!((q[0] - colliding[from][0]).abs() < 1.0, "{q:?}");
    }
}

#[test]
fn the_simple_push_leads_toward_the_line_and_keeps_what_is_held() {
    // The way through the channel runs at 10; the path runs in the wall.
    let colliding: Vec<Vec<f64>> = (0..4).map(|i| vec![8.0 + f64::from(i), 9.2]).collect();
    let found = searched(&colliding[0], |search| {
        let run =
            Run { before: Some(&[5.0, 10.0]), colliding: &colliding, after: Some(&[15.0, 10.0]) };
        Push::Simple.push(&run, search)
    });
    assert!(found.len() >= 4, "{found:?}");
    assert!(found.iter().all(|Pushed { q, .. }| (9.9..10.1).contains(&q[1])), "{found:?}");
}

#[test]
fn of_a_crowd_one_is_kept() {
    let crowd = [0.0, 0.3, 1.0, 1.2, 2.1].map(|x| Pushed { from: 0, q: vec![x, 0.0] });
    let kept = searched(&[0.0, 0.0], |search| thinned(search.cx.space(), crowd.to_vec(), 0.5));
    let kept: Vec<f64> = kept.iter().map(|pushed| pushed.q[0]).collect();
    assert_eq!(kept, [0.0, 1.0, 2.1]);
}

#[test]
fn a_robot_without_a_base_that_moves_is_retracted_but_not_translated() {
    assert!(Push::Workspace.suits(&problem("stick4").context()).is_ok());
    let gantry = problem("gantry").context();
    let refused = Push::Workspace.suits(&gantry).expect_err("its base stands still");
    assert!(refused.contains("a base that can be translated expected"), "{refused}");
    assert!(Push::Retraction.suits(&gantry).is_ok());
    let landscape = Problem::load(Path::new("tests/problems/landscape.toml")).unwrap();
    assert!(Push::Retraction.suits(&landscape.context()).is_err());
}

#[test]
fn retraction_leaves_a_wall_by_its_nearer_side_and_ends_near_contact() {
    let colliding = vec![vec![10.0, 9.3], vec![11.0, 11.4]];
    let found = searched(&colliding[0], |search| {
        Push::Retraction.push(&Run { before: None, colliding: &colliding, after: None }, search)
    });
    let found: Vec<f64> = found.iter().map(|pushed| pushed.q[1]).collect();
    assert!(found.len() == 2 && found[0] >= 9.9 && found[0] < 9.92, "{found:?}");
    assert!(found[1] >= 12.1 && found[1] < 12.12, "{found:?}");
}
