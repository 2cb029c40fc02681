//! What the command line offers beside its commands: versions, completions, manual pages, standard output as a file.

mod support;

use std::fs;
use support::Scratch;

const SMALL: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[query]
start = [1.0, 1.0]
goal = [8.0, 8.0]
[[strategies]]
label = "a"
nodes = 20
sampler = { uniform = {} }
"#;

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
    assert!(scratch.path("path.html").exists());
}
