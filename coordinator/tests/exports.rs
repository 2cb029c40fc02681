//! What is exported, read by other programs.

mod support;

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use support::{ENDLESS, Scratch};

const FORMATS: [&str; 6] = ["graphml", "csv", "npz", "map", "svg", "vtk"];

/// A file of the repository.
fn repository(name: &str) -> String {
    format!("{}/../{name}", env!("CARGO_MANIFEST_DIR"))
}

fn read(scratch: &Scratch, name: &str) -> String {
    fs::read_to_string(scratch.path(name)).expect("the file is there")
}

/// A Python that has networkx and NumPy, unless there is none and none is required.
fn has_python() -> bool {
    let there = Command::new("python3").args(["-c", "import networkx, numpy, lxml"]).output();
    let there = there.is_ok_and(|output| output.status.success());
    if !there {
        let required =
            std::env::var_os("ROADMILL_REQUIRE_PYTHON").is_some_and(|value| value == "1");
        assert!(!required, "no python3 with networkx, numpy and lxml");
        println!("not tested: no python3 with networkx, numpy and lxml");
    }
    there
}

#[track_caller]
fn python(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new("python3").args(arguments).current_dir(folder).output();
    let output = output.expect("python3 starts");
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success(), "{out}\n{err}");
    out.into_owned()
}

/// Exports a run in every format into the folder of the run, twice with the same bytes.
fn export_all(scratch: &Scratch, run: &str) {
    for format in FORMATS {
        let names = [format!("{run}/roadmap.{format}"), format!("{run}/again.{format}")];
        for name in &names {
            scratch.run(&["export", run, "--format", format, "--out", name]).assert_code(0);
        }
        let [one, other] = names.map(|name| fs::read(scratch.path(&name)).expect("it is written"));
        assert!(one == other, "{format} differs the second time");
    }
}

/// A roadmap whose edges have several planners.
fn turning() -> String {
    let within = "within = { nearest = { neighbors = 4, planners = \
                  [{ rotate-at = { percent = 50 } }, \"straight-line\"] } }";
    ENDLESS.replace("within = { nearest = { neighbors = 4 } }", within)
}

