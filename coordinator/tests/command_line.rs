//! What the command line offers beside its commands: versions, completions, manual pages, standard output as a file.

mod support;

use std::fs;
use support::{SMALL, Scratch};

#[test]
fn the_version_tells_which_programs_give_the_same_bits() {
    let done = Scratch::new().run(&["--version"]);
    done.assert_code(0);
    let bits = roadmill::BITS_VERSION;
    let expected = format!("roadmill {} (bits version {bits})\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(done.stdout, expected);
}

#[test]
fn shells_complete_commands_and_options() {
    let scratch = Scratch::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let done = scratch.run(&["completions", shell]);
        done.assert_code(0);
        for word in ["verify", "max-nodes", "or-resume"] {
            assert!(done.stdout.contains(word), "{shell} does not complete {word}");
        }
    }
    scratch.run(&["completions", "perl"]).assert_code(2);
}

#[test]
fn every_command_has_a_manual_page() {
    let scratch = Scratch::new();
    let done = scratch.run(&["man"]);
    done.assert_code(0);
    assert!(done.stdout.contains(".TH roadmill 1"), "{}", done.stdout);
    assert!(done.stdout.contains("Exit codes"), "{}", done.stdout);
    scratch.run(&["man", "--out", "pages/man1"]).assert_code(0);
    for name in ["roadmill", "roadmill-build", "roadmill-protein", "roadmill-protein-info"] {
        let page = fs::read_to_string(scratch.path(&format!("pages/man1/{name}.1")));
        let page = page.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(page.contains("Examples"), "{page}");
    }
    let hidden = scratch.path("pages/man1/roadmill-worker.1");
    assert!(!hidden.exists(), "a command that is hidden has a page");
}

#[test]
fn a_dash_is_standard_output() {
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    scratch.build("run", &["small.toml", "--threads", "1"], 0);
    for format in ["graphml", "npz", "svg"] {
        let file = format!("as.{format}");
        scratch.run(&["export", "run", "--format", format, "--out", &file]).assert_code(0);
        // Not read as text: an archive of arrays is none.
        let script = format!("$roadmill export run --format {format} --out - | cmp - {file}");
        let mut command = std::process::Command::new("sh");
        command.args(["-c", &script]).env("roadmill", env!("CARGO_BIN_EXE_roadmill"));
        scratch.start_command(command, "").finish().assert_code(0);
    }
    assert!(!scratch.path("-").exists());
    let done = scratch.run(&["query", "run", "--out", "-"]);
    done.assert_code(0);
    assert!(done.stdout.starts_with("x [length],y [length]\n"), "{}", done.stdout);

    let done = scratch.run(&["export", "run", "--format", "csv", "--out", "-"]);
    done.assert_code(2);
    done.assert_stderr(&["--out: - found, but csv is 2 files"]);
    let done = scratch.run(&["report", "run", "--out", "-"]);
    done.assert_code(2);
    done.assert_stderr(&["--out: - found; the name of a regular file expected"]);
}

/// A ball in a room that a block fills: it collides everywhere within its bounds.
const FILLED: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[[obstacles]]
shape = { box = { size = [10.0, 10.0, 1.0] } }
position = [4.5, 4.5, 0.0]
[[strategies]]
label = "a"
nodes = 20
sampler = { uniform = { attempts = 50 } }
"#;

#[test]
fn a_build_that_finds_nothing_says_what_is_in_the_way() {
    let scratch = Scratch::new();
    scratch.write("filled.toml", FILLED);
    let done = scratch.run(&["build", "filled.toml", "--threads", "1", "--out", "run"]);
    done.assert_code(3);
    let culprit = "most often the robot collides with obstacles[0]";
    done.assert_stderr(&["filled: 0 of 1000 uniform draws are valid", culprit, "obprm"]);
    let done = scratch.run(&["check", "filled.toml"]);
    done.assert_code(0);
    assert!(done.stdout.contains("draws            0 of 1000 uniform draws are valid"));
    assert!(done.stdout.contains(culprit), "{}", done.stdout);
}

