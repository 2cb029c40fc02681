//! Whoever dies, nothing changes: workers, the coordinator, and a set that kills.

mod support;

use rustix::process::Signal;
use std::collections::BTreeSet;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;
use support::{
    ENDLESS, Process, Random, Running, Scratch, left_of, processes_naming, send, wait_until,
};

fn start_endless(scratch: &Scratch, run: &str, workers: &str) -> Running {
    scratch.write("endless.toml", ENDLESS);
    scratch.start(&["build", "endless.toml", "--out", run, "--workers", workers])
}

/// Ends a build by a signal and compares it with an undisturbed one.
fn assert_undisturbed(scratch: &Scratch, run: &str, build: Running) {
    build.signal(Signal::INT);
    build.finish().assert_code(6);
    let summary = scratch.summary(run);
    assert!(summary.sets > 0, "{summary:?}");
    assert_eq!(summary.digest, scratch.undisturbed_digest(summary.sets), "{summary:?}");
}

/// Asks a roadmap of [`ENDLESS`] for a path: there may be none, but the run must be readable.
fn assert_readable(scratch: &Scratch, run: &str) {
    let (start, goal) = ("1 0.6 1 1 0 0 0", "7.2 3.5 3 1 0 0 0");
    let done = scratch.run(&["query", run, "--start", start, "--goal", goal]);
    assert!(matches!(done.status.code(), Some(0 | 3)), "{done:?}");
}

#[test]
fn workers_killed_at_any_moment_are_replaced_and_change_nothing() {
    const WORKERS: usize = 3;
    let scratch = Scratch::new();
    let build = start_endless(&scratch, "run", "3");
    let mut random = Random::new(0x5eed);
    let mut killed = BTreeSet::new();
    for kill in 1..=24 {
        let mut workers = Vec::new();
        wait_until("a worker to kill", || {
            workers = build.workers();
            !workers.is_empty()
        });
        let victim = workers[random.below(workers.len())];
        send(victim, Signal::KILL);
        killed.insert(victim);
        // From at once, which hits a replacement while it starts, to long after.
        sleep(Duration::from_millis(random.below(250) as u64));
        if kill % 3 == 0 {
            // A build whose workers only die is given up.
            scratch.wait_for_rounds("run", 1);
        }
    }
    wait_until("replacements", || {
        let workers = build.workers();
        workers.len() == WORKERS && workers.iter().all(|worker| !killed.contains(worker))
    });
    scratch.wait_for_rounds("run", 2);
    assert_undisturbed(&scratch, "run", build);
}

#[test]
fn a_worker_stopped_for_a_while_is_waited_for() {
    let scratch = Scratch::new();
    let build = start_endless(&scratch, "run", "2");
    scratch.wait_for_rounds("run", 1);
    let workers = build.workers();
    let stopped = workers[0];
    send(stopped, Signal::STOP);
    let is_stopped = || Process::of(stopped).is_some_and(|process| process.state == 'T');
    wait_until("the stop", is_stopped);
    sleep(Duration::from_secs(2));
    assert!(is_stopped(), "nobody has ended or continued it");
    send(stopped, Signal::CONT);
    scratch.wait_for_rounds("run", 2);
    assert_eq!(build.workers(), workers);
    assert_undisturbed(&scratch, "run", build);
}

