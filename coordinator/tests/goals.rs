//! Queries with several goals, through all that is done with a run.

mod support;

use serde_json::Value;
use std::fs;
use support::Scratch;

/// A point in a room with a wall that leaves a gap at one side, and three goals: two behind the wall, the nearer of them
/// second, and one that is walled in.
const ROOM: &str = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [6, 4]\n\
    bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n\
    [[obstacles]]\nshape = { box = { size = [0.5, 3, 1] } }\nposition = [2, 2.5, 0]\n\
    [[obstacles]]\nshape = { box = { size = [0.2, 4, 1] } }\nposition = [5, 2, 0]\n\
    [query]\nstart = [1, 3]\ngoal = GOALS\n[limits]\nsets = 40\n";
const GOALS: &str = "[[4.5, 3.5], [3, 2], [5.5, 1]]";

fn room(goals: &str) -> String {
    ROOM.replace("GOALS", goals)
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error} in {text}"))
}

#[test]
fn the_goal_to_which_the_way_costs_least_is_reached_and_named() {
    let scratch = Scratch::new();
    scratch.write("room.toml", &room(GOALS));
    scratch.write("near.toml", &room("[3, 2]"));
    let built = scratch.run(&["build", "room.toml", "--workers", "2", "--out", "run"]);
    built.assert_code(0);
    assert!(built.stdout.contains(" to goal 2\n"), "{}", built.stdout);
    let summary = json(&fs::read_to_string(scratch.path("run/summary.json")).expect("a summary"));
    let evaluator = &summary["evaluators"][0];
    assert_eq!(evaluator["goal"], 2, "{summary}");

    let asked = scratch.run(&["query", "run"]);
    asked.assert_code(0);
    assert!(asked.stderr.contains(" to goal 2 of 3, length "), "{}", asked.stderr);
    let last = asked.stdout.lines().last().expect("a path");
    assert!(last.starts_with("3,2") || last.starts_with("3.0,2.0"), "{last}");
    // The goal that is walled in is no worse for being asked alone, nor is the other behind the wall.
    scratch.run(&["query", "run", "--goal", "5.5 1"]).assert_code(3);
    let other = scratch.run(&["query", "run", "--goal", "4.5 3.5"]);
    other.assert_code(0);
    assert!(!other.stderr.contains("to goal"), "{}", other.stderr);

    let paths = scratch.run(&["paths", "run", "--count", "2", "--out", "ways"]);
    paths.assert_code(0);
    assert!(paths.stderr.contains("goal 2 of 3, to which the way costs least"), "{}", paths.stderr);
    scratch.run(&["verify", "run"]).assert_code(0);
    scratch.run(&["export", "run", "--format", "svg", "--out", "run.svg"]).assert_code(0);
    let picture = fs::read_to_string(scratch.path("run.svg")).expect("a picture");
    assert_eq!(picture.matches("class=\"goal\"").count(), 3);

    // One goal is another query, and says nothing of goals.
    let built = scratch.run(&["build", "near.toml", "--workers", "1", "--out", "near"]);
    built.assert_code(0);
    assert!(!built.stdout.contains("to goal"), "{}", built.stdout);
    let near = json(&fs::read_to_string(scratch.path("near/summary.json")).expect("a summary"));
    assert!(near["evaluators"][0].get("goal").is_none(), "{near}");

    // What is written is the same problem.
    scratch.run(&["import", "room.toml", "--out", "again.toml"]).assert_code(0);
    let again = fs::read_to_string(scratch.path("again.toml")).expect("a problem");
    assert!(again.contains("goal = [[4.5, 3.5], [3.0, 2.0], [5.5, 1.0]]"), "{again}");
    scratch.build("again", &["again.toml", "--workers", "1"], 0);
    assert_eq!(scratch.summary("again").digest, scratch.summary("run").digest);
}

#[test]
fn a_build_goes_on_with_other_goals() {
    let scratch = Scratch::new();
    // Sets about the ends of a query would need strategies of their own after a change of it.
    let uniform = "[[strategies]]\nlabel = \"u\"\nnodes = 50\nsampler = { uniform = {} }\n";
    let with = |goals: &str| format!("{}{uniform}", room(goals));
    scratch.write("walled.toml", &with("[[5.5, 1], [5.5, 3]]").replace("sets = 40", "sets = 5"));
    scratch.write("room.toml", &with(GOALS));
    // No goal can be reached.
    scratch.build("run", &["walled.toml", "--workers", "1"], 3);
    let went_on = scratch.run(&["resume", "run", "--with", "room.toml"]);
    went_on.assert_code(0);
    assert!(went_on.stdout.contains(" to goal 2\n"), "{}", went_on.stdout);
    scratch.run(&["verify", "run"]).assert_code(0);
    let asked = scratch.run(&["query", "run"]);
    assert!(asked.stderr.contains(" to goal 2 of 3, length "), "{}", asked.stderr);
}
