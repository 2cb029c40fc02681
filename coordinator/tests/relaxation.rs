//! Problems that are solved by way of easier versions of them.

mod support;

use roadmill::problem::Problem;
use roadmill_coordinator::{Relaxing, Workers};
use rustix::process::Signal;
use serde_json::{Value, json};
use std::fs;
use support::{Done, Scratch, wait_until};

/// A bracket that has to turn to get through a slot; with this seed three levels and more are tried.
const BRACKET: &str = include_str!("../../problems/bracket.toml");

fn scratch() -> Scratch {
    let scratch = Scratch::new();
    scratch.write("bracket.toml", BRACKET);
    scratch
}

fn relax(scratch: &Scratch, out: &str, arguments: &[&str]) -> Done {
    scratch.run(&[&["relax", "bracket.toml", "--out", out], arguments].concat())
}

fn book(scratch: &Scratch, folder: &str) -> Value {
    let text = fs::read_to_string(scratch.path(folder).join("relaxation.json")).expect("a book");
    serde_json::from_str(&text).expect("JSON")
}

/// The levels that were tried: level, guide, outcome.
fn levels(book: &Value) -> Vec<(f64, String, String)> {
    let text = |level: &Value, key: &str| level[key].as_str().expect("a text").to_owned();
    let levels = book["levels"].as_array().expect("levels").iter();
    let level = |level: &Value| {
        let at = level["level"].as_f64().expect("a number");
        (at, text(level, "guide"), text(level, "outcome"))
    };
    levels.map(level).collect()
}

/// The bytes of the ledgers of all levels, and of the files beside them.
fn contents(scratch: &Scratch, folder: &str) -> Vec<(String, Vec<u8>)> {
    let mut contents = Vec::new();
    for level in book(scratch, folder)["levels"].as_array().expect("levels") {
        if let Some(name) = level["folder"].as_str() {
            contents.push((name.to_owned(), scratch.ledger(&format!("{folder}/{name}"))));
        }
    }
    for name in ["problem.toml", "relaxation.json", "path.csv"] {
        let file = fs::read(scratch.path(folder).join(name));
        contents.push((name.to_owned(), file.unwrap_or_default()));
    }
    contents
}

#[track_caller]
fn assert_same(scratch: &Scratch, one: &str, other: &str) {
    for (left, right) in contents(scratch, one).iter().zip(contents(scratch, other)) {
        assert_eq!(left.0, right.0, "{one} and {other}");
        assert!(left.1 == right.1, "{} differs between {one} and {other}", left.0);
    }
}

#[test]
fn a_problem_that_is_too_hard_is_solved_level_by_level_with_the_same_bits_for_any_workers() {
    let scratch = scratch();
    for (out, crew) in [
        ("one", ["--workers", "1"]),
        ("three", ["--workers", "3"]),
        ("threads", ["--threads", "2"]),
    ] {
        let done = relax(&scratch, out, &crew);
        done.assert_code(0);
        done.assert_stderr(&["the path is in", "roadmill view"]);
        assert_same(&scratch, "one", out);
    }
    let book = book(&scratch, "one");
    assert_eq!(book["end"], "solved");
    let levels = levels(&book);
    assert_eq!(levels[0], (1.0, "nothing".to_owned(), "unsolved".to_owned()), "{levels:?}");
    let last = levels.last().expect("a level");
    assert_eq!((last.0, &*last.2), (1.0, "solved"), "{levels:?}");
    assert!(levels.len() >= 3, "{levels:?}");
    // The path is one of the problem itself: a build that was no relaxation's has it valid.
    let path = fs::read_to_string(scratch.path("one/path.csv")).expect("a path");
    assert!(path.starts_with("x [length],y [length],theta [rad]\n12,20,0\n"), "{path}");
    let folder = book["levels"].as_array().expect("levels").last().expect("one")["folder"].clone();
    let own = scratch.path("one").join(folder.as_str().expect("a folder")).join("path.csv");
    assert_eq!(fs::read_to_string(own).expect("a path"), path);
    // The first level is the very build of the problem.
    scratch.build("plain", &["bracket.toml", "--threads", "1", "--max-nodes", "3000"], 3);
    let log = |run: &str| scratch.run(&["log", run]).stdout;
    assert_eq!(log("plain"), log("one/level-01-1.0000"));
}

