//! Runs that go on from another run's roadmap after obstacles have come, moved and gone.

mod support;

use rustix::process::Signal;
use std::fs;
use support::{ENDLESS, Scratch, wait_until};

/// A wall has moved, the pillar has gone, and a ball has come.
fn changed() -> String {
    let changed = ENDLESS.replace("position = [4.0, 1.3, 2.0]", "position = [4.4, 1.3, 2.0]");
    let pillar =
        "shape = { cylinder = { radius = 0.6, height = 4.0 } }\nposition = [6.0, 2.0, 2.0]";
    assert!(changed.contains(pillar));
    changed.replace(pillar, "shape = { sphere = { radius = 0.5 } }\nposition = [1.0, 2.0, 2.0]")
}

/// A folder with the run `old`, and the problem `changed.toml`.
fn scratch() -> Scratch {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    scratch.build("old", &["endless.toml", "--threads", "1", "--max-sets", "12"], 0);
    scratch.write("changed.toml", &changed());
    scratch
}

const REPLAN: [&str; 4] = ["replan", "old", "--with", "changed.toml"];

fn replan(scratch: &Scratch, out: &str, arguments: &[&str]) -> support::Done {
    scratch.run(&[&REPLAN[..], &["--out", out], arguments].concat())
}

#[test]
fn a_replanned_run_has_the_same_bits_for_any_workers_and_names_its_parent() {
    let scratch = scratch();
    for (out, crew) in [
        ("one", ["--workers", "1"]),
        ("two", ["--workers", "2"]),
        ("four", ["--workers", "4"]),
        ("threads", ["--threads", "2"]),
    ] {
        let done = replan(&scratch, out, &[&crew[..], &["--max-sets", "30"]].concat());
        done.assert_code(0);
        assert!(done.stdout.contains("1 obstacle came, 1 moved, 1 went"), "{}", done.stdout);
        assert!(scratch.ledger(out) == scratch.ledger("one"), "the ledger of {out} differs");
        scratch.run(&["verify", out, "--all", "--threads", "2"]).assert_code(0);
    }
    scratch.run(&["verify", "two", "--all", "--workers", "2"]).assert_code(0);
    // One set of survivors makes the first round, and the problem's own schedule begins with the second.
    let log = scratch.run(&["log", "one"]).stdout;
    let sets: Vec<&str> = log.lines().filter(|line| line.contains("survivors:")).collect();
    assert_eq!(sets.len(), 1, "{log}");
    for set in ["survivors:0", "a:0", "b:0", "a:1"] {
        assert!(log.contains(set), "{set} in {log}");
    }
}

#[test]
fn the_run_that_is_gone_on_with_is_not_replaced() {
    let scratch = scratch();
    let before = scratch.ledger("old");
    fs::create_dir(scratch.path("above")).expect("a new folder");
    scratch.build("above/old", &["endless.toml", "--threads", "1", "--max-sets", "12"], 0);
    for (run, out) in [("old", "old"), ("old", "./old/"), ("above/old", "above")] {
        let done = scratch.run(&["replan", run, "--with", "changed.toml", "--out", out, "--force"]);
        done.assert_code(2);
        assert!(done.stderr.contains("the run that is gone on with is there"), "{}", done.stderr);
    }
    assert!(scratch.ledger("old") == before && scratch.ledger("above/old") == before);
}

#[test]
fn verify_needs_the_parent() {
    let scratch = scratch();
    replan(&scratch, "new", &["--threads", "2", "--max-sets", "20"]).assert_code(0);
    let verify = |arguments: &[&str]| {
        scratch.run(&[&["verify", "new", "--all", "--threads", "2"], arguments].concat())
    };
    verify(&[]).assert_code(0);
    // Moved together they find each other.
    fs::create_dir(scratch.path("elsewhere")).expect("a folder can be made");
    for run in ["old", "new"] {
        let to = scratch.path(&format!("elsewhere/{run}"));
        fs::rename(scratch.path(run), to).expect("it can be moved");
    }
    scratch.run(&["verify", "elsewhere/new", "--threads", "1"]).assert_code(0);
    fs::rename(scratch.path("elsewhere/new"), scratch.path("new")).expect("it can be moved");
    let lost = verify(&[]);
    lost.assert_code(2);
    lost.assert_stderr(&["the run that it replans is needed", "old", "--parent says where it is"]);
    verify(&["--parent", "elsewhere/old"]).assert_code(0);
    // A parent that has gone on, and a run that was never it.
    let more = ["resume", "elsewhere/old", "--max-sets", "16", "--threads", "1"];
    scratch.run(&more).assert_code(0);
    let changed = verify(&["--parent", "elsewhere/old"]);
    changed.assert_code(2);
    changed.assert_stderr(&["its ledger has the hash", "expected"]);
    verify(&["--parent", "new"]).assert_code(2);
    verify(&["--parent", "nowhere"]).assert_code(2);
    // What is no such run needs none, and takes none.
    scratch.run(&["verify", "elsewhere/old", "--all", "--threads", "2"]).assert_code(0);
    for parent in ["nowhere", "new"] {
        let done = scratch.run(&["verify", "elsewhere/old", "--parent", parent, "--threads", "1"]);
        done.assert_code(2);
        done.assert_stderr(&["elsewhere/old: replans no other run", "--parent", parent]);
    }
}

