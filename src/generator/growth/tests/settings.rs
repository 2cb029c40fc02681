//! What is refused, and what a problem that leaves settings open gets.

use super::{PLANE, grown, make, parse};
use crate::generator::GeneratorKind;
use crate::problem::Problem;
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
    for method in ["rrt", "rrg", "mrrg", "tree", "rrt-connect"] {
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
    let expected = "expected neighbors = \"auto\" or a whole number from 0 to 4294967295, or a table with finder and hop_limit";
    for (found, said) in [
        ("\"some\"", "invalid value: string \"some\", "),
        ("-1", "invalid value: integer `-1`, "),
        ("4294967296", "invalid value: integer `4294967296`, "),
        ("5.0", "invalid type: floating point `5.0`, "),
    ] {
        for method in ["rrg", "mrrg"] {
            let generator = format!("{{ {method} = {{ neighbors = {found} }} }}");
            refused(PLANE, &generator, &format!("{said}{expected}"));
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

/// The bar lies in a slot that is hardly wider and longer than the bar is, so that no motion of a twentieth of the space's diameter
/// is valid; half of a thirtieth of that is.
#[test]
fn a_step_that_leads_nowhere_is_halved_until_it_leads_on() {
    let slot = r#"
[space]
motion = "rigid-2d"
min = [0, 0]
max = [8, 6]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.0, 0.2, 1.0] } } }]
[[obstacles]]
shape = { box = { size = [1.2, 0.2, 1.0] } }
position = [1.0, 1.21, 0.0]
[[obstacles]]
shape = { box = { size = [1.2, 0.2, 1.0] } }
position = [1.0, 0.79, 0.0]
[[obstacles]]
shape = { box = { size = [0.2, 0.62, 1.0] } }
position = [0.35, 1.0, 0.0]
[[obstacles]]
shape = { box = { size = [0.2, 0.62, 1.0] } }
position = [1.65, 1.0, 0.0]
[query]
start = [1.0, 1.0, 0.0]
goal = [7.0, 5.0, 0.0]
"#;
    let text = format!(
        "{slot}[[strategies]]\nlabel = \"it\"\ngenerator = {{ rrt-connect = {{ attempts = 1000 }} }}\n"
    );
    let problem = parse(&text);
    let cx = problem.context();
    let GeneratorKind::RrtConnect(rrt) = &problem.strategies[0].generator else {
        panic!("an RRT-Connect")
    };
    let step = rrt.step.expect("it is part of the problem");
    assert_eq!(step, 0.05 * cx.space.diameter());
    let set = make(&cx, rrt, 0, None);
    let start = &cx.query.as_ref().expect("a query").start;
    let near = |index: usize| cx.space.distance(start, set.configs.get(index)) < 0.5 * step;
    assert!((1..set.configs.len()).any(near), "something grew in the slot");
}
