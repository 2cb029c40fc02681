//! What cannot be used is refused by file, line and reason, before anything is made; and what
//! every exit code stands for.

mod support;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use support::Scratch;

/// Sound, and satisfied within a round or two.
const BASE: &str = r#"name = "base"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [8.0, 4.0, 4.0]
bounds = "body"

[robot]
bodies = [{ shape = { box = { size = [0.5, 0.2, 0.2] } } }]

[[obstacles]]
shape = { box = { size = [0.2, 2.0, 2.0] } }
position = [4.0, 2.0, 2.0]
orientation = [1.0, 0.0, 0.0, 0.0]

[query]
start = [1.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]
goal = [7.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]

[img]
sets_per_round = 2

[[strategies]]
label = "a"
nodes = 30
sampler = { uniform = { attempts = 1000 } }
within = { nearest = { neighbors = 5 } }

[limits]
nodes = 5000
"#;

/// A wall from one end to the other is between start and goal.
const SEALED: (&str, &str) = ("size = [0.2, 2.0, 2.0]", "size = [0.2, 4.0, 4.0]");

/// [`BASE`] with a replacement, which must be possible.
fn changed((from, to): (&str, &str)) -> String {
    assert_eq!(BASE.matches(from).count(), 1, "{from}");
    BASE.replace(from, to)
}

fn line_of(text: &str, part: &str) -> usize {
    let at = text.find(part).expect("the part is there");
    1 + text[..at].matches('\n').count()
}

/// Files in a folder and below, with their contents.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("the folder is there").flatten() {
        let path = entry.path();
        if path.is_dir() {
            files.extend(contents(&path));
        } else {
            files.insert(path.clone(), fs::read(&path).expect("it can be read"));
        }
    }
    files
}

#[test]
fn the_problem_that_the_others_spoil_is_sound() {
    let scratch = Scratch::new();
    scratch.write("base.toml", BASE);
    scratch.build("run", &["base.toml", "--workers", "2"], 0);
    assert_eq!(scratch.summary("run").stop, "satisfied");
    assert!(scratch.path("run/path.csv").is_file());
}

