//! Builds of energies and of sets that grow from the roadmap: through deaths and interruptions, verified, and with
//! sets made apart.

mod support;

use rustix::process::Signal;
use std::fs;
use support::{Done, Random, Scratch, send, wait_until};

/// Takes a moment, so that it can be disturbed.
const SETS: &str = "sets = 300\n";

/// The golden problem of this name in a folder, as `problem.toml`, with more sets. Its criteria are never met.
fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new();
    let golden = format!("{}/../tests/problems/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(golden).expect("it ships");
    let longer = text.replace("sets = 24\n", SETS);
    assert_ne!(longer, text);
    scratch.write("problem.toml", &longer);
    scratch
}

fn disturbed_builds_come_to_the_same(name: &str) {
    let scratch = scratch(name);
    let running = scratch.start(&["build", "problem.toml", "--out", "run", "--workers", "3"]);
    let mut random = Random::new(0x6d75);
    for _ in 0..6 {
        scratch.wait_for_rounds("run", 1);
        let mut workers = Vec::new();
        wait_until("a worker to kill", || {
            workers = running.workers();
            !workers.is_empty()
        });
        send(workers[random.below(workers.len())], Signal::KILL);
    }
    // Whoever was killed is replaced, or no further round would come.
    scratch.wait_for_rounds("run", 2);
    running.signal(Signal::KILL);
    running.finish();
    let status = scratch.run(&["status", "run"]);
    assert!(status.stdout.contains("state       killed"), "{}", status.stdout);

    let running = scratch.start(&["resume", "run", "--threads", "2"]);
    scratch.wait_for_rounds("run", 2);
    running.signal(Signal::TERM);
    running.finish().assert_code(6);
    assert_eq!(scratch.summary("run").stop, "interrupted");
    scratch.run(&["resume", "run", "--workers", "2"]).assert_code(3);

    let digest = scratch.build("undisturbed", &["problem.toml", "--threads", "1"], 3);
    assert_eq!(scratch.summary("run").digest, digest);
    let done = scratch.run(&["diff", "run", "undisturbed"]);
    done.assert_code(0);
    assert!(done.stdout.contains("the same 300 sets and judgements"), "{}", done.stdout);
    for crew in [["--workers", "2"], ["--threads", "1"]] {
        let done = scratch.run(&[&["verify", "run", "--all"], &crew[..]].concat());
        done.assert_code(0);
        assert!(done.stdout.contains("300 of 300 sets and 100 judgements"), "{}", done.stdout);
    }
}

#[test]
fn a_disturbed_build_in_an_energy_comes_to_the_same() {
    disturbed_builds_come_to_the_same("landscape");
}

#[test]
fn a_disturbed_build_of_sets_that_grow_comes_to_the_same() {
    disturbed_builds_come_to_the_same("expansion");
    disturbed_builds_come_to_the_same("growth");
}

fn generate(scratch: &Scratch, sets: &str, out: &str) -> Done {
    scratch.run(&["generate", "problem.toml", "--sets", sets, "--out", out, "--threads", "2"])
}

/// Builds with sets that were made apart; whoever made one of them again would die.
fn imported_sets_are_taken_in(name: &str, sets: &[&str], faults: &str) {
    let scratch = scratch(name);
    for (number, sets) in sets.iter().enumerate() {
        generate(&scratch, sets, &format!("{number}.sets")).assert_code(0);
    }
    let build = ["build", "problem.toml", "--workers", "2", "--max-sets", "48"];
    let imports = ["--import", "?.sets", "--out", "run"];
    let done = scratch.start_with_faults(&[&build[..], &imports].concat(), faults).finish();
    done.assert_code(3);
    scratch.build("plain", &["problem.toml", "--threads", "2", "--max-sets", "48"], 3);
    assert!(scratch.ledger("run") == scratch.ledger("plain"), "the ledgers differ");
    scratch.run(&["verify", "run", "--all", "--threads", "2"]).assert_code(0);
}

#[test]
fn sets_in_an_energy_can_be_made_apart() {
    imported_sets_are_taken_in(
        "landscape",
        &["low:0..11", "even:3..9"],
        "die-at=low:0,die-at=low:10,die-at=even:3,die-at=even:8",
    );
}

/// Of a problem in which sets grow, the others can be made apart.
#[test]
fn sets_that_grow_cannot_be_made_apart_and_the_others_can() {
    imported_sets_are_taken_in("expansion", &["uniform:2..30"], "die-at=uniform:2");
    let scratch = scratch("expansion");
    let done = generate(&scratch, "expansion:0..3", "grown.sets");
    done.assert_code(2);
    done.assert_stderr(&["--sets: the sets of `expansion` grow from the roadmap of a build"]);
    assert!(!scratch.path("grown.sets").exists());
}
