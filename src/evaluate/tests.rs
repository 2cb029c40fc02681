use super::*;
use crate::img::{Setup, build};
use crate::problem::Problem;
use std::path::Path;
use std::sync::Arc;

/// Two rooms, of which the left one is three times as large, and no way from one to the other.
const ROOMS: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [8.2, 4.0]
bounds = "reference"
[robot]
bodies = [{ shape = { point = {} } }]
[[obstacles]]
shape = { box = { size = [0.2, 4.0, 1.0] } }
position = [6.1, 2.0, 0.0]
[query]
start = [1.0, 1.0]
goal = [8.0, 1.0]
[img]
sets_per_round = 1
[[strategies]]
label = "all"
nodes = 200
sampler = { uniform = {} }
[limits]
sets = 1
"#;

fn verdict(evaluators: &str) -> Verdict {
    let text = format!("evaluators = [{evaluators}]\n{ROOMS}");
    let problem = Problem::parse(Path::new("rooms.toml"), &text).unwrap();
    let built = build(&Arc::new(Setup::new(problem)));
    built.judgement.expect("one round is judged").verdicts.remove(0)
}

#[test]
fn coverage_counts_samples_and_connectivity_pairs() {
    let covered = verdict("{ coverage = {} }");
    assert!(covered.satisfied && covered.value == 1.0 && covered.threshold == 0.95);
    // Of 100 samples some 75 lie in the left room: p² + q² of the pairs, about 0.62, are connected.
    let connected = verdict("{ connectivity = {} }");
    assert!(!connected.satisfied && connected.threshold == 0.75);
    let left = (0..=100u32)
        .map(f64::from)
        .find(|left| {
            let right = 100.0 - left;
            (connected.value - (left * (left - 1.0) + right * (right - 1.0)) / 9900.0).abs() < 1e-12
        })
        .expect("the pairs of two groups that make a hundred");
    assert!((10.0..40.0).contains(&left.min(100.0 - left)), "{left}");
    // Listed: two in the left room, one in the right: one of three pairs.
    let listed = verdict(
        "{ connectivity = { samples = { listed = [[1, 1], [5, 3], [8, 2]] }, percent = 33 } }",
    );
    assert!(listed.satisfied && (listed.value - 1.0 / 3.0).abs() < 1e-12);
}

#[test]
fn trees_of_criteria_say_what_logic_says_and_judge_every_part() {
    let (yes, no) = ("{ coverage = {} }", "{ query = {} }");
    for (criterion, satisfied, parts) in [
        (format!("{{ all = [{yes}, {yes}] }}"), true, 2),
        (format!("{{ all = [{no}, {yes}] }}"), false, 2),
        (format!("{{ any = [{yes}, {no}] }}"), true, 2),
        (format!("{{ any = [{no}, {no}] }}"), false, 2),
        (format!("{{ not = {no} }}"), true, 1),
        (format!("{{ not = {{ any = [{yes}, {no}] }} }}"), false, 1),
    ] {
        let verdict = verdict(&criterion);
        assert_eq!((verdict.satisfied, verdict.parts.len()), (satisfied, parts), "{criterion}");
        assert!(verdict.asked.motions >= verdict.parts.iter().map(|p| p.asked.motions).sum());
    }
}

#[test]
fn samples_are_the_same_every_time_and_other_ones_elsewhere_in_the_tree() {
    let one = "{ coverage = { samples = { random = 3 } } }";
    let both = verdict(&format!("{{ all = [{one}, {one}] }}"));
    assert_eq!(both, verdict(&format!("{{ all = [{one}, {one}] }}")));
    let first = verdict(one);
    assert_eq!(first, verdict(one));
}

#[test]
fn wrong_settings_are_named() {
    for (evaluator, expected) in [
        ("{ coverage = { percent = 0 } }", "percent = 0 found"),
        ("{ coverage = { samples = { random = 1 } } }", "samples.random = 1 found"),
        ("{ all = [] }", "all = [] found"),
        ("{ not = { connectivity = { neighbors = 0 } } }", "neighbors = 0 found"),
        ("{ connectivity = { planners = [{ rotate-at = { percent = 101 } }] } }", "percent = 101"),
        (
            "{ all = [{ coverage = { samples = { listed = [[1, 1], [6.1, 1]] } } }] }",
            "samples.listed[1]: [6.1, 1.0] found",
        ),
        ("{ coverage = { sample = { random = 5 } } }", "unknown field `sample`"),
    ] {
        let text = format!("evaluators = [{evaluator}]\n{ROOMS}");
        let error = Problem::parse(Path::new("rooms.toml"), &text).unwrap_err().to_string();
        assert!(error.starts_with("rooms.toml:1: ") && error.contains(expected), "{error}");
    }
}