#[test]
fn check_gives_the_reasons_at_a_configuration() {
    let scratch = Scratch::new();
    scratch.write("filled.toml", FILLED);
    scratch.write("small.toml", SMALL);
    let done = scratch.run(&["check", "small.toml", "--at", "3 3"]);
    done.assert_code(0);
    assert_eq!(done.stdout, "valid\n");
    for (problem, at, expected) in [
        ("small.toml", "-1 3", "x is -1, 0 to 9 expected\n"),
        ("small.toml", "3, 8.9", "the robot reaches 0.1"),
        ("filled.toml", "4.5 4.5", "the robot collides with obstacles[0], "),
    ] {
        let done = scratch.run(&["check", problem, "--at", at, "--picture", "at.svg"]);
        done.assert_code(3);
        assert!(done.stdout.starts_with(expected), "{at}: {}", done.stdout);
        let picture = fs::read_to_string(scratch.path("at.svg")).expect("it is drawn");
        assert!(picture.contains("class=\"robot\""), "{at}: no robot is drawn");
        assert!(picture.contains(expected.trim_end()), "{at}: the reason is not in the picture");
    }
    let done = scratch.run(&["check", "filled.toml", "--at", "4.5 4.5", "--json"]);
    done.assert_code(3);
    let answer: serde_json::Value = serde_json::from_str(&done.stdout).expect("an object");
    assert_eq!(answer["valid"], false);
    let reason = &answer["reasons"][0];
    assert_eq!(reason["reason"], "collision");
    assert_eq!(
        (&reason["body"]["link"], &reason["other"]["obstacle"]),
        (&"robot".into(), &0.into())
    );
    // Out along an axis of the plane: half the block and the ball's radius.
    let depth = reason["depth"].as_f64().expect("a number");
    assert!((depth - 5.2).abs() < 1e-2, "{depth}");
    for (at, expected) in [("1 2 3", "3 values found, 2 expected: x y"), ("1 a", "`a` found")] {
        let done = scratch.run(&["check", "filled.toml", "--at", at]);
        done.assert_code(2);
        done.assert_stderr(&[expected]);
    }
}

#[test]
fn diff_names_the_keys_that_were_changed() {
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    scratch.write("other.toml", &SMALL.replace("nodes = 20", "nodes = 25"));
    scratch.build("run", &["small.toml", "--threads", "1"], 0);
    scratch.build("other", &["other.toml", "--threads", "1"], 0);
    let done = scratch.run(&["diff", "run", "other"]);
    done.assert_code(7);
    assert!(done.stdout.contains("\nstrategies[0].nodes: 20 and 25\n"), "{}", done.stdout);
}

#[test]
fn a_build_that_has_ended_says_how_to_look_at_it() {
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    let done = scratch.run(&["build", "small.toml", "--threads", "1", "--out", "run"]);
    done.assert_code(0);
    let line = done.stderr.lines().find(|line| line.contains("to look at it: `roadmill "));
    let command = line.and_then(|line| line.split('`').nth(1)).expect("a command");
    let words: Vec<&str> = command.split(' ').skip(1).collect();
    scratch.run(&words).assert_code(0);
    assert!(scratch.path("run-view.html").exists());
}