#[test]
fn other_programs_read_the_same_roadmap_from_every_format() {
    let scratch = Scratch::new();
    scratch.write("turning.toml", &turning());
    let turning = ["turning.toml", "--threads", "2", "--max-sets", "24"];
    scratch.build("turning", &turning, 0);
    scratch.build("maze", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    // A linkage with a mesh, one with a rotation for a joint, and a mesh among meshes.
    for (run, file) in [
        ("gantry", "problems/gantry.toml"),
        ("ball", "tests/problems/ball.toml"),
        ("cage", "problems/cage.toml"),
    ] {
        let arguments =
            ["build", &repository(file), "--threads", "2", "--max-sets", "10", "--out", run];
        let code = scratch.run(&arguments).status.code();
        assert!(matches!(code, Some(0 | 3)), "{run}: {code:?}");
    }
    for (run, dofs) in [("turning", 6), ("maze", 3), ("gantry", 3), ("ball", 4), ("cage", 6)] {
        export_all(&scratch, run);
        let summary: Value =
            serde_json::from_str(&read(&scratch, &format!("{run}/summary.json"))).expect("JSON");
        let counts = ["nodes", "edges"].map(|key| summary[key].as_u64().expect("a number"));
        assert_map(&read(&scratch, &format!("{run}/roadmap.map")), counts, dofs);
        if has_python() {
            let script = repository("tests/support/check_exports.py");
            let said = python(&scratch.path(run), &[&script, "."]);
            assert!(said.contains("agree"), "{said}");
        }
    }
    let edges = read(&scratch, "turning/roadmap.edges.csv");
    assert!(edges.contains(",rotate-at-50,51\n") && edges.contains(",straight-line,0\n"));
    assert!(read(&scratch, "turning/roadmap.map").contains(" 2 "));
}

/// Reads a `.map` as Open-PPL does, word by word. The first half of the values are lengths.
fn assert_map(text: &str, [nodes, edges]: [u64; 2], dofs: usize) {
    let (head, graph) = text.split_once("#####GRAPHSTART#####\n").expect("a graph");
    assert!(head.starts_with("#####ENVFILESTART#####\n") && head.contains(".env\n"));
    let graph = graph.strip_suffix("\n#####GRAPHSTOP#####\n").expect("an end");
    let mut words = graph.split_whitespace();
    let mut next = || words.next().expect("a word").parse::<f64>().expect("a number");
    assert_eq!([next(), next(), next()], [nodes, 2 * edges, nodes].map(|count| count as f64));
    let mut both = std::collections::BTreeMap::new();
    for node in 0..nodes {
        assert_eq!(next(), node as f64);
        let angles: Vec<f64> = (0..dofs).map(|_| next()).skip(dofs / 2 + dofs % 2).collect();
        assert!(angles.iter().all(|angle| angle.abs() <= 1.0), "{angles:?}");
        for _ in 0..next() as u64 {
            let target = next() as u64;
            for _ in 0..next() as usize * dofs {
                next();
            }
            let weight = next();
            let edge = (node.min(target), node.max(target));
            match both.remove(&edge) {
                None => drop(both.insert(edge, weight)),
                Some(other) => assert_eq!(weight.to_bits(), other.to_bits()),
            }
        }
    }
    assert!(both.is_empty(), "edges with one end: {both:?}");
    assert_eq!(words.next(), None);
}

#[test]
fn the_readmes_lines_of_python_work() {
    let readme = fs::read_to_string(repository("README.md")).expect("there is a README");
    let (_, snippet) = readme.split_once("```python\n").expect("lines of Python");
    let (snippet, _) = snippet.split_once("```").expect("their end");
    if !has_python() {
        return;
    }
    let scratch = Scratch::new();
    scratch.build("run", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    let out = ["--format", "graphml", "--out", "run/roadmap.graphml"];
    scratch.run(&[&["export", "run"], &out[..]].concat()).assert_code(0);
    let said = python(&scratch.path("run"), &["-c", snippet]);
    assert!(said.starts_with("[(") && said.matches('(').count() > 2, "{said}");
}

/// The path of a peptide is a structure with a model for each conformation, which begins with the source's.
#[test]
fn a_proteins_path_is_a_pdb_file_and_a_mazes_is_none() {
    let scratch = Scratch::new();
    scratch.build("peptide", &[&repository("problems/peptide.toml"), "--threads", "2"], 0);
    let out = ["--format", "pdb", "--out", "path.pdb"];
    scratch.run(&[&["export", "peptide"], &out[..]].concat()).assert_code(0);
    let read = |path: &str| {
        let done = scratch.run(&["protein", "info", path]);
        done.assert_code(0);
        done.stdout
    };
    let (path, source) = (read("path.pdb"), read(&repository("problems/structures/1UAO.pdb")));
    let models = fs::read_to_string(scratch.path("path.pdb")).expect("it is written");
    let models = models.lines().filter(|line| line.starts_with("MODEL")).count();
    assert!(models >= 2 && path.contains(&format!("models: {models}")), "{path}");
    for told in ["138 atoms, 10 residues", "GYDPETGTWG"] {
        assert!(path.contains(told) && source.contains(told), "{path}\n{source}");
    }
    scratch.build("maze", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    let refused = scratch.run(&[&["export", "maze"], &out[..]].concat());
    refused.assert_code(2);
    refused.assert_stderr(&["--format: this model is no molecule"]);
}

/// Residues whose names have four letters, or are none of the twenty, are amino acids of their chain in what is exported, by
/// this program and by gemmi.
#[test]
fn residues_of_other_names_stay_in_the_chain() {
    let scratch = Scratch::new();
    let peptide = fs::read_to_string(repository("problems/structures/1UAO.pdb")).expect("it ships");
    let atoms = peptide.lines().take_while(|line| !line.starts_with("ENDMDL"));
    let atoms = atoms.filter(|line| line.starts_with("ATOM"));
    let atoms: String = atoms.map(|line| format!("{line}\n")).collect();
    let renamed = atoms
        .replace("GLY A   1", "NGLYA   1")
        .replace("GLU A   5", "GLUPA   5")
        .replace("THR A   6", "TPO A   6");
    scratch.write("renamed.pdb", &renamed);
    scratch.run(&["protein", "problem", "renamed.pdb", "--out", "p.toml"]).assert_code(0);
    scratch.build("run", &["p.toml", "--threads", "1", "--max-sets", "1"], 0);
    scratch.run(&["export", "run", "--format", "pdb", "--out", "nodes.pdb"]).assert_code(0);
    // Of other nodes atoms of side chains, which move rigidly, may stand on one another, which files must not have.
    let nodes = read(&scratch, "nodes.pdb");
    let (first, _) = nodes.split_once("ENDMDL\n").expect("a model");
    scratch.write("first.pdb", &format!("{first}ENDMDL\nEND\n"));
    let done = scratch.run(&["protein", "info", "first.pdb", "--json"]);
    done.assert_code(0);
    let info: Value = serde_json::from_str(&done.stdout).expect("JSON");
    assert_eq!(info["chains"][0]["sequence"], "GYDPETGTWG");
    assert_eq!(info["chains"][0]["modified"], serde_json::json!(["TPO 6 (THR)"]));
    let gemmi = Command::new("python3").args(["-c", "import gemmi"]).output();
    if !gemmi.is_ok_and(|output| output.status.success()) {
        println!("not tested: no python3 with gemmi");
        return;
    }
    let script = "import gemmi; s = gemmi.read_structure('nodes.pdb'); s.setup_entities(); m = s[0]; \
                  print(len(m), [r.name for r in m[0].get_polymer()], m.count_atom_sites())";
    let said = python(&scratch.path("."), &["-c", script]);
    let names = "['GLY', 'TYR', 'ASP', 'PRO', 'GLU', 'TPO', 'GLY', 'THR', 'TRP', 'GLY']";
    assert_eq!(said.trim(), format!("1 {names} 138"));
}

#[test]
fn formats_that_are_not_there_are_refused() {
    let scratch = Scratch::new();
    let done = scratch.run(&["export", "run", "--format", "hologram", "--out", "out"]);
    done.assert_code(2);
    done.assert_stderr(&["hologram", "graphml, csv, npz, map, pdb, dcd, xtc, svg, vtk, clearance"]);
    assert!(!scratch.path("out").exists());
}

/// Length of a path as the program says it.
fn length(stderr: &str) -> f64 {
    let (_, rest) = stderr.split_once("length ").expect("a length");
    rest.split(',').next().and_then(|word| word.parse().ok()).expect("a number")
}

/// A number that the program prints after some words.
fn number_after(stderr: &str, words: &str) -> f64 {
    let (_, rest) = stderr.split_once(words).expect("the words");
    rest.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number")
}

#[test]
fn the_clearest_path_keeps_farther_away_than_the_shortest_and_costs_length() {
    let scratch = Scratch::new();
    scratch.build("run", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    let shortest = scratch.run(&["query", "run"]);
    let [widest, weighted] = ["widest", "weighted"].map(|by| {
        let found = scratch.run(&["query", "run", "--clearest", by, "--out", &format!("{by}.csv")]);
        found.assert_code(0);
        let [least, mean] =
            ["clearance ", "at least and "].map(|it| number_after(&found.stderr, it));
        (least, mean, length(&found.stderr))
    });
    assert!(widest.0 > 0.0 && widest.0 >= weighted.0 - 0.05, "{widest:?}, {weighted:?}");
    assert!(widest.2 >= length(&shortest.stderr) && weighted.2 >= length(&shortest.stderr));
    assert!(weighted.1 >= weighted.0 && widest.1 >= widest.0);
    // The edges of the widest path are those of the roadmap or attach the ends, and the path is one of the run.
    let lines = read(&scratch, "widest.csv");
    assert_eq!(lines.lines().next(), shortest.stdout.lines().next());
    assert_eq!(lines.lines().nth(1), shortest.stdout.lines().nth(1));
    assert_eq!(lines.lines().last(), shortest.stdout.lines().last());

    let page = ["view", "run", "--clearance", "--no-open", "--out", "view.html"];
    scratch.run(&page).assert_code(0);
    assert!(read(&scratch, "view.html").contains("\"name\":\"clearance\""));

    scratch.build("energy", &[&repository("problems/muller-brown.toml"), "--threads", "2"], 0);
    let refused = scratch.run(&["query", "energy", "--clearest", "widest"]);
    refused.assert_code(2);
    let why = "clearances: a problem of bodies among obstacles expected";
    assert!(refused.stderr.contains(why));
    let refused = scratch.run(&["view", "energy", "--clearance", "--no-open", "--out", "e.html"]);
    refused.assert_code(2);
    assert!(refused.stderr.contains(why) && !scratch.path("e.html").exists());
}

#[test]
fn paths_are_shortened_and_played() {
    let scratch = Scratch::new();
    scratch.build("run", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    let long = scratch.run(&["query", "run", "--out", "long.csv"]);
    assert_eq!(read(&scratch, "long.csv"), read(&scratch, "run/path.csv"));
    let short = ["query", "run", "--shorten", "--shorten-tries", "500"];
    let out = ["--out", "short.csv", "--animate", "short.html"];
    let shortened = scratch.run(&[&short[..], &out].concat());
    shortened.assert_code(0);
    assert!(length(&shortened.stderr) < length(&long.stderr));
    let again = scratch.run(&short);
    assert_eq!(again.stdout, read(&scratch, "short.csv"));

    let path = scratch.run(&[&short[..], &["--format", "path"]].concat()).stdout;
    let count = again.stdout.lines().count() - 1;
    let head = format!("VIZMO_PATH_FILE   Path Version 2012\n1\n{count}\n1.1 1 0\n");
    assert!(path.starts_with(&head), "{path}");
    assert_eq!(path.lines().count(), 3 + count);

    let page = read(&scratch, "short.html");
    for reference in ["http:", "https:", "src=", "url("] {
        assert!(!page.contains(reference), "refers to other files: {reference}");
    }
    let (_, data) = page.split_once("id=\"data\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("their end");
    let data: Value = serde_json::from_str(data).expect("JSON");
    let length = |list: &Value| list.as_array().expect("a list").len();
    let path = &data["paths"][0];
    assert_eq!(["frames", "configs", "way"].map(|key| length(&path[key])), [301; 3]);
    assert_eq!(["links", "obstacles", "paths"].map(|key| length(&data[key])), [1, 17, 1]);
    assert_eq!(length(&path["frames"][0]), 7);
    assert!(data["roadmap"].is_null());
    assert_eq!(data["name"], "maze");
}

/// Every link and obstacle has a surface, all triangles have their corners, and no number is broken.
#[test]
fn linkages_and_meshes_are_played_and_drawn() {
    let scratch = Scratch::new();
    scratch.build("run", &[&repository("problems/gantry.toml"), "--threads", "2"], 0);
    scratch.run(&["query", "run", "--animate", "page.html"]).assert_code(0);
    let page = read(&scratch, "page.html");
    let (_, data) = page.split_once("id=\"data\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("their end");
    let data: Value = serde_json::from_str(data).expect("JSON");
    let links = data["links"].as_array().expect("a list");
    let bodies: Vec<usize> = links.iter().map(|link| link.as_array().unwrap().len()).collect();
    assert_eq!(bodies, [2, 1, 1, 1, 1]);
    let surfaces = links.iter().chain([&data["obstacles"]]).flat_map(|all| all.as_array().unwrap());
    for surface in surfaces {
        let vertices = surface["v"].as_array().expect("numbers");
        assert!(vertices.iter().all(Value::is_number) && vertices.len() % 3 == 0);
        let corners = surface["t"].as_array().expect("corners");
        let most = corners.iter().map(|corner| corner.as_u64().unwrap()).max().expect("triangles");
        assert!(corners.len() % 3 == 0 && most as usize == vertices.len() / 3 - 1);
    }
    // Seven numbers a link.
    assert_eq!(data["paths"][0]["frames"][300].as_array().map(Vec::len), Some(35));
    let export = ["export", "run", "--format", "svg", "--out", "picture.svg"];
    scratch.run(&export).assert_code(0);
    let picture = read(&scratch, "picture.svg");
    assert!(!picture.contains("NaN") && !picture.contains("inf"), "{picture}");
}

#[test]
fn many_queries_go_into_a_folder_of_their_own() {
    let scratch = Scratch::new();
    scratch.build("run", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    let good = "x,y,theta,x,y,theta\n# there\n1.1,1,0,14.9,9,0\n\n14.9, 9, 0, 1.1, 1, 0\n";
    scratch.write("many.csv", good);
    let ask = |out: &str| scratch.run(&["query", "run", "--queries", "many.csv", "--out", out]);
    let done = ask("paths");
    done.assert_code(0);
    done.assert_stderr(&["2 of 2 queries solved"]);
    assert_eq!(read(&scratch, "paths/000000.csv"), read(&scratch, "run/path.csv"));
    let summary = read(&scratch, "paths/summary.csv");
    let mut lines = summary.lines();
    let header = "index,solved,length [length],configurations,dropped_edges,seconds";
    assert_eq!(lines.next(), Some(header));
    for (index, line) in lines.by_ref().enumerate() {
        assert!(line.starts_with(&format!("{index},1,")), "{line}");
        let configs = read(&scratch, &format!("paths/{index:06}.csv")).lines().count() - 1;
        assert_eq!(line.split(',').nth(3), Some(&*configs.to_string()));
    }

    // Nothing is overwritten, and nothing written where a line is wrong.
    let refused = ask("paths");
    refused.assert_code(2);
    refused.assert_stderr(&["paths: holds something"]);
    for (line, expected) in [
        ("1,2,3", "3 values found, 6 expected"),
        ("1.1,1,0,14.9,9,x", "goal: `x` found, a number expected"),
        ("1.1,1,,14.9,9,0", "nothing found in field 3"),
        ("2,6,0,14.9,9,0", "start: [2.0, 6.0, 0.0] found, where the robot collides"),
    ] {
        scratch.write("many.csv", &format!("{good}{line}\n"));
        let refused = ask("other");
        refused.assert_code(2);
        refused.assert_stderr(&["many.csv:6: ", expected]);
        assert!(!scratch.path("other").exists());
    }
    // Names stand above numbers only as many as these are.
    for (text, expected) in [
        ("# nothing\n", "many.csv: no queries found"),
        ("a,b\n", "many.csv:1: 2 values found, 6 expected"),
    ] {
        scratch.write("many.csv", text);
        let refused = ask("other");
        refused.assert_code(2);
        refused.assert_stderr(&[expected]);
    }
    // A device has no end; several paths have no place on standard output.
    scratch.write("many.csv", good);
    for (arguments, expected) in [
        (
            &["query", "run", "--queries", "/dev/zero", "--out", "other"][..],
            "/dev/zero: cannot read the queries: a device",
        ),
        (&["query", "run", "--queries", "many.csv", "--out", "-"], "a folder expected"),
        (&["paths", "run", "--out", "-"], "a folder expected"),
        (&["build", "maze.toml", "--out", "-"], "a folder expected"),
        (
            &["generate", "maze.toml", "--sets", "uniform:0..1", "--out", "-"],
            "a regular file expected",
        ),
    ] {
        let refused = scratch.run(arguments);
        refused.assert_code(2);
        refused.assert_stderr(&[expected]);
        assert_eq!(refused.stdout, "", "{arguments:?}");
    }
    assert!(!scratch.path("other").exists() && !scratch.path("-").exists());
    scratch.run(&["paths", "run", "--out", "./-"]).assert_code(0);
    assert!(scratch.path("-/paths.csv").exists());
}

#[test]
fn unsolved_queries_are_told_apart() {
    let scratch = Scratch::new();
    let sealed = repository("problems/sealed.toml");
    scratch.build("run", &[&sealed, "--threads", "2", "--max-sets", "8"], 3);
    let problem = fs::read_to_string(&sealed).expect("it ships with the repository");
    let end = |name: &str| {
        let line = problem.lines().find(|line| line.starts_with(name)).expect("an end");
        let (_, values) = line.split_once('[').expect("values");
        values.trim_end_matches(']').to_owned()
    };
    let (start, goal) = (end("start"), end("goal"));
    scratch.write("many.csv", &format!("{start},{goal}\n{start},{start}\n"));
    let done = scratch.run(&["query", "run", "--queries", "many.csv", "--out", "paths"]);
    done.assert_code(3);
    done.assert_stderr(&["1 of 2 queries unsolved"]);
    assert!(read(&scratch, "paths/summary.csv").contains("\n0,0,,0,"));
    assert!(!scratch.path("paths/000000.csv").exists());
    assert!(scratch.path("paths/000001.csv").exists());
}
