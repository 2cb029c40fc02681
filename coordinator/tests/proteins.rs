//! Structures of proteins, as the command line shows them.

mod support;

use serde_json::Value;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use support::Scratch;

/// Two residues that a peptide bond joins, a gap, one that lacks its O, and water.
const FRAGMENT: &str = "\
ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00 10.00           N
ATOM      2  CA  ALA A   1       1.200   0.800   0.000  1.00 10.00           C
ATOM      3  C   ALA A   1       2.400   0.000   0.000  1.00 10.00           C
ATOM      4  O   ALA A   1       2.400  -1.200   0.300  1.00 10.00           O
ATOM      5  N   GLY A   2       3.600   0.000   0.000  1.00 10.00           N
ATOM      6  CA  GLY A   2       4.800  -0.800   0.000  1.00 10.00           C
ATOM      7  C   GLY A   2       6.000   0.000   0.000  1.00 10.00           C
ATOM      8  O   GLY A   2       6.000   1.200   0.300  1.00 10.00           O
ATOM      9  N   MSE A   4      13.600   0.000   0.000  1.00 10.00           N
ATOM     10  CA AMSE A   4      14.800   0.800   0.000  0.40 10.00           C
ATOM     11  CA BMSE A   4      14.900   0.800   0.000  0.60 10.00           C
ATOM     12  C   MSE A   4      16.000   0.000   0.000  1.00 10.00           C
HETATM   13  O   HOH A   5      30.000   0.000   0.000  1.00 10.00           O
";

fn assert_lines(text: &str, expected: &[&str]) {
    for line in expected {
        assert!(text.lines().any(|found| found.trim() == *line), "{line}\nin\n{text}");
    }
}

#[test]
fn info_says_what_a_file_holds() {
    let scratch = Scratch::new();
    scratch.write("a.pdb", FRAGMENT);
    let done = scratch.run(&["protein", "info", "a.pdb"]);
    done.assert_code(0);
    assert_lines(
        &done.stdout,
        &[
            "a.pdb: PDB, models: 1",
            "model 1: 13 atoms, 4 residues; chains: 1",
            "chain `A`: 3 residues, ALA 1 to MSE 4; 11 atoms, 11 of them heavy; others: 1 water",
            "1 AGM",
            "gaps: GLY 2 and MSE 4 (7.60 Å)",
            "missing backbone atoms: O of MSE 4",
            "side chains not seen: ALA 1, MSE 4",
            "modified residues: MSE 4 (MET)",
            "alternative locations: MSE 4 (A 0.40, B 0.60: B taken)",
            "disulphides: none",
        ],
    );
    let done = scratch.run(&["protein", "info", "a.pdb", "--chain", "Z", "--json"]);
    done.assert_code(0);
    let info: Value = serde_json::from_str(&done.stdout).expect("JSON");
    assert_eq!(info["models"][0]["atoms"], 13);
    assert_eq!(info["chains"][0]["sequence"], "AGM");
}

/// Two models, numbered 2 and 5, of which the second lacks the glycine.
#[test]
fn info_shows_the_model_that_is_asked_for() {
    let scratch = Scratch::new();
    let lines: Vec<&str> = FRAGMENT.lines().collect();
    let (whole, short) = (lines.join("\n"), [&lines[..4], &lines[8..12]].concat().join("\n"));
    let text = format!("MODEL        2\n{whole}\nENDMDL\nMODEL        5\n{short}\nENDMDL\n");
    scratch.write("models.pdb", &text);
    let info = |model: &[&str]| {
        let done = scratch.run(&[&["protein", "info", "models.pdb"], model].concat());
        done.assert_code(0);
        done.stdout
    };
    let first = info(&[]);
    assert_lines(&first, &["model 2: 13 atoms, 4 residues; chains: 1", "1 AGM"]);
    assert_eq!(info(&["--model", "2"]), first);
    assert_lines(
        &info(&["--model", "5"]),
        &[
            "models.pdb: PDB, models: 2",
            "model 5: 8 atoms, 2 residues; chains: 1",
            "1 AM",
            "alternative locations: MSE 4 (A 0.40, B 0.60: B taken)",
        ],
    );
    let json: Value = serde_json::from_str(&info(&["--model", "5", "--json"])).expect("JSON");
    assert_eq!((&json["model"], &json["chains"][0]["residues"]), (&5.into(), &2.into()));
    assert_eq!(json["models"].as_array().map(Vec::len), Some(2));
    let done = scratch.run(&["protein", "info", "models.pdb", "--model", "3"]);
    done.assert_code(2);
    done.assert_stderr(&["models.pdb: no model 3 found; one of 2, 5 expected"]);
}

