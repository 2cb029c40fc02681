//! Builds that are killed, ended or held, and go on.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{frames, ledger_of};
use rustix::process::Signal;
use std::fs;
use support::{ENDLESS, Running, Scratch, wait_until};

/// Takes a moment, so that it can be disturbed.
const SETS: &str = "600";

fn start(scratch: &Scratch, command: &[&str]) -> Running {
    scratch.write("endless.toml", ENDLESS);
    scratch.start(&[command, &["--max-sets", SETS]].concat())
}

fn undisturbed(scratch: &Scratch) -> String {
    scratch.write("endless.toml", ENDLESS);
    scratch.build("undisturbed", &["endless.toml", "--threads", "2", "--max-sets", SETS], 0)
}

#[test]
fn a_killed_build_goes_on_with_any_crew_and_writes_the_same_bytes() {
    let scratch = Scratch::new();
    let build = ["build", "endless.toml", "--out", "run", "--or-resume"];
    // Begun by processes, gone on by threads, ended by processes.
    for crew in [["--workers", "2"], ["--threads", "2"]] {
        let running = start(&scratch, &[&build[..], &crew].concat());
        scratch.wait_for_rounds("run", 3);
        running.signal(Signal::KILL);
        running.finish();
    }
    let status = scratch.run(&["status", "run"]);
    status.assert_code(0);
    assert!(status.stdout.contains("state       killed"), "{}", status.stdout);
    let done = scratch.run(&["resume", "run", "--workers", "3"]);
    done.assert_code(0);
    done.assert_stderr(&["goes on after"]);
    assert_eq!(scratch.summary("run").digest, undisturbed(&scratch));
    assert!(scratch.ledger("run") == scratch.ledger("undisturbed"), "the ledgers differ");
    // What went into the parts that were killed nobody knows.
    assert_eq!(scratch.summary("run").run_cpu_seconds, None);

    // There is nothing left to do, and it says so.
    for arguments in [&["resume", "run"][..], &[&build[..], &["--max-sets", SETS]].concat()] {
        let done = scratch.run(arguments);
        done.assert_code(0);
        done.assert_stderr(&["the build has ended before: the limit of 600 sets is reached"]);
    }
    assert!(scratch.ledger("run") == scratch.ledger("undisturbed"));
    scratch.run(&["verify", "run", "--sample", "2%", "--workers", "2"]).assert_code(0);
}

#[test]
fn an_interrupted_build_goes_on_and_has_the_stop_besides() {
    let scratch = Scratch::new();
    let running = start(&scratch, &["build", "endless.toml", "--out", "run", "--threads", "2"]);
    scratch.wait_for_rounds("run", 2);
    running.signal(Signal::TERM);
    running.finish().assert_code(6);
    let first = scratch.summary("run");
    assert_eq!((&*first.stop, first.run_cpu_seconds), ("interrupted", Some(first.cpu_seconds)));
    let shorter = scratch.run(&["status", "run", "--json"]);
    assert!(shorter.stdout.contains("\"state\":\"interrupted\""), "{}", shorter.stdout);
    scratch.run(&["resume", "run", "--threads", "1"]).assert_code(0);
    let second = scratch.summary("run");
    let whole = second.run_cpu_seconds.expect("both parts told their ends");
    assert!((whole - first.cpu_seconds - second.cpu_seconds).abs() < 1e-9);
    assert_eq!(second.digest, undisturbed(&scratch));
    let done = scratch.run(&["diff", "run", "undisturbed"]);
    done.assert_code(0);
    assert!(done.stdout.contains("the same 600 sets and judgements"), "{}", done.stdout);
    let stops = |run: &str| {
        frames(&scratch.ledger(run)).iter().filter(|frame| frame.payload[0] == 4).count()
    };
    assert_eq!((stops("run"), stops("undisturbed")), (2, 1));
}

/// Both are pending when the process runs again, so the second comes before it could have ended.
#[test]
fn a_second_signal_ends_a_build_at_once_and_it_goes_on() {
    let scratch = Scratch::new();
    let running = start(&scratch, &["build", "endless.toml", "--out", "run", "--threads", "2"]);
    scratch.wait_for_rounds("run", 2);
    running.signal(Signal::STOP);
    let stopped = || support::Process::of(running.pid()).is_some_and(|it| it.state == 'T');
    wait_until("the stop", stopped);
    running.signal(Signal::INT);
    running.signal(Signal::TERM);
    running.signal(Signal::CONT);
    running.finish().assert_code(6);
    assert!(!scratch.path("run/summary.json").exists(), "it had no time for a summary");
    scratch.run(&["resume", "run", "--threads", "2"]).assert_code(0);
    assert_eq!(scratch.summary("run").digest, undisturbed(&scratch));
    assert!(scratch.ledger("run") == scratch.ledger("undisturbed"), "the ledgers differ");
}

