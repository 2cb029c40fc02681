//! Blocked extensions that slide along what blocks them.

use super::super::set::{Extension, GrowingSet};
use super::super::tree::Near;
use super::{PLANE, SPACE, grown, make, parse};
use crate::generator::SlidingTrees;
use crate::img::{Setup, build};
use crate::model::Scratch;
use crate::numbers::{NodeId, Ordinal};
use crate::seed::Seed;
use std::sync::Arc;

#[test]
fn without_trials_the_trees_are_those_of_end_trees() {
    let grown = |generator: &str| grown(PLANE, generator, 30, 8).1.digest();
    let straight = grown("{ end-trees = { step = 0.5 } }");
    assert_eq!(grown("{ sliding-trees = { step = 0.5, trials = 0, nearby = 0.0 } }"), straight);
    assert_ne!(grown("{ sliding-trees = { step = 0.5 } }"), straight);
}

/// A slide stays within one and a half steps of where it began, so that two of its milestones are at most three apart.
#[test]
fn every_edge_is_a_valid_motion_of_at_most_three_steps() {
    for scene in [PLANE, SPACE] {
        let (problem, roadmap) = grown(scene, "{ sliding-trees = { step = 0.5 } }", 30, 8);
        let (cx, scratch) = (problem.context(), &mut Scratch::new());
        for edge in roadmap.edges().iter() {
            let [a, b] = [edge.low, edge.high].map(|node| roadmap.configs().get(node.index()));
            assert!(cx.space.distance(a, b) <= 3.0 * 0.5 * (1.0 + 1e-9), "{a:?} to {b:?}");
            assert!(cx.model.is_valid(b, scratch), "{b:?}");
            assert!(cx.model.motion(a, b, 1, scratch).is_some(), "{a:?} to {b:?}");
        }
        assert!(roadmap.edges().iter().count() > 200);
    }
}

/// Of a roadmap of sampled and of grown sets, half of the sets extend nodes that grew and the ends only.
#[test]
fn half_of_the_sets_extend_nothing_that_was_sampled() {
    for scene in [PLANE, SPACE] {
        let text = format!(
            "{scene}[img]\nsets_per_round = 2\n[limits]\nsets = 12\n\
             [[strategies]]\nlabel = \"it\"\nnodes = 30\ngenerator = {{ sliding-trees = {{}} }}\n\
             [[strategies]]\nlabel = \"drawn\"\nnodes = 60\nsampler = {{ uniform = {{}} }}\n\
             [[evaluators]]\nall = [{{ query = {{}} }}, {{ not = {{ query = {{}} }} }}]\n"
        );
        let problem = parse(&text);
        let roadmap = build(&Arc::new(Setup::new(problem.clone()))).roadmap;
        let (cx, trees) = (problem.context(), SlidingTrees::default());
        let query = cx.query.as_ref().expect("a query");
        let sampled_roots = |ordinal: u64| {
            let made = make(&cx, &trees, ordinal, Some(&roadmap));
            let roots = made.root_edges.iter().map(|edge| edge.low);
            let is_end = |node: NodeId| {
                let q = roadmap.configs().get(node.index());
                q == &query.start[..] || query.goals().any(|goal| goal == q)
            };
            roots.filter(|node| !roadmap.grown().contains(*node) && !is_end(*node)).count()
        };
        let counts: Vec<usize> = (8..16).map(sampled_roots).collect();
        for (ordinal, count) in (8..16).zip(&counts) {
            assert!(ordinal / 2 % 2 == 0 || *count == 0, "{counts:?}");
        }
        assert!(counts.iter().any(|count| *count > 0), "{counts:?}");
    }
}

/// The bar stands before the first wall, below its end, and is to go on beyond: up, and then aside. From below no motion that is straight leads around
/// the wall's end.
#[test]
fn a_slide_gets_around_a_corner() {
    let problem =
        parse(&format!("{PLANE}[[strategies]]\nlabel = \"it\"\nsampler = {{ uniform = {{}} }}\n"));
    let cx = problem.context();
    let (at, toward) = ([2.3, 3.7, 0.0], [3.7, 4.9, 0.0]);
    let distance = cx.space.distance(&at, &toward);
    let mut around = 0;
    for ordinal in 0..30 {
        let (seed, scratch) = (Seed::of_set(1, "it", Ordinal(ordinal)), &mut Scratch::new());
        let set = GrowingSet::new(&cx, &seed, scratch, None, 50, (2.0, 100));
        let mut set = set.with_bending(30, 0.0).with_sliding();
        let number = set.add(&at);
        let extension = set.extend(Near { number, distance }, &toward);
        let made = set.made;
        // The milestones lie one behind the other, each nearer to where the slide is to lead.
        let chain: Vec<_> = made.edges.iter().map(|edge| [edge.low.0, edge.high.0]).collect();
        assert_eq!(
            chain,
            (1..made.configs.len() as u32).map(|node| [node - 1, node]).collect::<Vec<_>>()
        );
        let left: Vec<f64> = made.configs.iter().map(|q| cx.space.distance(q, &toward)).collect();
        assert!(left.is_sorted_by(|before, after| after < before), "{left:?}");
        match extension {
            Extension::Advanced(last) => assert_eq!(last as usize, made.configs.len() - 1),
            other => assert_eq!((other, made.configs.len()), (Extension::Trapped, 1)),
        }
        let end = made.configs.get(made.configs.len() - 1);
        if end[0] > 2.9 {
            around += 1;
            assert!(made.configs.len() > 2, "{end:?} is not seen from the beginning");
        }
    }
    assert!(around >= 5, "{around} of 30");
}