#[test]
fn when_the_coordinator_is_killed_workers_end_and_the_next_run_tidies_up() {
    let scratch = Scratch::new();
    let build = start_endless(&scratch, "killed", "3");
    scratch.wait_for_rounds("killed", 3);
    let coordinator = build.pid();
    let temporary = scratch.temporary();
    wait_until("workers that name the folder", || processes_naming(&temporary).len() == 3);
    build.signal(Signal::KILL);
    assert_eq!(build.finish().status.code(), None);
    wait_until("the end of the workers", || processes_naming(&temporary).is_empty());
    assert!(!scratch.temporary_files().is_empty(), "this would test nothing");
    let left = left_of(coordinator, &temporary);
    assert!(left.iter().any(|path| path.starts_with("/dev/shm")), "{left:?}");

    // What it had written is what every build writes, up to the moment of its death.
    assert_readable(&scratch, "killed");
    let other = start_endless(&scratch, "other", "2");
    let killed = scratch.ledger("killed");
    wait_until("as long a ledger", || scratch.ledger("other").len() >= killed.len());
    other.signal(Signal::INT);
    other.finish().assert_code(6);
    assert!(scratch.ledger("other").starts_with(&killed), "the ledgers differ");

    assert_eq!(left_of(coordinator, &temporary), [] as [&Path; 0]);
    assert_eq!(scratch.temporary_files(), [] as [&Path; 0]);
}

#[test]
fn a_set_that_kills_its_workers_ends_the_build_by_name() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let arguments = ["build", "endless.toml", "--out", "run", "--workers", "2"];
    // Far enough behind what is generated ahead for some rounds to be complete.
    let done = scratch.start_with_faults(&arguments, "die-at=b:12").finish();
    done.assert_code(5);
    done.assert_stderr(&["b:12"]);
    let summary = scratch.summary("run");
    assert_eq!(summary.stop, "deadly-job");
    assert!(summary.sets > 0, "{summary:?}");
    assert_eq!(summary.digest, scratch.undisturbed_digest(summary.sets), "{summary:?}");
    assert_readable(&scratch, "run");
}

/// Rubbish, an answer that was given before, and half a message: the worker is replaced.
#[test]
fn a_worker_that_talks_nonsense_is_replaced_and_changes_nothing() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let arguments = ["build", "endless.toml", "--out", "run", "--workers", "2", "--max-sets", "48"];
    let faults = [("garble-at", "a:5"), ("twice-at", "b:4"), ("half-at", "a:14")];
    let mark = |name: &str| scratch.path(name);
    let named = faults.map(|(name, set)| format!("{name}={set}:{}", mark(name).display()));
    scratch.start_with_faults(&arguments, &named.join(",")).finish().assert_code(0);
    assert!(faults.iter().all(|(name, _)| mark(name).is_file()), "the faults came about");
    assert_eq!(scratch.summary("run").digest, scratch.undisturbed_digest(48));
}

/// More often than as many workers may die at a job.
#[test]
fn a_job_is_not_blamed_for_workers_that_talk_nonsense_about_it() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let arguments = ["build", "endless.toml", "--out", "run", "--workers", "2", "--max-sets", "48"];
    let marks: Vec<_> = (0..4).map(|number| scratch.path(&format!("mark-{number}"))).collect();
    let named: Vec<_> =
        marks.iter().map(|mark| format!("garble-at=b:4:{}", mark.display())).collect();
    scratch.start_with_faults(&arguments, &named.join(",")).finish().assert_code(0);
    assert!(marks.iter().all(|mark| mark.is_file()), "the faults came about");
    assert_eq!(scratch.summary("run").digest, scratch.undisturbed_digest(48));
}

#[test]
fn workers_that_never_start_end_the_build() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let arguments = ["build", "endless.toml", "--out", "run", "--workers", "2"];
    let done = scratch.start_with_faults(&arguments, "no such fault").finish();
    done.assert_code(5);
    done.assert_stderr(&["ROADMILL_FAULTS", "without finishing a job"]);
    assert_eq!(scratch.summary("run").stop, "workers-lost");
}

#[test]
fn a_ledger_that_cannot_be_written_ends_the_build() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let arguments = ["build", "endless.toml", "--out", "run", "--workers", "2"];
    // More than the channel's files need.
    let done = scratch.start_with_file_limit(&arguments, 6144).finish();
    done.assert_code(1);
    done.assert_stderr(&["run/ledger: cannot write the ledger"]);
    // Nobody has killed it.
    let status = scratch.run(&["status", "run"]);
    assert!(status.stdout.contains("state       failed"), "{}", status.stdout);
    assert_readable(&scratch, "run");
}