/// Runs are reached by links, to the folder that they are in and to themselves, and by ways back through links.
#[test]
fn a_parent_is_found_again_by_whatever_links_it_was_reached() {
    let scratch = scratch();
    fs::create_dir_all(scratch.path("far/away/runs")).expect("a folder can be made");
    std::os::unix::fs::symlink("far/away", scratch.path("link")).expect("a link can be made");
    std::os::unix::fs::symlink("../../../old", scratch.path("far/away/runs/latest"))
        .expect("a link");
    for (old, out) in [
        ("old", "link/new"),
        ("link/runs/latest", "by-link"),
        ("link/../../old", "link/runs/new"),
        ("old", "link/runs/../other"),
    ] {
        let call = ["replan", old, "--with", "changed.toml", "--out", out, "--threads", "1"];
        scratch.run(&[&call[..], &["--max-sets", "4"]].concat()).assert_code(0);
        scratch.run(&["verify", out, "--threads", "1"]).assert_code(0);
    }
    // Without the links, too.
    scratch.run(&["verify", "far/away/runs/new", "--threads", "1"]).assert_code(0);
    fs::remove_file(scratch.path("link")).expect("it can be removed");
    scratch.run(&["verify", "far/away/new", "--threads", "1"]).assert_code(0);
}

#[test]
fn a_place_that_is_taken_is_told_before_anything_is_computed() {
    let scratch = scratch();
    fs::create_dir(scratch.path("mine")).expect("a folder can be made");
    scratch.write("mine/notes.txt", "mine");
    scratch.build("run", &["endless.toml", "--threads", "1", "--max-sets", "1"], 0);
    for (arguments, said) in [
        (&["--out", "run"][..], "run: exists already"),
        (&["--out", "mine"], "mine: exists already"),
        (&["--out", "mine", "--force"], "mine: holds no ledger"),
        (&["--out", "changed.toml", "--force"], "changed.toml: not a folder"),
        (&["--out", "mine", "--or-resume"], "mine: holds `notes.txt` but no ledger"),
        (&["--out", "run/new"], "in the folder of the run"),
    ] {
        let done = scratch.run(&[&REPLAN[..], arguments].concat());
        done.assert_code(2);
        done.assert_stderr(&[said]);
        assert_eq!(done.stdout, "", "{arguments:?}");
        // `build` has the same words.
        let build = scratch.run(&[&["build", "endless.toml"], arguments].concat());
        build.assert_code(2);
        build.assert_stderr(&[said]);
    }
}

#[test]
fn a_run_of_something_else_is_told_before_anything_is_computed() {
    let scratch = scratch();
    let sets = ["--max-sets", "6", "--threads", "1"];
    replan(&scratch, "new", &sets).assert_code(0);
    scratch.build("plain", &["endless.toml", "--threads", "1", "--max-sets", "1"], 0);
    scratch.build("other", &["endless.toml", "--threads", "1", "--max-sets", "13"], 0);
    scratch.write("third.toml", &changed().replace("[1.0, 2.0, 2.0]", "[1.2, 2.0, 2.0]"));
    for (call, said) in [
        (&["old", "--with", "changed.toml", "--out", "plain"][..], "it goes on from no other run"),
        (&["old", "--with", "third.toml", "--out", "new"], "is not what it was"),
        (&["old", "--with", "changed.toml", "--out", "new", "--seed", "9"], "the seed is 9"),
        (&["other", "--with", "changed.toml", "--out", "new"], "its ledger has the hash"),
    ] {
        let done = scratch.run(&[&["replan"], call, &["--or-resume"], &sets[..]].concat());
        done.assert_code(2);
        done.assert_stderr(&["cannot go on: ", said, "another --out expected"]);
        assert_eq!(done.stdout, "", "{call:?}");
    }
    replan(&scratch, "new", &[&sets[..], &["--or-resume"]].concat()).assert_code(0);
}