#[test]
fn every_level_is_a_run_as_any_and_verify_checks_them_and_the_decisions() {
    let scratch = scratch();
    relax(&scratch, "all", &["--threads", "2"]).assert_code(0);
    let verified = scratch.run(&["verify", "all", "--all", "--threads", "2"]);
    verified.assert_code(0);
    let book_before = book(&scratch, "all");
    let count = book_before["levels"].as_array().expect("levels").len();
    assert!(
        verified.stdout.contains(&format!(
            "{count} levels: each follows from those before it, and so does the end"
        )),
        "{}",
        verified.stdout
    );
    let last = book_before["levels"][count - 1]["folder"].as_str().expect("a folder").to_owned();
    let run = format!("all/{last}");
    scratch.run(&["verify", &run, "--all", "--threads", "1"]).assert_code(0);
    scratch.run(&["query", &run]).assert_code(0);
    scratch.run(&["status", &run]).assert_code(0);

    // The folder stands for the level that was solved last.
    for (arguments, out) in [
        (&["query", "all"][..], "path of "),
        (&["view", "all", "--no-open"], "all-view.html: "),
        (&["export", "all", "--format", "csv", "--out", "out.csv"], ""),
        (&["paths", "all", "--count", "1"], ""),
    ] {
        let done = scratch.run(arguments);
        done.assert_code(0);
        let said = format!(
            "all: a relaxation; the level that was solved last is number {count} at 1.0000, the problem itself: {run}"
        );
        done.assert_stderr(&[&said, out]);
    }
    assert_eq!(scratch.run(&["query", "all"]).stdout, scratch.run(&["query", &run]).stdout);
    // What asks for one run says which there are.
    for command in ["log", "replan"] {
        let arguments: &[&str] = match command {
            "log" => &["log", "all"],
            _ => &["replan", "all", "--with", "bracket.toml", "--out", "new"],
        };
        let done = scratch.run(arguments);
        done.assert_code(2);
        let said =
            format!("all: a relaxation found; the run of one of its levels expected, as {run}");
        done.assert_stderr(&[&said]);
    }
    let status = scratch.run(&["status", "all"]);
    status.assert_code(0);
    for said in [
        "relaxation  scale-robot, in all\n",
        "level 1     at 1.0000, factor 1.0000: unsolved, 3000 nodes, in level-01-1.0000\n",
        "level 2     at 0.5000, factor 0.6000: solved, ",
        "level 3     at 1.0000, factor 1.0000, helped by path of level 2: ",
        &format!(
            "state       solved: {count} levels tried; the path is in path.csv of the folder\n"
        ),
    ] {
        assert!(status.stdout.contains(said), "no `{said}` in\n{}", status.stdout);
    }
    let status = scratch.run(&["status", "all", "--json", "--watch"]).stdout;
    let status: Value = serde_json::from_str(&status).expect("one line");
    assert_eq!(status["levels"].as_array().map(Vec::len), Some(count));
    assert_eq!(
        (&status["state"], &status["levels"][1]["outcome"]),
        (&json!("solved"), &json!("solved"))
    );

    // What is recorded of a level is something else.
    let file = scratch.path("all/relaxation.json");
    let text = fs::read_to_string(&file).expect("a book");
    for (from, to, code, said) in [
        ("\"outcome\": \"unsolved\"", "\"outcome\": \"solved\"", 4, "relaxation.json"),
        ("\"level\": 0.5", "\"level\": 0.25", 4, "does not follow"),
        ("\"end\": \"solved\"", "\"end\": \"stuck\"", 7, "the end `stuck` does not follow"),
        ("roadmill relaxation 1", "roadmill relaxation 9", 4, "format"),
        ("\"nodes\": 3000", "\"nodes\": 3001", 7, "the run is not what is recorded of it"),
    ] {
        let forged = text.replacen(from, to, 1);
        assert_ne!(forged, text, "{from}");
        fs::write(&file, forged).expect("it can be written");
        let done = scratch.run(&["verify", "all", "--threads", "1"]);
        done.assert_code(code);
        done.assert_stderr(&[said]);
    }
    fs::write(&file, &text).expect("it can be written");
    // A level whose run is another's.
    let (first, second) =
        (scratch.path("all/level-01-1.0000"), scratch.path("all/level-02-0.5000"));
    for name in ["ledger", "ledger.durable"] {
        fs::copy(second.join(name), first.join(name)).expect("it can be copied");
    }
    let done = scratch.run(&["verify", "all", "--threads", "1"]);
    done.assert_code(7);
    done.assert_stderr(&["level-01-1.0000: its problem is not the one that follows"]);
}

