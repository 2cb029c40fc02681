//! A protein's transition between two structures, in one command.

mod support;

use std::fs;
use std::process::Command;
use support::Scratch;

/// The peptide that ships.
const PEPTIDE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/structures/1UAO.pdb");

/// A folder with `a.pdb`, the native peptide, and `b.pdb`, a conformation of it from the way to a stretched one.
fn two_structures() -> Scratch {
    let scratch = Scratch::new();
    fs::copy(PEPTIDE, scratch.path("a.pdb")).expect("it ships");
    let problem = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/chignolin.toml");
    scratch.build("way", &[problem, "--max-nodes", "200", "--threads", "2"], 3);
    let out = ["--format", "pdb", "--out", "way.pdb"];
    scratch.run(&[&["export", "way"], &out[..]].concat()).assert_code(0);
    let models = fs::read_to_string(scratch.path("way.pdb")).expect("it is written");
    let models: Vec<&str> = models.split("ENDMDL").collect();
    let (_, atoms) = models[12].split_once('\n').expect("it has lines");
    let is_atom = |line: &&str| line.starts_with("ATOM") || line.starts_with("TER");
    let lines: String = atoms.lines().filter(is_atom).map(|line| format!("{line}\n")).collect();
    scratch.write("b.pdb", &format!("{lines}END\n"));
    scratch
}

#[test]
fn two_structures_become_a_problem_a_roadmap_and_paths_whoever_works() {
    let scratch = two_structures();
    let transition = |out: &str, more: &[&str]| {
        let whole = [&["transition", "a.pdb", "b.pdb", "--out", out, "--max-sets", "32"], more];
        let done = scratch.run(&whole.concat());
        assert!(
            [Some(0), Some(3)].contains(&done.status.code()),
            "{}\n{}",
            done.stdout,
            done.stderr
        );
        (scratch.summary(out).digest, done.stdout)
    };
    let (digest, said) = transition("one", &["--threads", "1"]);
    for told in
        ["problem digest", "refit            Cα RMSD", "start            relaxed by", "goal "]
    {
        assert!(said.contains(told), "{told}\n{said}");
    }
    let page = fs::read_to_string(scratch.path("one.html")).expect("it is written");
    assert!(page.contains("</html>") && !page.contains("src=\"http"));
    assert!(scratch.path("one.toml").is_file() && scratch.path("one-structures").is_dir());
    assert_eq!(transition("two", &["--workers", "2"]).0, digest);
    // The problem that was written is the one that was built, and the build that is there is gone on with.
    scratch.build("three", &["one.toml", "--max-sets", "32", "--workers", "1"], 0);
    assert_eq!(scratch.summary("three").digest, digest);
    assert_eq!(transition("one", &["--threads", "2", "--or-resume"]).0, digest);
    scratch.run(&["verify", "two", "--all", "--threads", "2"]).assert_code(0);
    // Objects alone are for programs to read; what is said of the ends is no object.
    let (_, said) = transition("json", &["--threads", "2", "--json", "--max-time", "1"]);
    let objects = said.lines().map(serde_json::from_str::<serde_json::Value>);
    assert!(objects.clone().count() > 0 && objects.clone().all(|object| object.is_ok()), "{said}");
    // Of two structures it is said which is the native one.
    let done = scratch.run(&["orders", "one", "--unstructured", "1000"]);
    assert!(done.stdout.contains("the native conformation is the source"), "{}", done.stdout);

    let paths = ["paths", "one", "--count", "2", "--format", "pdb,csv", "--out", "paths"];
    let done = scratch.run(&paths);
    done.assert_code(0);
    for file in ["paths.csv", "path-1.pdb", "path-1.frames.csv"] {
        assert!(scratch.path("paths").join(file).is_file(), "{file}");
    }
    if has_python() {
        check(&scratch, &["paths", "one-structures/source.cif", "one-structures/target.cif"]);
    }
}

/// The paths of the problem that ships are what a program of another hand makes of the files.
#[test]
fn chignolins_paths_are_derived_again_from_their_files() {
    if !has_python() {
        return;
    }
    let scratch = Scratch::new();
    let problem = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/chignolin.toml");
    scratch.build("run", &[problem, "--threads", "2"], 0);
    let fast = ["--count", "3", "--dissimilar", "--tries", "6", "--shorten-tries", "10"];
    let files = ["--format", "pdb,csv", "--out", "paths"];
    scratch.run(&[&["paths", "run"], &fast[..], &files].concat()).assert_code(0);
    check(&scratch, &["paths", PEPTIDE]);
}