#[test]
fn strategies_are_compared_and_a_comparison_that_was_cut_off_goes_on() {
    let scratch = Scratch::new();
    // The direct way is closed: a wall with a gap at the top.
    let wall =
        "[[obstacles]]\nshape = { box = { size = [0.5, 8.0, 1.0] } }\nposition = [4.5, 4.0, 0.0]\n";
    scratch.write("wall.toml", &format!("{SMALL}{wall}[[evaluators]]\nquery = {{}}\n"));
    let command = |seeds: &str, more: &[&str]| {
        let out = if more.is_empty() { "c" } else { "beyond" };
        let all = ["compare", "wall.toml", "--samplers", "own", "halton", "--seeds", seeds];
        let limits = ["--threads", "1", "--max-nodes", "2000", "--out", out];
        let done = scratch.run(&[&all[..], &limits, more].concat());
        done.assert_code(0);
        done
    };
    let first = command("1-2", &[]);
    assert_eq!(first.stdout.lines().count(), 3, "{}", first.stdout);
    let row = |label: &str, text: &str| {
        text.lines().find(|line| line.starts_with(label)).expect("a row").to_owned()
    };
    assert!(row("own", &first.stdout).contains("2 of 2"), "{}", first.stdout);
    let ledger = scratch.ledger("c/runs/own-1");
    let of_seeds_before: Vec<String> = table(&scratch, "c/compare.csv");
    // Goes on: the runs that are there are taken as they are.
    let second = command("1-3", &[]);
    assert!(row("halton", &second.stdout).contains("3 of 3"), "{}", second.stdout);
    assert!(ledger == scratch.ledger("c/runs/own-1"));
    let all = table(&scratch, "c/compare.csv");
    assert_eq!(all.len(), 1 + 6, "{all:?}");
    assert!(of_seeds_before.iter().all(|line| all.contains(line)), "{all:?}");
    let curves = table(&scratch, "c/curves.csv");
    assert_eq!(curves[0], "strategy,seed,nodes,query");
    let page = fs::read_to_string(scratch.path("c/compare.html")).expect("a page");
    assert!(page.contains("How large a roadmap?"));

    // Runs that were asked for otherwise are not mixed with these.
    let start = ["compare", "wall.toml", "--samplers", "own", "--seeds", "1", "--threads", "1"];
    for (otherwise, said) in [
        (&["--max-nodes", "2000", "--go-on"][..], "by other criteria, or with or without --go-on"),
        (&["--max-nodes", "3000"], "within other limits"),
    ] {
        let done = scratch.run(&[&start[..], &["--out", "c"], otherwise].concat());
        done.assert_code(2);
        done.assert_stderr(&["c/runs/own-1: ", said, "another --out is expected"]);
    }
    // A comparison that cannot go on has all that there is in its tables, not only what comes before.
    fs::create_dir(scratch.path("c/runs/gap-1")).expect("a folder can be made");
    scratch.write("c/runs/gap-1/notes.txt", "mine");
    let gap = "gap = { sampler = { gaussian = { deviation = 0.5 } } }";
    let more =
        ["compare", "wall.toml", "--samplers", "own", gap, "--seeds", "1-3", "--threads", "1"];
    let done = scratch.run(&[&more[..], &["--max-nodes", "2000", "--out", "c"]].concat());
    done.assert_code(2);
    done.assert_stderr(&["c/runs/gap-1: holds `notes.txt`"]);
    let own: Vec<String> = table(&scratch, "c/compare.csv");
    assert_eq!(own.iter().filter(|line| line.starts_with("own,")).count(), 3, "{own:?}");

    // Beyond the criteria: to the limit, and yet it is told when they were met.
    let done = command("1", &["--go-on", "--json"]);
    for line in done.stdout.lines() {
        let built: serde_json::Value = serde_json::from_str(line).expect("an object");
        assert!(built["nodes"].as_u64() >= Some(2000), "{built}");
        let met = built["nodes_when_met"].as_u64().expect("met on the way");
        assert!(met < 2000, "{built}");
    }

    for (strategies, expected) in [
        ("unifrm", "unknown variant `unifrm`"),
        ("a/b = { sampler = { uniform = {} } }", "a label of letters"),
        ("own = { sampler = { uniform = {} } }", "another label expected"),
    ] {
        let done = scratch.run(&["compare", "wall.toml", "--samplers", strategies, "--out", "d"]);
        done.assert_code(2);
        done.assert_stderr(&[expected]);
        assert!(!scratch.path("d").exists());
    }
}

fn table(scratch: &Scratch, name: &str) -> Vec<String> {
    let text = fs::read_to_string(scratch.path(name)).expect("a table");
    text.lines().map(str::to_owned).collect()
}