#[test]
fn killed_or_interrupted_at_any_level_it_goes_on_to_the_same_bits() {
    let scratch = scratch();
    relax(&scratch, "whole", &["--threads", "1"]).assert_code(0);
    let whole = book(&scratch, "whole");
    let names: Vec<String> = whole["levels"]
        .as_array()
        .expect("levels")
        .iter()
        .map(|level| level["folder"].as_str().expect("a folder").to_owned())
        .collect();
    // Killed again and again, each time once another level has begun.
    let out = ["relax", "bracket.toml", "--out", "killed", "--workers", "1"];
    let mut running = scratch.start(&out);
    for name in &names {
        let ledger = scratch.path("killed").join(name).join("ledger");
        wait_until("the level's run", || ledger.is_file() || !running.is_alive());
        if !running.is_alive() {
            break;
        }
        running.signal(Signal::KILL);
        running.end();
        running = scratch.start(&["resume", "killed", "--workers", "2"]);
    }
    running.end().assert_code(0);
    assert_same(&scratch, "whole", "killed");

    // A limit of time leaves its mark in a ledger, but neither in the roadmaps nor in what the levels come to.
    let first = relax(&scratch, "short", &["--threads", "1", "--max-time", "0.000001s"]);
    first.assert_code(3);
    first.assert_stderr(&["`roadmill resume short` goes on"]);
    let status = scratch.run(&["status", "short"]).stdout;
    let said = "level 1     at 1.0000, factor 1.0000: not done, 250 nodes, in level-01-1.0000\n\
        state       time-limit: the limit of time is reached\nto go on    roadmill resume short";
    assert!(status.contains(said), "{status}");
    let mut code = 3;
    for _ in 0..40 {
        let done = scratch.run(&["resume", "short", "--threads", "1", "--max-time", "0.2s"]);
        code = done.status.code().expect("it ends by itself");
        if code == 0 {
            break;
        }
    }
    if code != 0 {
        scratch.run(&["resume", "short", "--threads", "1"]).assert_code(0);
    }
    let without_ledger = |mut book: Value| {
        for level in book["levels"].as_array_mut().expect("levels") {
            level["built"].as_object_mut().expect("it was built").remove("ledger");
        }
        book
    };
    let short = without_ledger(book(&scratch, "short"));
    assert_eq!(short, without_ledger(whole));
    scratch.run(&["verify", "short", "--threads", "1"]).assert_code(0);
    // One that has ended stays as it is.
    let done = scratch.run(&["resume", "short", "--threads", "1"]);
    done.assert_code(0);
    assert_eq!(without_ledger(book(&scratch, "short")), short);
}