#[test]
fn a_second_process_on_a_run_is_refused_and_readers_are_not() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let running = scratch.start(&["build", "endless.toml", "--out", "run", "--workers", "2"]);
    scratch.wait_for_rounds("run", 2);
    let holder = format!("process {} on host ", running.pid());
    let others: [&[&str]; 3] = [
        &["resume", "run"],
        &["build", "endless.toml", "--out", "run", "--or-resume"],
        &["build", "endless.toml", "--out", "run", "--force"],
    ];
    for arguments in others {
        let done = scratch.run(arguments);
        done.assert_code(2);
        done.assert_stderr(&[&holder, "works on this run"]);
    }
    let watch = scratch.start(&["status", "run", "--watch", "--json"]);
    let status = scratch.run(&["status", "run"]);
    assert!(status.stdout.contains(&format!("state       running: {holder}")), "{status:?}");
    let pose = "1 0.6 1 1 0 0 0";
    scratch.run(&["query", "run", "--start", pose, "--goal", pose]).assert_code(0);
    scratch.run(&["export", "run", "--format", "csv", "--out", "nodes.csv"]).assert_code(0);
    scratch.run(&["verify", "run", "--set", "a:1", "--threads", "1"]).assert_code(0);
    scratch.wait_for_rounds("run", 2);
    running.signal(Signal::INT);
    running.finish().assert_code(6);
    let watched = watch.finish();
    watched.assert_code(0);
    let last = watched.stdout.lines().last().unwrap_or_default();
    assert!(last.contains("\"state\":\"interrupted\""), "{last}");
    let summary = scratch.summary("run");
    assert_eq!(summary.digest, scratch.undisturbed_digest(summary.sets));
}

/// A wall with a hole, told apart by its file.
fn walled(mesh: &str, more: &str) -> String {
    format!(
        "seed = 2\n[space]\nmotion = \"translation-2d\"\nmin = [0.0, 0.0]\nmax = [4.0, 4.0]\n\
         bounds = \"body\"\n[robot]\nbodies = [{{ shape = {{ sphere = {{ radius = 0.1 }} }} }}]\n\
         [[obstacles]]\nshape = {{ mesh = {{ file = \"{mesh}\" }} }}\n{more}"
    )
}

const WEDGE: &str = "v 1 1 -1\nv 2 1 -1\nv 1 2 -1\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const ONE: &str = "[[strategies]]\nlabel = \"one\"\nnodes = 5\nsampler = { uniform = {} }\n";
const TWO: &str = "[[strategies]]\nlabel = \"two\"\nnodes = 7\nsampler = { uniform = {} }\n";