/// A roadmap with more ways than anybody waits for, of which all are looked for.
#[test]
fn the_search_for_old_paths_ends_with_the_time_or_a_signal() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    scratch.build("old", &["endless.toml", "--threads", "1", "--max-sets", "200"], 0);
    let query = "[query]\nstart = [1.0, 0.6, 1.0, 1.0, 0.0, 0.0, 0.0]\ngoal = [7.2, 3.0, 3.0, 1.0, 0.0, 0.0, 0.0]\n";
    scratch.write("changed.toml", &(changed() + query));
    let many = [&REPLAN[..], &["--paths", "1000", "--threads", "1", "--out", "new"]].concat();
    // No time at all: the search is cut, and the one round that every build makes is made.
    let done = scratch.run(&[&many[..], &["--max-time", "1e-9"]].concat());
    assert!(matches!(done.status.code(), Some(0 | 3)), "{done:?}");
    let cut = "the time was up before the search for them was over";
    assert!(done.stdout.contains(cut), "{}", done.stdout);
    scratch.run(&["verify", "new", "--threads", "1"]).assert_code(0);

    fs::remove_dir_all(scratch.path("new")).expect("it can be removed");
    let running = scratch.start(&many);
    wait_until("signals are listened to", || running.catches(Signal::INT) || !running.is_alive());
    running.signal(Signal::INT);
    let done = running.finish();
    done.assert_code(6);
    done.assert_stderr(&["a signal came; no run is made"]);
    assert!(!scratch.path("new").exists());
}

#[test]
fn a_killed_replanning_goes_on_and_writes_the_same_bytes() {
    let scratch = scratch();
    let sets = ["--max-sets", "600"];
    replan(&scratch, "undisturbed", &[&sets[..], &["--threads", "2"]].concat()).assert_code(0);
    for (crew, rounds) in [(["--workers", "2"], 1), (["--threads", "2"], 10)] {
        let call = [&REPLAN[..], &["--out", "run", "--or-resume"], &sets[..], &crew].concat();
        let running = scratch.start(&call);
        scratch.wait_for_rounds_or("run", rounds, || !running.is_alive());
        running.signal(Signal::KILL);
        running.finish();
    }
    scratch.run(&["resume", "run", "--workers", "3"]).assert_code(0);
    assert!(scratch.ledger("run") == scratch.ledger("undisturbed"), "the ledgers differ");
    scratch.run(&["verify", "run", "--sample", "2%", "--workers", "2"]).assert_code(0);
    // It can be gone on with by other criteria, and replanned itself.
    scratch.write(
        "more.toml",
        &changed().replace("label = \"b\"", "label = \"c\"").replace("\"b\"", "\"c\""),
    );
    let more = ["resume", "run", "--with", "more.toml", "--max-sets", "620", "--threads", "2"];
    scratch.run(&more).assert_code(0);
    let again = ["replan", "run", "--with", "endless.toml", "--out", "back", "--max-sets", "10"];
    scratch.run(&again).assert_code(0);
    for run in ["run", "back"] {
        scratch.run(&["verify", run, "--sample", "1%", "--threads", "2"]).assert_code(0);
    }
    scratch.run(&["verify", "back", "--set", "survivors:0", "--threads", "1"]).assert_code(0);
}

/// A disc that can pass a wall above and below.
const DISC: &str = r#"
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
nodes = 60
sampler = { uniform = {} }
"#;

const CRATE: &str =
    "[[obstacles]]\nshape = { box = { size = [0.4, 1.6, 1.0] } }\nposition = [4.0, 5.2, 0.0]\n";