#[test]
fn what_cannot_be_relaxed_or_gone_on_with_is_told() {
    let scratch = scratch();
    let other = BRACKET.replace("start = [12.0", "start = [13.0");
    scratch.write("other.toml", &other);
    scratch.write("no-query.toml", BRACKET.split("[query]").next().expect("a text"));
    let deep = BRACKET.replace("retraction-trees", "contact-trees");
    let deep = deep.replace("scale-robot = { least = 0.2 }", "penetration = { depth = 1.0 }");
    scratch.write("deep.toml", &deep);
    fs::create_dir(scratch.path("mine")).expect("a folder");
    scratch.write("mine/notes.txt", "mine");
    let few = ["--threads", "1", "--max-nodes", "100"];
    let done = relax(&scratch, "few", &few);
    done.assert_code(3);
    done.assert_stderr(&["roadmill: "]);
    for (arguments, said) in [
        (&["relax", "no-query.toml", "--out", "new"][..], "no [query] found"),
        (&["relax", "bracket.toml", "--out", "mine"], "mine: holds something"),
        (&["relax", "bracket.toml", "--out", "few"], "a relaxation is there already"),
        (&["relax", "other.toml", "--out", "few", "--or-resume"], "few: cannot go on: the problem"),
        (
            &["relax", "bracket.toml", "--out", "few", "--or-resume"],
            "few: cannot go on: the problem",
        ),
        (&["resume", "few", "--max-nodes", "5"], "--max-nodes: found, but few is a relaxation"),
        (&["verify", "few", "--set", "uniform:0"], "--set: found, but few is a relaxation"),
        (&["resume", "mine"], "mine: no run here"),
        (&["relax", "bracket.toml", "--out", "-"], "a folder expected"),
        (&["check", "deep.toml"], "relaxation.kind: at level 0 strategy `trees`: generator: "),
        (
            &["relax", "deep.toml", "--out", "new"],
            "relaxation.kind: at level 0 strategy `trees`: generator: ",
        ),
        (
            &["relax", "bracket.toml", "--out", "new", "--max-nodes", "0"],
            "--max-nodes: nodes = 0 found; 1 to 4294967293 expected",
        ),
    ] {
        let done = scratch.run(arguments);
        done.assert_code(2);
        done.assert_stderr(&[said]);
    }
    // The same limits again are the same loop.
    let again = relax(&scratch, "few", &[&few[..], &["--or-resume"]].concat());
    again.assert_code(3);
    scratch.run(&["verify", "few", "--all", "--threads", "1"]).assert_code(0);
}

/// The book is there before anything else is, so that a folder whose loop was killed at its beginning is known for what it is.
#[test]
fn a_loop_killed_before_its_problem_was_written_is_begun_again() {
    let scratch = scratch();
    // The slot is closed.
    let closed = BRACKET.replace("[1.0, 17.6, 6.0]", "[1.0, 24.0, 6.0]");
    scratch.write("bracket.toml", &closed);
    let few = ["--threads", "1", "--max-nodes", "100"];
    relax(&scratch, "few", &few).assert_code(3);
    let whole = book(&scratch, "few");
    let status = scratch.run(&["status", "few"]).stdout;
    assert!(status.contains("state       nothing-solved: 4 levels tried\n"), "{status}");
    let done = scratch.run(&["query", "few"]);
    done.assert_code(2);
    done.assert_stderr(&["few: a relaxation found, of which no level is solved; the run of a level expected, as few/level-04-0.0000"]);
    let mut begun = whole.clone();
    (begun["levels"], begun["end"]) = (json!([]), Value::Null);
    fs::create_dir(scratch.path("killed")).expect("a folder");
    scratch.write("killed/relaxation.json", &begun.to_string());
    for name in ["relaxation.json.abc123.tmp", "problem.toml.ABC123.tmp", "lock"] {
        scratch.write(&format!("killed/{name}"), "");
    }
    scratch.write("killed/relaxation.json.backup", "mine");
    let killed = "killed: no problem.toml found: whoever began this relaxation was killed before the problem was written";
    scratch.write("other.toml", &closed.replace("start = [12.0", "start = [13.0"));
    let again =
        |problem| [&["relax", problem, "--out", "killed", "--or-resume"], &few[..]].concat();
    for (arguments, said) in [
        (&["resume", "killed"][..], killed),
        (&["status", "killed"], killed),
        (&["verify", "killed"], killed),
        (&["relax", "bracket.toml", "--out", "killed"], "killed: a relaxation is there already"),
        (&again("other.toml"), "killed: cannot go on: the problem"),
    ] {
        let done = scratch.run(arguments);
        done.assert_code(2);
        done.assert_stderr(&[said]);
    }
    scratch.run(&again("bracket.toml")).assert_code(3);
    assert_eq!(book(&scratch, "killed"), whole);
    let names: Vec<String> = support::children(&scratch.path("killed"))
        .iter()
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    assert!(names.iter().all(|name| !name.ends_with(".tmp")), "{names:?}");
    assert!(names.contains(&"relaxation.json.backup".to_owned()), "{names:?}");
    // Killed while it wrote the book itself.
    fs::create_dir(scratch.path("early")).expect("a folder");
    scratch.write("early/relaxation.json.abc123.tmp", "");
    scratch.write("early/lock", "");
    relax(&scratch, "early", &few).assert_code(2);
    relax(&scratch, "early", &[&few[..], &["--or-resume"]].concat()).assert_code(3);
    assert_eq!(book(&scratch, "early"), whole);
}

