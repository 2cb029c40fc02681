//! Signals end a build after its last complete round, which is saved.

mod support;

use rustix::process::Signal;
use support::{ENDLESS, Scratch, wait_until};

fn ends_a_build(signal: Signal, executor: [&str; 2]) {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let arguments = ["build", "endless.toml", "--out", "run", executor[0], executor[1]];
    let build = scratch.start(&arguments);
    scratch.wait_for_rounds("run", 3);
    build.signal(signal);
    let done = build.finish();
    done.assert_code(6);
    done.assert_stderr(&["signal"]);
    assert!(done.stdout.contains("a signal came"), "{}", done.stdout);

    let summary = scratch.summary("run");
    assert_eq!(summary.stop, "interrupted");
    assert!(summary.sets >= 8, "{summary:?}");
    assert!(done.stdout.contains(&format!("digest {}", summary.digest)), "{}", done.stdout);
    assert_eq!(summary.digest, scratch.undisturbed_digest(summary.sets), "{summary:?}");
    let pose = "1 0.6 1 1 0 0 0";
    scratch.run(&["query", "run", "--start", pose, "--goal", pose]).assert_code(0);
}

#[test]
fn sigint_ends_a_build() {
    ends_a_build(Signal::INT, ["--workers", "2"]);
}

#[test]
fn sigterm_ends_a_build() {
    ends_a_build(Signal::TERM, ["--workers", "2"]);
}

#[test]
fn sighup_ends_a_build() {
    ends_a_build(Signal::HUP, ["--workers", "2"]);
}

#[test]
fn sigint_ends_a_build_in_threads() {
    ends_a_build(Signal::INT, ["--threads", "2"]);
}

/// While the workers start, too.
#[test]
fn a_signal_before_the_first_round_ends_a_build() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let build = scratch.start(&["build", "endless.toml", "--out", "run", "--workers", "4"]);
    // Made once signals are listened to.
    wait_until("the run folder", || scratch.path("run").is_dir());
    build.signal(Signal::INT);
    build.finish().assert_code(6);
    assert_eq!(scratch.summary("run").stop, "interrupted");
}

/// A set of a million nodes takes far longer than anybody waits.
#[test]
fn a_signal_ends_generate_within_a_set_and_leaves_nothing() {
    let scratch = Scratch::new();
    let large = ENDLESS.replace("nodes = 12", "nodes = 1000000");
    assert_ne!(large, ENDLESS);
    scratch.write("large.toml", &large);
    std::fs::create_dir(scratch.path("parts")).expect("a folder can be made");
    let generate = ["generate", "large.toml", "--sets", "a:0..4", "--out", "parts/a.sets"];
    let running = scratch.start(&[&generate[..], &["--threads", "2"]].concat());
    wait_until("the file", || !support::children(&scratch.path("parts")).is_empty());
    std::thread::sleep(std::time::Duration::from_millis(300));
    running.signal(Signal::INT);
    let done = running.finish();
    done.assert_code(6);
    done.assert_stderr(&["a signal came; nothing is written"]);
    assert!(support::children(&scratch.path("parts")).is_empty());
}
