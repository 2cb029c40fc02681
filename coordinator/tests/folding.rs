//! `fold` and `orders`: in which order the parts of a native structure form, from its file to a page.

mod support;

use std::fs;
use support::Scratch;

/// The peptide that ships: a hairpin of two strands.
const PEPTIDE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/structures/1UAO.pdb");

#[test]
fn a_hairpin_folds_in_one_command_whoever_works() {
    let scratch = Scratch::new();
    fs::copy(PEPTIDE, scratch.path("native.pdb")).expect("it ships");
    let fold = |out: &str, more: &[&str]| {
        let done = scratch.run(&[&["fold", "native.pdb", "--out", out], more].concat());
        done.assert_code(0);
        (scratch.summary(out).digest, done.stdout)
    };
    let (digest, said) = fold("one", &["--threads", "1"]);
    assert!(said.contains("formation-order") && said.contains("all criteria are met"), "{said}");
    // Both strands are made of their pairing alone, so all three form together on every pathway.
    for told in ["pathways to the native conformation", "1.000  [β1 β2]", "1.000  β1–β2"] {
        assert!(said.contains(told), "{told}\n{said}");
    }
    let page = fs::read_to_string(scratch.path("one.html")).expect("it is written");
    assert!(page.contains("</html>") && page.contains("<section id=\"folding\">"));
    assert!(page.contains("[β1 β2]") && page.contains("40 % of the contacts"));
    assert!(!page.contains(">NaN"), "every number that is shown is one");

    assert_eq!(fold("two", &["--workers", "2"]).0, digest);
    assert_eq!(fold("one", &["--threads", "2", "--or-resume"]).0, digest);
    scratch.build("three", &["one.toml", "--workers", "1"], 0);
    assert_eq!(scratch.summary("three").digest, digest);
    scratch.run(&["verify", "two", "--all", "--threads", "2"]).assert_code(0);

    scratch.run(&["orders", "one", "--out", "tables"]).assert_code(0);
    let table = |name: &str| fs::read_to_string(scratch.path("tables").join(name)).expect(name);
    assert!(table("orders.csv").contains("elements,[β1 β2],"));
    assert!(table("precedence.csv").contains("β1,β2,0\n"));
    assert_eq!(table("parts.csv").lines().count(), 1 + 3);
    let contacts = table("contacts.csv");
    assert!(contacts.lines().skip(1).all(|line| line.split(',').count() == 3), "{contacts}");
    // With every contact needed the strands form later than with the first.
    let formed_at = |share: &str| {
        let done = scratch.run(&["orders", "one", "--formed", share]);
        done.assert_code(0);
        let line = done.stdout.lines().find(|line| line.starts_with("β1 ")).expect("a line");
        line.split_whitespace().last().and_then(|at| at.parse::<f64>().ok()).expect("a number")
    };
    assert!(formed_at("0.2") < formed_at("1"));

    // The run's own criterion is found within another, too: here every conformation is unstructured.
    let problem = fs::read_to_string(scratch.path("one.toml")).expect("it is written");
    let (before, _) = problem.split_once("[[evaluators]]").expect("it has a criterion");
    let within = "[[evaluators]]\nall = [{ formation-order = { unstructured = 10 } }]\n";
    scratch.write("within.toml", &format!("{before}{within}"));
    scratch.build("within", &["within.toml", "--max-sets", "10", "--threads", "1"], 3);
    let done = scratch.run(&["orders", "within"]);
    done.assert_code(0);
    assert!(done.stdout.contains("at most 10 of 10 native contacts"), "{}", done.stdout);
    // Objects alone are for programs to read.
    let (_, said) = fold("json", &["--threads", "1", "--json"]);
    let objects = said.lines().map(serde_json::from_str::<serde_json::Value>);
    assert!(objects.clone().count() > 0 && objects.clone().all(|object| object.is_ok()), "{said}");
}