#[test]
fn compare_says_how_two_conformations_differ() {
    let scratch = Scratch::new();
    scratch.write("a.pdb", FRAGMENT);
    let moved = FRAGMENT.replace("HETATM", "ATOM  ").replace("   0.300  1.00", "   0.400  1.00");
    scratch.write("b.pdb", &moved);
    let done = scratch.run(&["protein", "compare", "a.pdb", "b.pdb"]);
    done.assert_code(0);
    assert_lines(
        &done.stdout,
        &[
            "3 residues matched by number, identity 100.0 %",
            "only in the first: none",
            "ends differ by 0 heavy atoms (- only in the first, + only in the second): none",
            "CA RMSD after superposition: 0.000 Å",
            "GLY 2         0.000",
        ],
    );
    let done =
        scratch.run(&["protein", "compare", "a.pdb", "b.pdb", "--residues", "1-2", "--json"]);
    done.assert_code(0);
    let report: Value = serde_json::from_str(&done.stdout).expect("JSON");
    assert_eq!(report["matched"], 2);
    let other = FRAGMENT.replace("ALA", "TRP").replace("GLY", "LYS");
    scratch.write("c.pdb", &other);
    let done = scratch.run(&["protein", "compare", "a.pdb", "c.pdb"]);
    done.assert_code(2);
    done.assert_stderr(&["a.pdb and c.pdb: chains `A` (3 residues) and `A` (3) found", "expected"]);
}

#[test]
fn what_is_no_structure_is_refused_by_file_and_line() {
    let scratch = Scratch::new();
    scratch.write("page.pdb", "<html>\n");
    scratch.write("cut.pdb", &FRAGMENT[..FRAGMENT.len() - 40]);
    for (arguments, fragments) in [
        (&["info", "page.pdb"][..], &["page.pdb:1: a page of HTML or XML found", "expected"][..]),
        (&["info", "cut.pdb"], &["cut.pdb:13: atom `O` of residue `HOH`: a line that ends after"]),
        (&["info", "lost.pdb"], &["lost.pdb: cannot read the structure: No such file"]),
        (&["info", "."], &["a folder found; a regular file expected"]),
        (&["compare", "cut.pdb", "cut.pdb", "--residues", "x"], &["FIRST-LAST expected"]),
    ] {
        let done = scratch.run(&[&["protein"], arguments].concat());
        done.assert_code(2);
        done.assert_stderr(fragments);
    }
}

/// The peptide that ships.
const PEPTIDE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/structures/1UAO.pdb");

/// From the peptide to itself: the problem file names its structures, says its ends, and is built.
#[test]
fn a_transition_becomes_a_problem_that_can_be_built() {
    let scratch = Scratch::new();
    let done = scratch.run(&["protein", "problem", PEPTIDE, PEPTIDE, "--out", "fold.toml"]);
    done.assert_code(0);
    assert!(done.stdout.contains("refit            Cα RMSD 0.000 Å"), "{}", done.stdout);
    for name in ["source.cif", "target.cif"] {
        assert!(scratch.path("fold-structures").join(name).is_file(), "{name}");
    }
    let text = std::fs::read_to_string(scratch.path("fold.toml")).expect("it is there");
    assert!(text.starts_with("# Written by `roadmill protein problem`.\n"), "{text}");
    assert!(
        text.contains("source = { file = \"fold-structures/source.cif\", chain = \"A\" }"),
        "{text}"
    );
    let done = scratch.run(&["check", "fold.toml"]);
    done.assert_code(0);
    for end in ["start ", "goal "] {
        let has = |line: &str| line.starts_with(end) && line.contains("model kJ/mol");
        assert!(done.stdout.lines().any(has), "{end}\n{}", done.stdout);
    }
    assert_eq!(done.stdout.matches("keeps all rules").count(), 3, "{}", done.stdout);
    scratch.build("run", &["fold.toml"], 0);
    // What is there is kept, unless it is told otherwise.
    let again = ["protein", "problem", PEPTIDE, "--out", "fold.toml"];
    scratch.run(&again).assert_code(2);
    assert_eq!(std::fs::read_to_string(scratch.path("fold.toml")).expect("it is there"), text);
    scratch.run(&[&again[..], &["--force"]].concat()).assert_code(0);
    let text = std::fs::read_to_string(scratch.path("fold.toml")).expect("it is there");
    assert!(!text.contains("target") && !text.contains("[query]"), "{text}");
}