/// Runs `bench/check_paths.py`, which fails if anything differs.
fn check(scratch: &Scratch, arguments: &[&str]) {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../bench/check_paths.py");
    let mut command = Command::new("python3");
    command.arg(script).args(arguments).current_dir(scratch.path("."));
    let output = command.output().expect("python3 starts");
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success() && out.contains("| 1 |"), "{out}\n{err}");
}

/// Whether Python has what the script needs. Where `ROADMILL_REQUIRE_PYTHON` is 1 it must.
fn has_python() -> bool {
    let mut command = Command::new("python3");
    let done = command.args(["-c", "import gemmi, mdtraj, numpy"]).output();
    let has = done.is_ok_and(|output| output.status.success());
    let required = std::env::var_os("ROADMILL_REQUIRE_PYTHON").is_some_and(|value| value == "1");
    assert!(has || !required, "python3 with gemmi, mdtraj and numpy expected");
    if !has {
        eprintln!("skipped: python3 has no gemmi, mdtraj and numpy");
    }
    has
}

/// The page has what is left of the time, which may be too little for its paths, and the run is kept.
#[test]
fn the_page_is_bounded_by_the_time() {
    let scratch = Scratch::new();
    fs::copy(PEPTIDE, scratch.path("a.pdb")).expect("it ships");
    // Five residues, so that a round is made soon.
    let whole = ["transition", "a.pdb", "a.pdb", "--residues", "3-7", "--out", "it"];
    let done = scratch.run(&[&whole[..], &["--threads", "2", "--max-time", "0.01"]].concat());
    done.assert_code(0);
    done.assert_stderr(&["it.html: the time was up before the search for paths was over"]);
    let page = fs::read_to_string(scratch.path("it.html")).expect("it is written");
    assert!(page.contains("The time for the search was up before its end"));
    assert!(scratch.path("it/ledger").is_file() && scratch.path("it.toml").is_file());
}

#[test]
fn what_is_there_is_kept_unless_it_is_told_otherwise() {
    let scratch = Scratch::new();
    fs::copy(PEPTIDE, scratch.path("a.pdb")).expect("it ships");
    scratch.write("it.toml", "seed = 1\n");
    let whole = ["transition", "a.pdb", "a.pdb", "--out", "it", "--max-sets", "2"];
    scratch.run(&whole).assert_code(2);
    assert_eq!(fs::read_to_string(scratch.path("it.toml")).expect("it is there"), "seed = 1\n");
    assert!(!scratch.path("it").exists());
    // What cannot be used leaves nothing behind: a number of workers, a limit, a run folder or a page that is taken.
    let left = ["new", "new.toml", "new-structures", "new.html"];
    let none = |there: &[&str]| {
        for name in left.iter().filter(|name| !there.contains(name)) {
            assert!(!scratch.path(name).exists(), "{name}");
        }
    };
    let whole = ["transition", "a.pdb", "a.pdb", "--out", "new", "--max-sets", "2"];
    for (more, fragment) in [
        (["--workers", "0"], "--workers: 0 found"),
        (["--max-nodes", "0"], "--max-nodes"),
        (["--residues", "2-30"], "no residue 30 found"),
    ] {
        let done = scratch.run(&[&whole[..], &more].concat());
        done.assert_code(2);
        done.assert_stderr(&[fragment]);
        none(&[]);
    }
    fs::create_dir(scratch.path("new")).expect("a folder can be made");
    scratch.write("new/note", "");
    let done = scratch.run(&whole);
    done.assert_code(2);
    done.assert_stderr(&["new: "]);
    none(&["new"]);
    fs::remove_dir_all(scratch.path("new")).expect("it is there");
    fs::create_dir(scratch.path("new.html")).expect("a folder can be made");
    for more in [&[][..], &["--force"]] {
        let done = scratch.run(&[&whole[..], more].concat());
        done.assert_code(2);
        done.assert_stderr(&["new.html found, a folder; the name of a file expected"]);
        none(&["new.html"]);
    }
    let hold = [&whole[..], &["--hold", "-1"]].concat();
    let done = scratch.run(&hold);
    done.assert_code(2);
    done.assert_stderr(&["--hold", "a number from 0"]);
}