#[test]
fn a_change_of_the_problem_is_refused_with_the_reason_or_opens_a_chapter() {
    let scratch = Scratch::new();
    scratch.write("wedge.obj", WEDGE);
    let limit = |sets: u32| format!("[limits]\nsets = {sets}\n");
    let first = walled("wedge.obj", &format!("{ONE}{}", limit(10)));
    scratch.write("first.toml", &first);
    scratch.build("run", &["first.toml", "--threads", "1"], 0);
    let ledger = scratch.ledger("run");

    let further = walled("wedge.obj", &format!("{TWO}{ONE}{}", limit(30)));
    scratch.write("further.toml", &further);
    scratch.write("moved.toml", &first.replace("radius = 0.1", "radius = 0.2"));
    scratch.write("other.toml", &first.replace("nodes = 5", "nodes = 6"));
    let or_resume = |problem: &'static str| ["build", problem, "--out", "run", "--or-resume"];
    let refused = |arguments: &[&str], reasons: &[&str]| {
        let done = scratch.run(arguments);
        done.assert_code(2);
        done.assert_stderr(&[&["run: cannot go on: "], reasons].concat());
        assert!(scratch.ledger("run") == ledger, "{arguments:?}");
    };
    refused(&or_resume("further.toml"), &["the strategies are not those", "resume --with"]);
    refused(&or_resume("moved.toml"), &["the robot is not what it was"]);
    refused(&["resume", "run", "--with", "moved.toml"], &["the robot is not what it was"]);
    refused(&["resume", "run", "--with", "other.toml"], &["strategy `one` is not what it was"]);
    scratch.write("wedge.obj", &WEDGE.replace("v 2 1", "v 3 1"));
    refused(&or_resume("first.toml"), &["wedge.obj has changed"]);
    refused(&["resume", "run", "--with", "first.toml"], &["obstacle", "wedge.obj has changed"]);
    // The same triangles from other bytes: a build that only goes on wants the file as it was.
    scratch.write("wedge.obj", &format!("# a remark\n{WEDGE}"));
    refused(&or_resume("first.toml"), &["wedge.obj has changed"]);

    // A chapter; asked for again, it goes on with that chapter.
    let chapter = ["resume", "run", "--with", "further.toml", "--threads", "2"];
    let done = scratch.run(&chapter);
    done.assert_code(0);
    done.assert_stderr(&["in a new chapter"]);
    let grown = scratch.ledger("run");
    assert!(grown.starts_with(&ledger), "what was there stays");
    scratch.run(&chapter).assert_code(0);
    assert!(scratch.ledger("run") == grown);
    let log = scratch.run(&["log", "run"]).stdout;
    let sets: Vec<_> = log.lines().skip(1).filter_map(|line| line.split(' ').nth(2)).collect();
    assert_eq!(sets.len(), 30);
    assert_eq!(sets[8..14], ["one:8", "one:9", "two:0", "one:10", "two:1", "one:11"]);
    let status = scratch.run(&["status", "run"]).stdout;
    assert!(status.contains("chapters    2"), "{status}");

    // Limits of the command line make one too; it can be verified through all of them.
    scratch.run(&["resume", "run", "--max-sets", "35", "--workers", "2"]).assert_code(0);
    let done = scratch.run(&["verify", "run", "--all", "--threads", "2"]);
    done.assert_code(0);
    assert!(done.stdout.contains("35 of 35 sets and 9 judgements"), "{}", done.stdout);
    scratch.run(&["export", "run", "--format", "npz", "--out", "roadmap.npz"]).assert_code(0);
}

#[test]
fn a_limit_of_memory_ends_a_build_at_a_rounds_end_and_it_goes_on() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let limits = ["--max-memory", "1M", "--workers", "1"];
    scratch.build("run", &[&["endless.toml", "--max-sets", "40"], &limits[..]].concat(), 0);
    let summary = scratch.summary("run");
    assert_eq!(summary.stop, "memory-limit");
    assert!(summary.sets >= 4 && summary.sets < 40, "{summary:?}");
    scratch.run(&["resume", "run", "--threads", "1"]).assert_code(0);
    assert_eq!(scratch.summary("run").digest, scratch.undisturbed_digest(40));
}

/// Records that are whole in themselves but not what the seeds give.
#[test]
fn verify_names_the_first_difference_and_diff_the_reason() {
    let scratch = Scratch::new();
    scratch.write("wedge.obj", WEDGE);
    scratch.write("p.toml", &walled("wedge.obj", &format!("{ONE}{TWO}[limits]\nsets = 20\n")));
    for (run, seed) in [("run", "2"), ("other", "3")] {
        scratch.build(run, &["p.toml", "--seed", seed, "--threads", "1"], 0);
    }
    let payloads = |run: &str| frames(&scratch.ledger(run)).into_iter().map(|frame| frame.payload);
    let forge = |ledger: Vec<u8>| {
        fs::write(scratch.path("run/ledger"), ledger).expect("it can be written");
        fs::remove_file(scratch.path("run/ledger.durable")).unwrap_or_default();
    };
    let diff = scratch.run(&["diff", "run", "other"]);
    diff.assert_code(7);
    diff.assert_stderr(&["first difference: set one:0 (number 0, round 0): node 0, x: "]);
    assert!(diff.stdout.contains("seed: 2 and 3"), "{}", diff.stdout);

    let genuine: Vec<Vec<u8>> = payloads("run").collect();
    // What a set claims to have cost is the last that its record holds.
    let mut claims = genuine.clone();
    for record in [4, 2] {
        let at = claims[record].len() - 16;
        claims[record][at] ^= 1;
    }
    forge(ledger_of(claims));
    let verify =
        |choice: &[&str]| scratch.run(&[&["verify", "run", "--threads", "2"], choice].concat());
    let done = verify(&["--all"]);
    done.assert_code(7);
    done.assert_stderr(&[
        "run: joining set two:0: recorded and recomputed differ",
        "configurations",
    ]);
    verify(&["--set", "one:0", "--set", "two:2"]).assert_code(0);
    verify(&["--set", "two:1"]).assert_code(7);

    // Another seed's sets under this seed's beginning.
    forge(ledger_of(genuine[..1].iter().cloned().chain(payloads("other").skip(1))));
    let done = verify(&["--all"]);
    done.assert_code(7);
    done.assert_stderr(&["run: generating set one:0: recorded and recomputed differ: node 0, x: "]);

    // Bits of another version: they can be read, but not recomputed nor added to.
    let mut bits = genuine.clone();
    let version = 4 + 8 + (8 + env!("CARGO_PKG_VERSION").len());
    assert_eq!(bits[0][version], roadmill::BITS_VERSION as u8);
    bits[0][version] += 1;
    forge(ledger_of(bits));
    let words = format!("bits of version {}", roadmill::BITS_VERSION + 1);
    let done = verify(&["--set", "one:0"]);
    done.assert_code(2);
    done.assert_stderr(&["set one:0 needs a roadmill with", &words]);
    let done = scratch.run(&["resume", "run", "--max-sets", "22"]);
    done.assert_code(2);
    done.assert_stderr(&[&words, "--accept-bits"]);
    scratch.run(&["export", "run", "--format", "csv", "--out", "nodes.csv"]).assert_code(0);
    let accepted = ["resume", "run", "--max-sets", "30", "--accept-bits", "--threads", "1"];
    scratch.run(&accepted).assert_code(0);
    verify(&["--set", "one:11"]).assert_code(0);
    verify(&["--set", "one:1"]).assert_code(2);
}

