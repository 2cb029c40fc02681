//! Configurations at which gaps are at one another.

use super::{sampler, sets};
use crate::model::Scratch;
use crate::problem::Problem;
use std::path::Path;

#[test]
fn at_every_milestone_two_gaps_are_near_each_other() {
    let problem = Problem::load(Path::new("problems/hook.toml"));
    let cx = problem.unwrap_or_else(|error| panic!("{error}")).context();
    let scratch = &mut Scratch::new();
    let drawn = sets(&cx, &sampler("gaps = {}"), 0..3, 10, scratch);
    let gaps = cx.model.gaps().expect("both have gaps");
    assert_eq!(drawn.len(), 30);
    for q in drawn.iter() {
        assert!(cx.model.is_valid(q, scratch), "{q:?}");
        let is_near = |pair: usize| {
            let mut there = q.to_vec();
            gaps.align(pair, [0.0; 3], &mut there);
            let parts = (0..3).map(|axis| there[axis] - q[axis]);
            let apart: f64 = parts.map(|part| part * part).sum();
            apart.sqrt() <= 0.75 * gaps.widths(pair).iter().sum::<f64>() + 1e-9
        };
        assert!((0..gaps.pairs()).any(is_near), "{q:?}");
    }
}

#[test]
fn a_robot_without_gaps_is_refused() {
    let text =
        format!("{}[[strategies]]\nsampler = {{ gaps = {{}} }}\nlabel = \"it\"\n", super::SCENE);
    let refused = Problem::parse(Path::new("scene.toml"), &text).expect_err("a rod has no gaps");
    assert!(refused.to_string().contains("a sampler at gaps found"), "{refused}");
}