#[test]
fn what_is_no_transition_is_refused_and_leaves_nothing() {
    let scratch = Scratch::new();
    let peptide = std::fs::read_to_string(PEPTIDE).expect("it ships");
    let other = ["GLY", "TYR", "ASP", "PRO", "GLU", "THR", "TRP"]
        .iter()
        .fold(chain(&peptide, 'A', 0.0), |text, name| text.replace(name, "ALA"));
    scratch.write("other.pdb", &other);
    let is_kept = |line: &&str| !matches!(line.get(22..26), Some("   5" | "   6"));
    let gap: String = peptide.lines().filter(is_kept).map(|line| format!("{line}\n")).collect();
    scratch.write("gap.pdb", &gap);
    scratch
        .write("two.pdb", &format!("{}{}", chain(&peptide, 'A', 0.0), chain(&peptide, 'B', 40.0)));
    let before = names(&scratch);
    for (arguments, expected) in [
        (
            &["two.pdb", PEPTIDE, "--chain", "C"][..],
            "no chain `C` found; one of `A` (GLY 1 to GLY 10)",
        ),
        (&[PEPTIDE, "other.pdb"], "two states of one protein, at least 50 %, expected"),
        (&["gap.pdb"], "a gap between PRO 4 and GLY 7 found"),
        (&[PEPTIDE, "gap.pdb"], "a gap between PRO 4 and GLY 7 found"),
        (&[PEPTIDE, "--obstacle", "A"], "`A` found, the chain that moves"),
        (&[PEPTIDE, PEPTIDE, "--residues", "2-30"], "no residue 30 found"),
    ] {
        let whole = [&["protein", "problem"], arguments, &["--out", "x.toml"]].concat();
        let done = scratch.run(&whole);
        done.assert_code(2);
        done.assert_stderr(&[expected]);
        assert_eq!(names(&scratch), before, "{arguments:?}");
    }
    let around =
        ["protein", "problem", "two.pdb", "--chain", "A", "--obstacle", "B", "--out", "x.toml"];
    scratch.run(&around).assert_code(0);
}

/// The names of what is in the folder.
fn names(scratch: &Scratch) -> Vec<PathBuf> {
    let mut names = support::children(&scratch.path("."));
    // What the commands have printed.
    names.retain(|path| !path.extension().is_some_and(|it| it == "stdout" || it == "stderr"));
    names.sort();
    names
}

/// The atoms of a file as those of one chain, moved along x, Å.
fn chain(text: &str, name: char, shift: f64) -> String {
    let of = |line: &str| {
        let x: f64 = line[30..38].trim().parse().expect("a number");
        format!("{}{name}{}{:8.3}{}\n", &line[..21], &line[22..30], x + shift, &line[38..])
    };
    text.lines().filter(|line| line.starts_with("ATOM")).map(of).collect()
}

/// The PDB files of the folder that `ROADMILL_DATA` names, or `None`, said aloud.
fn files() -> Option<Vec<PathBuf>> {
    let folder =
        std::env::var_os("ROADMILL_DATA").map(|data| PathBuf::from(data).join("structures"));
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
    let Some(entries) = entries else {
        let required = std::env::var_os("ROADMILL_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "ROADMILL_DATA names no folder with `structures` in it");
        println!("skipped: ROADMILL_DATA names no folder with `structures` in it");
        return None;
    };
    let files = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> =
        files.filter(|file| file.extension().is_some_and(|end| end == "pdb")).collect();
    files.sort();
    Some(files)
}

/// A Python that has gemmi, unless there is none and none is required.
fn has_python() -> bool {
    let there = Command::new("python3").args(["-c", "import gemmi"]).output();
    let there = there.is_ok_and(|output| output.status.success());
    if !there {
        let required =
            std::env::var_os("ROADMILL_REQUIRE_PYTHON").is_some_and(|value| value == "1");
        assert!(!required, "no python3 with gemmi");
        println!("not tested: no python3 with gemmi");
    }
    there
}

#[test]
fn gemmi_reads_the_same_models_atoms_and_residues() {
    let Some(files) = files() else { return };
    if !has_python() {
        return;
    }
    let scratch = Scratch::new();
    let mut said = String::new();
    for file in &files {
        let file = file.to_str().expect("a name in UTF-8");
        let done = scratch.run(&["protein", "info", file, "--json"]);
        done.assert_code(0);
        said.push_str(&done.stdout);
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/structures/against_gemmi.py");
    let mut python = Command::new("python3")
        .arg(script)
        .args(&files)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("python3 starts");
    let mut stdin = python.stdin.take().expect("a pipe");
    stdin.write_all(said.as_bytes()).expect("python3 reads all of it");
    drop(stdin);
    let output = python.wait_with_output().expect("python3 ends");
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success() && out.contains("agree"), "{out}\n{err}");
}
