//! Blocked extensions that are bent aside.

use super::super::extent::Extent;
use super::super::set::{Extension, GrowingSet};
use super::super::tree::Near;
use super::{PLANE, SPACE, grown, parse};
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::seed::Seed;

#[test]
fn without_trials_the_trees_are_those_of_end_trees() {
    let grown = |generator: &str| grown(PLANE, generator, 30, 8).1.digest();
    let straight = grown("{ end-trees = { step = 0.5 } }");
    assert_eq!(grown("{ retraction-trees = { step = 0.5, trials = 0, nearby = 0.0 } }"), straight);
    assert_ne!(grown("{ retraction-trees = { step = 0.5 } }"), straight);
}

#[test]
fn every_edge_is_a_valid_motion_of_at_most_one_and_a_half_steps() {
    let methods = ["retraction-trees = { step = 0.5 }", "contact-trees = { step = 0.5 }"];
    for (scene, method) in [PLANE, SPACE].into_iter().flat_map(|s| methods.map(|m| (s, m))) {
        let (problem, roadmap) = grown(scene, &format!("{{ {method} }}"), 30, 8);
        let (cx, scratch) = (problem.context(), &mut Scratch::new());
        for edge in roadmap.edges().iter() {
            let [a, b] = [edge.low, edge.high].map(|node| roadmap.configs().get(node.index()));
            assert!(cx.space.distance(a, b) <= 1.5 * 0.5 * (1.0 + 1e-9), "{a:?} to {b:?}");
            assert!(cx.model.is_valid(b, scratch), "{b:?}");
            assert!(cx.model.motion(a, b, 1, scratch).is_some(), "{a:?} to {b:?}");
        }
        assert!(roadmap.edges().iter().count() > 200);
    }
}

/// The bar stands before a wall, and is to go on behind it and further up.
#[test]
fn a_blocked_extension_goes_on_along_the_obstacle() {
    let problem =
        parse(&format!("{PLANE}[[strategies]]\nlabel = \"it\"\nsampler = {{ uniform = {{}} }}\n"));
    let cx = problem.context();
    let (at, toward) = ([2.3, 1.0, 0.0], [4.0, 2.2, 0.0]);
    let distance = cx.space.distance(&at, &toward);
    let extended = |trials: u32, ordinal: u64| {
        let (seed, scratch) = (Seed::of_set(1, "it", Ordinal(ordinal)), &mut Scratch::new());
        let set = GrowingSet::new(&cx, &seed, scratch, None, 10, (0.5, 100));
        let mut set = set.with_bending(trials, 0.0);
        let number = set.add(&at);
        let extension = set.extend(Near { number, distance }, &toward);
        (extension, extension.milestone().map(|new| set.config(new).to_vec()), set.made)
    };
    for ordinal in 0..20 {
        assert_eq!(extended(0, ordinal).0, Extension::Trapped);
        let (extension, reached, made) = extended(12, ordinal);
        assert!(matches!(extension, Extension::Advanced(_)), "{extension:?}");
        let q = reached.expect("a milestone");
        assert!(cx.space.distance(&q, &toward) < distance - 0.05 * 0.5, "{q:?}");
        assert!(q[1] > at[1], "{q:?} is further up");
        assert_eq!((made.configs.len(), made.edges.len()), (2, 1));
    }
}

/// The same bar, by the normal of the one contact: the extension ends at the wall, moved back by no more than it has to.
#[test]
fn a_blocked_extension_is_retracted_to_contact() {
    let problem =
        parse(&format!("{PLANE}[[strategies]]\nlabel = \"it\"\nsampler = {{ uniform = {{}} }}\n"));
    let cx = problem.context();
    let (at, toward) = ([2.3, 1.0, 0.0], [4.0, 2.2, 0.0]);
    let distance = cx.space.distance(&at, &toward);
    let (seed, scratch) = (Seed::of_set(1, "it", Ordinal(0)), &mut Scratch::new());
    let set = GrowingSet::new(&cx, &seed, scratch, None, 10, (0.5, 100));
    let mut set = set.with_retraction();
    let number = set.add(&at);
    let extension = set.extend(Near { number, distance }, &toward);
    let new = extension.milestone().expect("the bar gets on along the wall");
    let q = set.config(new).to_vec();
    assert!(q[1] > 1.1 && cx.space.distance(&q, &toward) < distance - 0.05 * 0.5, "{q:?}");
    // A little nearer to where the extension was to lead it collides.
    let mut nearer = q.clone();
    cx.space.interpolate(&q, &toward, 0.05, &mut nearer);
    assert!(!cx.model.is_valid(&nearer, &mut Scratch::new()), "{q:?}");
}

/// Of a draw from the whole space the part in the box is the same as of the box in the space, and the angle is left alone.
#[test]
fn what_is_drawn_nearby_lies_in_the_box_around_the_tree() {
    let problem =
        parse(&format!("{PLANE}[[strategies]]\nlabel = \"it\"\nsampler = {{ uniform = {{}} }}\n"));
    let space = &problem.context().space;
    let mut extent = Extent::default();
    extent.cover(space, &[1.0, 2.0, 0.3]);
    let mut more = Extent::default();
    more.cover(space, &[3.0, 1.0, -0.3]);
    extent.unite(&more);
    let shrunk = |q: [f64; 3], margin: f64| {
        let mut shrunk = q;
        extent.shrink_into(space, margin, &mut shrunk);
        shrunk
    };
    // The reals of the space are bounded by [0, 8] and [0, 6].
    assert_eq!(shrunk([4.0, 3.0, 2.0], 0.0), [2.0, 1.5, 2.0]);
    assert_eq!(shrunk([0.0, 6.0, -3.0], 0.0), [1.0, 2.0, -3.0]);
    assert_eq!(shrunk([0.0, 6.0, -3.0], 0.5), [0.5, 2.5, -3.0]);
    assert_eq!(shrunk([2.0, 1.5, 0.0], 1e9), [2.0, 1.5, 0.0]);
}
