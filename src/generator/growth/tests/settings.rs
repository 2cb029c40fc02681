//! What is refused, and what a problem that leaves settings open gets.

use super::{PLANE, grown, make, parse};
use crate::generator::GeneratorKind;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::seed::Seed;
use crate::space::Space;
use std::path::Path;

#[test]
fn settings_are_refused_with_what_is_expected() {
    let refused = |scene: &str, generator: &str, message: &str| {
        let text = format!("{scene}[[strategies]]\nlabel = \"it\"\ngenerator = {generator}\n");
        let error = Problem::parse(Path::new("growth.toml"), &text).expect_err(generator);
        let error = error.to_string();
        assert!(error.contains(message), "{error}");
        assert!(error.starts_with("growth.toml:"), "{error}");
    };
    for method in [
        "rrt",
        "rrg",
        "mrrg",
        "tree",
        "rrt-connect",
        "end-trees",
        "retraction-trees",
        "contact-trees",
        "sliding-trees",
    ] {
        let with = |settings: &str| format!("{{ {method} = {{ {settings} }} }}");
        refused(
            PLANE,
            &with("step = 0.0"),
            "step = 0 found; a length above 0, at most 1e30, expected",
        );
        refused(
            PLANE,
            &with("step = nan"),
            "step = NaN found; a length above 0, at most 1e30, expected",
        );
        refused(
            PLANE,
            &with("step = 1e31"),
            "step = 1e31 found; a length above 0, at most 1e30, expected",
        );
        refused(PLANE, &with("attempts = 0"), "attempts = 0 found; 1 to 1000000000 expected");
        refused(PLANE, &with("bounces = 1"), "unknown field `bounces`");
        let (sceneless, _) = PLANE.split_once("[query]").expect("it has a query");
        if method == "tree" {
            parse(&format!("{sceneless}[[strategies]]\nlabel = \"it\"\ngenerator = {}", with("")));
        } else {
            refused(sceneless, &with(""), "but no [query]");
        }
    }
    for method in ["rrt", "rrg", "mrrg"] {
        for bias in ["1.0", "-0.1", "nan"] {
            let generator = format!("{{ {method} = {{ goal_bias = {bias} }} }}");
            refused(PLANE, &generator, "found; at least 0, less than 1 expected");
        }
    }
    let neighbors = "neighbors = 0 found; \"auto\" or at least 1 expected";
    refused(PLANE, "{ rrg = { neighbors = 0 } }", neighbors);
    let expected = "\"auto\" or a whole number from 0 to 4294967295, or a table with finder and hop_limit expected";
    for found in ["\"some\"", "-1", "4294967296", "5.0"] {
        for method in ["rrg", "mrrg"] {
            let generator = format!("{{ {method} = {{ neighbors = {found} }} }}");
            let key = format!("strategies[0].generator.{method}.neighbors");
            refused(PLANE, &generator, &format!("{key}: {found} found; {expected}"));
        }
    }
    for method in ["rrg", "mrrg"] {
        let with = |found: &str| format!("{{ {method} = {{ neighbors = {{ {found} }} }} }}");
        refused(PLANE, &with("hop_limit = 0"), "hop_limit = 0 found; at least 1 expected");
        refused(PLANE, &with("hops = 1"), "unknown field `hops`");
        let none = "finder = { brute-force = { neighbors = 0 } }";
        refused(PLANE, &with(none), "neighbors = 0 found; \"auto\" or at least 1 expected");
        let of_proteins = "neighbours by Cα RMSD found, a model with Cα expected";
        refused(PLANE, &with("finder = { ca-rmsd = {} }"), of_proteins);
    }
    refused(PLANE, "{ mrrg = { directions = 0 } }", "directions = 0 found; 1 to 1000 expected");
    refused(PLANE, "{ mrrg = { trials = 1001 } }", "trials = 1001 found; 1 to 1000 expected");
    let trials = "trials = 1001 found; 0 to 1000 expected";
    refused(PLANE, "{ retraction-trees = { trials = 1001 } }", trials);
    refused(PLANE, "{ contact-trees = { trials = 1001 } }", trials);
    refused(PLANE, "{ sliding-trees = { trials = 1001 } }", trials);
    for nearby in ["1.0", "-0.1", "nan"] {
        let generator = format!("{{ retraction-trees = {{ nearby = {nearby} }} }}");
        refused(PLANE, &generator, "found; at least 0, less than 1 expected");
    }
    let sampler = "{ tree = { sampler = { gaussian = { deviation = -1.0 } } } }";
    refused(PLANE, sampler, "deviation");
    refused(PLANE, "{ tree = { sampler = { energy = { always = 0.0, never = 1.0 } } } }", "energy");
}