#[test]
fn unusable_problems_are_refused_at_their_line() {
    const SIZE: &str = "shape = { box = { size = [0.2, 2.0, 2.0] } }";
    const POSITION: &str = "position = [4.0, 2.0, 2.0]";
    const ORIENTATION: &str = "orientation = [1.0, 0.0, 0.0, 0.0]";
    const START: &str = "start = [1.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]";
    const MAX: &str = "max = [8.0, 4.0, 4.0]";
    const SAMPLER: &str = "sampler = { uniform = { attempts = 1000 } }";
    let cases = [
        // unknown keys and words
        (SAMPLER, "sampler = { uniform = { attempt = 1000 } }", "attempt"),
        (SAMPLER, "sampler = { unform = {} }", "unform"),
        ("sets_per_round = 2", "set_per_round = 2", "set_per_round"),
        ("name = \"base\"", "nam = \"base\"", "nam"),
        ("motion = \"rigid-3d\"", "motion = \"rigid\"", "rigid"),
        // broken syntax
        (MAX, "max = [8.0, 4.0 4.0]", "expected"),
        ("label = \"a\"", "label = \"a", "string"),
        // meshes
        (SIZE, "shape = { mesh = { file = \"missing.obj\" } }", "missing.obj: cannot read"),
        (SIZE, "shape = { mesh = { file = \"empty.obj\" } }", "empty.obj: no faces"),
        (SIZE, "shape = { mesh = { file = \"flat.obj\" } }", "flat.obj: all 2 triangles have zero"),
        (SIZE, "shape = { mesh = { file = \"cut.obj\" } }", "cut.obj:2: "),
        // numbers
        (MAX, "max = [nan, 4.0, 4.0]", "NaN"),
        (MAX, "max = [inf, 4.0, 4.0]", "inf"),
        (MAX, "max = [8.0, -4.0, 4.0]", "more than min"),
        (MAX, "max = [8.0, 4.0]", "2 values found"),
        (SIZE, "shape = { box = { size = [0.2, nan, 2.0] } }", "NaN"),
        (SIZE, "shape = { sphere = { radius = 0.0 } }", "positive"),
        (POSITION, "position = [4.0, inf, 2.0]", "inf"),
        (ORIENTATION, "orientation = [0.0, 0.0, 0.0, 0.0]", "quaternion"),
        (ORIENTATION, "orientation = [nan, 0.0, 0.0, 0.0]", "quaternion"),
        // configurations
        (START, "start = [1.0, 2.0, 2.0, 0.0, 0.0, 0.0, 0.0]", "quaternion"),
        (START, "start = [nan, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]", "NaN"),
        (START, "start = [4.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]", "collides"),
        (START, "start = [9.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]", "x is 9, 0 to 8 expected"),
        (START, "start = [0.1, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0]", "the robot reaches 0.15"),
        (START, "start = [1.0, 2.0, 2.0]", "7 expected: x y z qw qx qy qz"),
        // counts
        ("sets_per_round = 2", "sets_per_round = 0", "0 found"),
        ("neighbors = 5", "neighbors = 0", "neighbors = 0 found"),
        ("attempts = 1000", "attempts = 0", "attempts = 0 found"),
        ("nodes = 30", "nodes = 1000000000000", "1000000000000 found"),
        ("nodes = 5000", "nodes = 1000000000000", "1000000000000 found"),
        // whole numbers
        ("nodes = 30\n", "nodes = -1\n", "strategies[0].nodes: -1 found; a whole number from 0 to"),
        (
            "neighbors = 5",
            "neighbors = -1",
            "strategies[0].within.nearest.neighbors: -1 found; a whole number from 0 to 4294967295 expected",
        ),
        (
            "attempts = 1000",
            "attempts = -4",
            "strategies[0].sampler.uniform.attempts: -4 found; a whole number from 0 to",
        ),
        (
            "attempts = 1000",
            "attempts = 2.5",
            "strategies[0].sampler.uniform.attempts: 2.5 found; a whole number from 0 to",
        ),
        (
            "attempts = 1000",
            "attempts = \"many\"",
            "strategies[0].sampler.uniform.attempts: \"many\" found; a whole number from 0 to",
        ),
        (
            "within = { nearest = { neighbors = 5 } }",
            "within = { neighbors = { finder = { randomised = { nearest = -1 } } } }",
            "finder.randomised.nearest: -1 found; a whole number from 0 to 4294967295 expected",
        ),
        (
            SAMPLER,
            "generator = { rrg = { neighbors = { hop_limit = -1 } } }",
            "rrg.neighbors.hop_limit: -1 found; a whole number from 0 to 4294967295 expected",
        ),
        (
            SAMPLER,
            "generator = { rrg = { neighbors = -1 } }",
            "rrg.neighbors: -1 found; \"auto\" or a whole number from 0 to 4294967295, or a table",
        ),
        (
            "sets_per_round = 2",
            "sets_per_round = -2",
            "img.sets_per_round: -2 found; a whole number from 0 to",
        ),
    ];
    let scratch = Scratch::new();
    scratch.write("empty.obj", "v 0 0 0\nv 1 0 0\n");
    scratch.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n");
    scratch.write("cut.obj", "v 0 0 0\nv 1 0");
    let mut wrong = Vec::new();
    for (from, to, reason) in cases {
        let text = changed((from, to));
        scratch.write("bad.toml", &text);
        let place = format!("bad.toml:{}: ", line_of(&text, to));
        for arguments in
            [&["build", "bad.toml", "--workers", "1", "--out", "run"][..], &["check", "bad.toml"]]
        {
            let done = scratch.run(arguments);
            let says = done.stderr.contains(&place) && done.stderr.contains(reason);
            if done.status.code() != Some(2) || !says || !done.stdout.is_empty() {
                wrong.push(format!("{to}\n{place}… {reason} expected of\n{done:?}"));
            }
        }
        assert!(!scratch.path("run").exists(), "{to}");
        assert!(scratch.temporary_files().is_empty(), "{to}: something was started");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn unusable_command_lines_are_refused() {
    let scratch = Scratch::new();
    scratch.write("base.toml", BASE);
    scratch.write("file", "a file, no folder");
    fs::create_dir(scratch.path("no-run")).expect("a folder can be made");
    scratch.write("no-run/notes.txt", "mine");
    scratch.build("run", &["base.toml", "--threads", "1"], 0);
    let before = contents(&scratch.path("."));
    let cases: [(&[&str], &[&str]); 24] = [
        (
            &["build", "base.toml", "--max-nodes", "1000000000000"],
            &["--max-nodes", "1000000000000"],
        ),
        (&["build", "base.toml", "--max-nodes", "0"], &["--max-nodes", "0 found"]),
        (&["build", "base.toml", "--max-sets", "0"], &["--max-sets", "0 found"]),
        (&["build", "base.toml", "--max-time", "0s"], &["--max-time"]),
        (&["build", "base.toml", "--workers", "0"], &["--workers", "0 found"]),
        (&["build", "base.toml", "--threads", "0"], &["--threads", "0 found"]),
        (&["build", "base.toml", "--workers", "1", "--threads", "1"], &["--threads"]),
        (&["build", "base.toml", "--force"], &["--out"]),
        (&["build", "missing.toml"], &["missing.toml", "cannot read"]),
        (&["build", "base.toml", "--out", "file/run"], &["file/run", "cannot make"]),
        (&["build", "base.toml", "--out", "/proc/run"], &["/proc/run", "cannot make"]),
        (&["build", "base.toml", "--out", "run"], &["run: exists already", "--force"]),
        (&["build", "base.toml", "--out", "no-run"], &["no-run: exists already"]),
        (&["build", "base.toml", "--out", "no-run", "--force"], &["no-run: holds no ledger"]),
        (&["build", "base.toml", "--out", "file", "--force"], &["file: not a folder"]),
        (&["query", "no-run"], &["no-run", "no run here"]),
        (&["status", "no-run"], &["no-run", "no run here"]),
        (&["resume", "no-run"], &["no-run", "no run here"]),
        (&["build", "base.toml", "--or-resume"], &["--out"]),
        (
            &["build", "base.toml", "--out", "no-run", "--or-resume"],
            &["no-run: holds `notes.txt` but no ledger"],
        ),
        (&["build", "base.toml", "--max-memory", "0"], &["--max-memory", "positive"]),
        (&["verify", "run", "--sample", "101%"], &["--sample", "percentage"]),
        (&["verify", "run", "--set", "b:0"], &["`b:0` found", "a label of a"]),
        (&["verify", "run", "--set", "a:99", "--threads", "1"], &["not every set"]),
    ];
    for (arguments, fragments) in cases {
        let done = scratch.run(arguments);
        done.assert_code(2);
        done.assert_stderr(fragments);
        let mut now = contents(&scratch.path("."));
        now.retain(|path, _| !is_output(path));
        let mut before = before.clone();
        before.retain(|path, _| !is_output(path));
        assert!(now == before, "{arguments:?} changed a file");
        assert!(!scratch.path("runs").exists(), "{arguments:?}");
    }
}

/// Where the support module keeps what the processes say.
fn is_output(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "stdout" || extension == "stderr")
}

#[test]
fn force_replaces_a_run() {
    let scratch = Scratch::new();
    scratch.write("base.toml", BASE);
    scratch.build("run", &["base.toml", "--threads", "1"], 0);
    scratch.write("run/old", "of the old run");
    let digest = scratch.build("run", &["base.toml", "--threads", "1", "--force"], 0);
    assert!(!scratch.path("run/old").exists());
    // A problem that cannot be used replaces nothing.
    scratch.write("bad.toml", "nonsense");
    scratch.run(&["build", "bad.toml", "--out", "run", "--force"]).assert_code(2);
    assert_eq!(scratch.summary("run").digest, digest);
}

#[test]
fn without_success_the_exit_code_is_3() {
    let scratch = Scratch::new();
    scratch.write("sealed.toml", &changed(SEALED));
    let limit = ["build", "sealed.toml", "--out", "run", "--workers", "2", "--max-nodes", "100"];
    let done = scratch.run(&limit);
    done.assert_code(3);
    done.assert_stderr(&["limit of 100 nodes", "before all criteria are met"]);
    assert!(!scratch.path("run/path.csv").exists());
    let done = scratch.run(&["query", "run"]);
    done.assert_code(3);
    done.assert_stderr(&["no path"]);
    assert_eq!(done.stdout, "");
}

/// `tests/ledger.rs` damages every byte; here it is seen that every command looks.
#[test]
fn every_command_finds_damage_to_a_ledger_and_leaves_it_alone() {
    let scratch = Scratch::new();
    scratch.write("base.toml", BASE);
    scratch.build("run", &["base.toml", "--threads", "1"], 0);
    let mut ledger = scratch.ledger("run");
    let place = ledger.len() * 3 / 4;
    ledger[place] ^= 0x10;
    fs::write(scratch.path("run/ledger"), &ledger).expect("it can be written");
    let commands: [&[&str]; 9] = [
        &["query", "run"],
        &["export", "run", "--format", "csv", "--out", "nodes.csv"],
        &["status", "run"],
        &["log", "run"],
        &["verify", "run", "--threads", "1"],
        &["diff", "run", "run"],
        &["resume", "run", "--threads", "1"],
        &["resume", "run", "--with", "base.toml", "--max-nodes", "9999"],
        &["build", "base.toml", "--out", "run", "--or-resume", "--threads", "1"],
    ];
    for arguments in commands {
        let done = scratch.run(arguments);
        done.assert_code(4);
        done.assert_stderr(&["run/ledger: record ", " at byte "]);
        assert!(scratch.ledger("run") == ledger, "{arguments:?}");
    }
}

#[test]
fn check_shows_the_grammar_of_configurations() {
    let scratch = Scratch::new();
    scratch.write("base.toml", BASE);
    let done = scratch.run(&["check", "base.toml"]);
    done.assert_code(0);
    assert!(done.stdout.contains("x y z qw qx qy qz"), "{}", done.stdout);
}

#[test]
fn help_lists_every_exit_code() {
    let scratch = Scratch::new();
    for arguments in [&["--help"][..], &["build", "--help"], &["verify", "--help"]] {
        let done = scratch.run(arguments);
        done.assert_code(0);
        let (_, table) = done.stdout.split_once("Exit codes:").expect("there is a table");
        let codes = table.lines().filter_map(|line| line.split_whitespace().next());
        let codes: Vec<&str> = codes.filter(|word| word.parse::<u8>().is_ok()).collect();
        assert_eq!(codes, ["0", "1", "2", "3", "4", "5", "6", "7"]);
    }
}

#[test]
fn json_is_an_object_per_line_and_the_last_is_the_summary() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", support::ENDLESS);
    // Long enough for a progress report on most machines; the lines are checked on all.
    let limits = ["--max-time", "1.5s", "--workers", "2"];
    let arguments = [&["build", "endless.toml", "--out", "run", "--json"], &limits[..]].concat();
    let done = scratch.run(&arguments);
    done.assert_code(0);
    let lines = done.stdout.lines().map(|line| {
        serde_json::from_str::<serde_json::Value>(line).unwrap_or_else(|e| panic!("{e}: {line}"))
    });
    let lines: Vec<_> = lines.collect();
    let (last, others) = lines.split_last().expect("there are lines");
    assert_eq!(last["event"], "summary");
    assert_eq!(last["stop"], "time-limit");
    assert_eq!(last["digest"], scratch.summary("run").digest);
    assert!(others.iter().all(|line| line["event"] == "progress"), "{others:?}");
}

#[test]
fn unnamed_run_folders_are_numbered() {
    let scratch = Scratch::new();
    scratch.write("other-name.toml", BASE);
    for expected in ["runs/base", "runs/base-2", "runs/base-3"] {
        let done = scratch.run(&["build", "other-name.toml", "--threads", "1"]);
        done.assert_code(0);
        assert!(done.stdout.contains(&format!("run         {expected}\n")), "{}", done.stdout);
        assert!(scratch.path(expected).join("ledger").is_file(), "{expected}");
    }
}
