//! What is printed: output that is lost is a failure, a reader that has left is none, and names from files do nothing
//! to a terminal.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{frames, ledger_of};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;
use support::{Done, SMALL, Scratch};

/// Runs a script in the folder of `scratch`; `$roadmill` is the program.
fn sh(scratch: &Scratch, script: &str) -> Done {
    let mut command = Command::new("sh");
    command.args(["-c", script]).env("roadmill", env!("CARGO_BIN_EXE_roadmill"));
    scratch.start_command(command, "").finish()
}

fn scratch() -> Scratch {
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    scratch.build("run", &["small.toml", "--threads", "1"], 0);
    scratch
}

const COMMANDS: [&str; 11] = [
    "query run",
    "log run",
    "log run --json",
    "status run",
    "status run --json",
    "diff run run",
    "verify run --threads 1",
    "check small.toml",
    "build small.toml --out other --threads 1 --json",
    "import small.toml --out copy.toml",
    "--help",
];

#[test]
fn lost_output_is_a_failure_with_a_message() {
    let scratch = scratch();
    for command in COMMANDS {
        let done = sh(&scratch, &format!("$roadmill {command} > /dev/full"));
        assert_eq!(done.status.code(), Some(1), "{command}: {}", done.stderr);
        done.assert_stderr(&["cannot write to standard output: No space left on device"]);
    }
}

#[test]
fn a_reader_that_has_left_ends_a_command_quietly() {
    let scratch = scratch();
    for name in ["other", "copy.toml"] {
        let _ = fs::remove_dir_all(scratch.path(name));
    }
    for command in COMMANDS {
        // The reader is gone before anything is printed.
        let script = format!(
            "mkfifo fifo; exec 3<>fifo 4>fifo; exec 3<&-; rm fifo
             $roadmill {command} >&4 2> messages; echo code $?"
        );
        let done = sh(&scratch, &script);
        assert_eq!(done.stdout, "code 0\n", "{command}");
        let messages = fs::read_to_string(scratch.path("messages")).expect("there are some");
        assert!(!messages.contains("cannot write") && !messages.contains("panicked"), "{messages}");
    }
}

#[test]
fn messages_that_nobody_can_read_change_nothing() {
    let scratch = scratch();
    let commands = [
        ("build small.toml --out new --workers 2", 0),
        ("build small.toml --out new", 2),
        ("query run", 0),
        ("check none.toml", 2),
        ("nonsense", 2),
    ];
    for (command, code) in commands {
        sh(&scratch, &format!("$roadmill {command} 2> /dev/full")).assert_code(code);
    }
    assert!(scratch.ledger("run") == scratch.ledger("new"), "the ledgers differ");
}

/// Line breaks, tabs and blanks of a label move nothing, and columns stay columns.
#[test]
fn labels_break_neither_lines_nor_columns() {
    let scratch = Scratch::new();
    let label =
        |end: &str| SMALL.replace("label = \"a\"", &format!("label = \"a b\\nc\\td{end}\""));
    scratch.write("small.toml", &label(""));
    scratch.write("other.toml", &label("e"));
    scratch.build("run", &["small.toml", "--threads", "1"], 0);
    scratch.build("other", &["other.toml", "--threads", "1"], 0);
    let check = scratch.run(&["check", "small.toml"]).stdout;
    assert!(
        check.contains("\nstrategy         a b\\nc\\td: 20 nodes per set, sampler = { uniform"),
        "{check}"
    );
    assert!(check.contains("\nschedule         a b\\nc\\td, over and over"), "{check}");
    let log = scratch.run(&["log", "run"]).stdout;
    let columns: Vec<usize> = log.lines().map(|line| line.split_whitespace().count()).collect();
    assert!(columns.len() > 1 && columns.iter().all(|count| *count == 10), "{log}");
    assert!(log.contains(" a\\u{20}b\\nc\\td:0 "), "{log}");
    for (command, shown) in [
        (&["diff", "run", "other"][..], "it is a b\\nc\\td:0 and a b\\nc\\tde:0"),
        (&["verify", "run", "--set=b:0"][..], "with a label of a b\\nc\\td"),
    ] {
        let done = scratch.run(command);
        assert!(done.stderr.trim_end().ends_with(shown), "{}", done.stderr);
        assert_eq!(done.stderr.lines().count(), 1, "{}", done.stderr);
    }
}