#[test]
fn a_step_that_is_left_open_becomes_part_of_the_problem() {
    let (problem, _) = grown(PLANE, "{ rrt = {} }", 2, 1);
    let GeneratorKind::Rrt(rrt) = &problem.strategies[0].generator else { panic!("an RRT") };
    let space: &Space = &problem.context().space;
    assert_eq!(rrt.step, Some(0.2 * space.diameter()));
}

/// Both ends lie in slots in which the bar cannot move by a twentieth of the space's diameter.
#[test]
fn where_no_tree_can_grow_the_rest_of_a_set_is_drawn() {
    let slot = |x: f64| {
        let wall = |size: [f64; 2], at: [f64; 2]| {
            format!(
                "[[obstacles]]\nshape = {{ box = {{ size = [{:?}, {:?}, 1.0] }} }}\nposition = [{:?}, {:?}, 0.0]\n",
                size[0], size[1], at[0], at[1]
            )
        };
        wall([1.2, 0.2], [x, 3.21])
            + &wall([1.2, 0.2], [x, 2.79])
            + &wall([0.2, 0.62], [x - 0.61, 3.0])
            + &wall([0.2, 0.62], [x + 0.61, 3.0])
    };
    let scene = format!(
        "[space]\nmotion = \"rigid-2d\"\nmin = [0, 0]\nmax = [8, 6]\nbounds = \"body\"\n[robot]\n\
         bodies = [{{ shape = {{ box = {{ size = [1.0, 0.2, 1.0] }} }} }}]\n{}{}\
         [query]\nstart = [2.0, 3.0, 0.0]\ngoal = [6.0, 3.0, 0.0]\n",
        slot(2.0),
        slot(6.0)
    );
    let strategy = |generator: &str| {
        parse(&format!(
            "{scene}[[strategies]]\nlabel = \"it\"\ngenerator = {{ {generator} = {{}} }}\n"
        ))
    };
    for generator in ["end-trees", "retraction-trees", "contact-trees", "sliding-trees"] {
        let problem = strategy(generator);
        let (cx, trees) = (problem.context(), problem.strategies[0].generator.method());
        let set = make(&cx, trees, 0, None);
        // The ends are nodes, and stand alone among what was drawn.
        let query = cx.query.as_ref().expect("a query");
        assert_eq!((set.configs.get(0), set.configs.get(1)), (&query.start[..], &query.goal[..]));
        assert_eq!((set.configs.len(), set.edges.len()), (40, 0));
        assert!(set.configs.iter().all(|q| cx.model.is_valid(q, &mut Scratch::new())));
        assert_eq!(make(&cx, trees, 0, None), set);
    }

    let problem = strategy("rrt-connect");
    let seed = Seed::of_set(1, "it", Ordinal(0));
    let made = problem.strategies[0].generator.method();
    let given_up = made.generate(&problem.context(), &seed, 40, None, &mut Scratch::new());
    assert!(given_up.is_err(), "a tree alone has nowhere to go");
}

#[test]
fn trees_from_both_ends_are_those_of_rrt_connect() {
    let step = "{ step = 0.5 }";
    let grown = |generator: &str| grown(PLANE, &format!("{{ {generator} = {step} }}"), 30, 8).1;
    assert_eq!(grown("end-trees").digest(), grown("rrt-connect").digest());
}
