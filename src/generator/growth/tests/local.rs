//! Trees from places between the ends.

use super::{SPACE, grown, make, parse};
use crate::generator::{BentTrees, GeneratorKind, LocalTrees, SlidingTrees};
use crate::img::{Setup, build};
use crate::model::Scratch;
use crate::problem::Problem;
use crate::sampler::SamplerKind;
use std::path::Path;
use std::sync::Arc;

fn hook() -> Problem {
    Problem::load(Path::new("problems/hook.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// Those of the default, from the beginning on.
fn trees(problem: &Problem) -> LocalTrees {
    let trees = problem.strategies().iter().find(|strategy| strategy.label() == "gaps");
    match trees.expect("the default has it").generator() {
        GeneratorKind::LocalTrees(trees) => LocalTrees { after: 0, ..trees.clone() },
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_problem_with_gaps_on_both_sides_has_local_trees() {
    let problem = hook();
    let labels: Vec<&str> = problem.strategies().iter().map(|each| each.label()).collect();
    assert_eq!(labels, ["uniform", "trees", "gaps"]);
    let labels = |problem: &Problem| problem.strategies().len();
    assert_eq!(labels(&parse(SPACE)), 2, "a bar has no gaps");
}

#[test]
fn a_set_has_roots_of_its_own_and_valid_edges() {
    let problem = hook();
    let (cx, trees) = (problem.context(), trees(&problem));
    let made = make(&cx, &trees, 0, None);
    assert_eq!(made.configs.len(), 40);
    let scratch = &mut Scratch::new();
    assert!(made.configs.iter().all(|q| cx.model.is_valid(q, scratch)));
    for edge in &made.edges {
        let [a, b] = [edge.low, edge.high].map(|node| made.configs.get(node.index()));
        assert!(cx.model.motion(a, b, 1, scratch).is_some());
    }
    // The ends come first.
    let query = cx.query.as_ref().expect("a query");
    assert_eq!((made.configs.get(0), made.configs.get(1)), (&query.start[..], &query.goal[..]));
    assert_eq!(make(&cx, &trees, 0, None), made);
    assert_ne!(make(&cx, &trees, 1, None), made);
    // In a roadmap of fewer nodes than it is asked for the set is one of trees from the ends.
    let later = LocalTrees { after: 1, ..trees.clone() };
    let LocalTrees { step, trials, nearby, attempts, .. } = trees;
    let sliding = SlidingTrees(BentTrees { step, trials, nearby, attempts });
    assert_eq!(make(&cx, &later, 1, None), make(&cx, &sliding, 1, None));
}

/// With a sampler that any model has they are defined everywhere, and solve what trees from the ends do.
#[test]
fn they_solve_a_query_from_uniform_roots() {
    let generator = "{ local-trees = { step = 0.5, sampler = { uniform = {} } } }";
    let (problem, roadmap) = grown(SPACE, generator, 30, 12);
    let GeneratorKind::LocalTrees(trees) = problem.strategies()[0].generator() else {
        panic!("local trees")
    };
    assert!(matches!(trees.sampler, SamplerKind::Uniform(_)));
    let query = problem.context().query.clone().expect("a query");
    let node = |q: &[f64]| roadmap.configs().iter().position(|at| at == q).expect("an end") as u32;
    let [start, goal] = [node(&query.start), node(&query.goal)].map(crate::numbers::NodeId);
    assert!(roadmap.components().same(start, goal));
}

/// Of a model without gaps the trees are those of the ends, and of what other strategies have left.
#[test]
fn without_gaps_there_are_no_roots() {
    let text = format!(
        "{SPACE}[[strategies]]\nlabel = \"it\"\ngenerator = {{ local-trees = {{ step = 0.5 }} }}\n"
    );
    let text = format!("{text}among = {{ until-joined = {{}} }}\n[limits]\nsets = 12\n");
    let roadmap = build(&Arc::new(Setup::new(parse(&text)))).roadmap;
    assert!(roadmap.components().count() <= 2);
}
