//! Queries whose ends see each other, as the program answers them and as ledgers of earlier versions hold them.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{frames, ledger_of};
use roadmill::internal::wire;
use roadmill::model::Scratch as Memory;
use roadmill::numbers::RoundNumber;
use roadmill_coordinator::Run;
use roadmill_coordinator::run::ledger::{Judged, Record};
use std::fs;
use support::{Done, Scratch};

/// One node, somewhere in an empty room.
const ONE: &str = "[space]\nmotion = \"rigid-2d\"\nmin = [-10, -10]\nmax = [10, 10]\nbounds = \"body\"\n\
    [robot]\nbodies = [{ shape = { box = { size = [1, 0.4, 0.4] } } }]\n\
    [img]\nsets_per_round = 1\n[limits]\nsets = 1\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 1\nsampler = { uniform = {} }\n";

/// The same room with a query across it.
const ROOM: &str = "[space]\nmotion = \"rigid-2d\"\nmin = [0, 0]\nmax = [10, 10]\nbounds = \"body\"\n\
    [robot]\nbodies = [{ shape = { box = { size = [1, 0.4, 0.4] } } }]\n\
    [query]\nstart = [1, 1, 3.0]\ngoal = [9, 9, -3.0]\n";

fn query(scratch: &Scratch, more: &[&str]) -> Done {
    let done = scratch.run(&[&["query", "run"], more].concat());
    done.assert_code(0);
    done
}

/// The lines of a path after its heading.
fn configs(done: &Done) -> Vec<&str> {
    done.stdout.lines().skip(1).collect()
}

#[test]
fn the_straight_way_is_taken_where_it_is_free() {
    let scratch = Scratch::new();
    scratch.write("one.toml", ONE);
    scratch.build("run", &["one.toml", "--threads", "1"], 0);
    let done = query(&scratch, &["--start", "1 1 0", "--goal", "2 2 0"]);
    assert_eq!(configs(&done), ["1,1,0", "2,2,0"]);
    done.assert_stderr(&["path of 2 configurations, length 1.414214"]);
    for more in [&[][..], &["--shorten"], &["--format", "path"]] {
        let ends = ["--start", "1 1 0", "--goal", "1 1 0"];
        query(&scratch, &[&ends[..], more].concat())
            .assert_stderr(&["path of 1 configuration, length 0.000000"]);
    }
    scratch.write("many.csv", "1,1,0,2,2,0\n1,1,0,1,1,0\n-3,1,0,4,4,1\n");
    query(&scratch, &["--queries", "many.csv", "--out", "paths"])
        .assert_stderr(&["3 of 3 queries solved"]);
    // The page plays a robot that stands still.
    query(&scratch, &["--start", "1 1 0", "--goal", "1 1 0", "--animate", "still.html"]);
}

#[test]
fn a_build_ends_after_its_first_round_and_its_path_is_the_straight_one() {
    let scratch = Scratch::new();
    scratch.write("room.toml", ROOM);
    scratch.build("run", &["room.toml", "--threads", "1"], 0);
    assert_eq!(scratch.summary("run").sets, 5, "one round, since every build makes one");
    let path = fs::read_to_string(scratch.path("run/path.csv")).expect("it has a path");
    assert_eq!(path.lines().skip(1).collect::<Vec<_>>(), ["1,1,3", "9,9,-3"]);
    let short = query(&scratch, &["--shorten"]);
    assert_eq!(configs(&short), ["1,1,3", "9,9,-3"]);
    short.assert_stderr(&["length 11.314878"]);
    scratch.run(&["export", "run", "--format", "svg", "--out", "room.svg"]).assert_code(0);
    let verified = scratch.run(&["verify", "run", "--all", "--threads", "1"]);
    verified.assert_code(0);
    assert!(!verified.stdout.contains("earlier version"), "{}", verified.stdout);
}

/// A judgement recorded before the direct motion was tried is not wrong: `verify` says what it is.
#[test]
fn judgements_of_earlier_versions_are_verified_by_their_own_rule() {
    let scratch = Scratch::new();
    scratch.write("room.toml", ROOM);
    scratch.build("run", &["room.toml", "--threads", "1"], 0);
    let run = Run::at(scratch.path("run")).read().expect("it is sound");
    let mut cx = run.problem().context();
    cx.try_direct_motion(false);
    let evaluator = run.problem().evaluators()[0].method();
    let verdict = evaluator.evaluate(&cx, "0", run.roadmap(), &mut Memory::new());
    let path = verdict.answer().and_then(|answer| answer.path.as_ref()).expect("a way");
    assert!(path.configs.len() > 2, "it goes through the roadmap");

    let forge = |verdict: &roadmill::evaluate::Verdict| {
        let judged = Judged { round: RoundNumber(0), verdicts: vec![verdict.clone()] };
        let payloads =
            frames(&scratch.ledger("run")).into_iter().map(|frame| match frame.payload {
                payload if payload.starts_with(&3u32.to_le_bytes()) => {
                    wire::encode(&Record::Judged(judged.clone()))
                }
                payload => payload,
            });
        let ledger = ledger_of(payloads);
        fs::write(scratch.path("run/ledger"), ledger).expect("it can be written");
        fs::remove_file(scratch.path("run/ledger.durable")).unwrap_or_default();
    };
    forge(&verdict);
    let verify = ["verify", "run", "--all", "--threads", "1"];
    let verified = scratch.run(&verify);
    verified.assert_code(0);
    assert!(verified.stdout.contains("1 judgements recomputed"), "{}", verified.stdout);
    let expected = "1 of these judgements are by an earlier version";
    assert!(verified.stdout.contains(expected), "{}", verified.stdout);
    // Queries of such a run are answered as those of any other.
    assert_eq!(configs(&query(&scratch, &[])), ["1,1,3", "9,9,-3"]);

    // What is right by neither rule is wrong.
    let mut wrong = verdict;
    wrong.asked.motions += 1;
    forge(&wrong);
    let refused = scratch.run(&verify);
    refused.assert_code(7);
    refused.assert_stderr(&["the judgement of round 0: recorded and recomputed differ"]);
}