#[test]
fn paths_of_the_old_roadmap_are_tried_before_anything_grows() {
    let scratch = Scratch::new();
    scratch.write("disc.toml", DISC);
    // Without criteria it goes on to its limit.
    let many = format!("evaluators = []\n{DISC}[limits]\nsets = 6\n");
    scratch.write("many.toml", &many);
    scratch.write("above.toml", &(DISC.to_owned() + CRATE));
    let both = CRATE.replace("5.2", "0.8");
    scratch.write("closed.toml", &(DISC.to_owned() + CRATE + &both + "[limits]\nsets = 9\n"));
    scratch.build("old", &["many.toml", "--threads", "1"], 0);
    let replan = |with: &str, out: &str, arguments: &[&str]| {
        let call = ["replan", "old", "--with", with, "--out", out, "--threads", "1"];
        scratch.run(&[&call[..], arguments].concat())
    };
    let above = replan("above.toml", "above", &["--paths", "12"]);
    above.assert_code(0);
    assert!(above.stdout.contains("blocked"), "{}", above.stdout);
    assert!(above.stdout.contains("nothing has to grow for a way"), "{}", above.stdout);
    let log = scratch.run(&["log", "above"]).stdout;
    assert!(log.contains("survivors:0") && !log.contains("u:0"), "{log}");
    scratch.run(&["query", "above", "--shorten"]).assert_code(0);
    // With both passages closed there is no way, and the build ends at its limit.
    let closed = replan("closed.toml", "closed", &[]);
    closed.assert_code(3);
    assert!(closed.stdout.contains("is valid still"), "{}", closed.stdout);
    let untold = replan("closed.toml", "untold", &["--paths", "0", "--components", "all"]);
    untold.assert_code(3);
    assert!(!untold.stdout.contains("path "), "{}", untold.stdout);
    assert!(untold.stdout.contains(" 0 dropped"), "{}", untold.stdout);
    // When the way opens again pairs are tried where the crates stood.
    let call = ["replan", "closed", "--with", "disc.toml", "--out", "open", "--threads", "1"];
    let open = scratch.run(&[&call[..], &["--neighbors", "40"]].concat());
    open.assert_code(0);
    assert!(
        open.stdout.contains("2 went") && !open.stdout.contains(" 0 new ones"),
        "{}",
        open.stdout
    );
    scratch.run(&["verify", "open", "--all", "--threads", "1"]).assert_code(0);
    // Standard output is for objects alone where they are asked for.
    let json = replan("above.toml", "json", &["--json"]);
    json.assert_code(0);
    assert!(json.stdout.lines().all(|line| line.starts_with('{')), "{}", json.stdout);
    json.assert_stderr(&["1 obstacle came", "valid still"]);
}

#[test]
fn what_cannot_be_replanned_is_said_and_leaves_nothing() {
    let scratch = Scratch::new();
    scratch.write("disc.toml", DISC);
    scratch.run(&["build", "disc.toml", "--out", "old", "--threads", "1"]).assert_code(0);
    let refused = |with: &str, arguments: &[&str], what: &[&str]| {
        scratch.write("with.toml", with);
        let call = ["replan", "old", "--with", "with.toml", "--out", "new", "--threads", "1"];
        let done = scratch.run(&[&call[..], arguments].concat());
        done.assert_code(2);
        done.assert_stderr(what);
        assert!(!scratch.path("new").exists(), "something is left");
    };
    let robot = DISC.replace("radius = 0.2", "radius = 0.1");
    refused(&robot, &[], &["with.toml: the robot is not what it was"]);
    let query = DISC.find("[query]").expect("a query");
    let without = DISC[..query].to_owned() + &DISC[DISC.find("[img]").expect("a schedule")..];
    refused(&without, &["--components", "start"], &["with.toml: ", "[query]"]);
    refused(DISC, &["--neighbors", "0"], &["--neighbors", "1..=1000"]);
    refused(DISC, &["--neighbors", "4294967295"], &["--neighbors", "1..=1000"]);
    refused(DISC, &["--components", "some"], &["--components", "start, all"]);
    refused("nonsense", &[], &["with.toml:1"]);
    let closed = DISC.replace("size = [0.4, 3.0, 1.0]", "size = [0.4, 3.0, -1.0]");
    refused(&closed, &[], &["with.toml:"]);
    let survivors = DISC.replace("sampler = { uniform = {} }", "generator = { survivors = {} }");
    refused(&survivors, &[], &["with.toml:", "roadmill replan"]);
    let done = scratch.run(&["replan", "nowhere", "--with", "disc.toml", "--out", "new"]);
    done.assert_code(2);
    done.assert_stderr(&["nowhere"]);
}