/// A disc that passes a wall, by trees about the ends of its query and by sets that know nothing of it.
const ABOUT_ENDS: &str = r#"
evaluators = []
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [8.0, 6.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[[obstacles]]
shape = { box = { size = [0.4, 3.0, 1.0] } }
position = [4.0, 3.0, 0.0]
[query]
start = [1.0, 3.0]
goal = [7.0, 3.0]
[img]
sets_per_round = 2
[[strategies]]
label = "u"
nodes = 10
sampler = { uniform = {} }
[[strategies]]
label = "trees"
nodes = 15
generator = { rrt-connect = { step = 0.5 } }
[limits]
sets = 8
"#;

#[test]
fn a_build_goes_on_with_another_query_and_each_set_is_verified_under_its_own() {
    let scratch = Scratch::new();
    let chapter = |label: &str, start: &str, sets: u32| {
        let text = ABOUT_ENDS.replace("\"trees\"", &format!("{label:?}"));
        let text = text.replace("start = [1.0, 3.0]", &format!("start = {start}"));
        text.replace("sets = 8", &format!("sets = {sets}"))
    };
    scratch.write("one.toml", ABOUT_ENDS);
    scratch.build("run", &["one.toml", "--threads", "1"], 0);
    let resume = |text: &str| {
        scratch.write("with.toml", text);
        scratch.run(&["resume", "run", "--with", "with.toml", "--threads", "2"])
    };
    let before = scratch.ledger("run");
    let same_label = resume(&chapter("trees", "[1.0, 5.0]", 16));
    same_label.assert_code(2);
    same_label.assert_stderr(&["the strategy `trees`", "one with a label of its own expected"]);
    let query = "[query]\nstart = [1.0, 5.0]\ngoal = [7.0, 3.0]\n";
    let without = chapter("u2", "[1.0, 5.0]", 16).replace(query, "");
    let without =
        without.replace("rrt-connect = { step = 0.5 }", "sample = { sampler = { uniform = {} } }");
    let without = resume(&without);
    without.assert_code(2);
    without.assert_stderr(&["no [query] found, but the strategy `trees`"]);
    assert!(scratch.ledger("run") == before, "the ledger has changed");

    resume(&chapter("others", "[1.0, 5.0]", 16)).assert_code(0);
    // Back to the first query, and on with it as before but for the limit.
    resume(&chapter("back", "[1.0, 3.0]", 24)).assert_code(0);
    resume(&chapter("back", "[1.0, 3.0]", 32)).assert_code(0);
    for crew in [["--threads", "2"], ["--workers", "2"]] {
        let all = scratch.run(&["verify", "run", "--all", crew[0], crew[1]]);
        all.assert_code(0);
        assert!(all.stdout.contains("32 of 32 sets"), "{}", all.stdout);
    }
    let named = ["--set", "trees:0", "--set", "others:1", "--set", "back:7"];
    let some = scratch.run(&[&["verify", "run", "--threads", "1"], &named[..]].concat());
    some.assert_code(0);
    assert!(some.stdout.contains("3 of 32 sets"), "{}", some.stdout);
    let missing = ["verify", "run", "--set", "trees:0", "--set", "trees:7", "--threads", "1"];
    scratch.run(&missing).assert_code(2);
    scratch.run(&["query", "run"]).assert_code(0);
}
