//! Several paths out of one run.

mod support;

use rustix::process::Signal;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use support::{Scratch, wait_until};

/// A round hill in the middle of a plane, and two points on either side of it.
const HILL: &str = "[landscape]\nmin = [-2, -2]\nmax = [2, 2]\ntolerance = 0.01\n\
    energy = { terms = [{ height = 50, centre = [0, 0], xx = -2, yy = -2 }] }\n\
    [query]\nstart = [-1.5, 0.1]\ngoal = [1.6, 0]\n[img]\nsets_per_round = 1\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 120\nsampler = { uniform = {} }\n\
    [limits]\nsets = 1\n";

/// A point in a room with a wall from side to side.
const ROOMS: &str = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [4, 4]\n\
    bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n\
    [[obstacles]]\nshape = { box = { size = [0.5, 4, 1] } }\nposition = [2, 2, 0]\n\
    [query]\nstart = [1, 2]\ngoal = [3, 2]\n[img]\nsets_per_round = 1\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 20\nsampler = { uniform = {} }\n\
    [limits]\nsets = 1\n";

/// The lines of a CSV file as columns by name, its numbers as text.
fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).expect("the file is there");
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let names = lines.next().expect("a heading");
    lines.map(|line| names.iter().cloned().zip(line).collect()).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

#[test]
fn two_ways_around_a_hill_are_printed_and_written() {
    let scratch = Scratch::new();
    scratch.write("hill.toml", HILL);
    scratch.build("run", &["hill.toml"], 0);
    let ask = |out: &str| {
        let distance = ["--dissimilar", "1", "--count", "2", "--spacing", "0.1", "--tries", "20"];
        let done = scratch.run(&[&["paths", "run", "--out", out][..], &distance].concat());
        done.assert_code(0);
        done
    };
    let done = ask("ways");
    let lines: Vec<&str> = done.stdout.lines().collect();
    assert_eq!(lines.len(), 6, "{}", done.stdout);
    assert!(lines[2].trim_start().starts_with('1') && lines[3].trim_start().starts_with('2'));
    let ways = scratch.path("ways");
    let paths = table(&ways.join("paths.csv"));
    assert_eq!(paths.len(), 2);
    assert!(number(&paths[0], "peak [energy]") <= number(&paths[1], "peak [energy]"));
    let pairs = table(&ways.join("matrix.csv"));
    assert!(pairs.len() == 1 && number(&pairs[0], "frechet [length]") >= 1.0, "{pairs:?}");
    for row in &paths {
        assert_eq!(row["frechet [length]"], pairs[0]["frechet [length]"]);
        let file = ways.join(format!("path-{}.csv", row["path"]));
        let configs = table(&file);
        assert_eq!(configs.len().to_string(), row["configurations"]);
        assert_eq!((&configs[0]["x [length]"][..], &configs[0]["y [length]"][..]), ("-1.5", "0.1"));
    }
    // The same files again, byte for byte.
    ask("again");
    for name in ["paths.csv", "matrix.csv", "path-1.csv", "path-2.csv"] {
        let [one, other] =
            ["ways", "again"].map(|folder| fs::read(scratch.path(folder).join(name)));
        assert_eq!(one.expect("written"), other.expect("written"), "{name}");
    }
    // The best routes, however alike, need no folder.
    let done = scratch.run(&["paths", "run", "--count", "4", "--by", "cost"]);
    done.assert_code(0);
    assert_eq!(done.stdout.lines().count(), 2 + 4 + 1 + 6, "{}", done.stdout);
}

#[test]
fn what_cannot_be_asked_is_refused_and_no_path_is_no_success() {
    let scratch = Scratch::new();
    scratch.write("rooms.toml", ROOMS);
    scratch.build("run", &["rooms.toml"], 3);
    for (arguments, fragment) in [
        (&["--by", "barrier"][..], "this model has no energies, cost expected"),
        (&["--format", "csv,pdb", "--out", "x"], "pdb found; this model is no molecule"),
        (&["--angle", "A=1-2/3-4/5-6"], "this model is no molecule"),
        (&["--angle", "A=1-2/3-4"], "NAME=FIRST-LAST/FIRST-LAST/FIRST-LAST expected"),
        (&["--format", "csv"], "--out"),
        (&["--dissimilar", "0"], "a distance from 1e-3"),
        (&["--count", "0"], "0 is not in 1..=1000"),
        (&["--out", "run"], "holds something; a new or an empty folder expected"),
        (&["--start", "9 9"], "--start"),
    ] {
        let done = scratch.run(&[&["paths", "run"], arguments].concat());
        done.assert_code(2);
        done.assert_stderr(&[fragment]);
    }
    for arguments in [&[][..], &["--dissimilar"]] {
        let done = scratch.run(&[&["paths", "run"], arguments].concat());
        done.assert_code(3);
        done.assert_stderr(&["no path: nothing joins start and goal"]);
    }
    // In one room there are ways, of which bodies have tables.
    let done =
        scratch.run(&["paths", "run", "--goal", "1 3.5", "--dissimilar", "0.3", "--out", "ways"]);
    done.assert_code(0);
    let paths = table(&scratch.path("ways").join("paths.csv"));
    assert!(!paths.is_empty() && paths[0]["barrier [1]"].is_empty(), "{paths:?}");
    assert!(number(&paths[0], "cost [length]") >= 1.5);
}

