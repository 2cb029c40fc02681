//! What ends a build that has not met its criteria, and what is said of it.

mod support;

use roadmill::problem::{NODES_MAX, Problem};
use roadmill_coordinator::{Run, Workers};
use std::fs;
use std::path::Path;
use support::{ENDLESS, Scratch};

/// Over before any work is done, on every machine.
const NO_TIME: [&str; 2] = ["--max-time", "0.000001s"];

/// [`ENDLESS`] without its limit of nodes.
fn open() -> String {
    ENDLESS.replace("[limits]\nnodes = 4000000\n", "")
}

fn rounds(scratch: &Scratch) -> u64 {
    let status = scratch.run(&["status", "run", "--json"]);
    status.assert_code(0);
    let status: serde_json::Value = serde_json::from_str(&status.stdout).expect("it is JSON");
    status["rounds"].as_u64().expect("a number")
}

#[test]
fn every_call_finishes_a_round_however_short_its_time() {
    for crew in [["--threads", "1"], ["--workers", "1"]] {
        let scratch = Scratch::new();
        scratch.write("endless.toml", ENDLESS);
        let build = [&["build", "endless.toml", "--out", "run"], &NO_TIME[..], &crew].concat();
        let done = scratch.run(&build);
        done.assert_code(0);
        done.assert_stderr(&["`roadmill resume run` goes on; --max-time TIME"]);
        assert_eq!((rounds(&scratch), scratch.summary("run").stop.as_str()), (1, "time-limit"));
        // However slow the disk, what goes into the ledger before the first round is a part of the time.
        let summary = fs::read(scratch.path("run/summary.json")).expect("there is a summary");
        let summary: serde_json::Value = serde_json::from_slice(&summary).expect("it is JSON");
        let seconds = |key: &str| summary[key].as_f64().expect("a number");
        assert!(seconds("ledger_seconds") <= seconds("wall_seconds"), "{summary}");
        // The limit of the first call is the run's.
        for expected in [2, 3] {
            scratch.run(&[&["resume", "run"], &crew[..]].concat()).assert_code(0);
            assert_eq!(rounds(&scratch), expected);
        }
        assert_eq!(scratch.summary("run").digest, scratch.undisturbed_digest(12));
    }
}

/// A limit of time does not come between a round and its judgement.
#[test]
fn a_build_that_its_time_ends_has_judged_its_last_round() {
    let scratch = Scratch::new();
    let criterion = "[[evaluators]]\ncoverage = { percent = 100, samples = { random = 200 } }\n";
    scratch.write("judged.toml", &format!("{ENDLESS}{criterion}"));
    let build =
        [&["build", "judged.toml", "--out", "run", "--threads", "1"], &NO_TIME[..]].concat();
    let done = scratch.run(&build);
    done.assert_code(3);
    done.assert_stderr(&["the limit of time is reached before all criteria are met", "resume run"]);
    assert!(done.stdout.contains("evaluator   coverage 0."), "{}", done.stdout);
    let status = scratch.run(&["status", "run"]);
    assert!(status.stdout.contains("evaluator   coverage 0."), "{}", status.stdout);
    assert!(status.stdout.contains("to go on    `roadmill resume run`"), "{}", status.stdout);
}

#[test]
fn the_end_at_a_limit_names_the_option_that_goes_on() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    for (number, (option, value)) in
        [("--max-nodes", "100"), ("--max-sets", "8"), ("--max-memory", "1M")]
            .into_iter()
            .enumerate()
    {
        let run = format!("run{number}");
        let build = ["build", "endless.toml", "--out", &run, "--threads", "1", option, value];
        let done = scratch.run(&build);
        done.assert_code(0);
        let way = format!("`roadmill resume {run}` goes on");
        done.assert_stderr(&[&way, option]);
        if option != "--max-memory" {
            let again = scratch.run(&["resume", &run, "--threads", "1"]);
            again.assert_code(0);
            again.assert_stderr(&["the build has ended before", &way]);
        }
    }
    let before = scratch.summary("run0").sets;
    let done = scratch.run(&["resume", "run0", "--threads", "1", "--max-nodes", "150"]);
    done.assert_code(0);
    assert!(scratch.summary("run0").sets > before, "it went on");
}