/// A label, the reason of a stop and a problem's file name may hold anything.
#[test]
fn names_from_files_do_nothing_to_a_terminal() {
    let scratch = Scratch::new();
    let label = "a\\u001b]0;title\\u0007\\u009b31m\\u202Eb";
    let text = SMALL.replace("label = \"a\"", &format!("label = \"{label}\""));
    assert_ne!(text, SMALL);
    scratch.write("small.toml", &text);
    scratch.build("run", &["small.toml", "--threads", "1"], 0);
    // A stop with a reason that would clear the screen.
    let mut payloads: Vec<_> =
        frames(&scratch.ledger("run")).into_iter().map(|f| f.payload).collect();
    let stop = payloads.last_mut().expect("a stop");
    let length = stop.len();
    stop[length - 4..].copy_from_slice(b"\x1b[2J");
    fs::write(scratch.path("run").join("ledger"), ledger_of(payloads)).expect("it is written");
    fs::remove_file(scratch.path("run").join("ledger.durable")).expect("it is there");
    for command in [
        "log run",
        "log run --json",
        "status run",
        "status run --json",
        "query run",
        "verify run --all --threads 1",
        "check small.toml",
        "diff run run",
    ] {
        let done = sh(&scratch, &format!("$roadmill {command}"));
        let printed = format!("{}{}", done.stdout, done.stderr);
        let acts = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(!printed.contains(acts), "{command}: {printed:?}");
    }
    let done = scratch.run(&["log", "run"]);
    assert!(done.stdout.contains("a\\u{1b}]0;title"), "{}", done.stdout);
}

#[test]
fn files_that_others_may_read_follow_the_umask_and_shared_memory_does_not() {
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    let script = "umask 022
        $roadmill build small.toml --out shared/run --workers 2
        $roadmill generate small.toml --sets a:0..2 --out shared/part.sets --threads 1
        $roadmill export shared/run --format csv --out shared/out
        $roadmill query shared/run --out shared/path.csv
        umask 077; $roadmill build small.toml --out own --workers 1";
    sh(&scratch, script).assert_code(0);
    let mode = |name: &str| {
        let metadata = fs::metadata(scratch.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        metadata.permissions().mode() & 0o777
    };
    for name in ["shared", "shared/run"] {
        assert_eq!(mode(name), 0o755, "{name}");
    }
    for name in ["ledger", "ledger.durable", "lock", "summary.json", "path.csv"] {
        assert_eq!(mode(&format!("shared/run/{name}")), 0o644, "{name}");
        assert_eq!(mode(&format!("own/{name}")), 0o600, "{name}");
    }
    for name in ["shared/part.sets", "shared/path.csv"] {
        assert_eq!(mode(name), 0o644, "{name}");
    }
    assert_eq!(mode("own"), 0o700);
}

/// Files that may not grow further are errors of the write, not the end of the process.
#[test]
fn a_limit_of_file_sizes_is_an_error_and_nothing_is_left_behind() {
    let scratch = scratch();
    for command in [
        "export run --format graphml --out out.graphml",
        "generate small.toml --sets a:0..50 --out out.sets --threads 1",
        "build small.toml --out out --threads 1",
    ] {
        // In units of 512 or 1024 bytes, as the shell likes.
        let done =
            sh(&scratch, &format!("(ulimit -f 2; $roadmill {command}; echo code $?) 2>&1 | cat"));
        assert!(done.stdout.contains("File too large"), "{command}: {}", done.stdout);
        assert!(done.stdout.contains("code 1"), "{command}: {}", done.stdout);
    }
    let names = support::children(&scratch.path(""));
    let is_out = |path: &&std::path::PathBuf| path.to_string_lossy().contains("/out");
    assert_eq!(names.iter().filter(is_out).count(), 0, "{names:?}");
}