/// A point in a room with a pillar in its middle.
const PILLAR: &str = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [4, 4]\n\
    bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n\
    [[obstacles]]\nshape = { box = { size = [1, 1, 1] } }\nposition = [2, 2, 0]\n\
    [query]\nstart = [0.5, 2]\ngoal = [3.5, 2.1]\n[img]\nsets_per_round = 1\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 150\nsampler = { uniform = {} }\n\
    [[evaluators]]\nall = [{ query = {} }, { not = { query = {} } }]\n[limits]\nsets = 1\n";

#[test]
fn the_ways_around_a_pillar_are_told_apart() {
    let scratch = Scratch::new();
    scratch.write("pillar.toml", PILLAR);
    scratch.build("run", &["pillar.toml"], 3);
    let done = scratch.run(&["paths", "run", "--distinct", "--count", "4", "--out", "ways"]);
    done.assert_code(0);
    let paths = table(&scratch.path("ways").join("paths.csv"));
    // Below it, above it, and then once around it and on.
    let classes: Vec<&str> = paths.iter().map(|row| &row["class"][..]).collect();
    assert_eq!(
        classes[..2].iter().collect::<std::collections::BTreeSet<_>>(),
        ["-", "1"].iter().collect()
    );
    assert_eq!(
        classes[2..].iter().collect::<std::collections::BTreeSet<_>>(),
        ["-1", "1 1"].iter().collect()
    );
    let lengths: Vec<f64> = paths.iter().map(|row| number(row, "cost [length]")).collect();
    assert!(lengths.is_sorted() && lengths[1] < 4.0 && lengths[2] > 5.0, "{lengths:?}");
    for class in classes {
        assert!(done.stdout.lines().any(|line| line.trim_start().ends_with(&format!("  {class}"))));
    }
    // The search has an order of its own, and needs obstacles.
    let done = scratch.run(&["paths", "run", "--distinct", "--dissimilar"]);
    done.assert_code(2);
    scratch.write("hill.toml", HILL);
    scratch.build("hill", &["hill.toml"], 0);
    let done = scratch.run(&["paths", "hill", "--distinct"]);
    done.assert_code(2);
    done.assert_stderr(&["--distinct: this model knows of no obstacles, bodies expected"]);
}

/// Around a pillar there are ways without end.
#[test]
fn a_search_ends_with_the_time_or_a_signal_and_gives_what_it_has_found() {
    let scratch = Scratch::new();
    scratch.write("pillar.toml", &PILLAR.replace("nodes = 150", "nodes = 1500"));
    scratch.build("run", &["pillar.toml"], 3);
    let no_time = |arguments: &[&str]| {
        scratch.run(&[&["paths", "run", "--max-time", "1e-9"], arguments].concat())
    };
    for arguments in [&["--count", "50"][..], &["--dissimilar", "0.2"]] {
        let done = no_time(arguments);
        // The best path is known at once; whether it passes the finer check is another matter.
        match done.status.code() {
            Some(0) => {
                done.assert_stderr(&["the time was up before the search for paths was over"])
            }
            _ => done.assert_stderr(&["no path: the time was up"]),
        }
        assert!(done.stdout.lines().count() < 12, "{}", done.stdout);
    }
    let done = no_time(&["--distinct"]);
    done.assert_code(3);
    done.assert_stderr(&["no path: the time was up before one was found"]);

    let search = ["paths", "run", "--distinct", "--count", "1000", "--shorten-tries", "100000"];
    let running = scratch.start(&[&search[..], &["--out", "ways"]].concat());
    wait_until("signals are listened to", || running.catches(Signal::INT) || !running.is_alive());
    running.signal(Signal::INT);
    let done = running.finish();
    done.assert_code(6);
    done.assert_stderr(&["a signal came"]);
    // What was found is printed, and written.
    let count = done.stderr.split("these ").nth(1).and_then(|rest| rest.split(' ').next());
    if let Some(count) = count {
        assert_eq!(table(&scratch.path("ways").join("paths.csv")).len().to_string(), count);
    }
}

/// A Python that has mdtraj, unless there is none and none is required.
fn has_python() -> bool {
    let there = Command::new("python3").args(["-c", "import mdtraj"]).output();
    let there = there.is_ok_and(|output| output.status.success());
    if !there {
        let required =
            std::env::var_os("ROADMILL_REQUIRE_PYTHON").is_some_and(|value| value == "1");
        assert!(!required, "no python3 with mdtraj");
        println!("not tested: no python3 with mdtraj");
    }
    there
}

