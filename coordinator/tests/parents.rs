//! Builds from the roadmap of another run.

mod support;

use std::fs;
use support::{ENDLESS, Scratch};

/// The endless build from another run's roadmap, with the wall in the middle moved.
fn child(parent: &str) -> String {
    let child = ENDLESS.replace("position = [4.0, 1.3, 2.0]", "position = [4.4, 1.3, 2.0]");
    let reuse = format!("generator = {{ reuse = {{ parent = {{ {parent} }}, spread = 1.0 }} }}");
    child.replace(
        "nodes = 7\nsampler = { uniform = {} }\nwithin = { nearest = { neighbors = 4 } }",
        &format!("nodes = 7\n{reuse}"),
    )
}

fn scratch() -> Scratch {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    scratch.build("parent", &["endless.toml", "--threads", "1", "--max-sets", "8"], 0);
    scratch.write("child.toml", &child("run = \"parent\""));
    scratch
}

/// What `check` says of the parent's ledger.
fn hash_of(described: &str) -> String {
    let (_, rest) = described.split_once("ledger = \"").expect("the parent is described");
    rest[..64].to_owned()
}

#[test]
fn a_build_from_a_parent_is_the_same_everywhere_and_needs_the_parent_no_more() {
    let scratch = scratch();
    let build = ["child.toml", "--max-sets", "24"];
    scratch.build("threads", &[&build[..], &["--threads", "2"]].concat(), 0);
    scratch.build("processes", &[&build[..], &["--workers", "3"]].concat(), 0);
    assert!(scratch.ledger("threads") == scratch.ledger("processes"), "the ledgers differ");
    scratch
        .run(&["generate", "child.toml", "--sets", "b:0..9", "--out", "b.sets", "--threads", "1"])
        .assert_code(0);
    scratch.build("short", &["child.toml", "--max-sets", "12", "--threads", "1"], 0);
    // The problem has taken the roadmap in.
    let imports = [&build[..], &["--threads", "1", "--import", "b.sets"]].concat();
    scratch.build("imported", &imports, 0);
    assert!(scratch.ledger("imported") == scratch.ledger("threads"), "the ledgers differ");
    // Written elsewhere it is the same problem.
    fs::create_dir(scratch.path("elsewhere")).expect("a folder can be made");
    scratch.run(&["import", "child.toml", "--out", "elsewhere/child.toml"]).assert_code(0);
    let elsewhere = ["elsewhere/child.toml", "--max-sets", "24", "--threads", "1"];
    let digest = scratch.build("elsewhere-run", &elsewhere, 0);
    assert_eq!(digest, scratch.summary("threads").digest);
    fs::remove_dir_all(scratch.path("parent")).expect("it is there");
    scratch.run(&["verify", "threads", "--all", "--workers", "2"]).assert_code(0);
    scratch.run(&["resume", "short", "--max-sets", "24", "--workers", "2"]).assert_code(0);
    assert_eq!(scratch.summary("short").digest, scratch.summary("threads").digest);
    // The ledger names the parent's with every set that was made from it.
    let parentless = scratch.run(&["build", "child.toml", "--out", "none", "--threads", "1"]);
    parentless.assert_code(2);
    parentless.assert_stderr(&["child.toml:", "strategies[1].generator", "parent"]);
}

#[test]
fn a_parent_with_another_ledger_or_robot_is_refused_at_its_line() {
    let scratch = scratch();
    let described = scratch.run(&["check", "child.toml"]);
    described.assert_code(0);
    let hash = hash_of(&described.stdout);
    scratch.write("named.toml", &child(&format!("run = \"parent\", ledger = \"{hash}\"")));
    scratch.run(&["check", "named.toml"]).assert_code(0);
    scratch.run(&["resume", "parent", "--max-sets", "12", "--threads", "1"]).assert_code(0);
    let line = child("").lines().position(|line| line.contains("reuse")).expect("a line") + 1;
    let refused = |text: &str, what: &[&str]| {
        scratch.write("refused.toml", text);
        let done = scratch.run(&["check", "refused.toml"]);
        done.assert_code(2);
        done.assert_stderr(what);
    };
    let named = child(&format!("run = \"parent\", ledger = \"{hash}\""));
    refused(&named, &[&format!("refused.toml:{line}: "), &hash, "expected"]);
    refused(&child("run = \"parent\", ledger = \"12\""), &["64 hexadecimal digits expected"]);
    refused(&child("run = \"nowhere\""), &[&format!("refused.toml:{line}: "), "nowhere"]);
    let planar = child("run = \"parent\"").replace("rigid-3d", "translation-3d");
    refused(&planar, &["the configurations of parent are x y z qw qx qy qz; x y z expected"]);
    scratch.write("parent/ledger", "nothing");
    refused(&child("run = \"parent\""), &[&format!("refused.toml:{line}: "), "parent"]);
}