/// Where a time is given it is the limit; else a number that goes by memory; and what is given is kept.
#[test]
fn nodes_that_are_left_open_give_way_to_a_limit_of_time() {
    let folder = tempfile::tempdir().expect("a folder");
    let load = |text: &str| Problem::parse(Path::new("open.toml"), text).expect("it is sound");
    let grown = |name: &str, text: &str, seconds: Option<f64>| {
        let begun = Run::begin(load(text)).folder(folder.path().join(name));
        let begun = begun.workers(&Workers::threads(1)).max_sets(4);
        begun.max_seconds(seconds).grow().expect("it can be begun").problem().limits().nodes
    };
    let by_memory = load(&open()).limits().nodes;
    assert!((1_000_000..NODES_MAX).contains(&by_memory), "{by_memory}");
    assert_eq!(grown("open", &open(), None), by_memory);
    assert_eq!(grown("timed", &open(), Some(1000.0)), NODES_MAX);
    assert_eq!(grown("given", ENDLESS, Some(1000.0)), 4_000_000);
    // A number that is given is meant, though it is what the limit would be if it were left open.
    let same = ENDLESS.replace("nodes = 4000000", &format!("nodes = {by_memory}"));
    assert_eq!(grown("given-the-same", &same, Some(1000.0)), by_memory);
    let seconds = format!("{}[limits]\nseconds = 1000\n", open());
    assert_eq!(grown("in-the-file", &seconds, None), NODES_MAX);
    let both = format!("{}[limits]\nseconds = 1000\nnodes = 70\n", open());
    assert_eq!(grown("both", &both, None), 70);
}

/// A run keeps the limit that it was begun with, as long as nothing is said of it.
#[test]
fn a_run_of_an_earlier_default_is_gone_on_with() {
    let scratch = Scratch::new();
    scratch.write("open.toml", &open());
    let build = ["build", "open.toml", "--out", "run", "--threads", "1"];
    // As an earlier version would have begun it, and as this one does.
    scratch.run(&[&build[..], &NO_TIME, &["--max-nodes", "100000"]].concat()).assert_code(0);
    for limits in [&NO_TIME[..], &["--max-time", "0.000002"]] {
        scratch.run(&[&build[..], limits, &["--or-resume"]].concat()).assert_code(0);
    }
    assert_eq!(rounds(&scratch), 3);
    let run = Run::at(scratch.path("run")).read().expect("it is sound");
    assert_eq!(run.problem().limits().nodes, 100_000);
    let other = scratch.run(&[&build[..], &["--max-nodes", "99", "--or-resume"]].concat());
    other.assert_code(2);
    other.assert_stderr(&["the limits are not those of the run"]);
    // A number that is given is meant, though an earlier version had it as its default.
    let another = ["build", "open.toml", "--out", "another", "--threads", "1"];
    scratch.run(&[&another[..], &NO_TIME].concat()).assert_code(0);
    let given = scratch.run(&[&another[..], &["--max-nodes", "100000", "--or-resume"]].concat());
    given.assert_code(2);
    given.assert_stderr(&["the limits are not those of the run"]);
}

/// A limit of time is one of the call: the problem file's as it is now, not as it was when the run was begun.
#[test]
fn a_run_goes_on_under_the_time_that_its_file_has_now() {
    let scratch = Scratch::new();
    let build = [
        "build",
        "timed.toml",
        "--out",
        "run",
        "--threads",
        "1",
        "--max-sets",
        "30",
        "--or-resume",
    ];
    for (seconds, stop) in [("0.000001", "time-limit"), ("1000", "set-limit")] {
        scratch.write(
            "timed.toml",
            &ENDLESS.replace("[limits]", &format!("[limits]\nseconds = {seconds}")),
        );
        scratch.run(&build).assert_code(0);
        assert_eq!(scratch.summary("run").stop, stop);
    }
}