/// The slot is too narrow for the bracket itself, so that more and more help is asked for, for which paths are searched for.
#[test]
fn a_limit_of_time_ends_searches_for_paths_that_help() {
    let scratch = Scratch::new();
    let steep = BRACKET.replace("[1.0, 17.6, 6.0]", "[1.0, 19.8, 6.0]");
    let steep =
        steep.replace("nodes = 3000", "nodes = 250\nstart = 0.01\nfinest = 0.5\nlevels = 3");
    scratch.write("steep.toml", &steep);
    let problem = Problem::load(&scratch.path("steep.toml")).expect("a problem");
    let threads = Workers::threads(2);
    let whole = scratch.path("whole");
    let ended =
        Relaxing::begin(problem.clone(), &whole).workers(&threads).solve().expect("it ends");
    let guides: Vec<&str> = ended.book.levels.iter().map(|level| &*level.guide).collect();
    assert_eq!(guides, ["nothing", "path", "dissimilar-paths"]);
    // With next to no time each call finishes a round of a level; none comes beyond the search.
    let short = scratch.path("short");
    let no_time = |relaxing: Relaxing| {
        relaxing.workers(&threads).max_seconds(Some(1e-9)).solve().expect("it ends")
    };
    let mut at = no_time(Relaxing::begin(problem, &short));
    for _ in 0..10 {
        if at.cut.is_some() {
            break;
        }
        at = no_time(Relaxing::at(&short));
    }
    let done = scratch.run(&["resume", "short", "--threads", "1", "--max-time", "0.000001s"]);
    done.assert_code(3);
    let why = "the limit of time is reached while paths are looked for that help";
    done.assert_stderr(&[why, "`roadmill resume short` goes on"]);
    assert_eq!(book(&scratch, "short")["levels"].as_array().map(Vec::len), Some(2));
    assert!(!scratch.path("short").join("level-03-1.0000").exists());
    let status = scratch.run(&["status", "short"]).stdout;
    let said =
        "level 3     at 1.0000, factor 1.0000, helped by dissimilar-paths of level 1: not done\n";
    assert!(status.contains(said), "{status}");
    assert!(status.contains("state       stopped: nobody works on it\nto go on"), "{status}");
    let again = Relaxing::at(&short).workers(&threads).solve().expect("it ends");
    let chain = |relaxed: &roadmill_coordinator::work::relaxing::Relaxed| {
        relaxed.book.levels.iter().map(|level| level.chain).collect::<Vec<_>>()
    };
    assert_eq!(chain(&again), chain(&ended));
}