/// Reads path-1 as PDB, DCD and XTC, and measures its frames anew.
const READ: &str = r#"
import csv, mdtraj, numpy
shapes = mdtraj.load("path-1.pdb", standard_names=False)
moving = mdtraj.load_dcd("path-1.dcd", top=shapes.topology)
packed = mdtraj.load_xtc("path-1.xtc", top=shapes.topology)
assert packed.n_frames == moving.n_frames and abs(packed.xyz - moving.xyz).max() < 1e-4
assert shapes.n_frames == moving.n_frames and shapes.n_atoms == moving.n_atoms
# PDB has three decimals of an Å; mdtraj has nm.
assert abs(shapes.xyz - moving.xyz).max() < 1e-4, abs(shapes.xyz - moving.xyz).max()
rows = list(csv.DictReader(open("path-1.frames.csv")))
assert len(rows) == shapes.n_frames
alphas = moving.topology.select("name CA")
# In single precision RMSDs near 0 are off by some 0.002 Å.
for end, column in ((0, "rmsd_start [Å]"), (-1, "rmsd_goal [Å]")):
    found = mdtraj.rmsd(moving, moving, frame=end % len(rows), atom_indices=alphas) * 10
    told = numpy.array([float(row[column]) for row in rows])
    assert abs(found - told).max() < 5e-3, abs(found - told).max()
length = 0
for before in range(len(rows) - 1):
    pair = moving[before:before + 2]
    step = mdtraj.rmsd(pair, pair, frame=0, atom_indices=alphas)[1] * 10
    assert step < 0.505, step
    length += step
assert abs(length - float(rows[-1]["length [Å]"])) < 0.02 * len(rows), length
radii = mdtraj.compute_rg(moving.atom_slice(alphas), masses=numpy.ones(len(alphas))) * 10
assert abs(radii - [float(row["radius_of_gyration [Å]"]) for row in rows]).max() < 2e-3
"#;

#[test]
fn a_peptides_paths_are_read_by_other_programs() {
    let scratch = Scratch::new();
    // The problem that ships, with a roadmap of a few nodes.
    let problems = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems");
    let text = fs::read_to_string(format!("{problems}/peptide.toml")).expect("it ships");
    let text = text.replace("structures/", &format!("{problems}/structures/"));
    let text = text.replace("nodes = 60", "nodes = 6").replace("neighbors = 10", "neighbors = 3");
    scratch.write("peptide.toml", &text.replace("sets_per_round = 5", "sets_per_round = 1"));
    scratch.build("run", &["peptide.toml"], 0);
    let near = "-3.0 -1.4 1.7 -1.2 2.0 -0.2 -1.0 -0.7 -1.8 -0.4 1.6 0.6 -2.8 2.9 -1.2 2.2 -1.2";
    let done = scratch.run(&[
        "paths",
        "run",
        "--goal",
        near,
        "--count",
        "2",
        "--dissimilar",
        "0.05",
        "--tries",
        "4",
        "--shorten-tries",
        "5",
        "--format",
        "csv,pdb,dcd,xtc",
        "--angle",
        "bend=1-3/4-6/7-10",
        "--out",
        "ways",
    ]);
    done.assert_code(0);
    let folder = scratch.path("ways");
    let frames = table(&folder.join("path-1.frames.csv"));
    let paths = table(&folder.join("paths.csv"));
    assert_eq!(frames.len().to_string(), paths[0]["frames"]);
    let (first, last) = (&frames[0], &frames[frames.len() - 1]);
    assert_eq!((number(first, "rmsd_start [Å]"), number(last, "rmsd_goal [Å]")), (0.0, 0.0));
    assert_eq!((number(first, "contacts_start"), number(last, "contacts_goal")), (1.0, 1.0));
    assert!((0.0..180.0).contains(&number(first, "bend [deg]")));
    // The barrier is the highest energy on the way above that at the start; frames may step over it.
    let energy = |row: &BTreeMap<String, String>| number(row, "energy [kJ/mol]");
    let highest = frames.iter().map(energy).fold(f64::NEG_INFINITY, f64::max);
    let barrier = number(&paths[0], "barrier [kJ/mol]");
    assert!(highest - energy(first) <= barrier + 1e-9, "{highest} {barrier}");
    let rise = barrier - number(&paths[0], "barrier_back [kJ/mol]");
    assert!((rise - (energy(last) - energy(first))).abs() < 1e-9, "{rise}");
    let contacts = table(&folder.join("path-1.contacts.csv"));
    let shares: Vec<f64> = contacts.iter().map(|row| number(row, "share")).collect();
    assert!(shares.is_sorted() && shares.iter().all(|share| (0.0..=1.0).contains(share)));
    let pdb = fs::read_to_string(folder.join("path-1.pdb")).expect("written");
    assert_eq!(pdb.matches("MODEL ").count(), frames.len());
    if has_python() {
        let output = Command::new("python3").args(["-c", READ]).current_dir(&folder).output();
        let output = output.expect("python3 starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}