#[test]
fn a_page_about_folding_is_bounded_and_written_to_regular_files_outside_of_other_runs() {
    let scratch = Scratch::new();
    fs::copy(PEPTIDE, scratch.path("native.pdb")).expect("it ships");
    let fold = |out: &str| {
        let limits = ["--max-sets", "10", "--threads", "1"];
        scratch.run(&[&["fold", "native.pdb", "--out", out], &limits[..]].concat())
    };
    let done = fold("run");
    assert!([Some(0), Some(3)].contains(&done.status.code()), "{}", done.stderr);
    let report =
        |out: &str, more: &[&str]| scratch.run(&[&["report", "run", "--out", out], more].concat());
    // No time at all: no pathway is followed, and the page says so. With time enough it is the usual page.
    let done = report("cut.html", &["--max-time", "1e-9"]);
    done.assert_code(0);
    assert!(done.stderr.contains("the time was up"), "{}", done.stderr);
    let page = |name: &str| fs::read_to_string(scratch.path(name)).expect("it is written");
    let cut = page("cut.html");
    assert!(cut.contains("</html>") && cut.contains("before all pathways were followed"));
    report("whole.html", &["--max-time", "1h"]).assert_code(0);
    assert_eq!(page("whole.html"), page("run.html"));
    // What only a search between two ends can be told.
    for option in
        [["--dissimilar", "2"], ["--by", "cost"], ["--tries", "9"], ["--shorten-tries", "9"]]
    {
        let done = report("refused.html", &option);
        done.assert_code(2);
        done.assert_stderr(&[&format!("{}: of no use to a run about folding", option[0])]);
    }
    // A pipe that nobody reads is not waited for.
    let pipe = scratch.path("pipe.html");
    rustix::fs::mkfifoat(rustix::fs::CWD, &pipe, rustix::fs::Mode::RUSR | rustix::fs::Mode::WUSR)
        .expect("it can be made");
    let done = report("pipe.html", &[]);
    done.assert_code(2);
    done.assert_stderr(&["pipe.html found, a named pipe", "a regular file expected"]);
    // A run within another would go with that one.
    let done = fold("run/sub");
    done.assert_code(2);
    done.assert_stderr(&["run/sub: in the folder of the run", "outside of any run expected"]);
    let made = ["run/sub", "run/sub.toml", "run/sub-structures"];
    assert!(made.iter().all(|made| !scratch.path(made).exists()), "nothing is left of it");
}

#[test]
fn what_cannot_be_said_is_an_error() {
    let scratch = Scratch::new();
    fs::copy(PEPTIDE, scratch.path("native.pdb")).expect("it ships");
    let fold = ["fold", "native.pdb", "--out", "short", "--max-sets", "1", "--threads", "1"];
    scratch.run(&fold).assert_code(3);
    // A roadmap that does not come to unstructured conformations: there is a page, which says so, and no order.
    let problem = fs::read_to_string(scratch.path("short.toml")).expect("it is written");
    let near = problem.replace("step = 0.25", "step = 0.05").replace("step = 1.0", "step = 0.05");
    assert_eq!(near.matches("step = 0.05").count(), 2, "{near}");
    scratch.write("near.toml", &near);
    scratch.build("near", &["near.toml", "--max-sets", "10", "--threads", "1"], 3);
    scratch.run(&["report", "near", "--out", "near.html"]).assert_code(0);
    let page = fs::read_to_string(scratch.path("near.html")).expect("it is written");
    assert!(page.contains("No pathway"), "the page says so");
    let done = scratch.run(&["orders", "near"]);
    done.assert_code(3);
    assert!(done.stderr.contains("no pathway"), "{}", done.stderr);
    // Shares that are none.
    for share in ["0", "1.5", "NaN", "most"] {
        let done = scratch.run(&["orders", "short", "--formed", share]);
        done.assert_code(2);
        assert!(done.stderr.contains("above 0, at most 1"), "{}", done.stderr);
    }
    // Four residues are no helix and no strand.
    let part = ["fold", "native.pdb", "--residues", "1-4", "--out", "part"];
    let done = scratch.run(&part);
    done.assert_code(2);
    assert!(done.stderr.contains("without helices and strands"), "{}", done.stderr);
    assert!(!scratch.path("part.toml").exists(), "no problem is left");
    // A robot has no native structure, and neither has one an order.
    let maze = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/maze.toml");
    scratch.build("maze", &[maze, "--threads", "1"], 0);
    let done = scratch.run(&["orders", "maze"]);
    done.assert_code(2);
    assert!(done.stderr.contains("that of a protein expected"), "{}", done.stderr);
    let problem = fs::read_to_string(maze).expect("it ships");
    let problem = problem.split("[[evaluators]]").next().expect("a beginning");
    scratch.write("ordered.toml", &format!("{problem}[[evaluators]]\nformation-order = {{}}\n"));
    let done = scratch.run(&["check", "ordered.toml"]);
    done.assert_code(2);
    assert!(done.stderr.contains("a protein with helices or strands expected"), "{}", done.stderr);
}
