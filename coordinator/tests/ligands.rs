//! `ligand problem`, `ligand poses` and `ligand rank`: biotin at streptavidin, which ship as one file, and small molecules beside it.

mod support;

use serde_json::Value;
use std::fs;
use support::{Done, Scratch};

const COMPLEX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/structures/1STP.pdb");

/// Options that make a search small: a coarse grid, a short cut-off, few nodes.
const SMALL: [&str; 4] = ["--spacing", "0.6", "--cutoff", "8"];

/// A folder with the complex.
fn scratch() -> Scratch {
    let scratch = Scratch::new();
    fs::copy(COMPLEX, scratch.path("1STP.pdb")).expect("it ships");
    scratch
}

fn problem(scratch: &Scratch, out: &str, more: &[&str]) -> Done {
    let first = ["ligand", "problem", "1STP.pdb", "--ligand", "BTN", "--out", out];
    scratch.run(&[&first[..], &SMALL, more].concat())
}

/// A molecule of carbons and one oxygen in a zigzag from a place in the site on, as a record of an SDF file.
fn alcohol(name: &str, carbons: usize) -> String {
    let count = carbons + 1;
    let mut text = format!("{name}\n\n\n{count:>3}{carbons:>3}  0  0  0  0  0  0  0  0999 V2000\n");
    for atom in 0..count {
        let (x, y) = (8.0 + 1.25 * atom as f64, 2.0 + 0.8 * (atom % 2) as f64);
        let element = if atom == carbons { "O" } else { "C" };
        text += &format!(
            "{x:>10.4}{y:>10.4}{:>10.4} {element}   0  0  0  0  0  0  0  0  0  0  0  0\n",
            -11.0
        );
    }
    for bond in 1..=carbons {
        text += &format!("{bond:>3}{:>3}  1  0\n", bond + 1);
    }
    text + "M  END\n$$$$\n"
}

#[test]
fn a_search_is_written_built_and_its_poses_are_the_same_in_every_call() {
    let scratch = scratch();
    let done = problem(&scratch, "btn.toml", &["--box-around-ligand", "8", "--nodes", "300"]);
    done.assert_code(0);
    assert!(done.stdout.contains("16 heavy atoms, 11 degrees of freedom"), "{}", done.stdout);
    assert!(done.stdout.contains("8.0 x 8.0 x 8.0 Å"), "{}", done.stdout);
    done.assert_stderr(&["protein: left out 84 HOH"]);
    assert!(scratch.path("btn-structures/protein.cif").is_file());
    // Once more only by force, and then the same.
    let again = |more: &[&str]| {
        let options = [&["--box-around-ligand", "8", "--nodes", "300"], more].concat();
        problem(&scratch, "btn.toml", &options)
    };
    again(&[]).assert_code(2);
    let forced = again(&["--force"]);
    forced.assert_code(0);
    assert_eq!(forced.stdout, done.stdout);

    let digest = scratch.build("run", &["btn.toml", "--threads", "2"], 0);
    assert_eq!(scratch.build("again", &["btn.toml", "--workers", "1"], 0), digest);

    let poses = |out: &str| {
        let options = ["--count", "3", "--improve", "12", "--format", "sdf,pdb,csv", "--ways", "1"];
        let page = format!("{out}.html");
        let files = ["--out", out, "--page", &page];
        let done = scratch.run(&[&["ligand", "poses", "run"], &options[..], &files].concat());
        done.assert_code(0);
        done.stdout
    };
    let said = poses("a");
    assert_eq!(poses("b"), said);
    // Nothing that is there is lost.
    let again = ["ligand", "poses", "run", "--out", "a", "--count", "1", "--improve", "2"];
    let done = scratch.run(&again);
    done.assert_code(2);
    done.assert_stderr(&["a.sdf: it is there already; --force replaces it"]);
    let file = |name: &str| fs::read_to_string(scratch.path(name)).expect(name);
    for end in [".sdf", ".pdb", "-protein.pdb", ".csv", ".html"] {
        assert_eq!(file(&format!("a{end}")), file(&format!("b{end}")), "{end}");
    }
    for told in ["reference        the given pose", "best RMSD", "outcome", "descents"] {
        assert!(said.contains(told), "{told}\n{said}");
    }
    assert_eq!(file("a.sdf").matches("$$$$").count(), file("a.csv").lines().count() - 1);
    assert!(file("a.sdf").contains("> <energy_kJ_mol>") && file("a.sdf").contains("rmsd_A"));
    assert!(file("a.pdb").contains("HETATM") && file("a.pdb").contains("CONECT"));
    assert!(file("a-protein.pdb").contains("ATOM") && !file("a-protein.pdb").contains("BTN"));
    assert!(file("a.html").ends_with("</html>\n") || file("a.html").contains("</html>"));

    // The poses are read again as the same molecule: the reference may be one of them.
    let done =
        scratch.run(&["ligand", "poses", "run", "--count", "2", "--improve", "12", "--json"]);
    done.assert_code(0);
    let of_json: Value = serde_json::from_str(&done.stdout).expect("JSON");
    let rows = of_json["rows"].as_array().expect("rows");
    let energy = |row: &Value| row["energy"].as_f64().expect("an energy");
    assert!(rows.len() <= 2 && rows.windows(2).all(|two| energy(&two[0]) <= energy(&two[1])));
    let first = file("a.sdf").split_inclusive("$$$$\n").next().expect("a record").to_owned();
    scratch.write("best.sdf", &first);
    let options = ["--count", "1", "--improve", "12", "--reference", "best.sdf", "--json"];
    let done = scratch.run(&[&["ligand", "poses", "run"], &options[..]].concat());
    done.assert_code(0);
    let of_json: Value = serde_json::from_str(&done.stdout).expect("JSON");
    let rmsd = of_json["rows"][0]["rmsd"].as_f64().expect("a number");
    assert!(rmsd < 0.2, "{rmsd}");
    assert_eq!(of_json["outcome"], "hit");
}

#[test]
fn hints_become_nodes_in_any_order_of_their_atoms() {
    let scratch = scratch();
    scratch.write("propanol.sdf", &alcohol("propanol", 3));
    // The same molecule from its other end, which touches nothing else.
    let record = "hint\n\n\n  4  3  0  0  0  0  0  0  0  0999 V2000\n    \
                  8.0000    2.0000  -11.0000 O   0  0  0  0  0  0  0  0  0  0  0  0\n    \
                  9.2500    2.8000  -11.0000 C   0  0  0  0  0  0  0  0  0  0  0  0\n   \
                  10.5000    2.0000  -11.0000 C   0  0  0  0  0  0  0  0  0  0  0  0\n   \
                  11.7500    2.8000  -11.0000 C   0  0  0  0  0  0  0  0  0  0  0  0\n  \
                  1  2  1  0\n  2  3  1  0\n  3  4  1  0\nM  END\n$$$$\n";
    scratch.write("hints.sdf", record);
    let made = |out: &str, more: &[&str]| {
        let first = ["ligand", "problem", "1STP.pdb", "--ligand", "propanol.sdf", "--out", out];
        let region = ["--box-at", "10,2,-11", "--box-size", "8,8,6", "--nodes", "200"];
        scratch.run(&[&first[..], &SMALL, &region, more].concat())
    };
    made("hinted.toml", &["--hints", "hints.sdf"]).assert_code(0);
    let text = fs::read_to_string(scratch.path("hinted.toml")).expect("it is written");
    assert!(text.contains("label = \"hints\"") && text.contains("given"), "{text}");
    scratch.build("hinted", &["hinted.toml", "--threads", "2"], 0);

    scratch.write("other.sdf", &alcohol("butanol", 4));
    let done = made("other.toml", &["--hints", "other.sdf"]);
    done.assert_code(2);
    done.assert_stderr(&["hint 1: 5 atoms with 4 bonds found", "the same molecule"]);
    scratch.write("far.sdf", &record.replace("-11.0000", " 90.0000"));
    let done = made("far.toml", &["--hints", "far.sdf"]);
    done.assert_code(2);
    done.assert_stderr(&["hint 1: a pose outside of the box found"]);
}

#[test]
fn what_cannot_be_searched_is_an_error_that_says_why() {
    let scratch = scratch();
    let run = |more: &[&str]| {
        let first = ["ligand", "problem", "1STP.pdb", "--out", "p.toml"];
        scratch.run(&[&first[..], more].concat())
    };
    for (options, told) in [
        (&["--ligand", "none.sdf"][..], "none.sdf found, which is no file"),
        (&["--ligand", "XYZ"], "XYZ"),
        (&["--ligand", "BTN", "--chains", "Q"], "no chain `Q` found"),
        (&["--ligand", "BTN", "--molecule", "x"], "--molecule: of no use to a residue"),
        (&["--ligand", "1STP.pdb", "--chain", "A"], "--chain and --number: of no use"),
        (&["--ligand", "BTN", "--spacing", "9"], "spacing 9 found"),
    ] {
        let done = run(options);
        done.assert_code(2);
        done.assert_stderr(&[told]);
        assert!(!scratch.path("p.toml").exists());
    }
    // A run of another model has no poses.
    scratch.write("small.toml", support::SMALL);
    scratch.build("small", &["small.toml", "--threads", "1"], 0);
    let done = scratch.run(&["ligand", "poses", "small"]);
    done.assert_code(2);
    done.assert_stderr(&["a run of another model found; one of a ligand at a protein expected"]);
}

#[test]
fn ligands_are_ranked_beside_what_was_measured() {
    let scratch = scratch();
    let ligands: String = (2..6).map(|size| alcohol(&format!("c{size}"), size)).collect();
    scratch.write("ligands.sdf", &ligands);
    scratch.write("ki.csv", "name,ki\nc2,40\nc3,30\nc4,20\nc5,10\n");
    let rank = |out: &str, more: &[&str]| {
        let first = ["ligand", "rank", "1STP.pdb", "ligands.sdf", "--out", out, "--nodes", "60"];
        let step = ["--step", "0.5", "--grid", "exact", "--threads", "2"];
        scratch.run(&[&first[..], &SMALL[2..], &step, more].concat())
    };
    let done = rank("one", &["--measured", "ki.csv"]);
    done.assert_code(0);
    // More heavy atoms, smaller values: the control has the opposite order.
    let control = done.stdout.lines().find(|line| line.starts_with("heavy atoms (control)"));
    assert!(control.is_some_and(|line| line.contains("-1.000")), "{}", done.stdout);
    assert_eq!(done.stdout.matches("distance ").count(), 3 + 1, "{}", done.stdout);
    let csv = fs::read_to_string(scratch.path("one/rank.csv")).expect("a table");
    assert_eq!(csv.lines().count(), 1 + 4);
    let page = fs::read_to_string(scratch.path("one/rank.md")).expect("a document");
    assert!(page.contains("| energy 1 % |") && page.contains("95 % interval"));
    // Nothing is left to do, and the tables come to the same.
    rank("one", &["--measured", "ki.csv"]).assert_code(2);
    let again = rank("one", &["--measured", "ki.csv", "--or-resume"]);
    again.assert_code(0);
    assert_eq!(again.stdout, done.stdout);
    assert_eq!(fs::read_to_string(scratch.path("one/rank.csv")).expect("a table"), csv);
    scratch.run(&["verify", "one/c3", "--all", "--threads", "2"]).assert_code(0);

    // What is wrong is said before anything runs.
    for (ligands, measured, told) in [
        (format!("{ligands}{}", alcohol("c2", 3)), "", "a second ligand `c2` found"),
        (format!("{ligands}{}", alcohol("a/b", 3)), "", "`a/b` found as the name of a ligand"),
        (ligands.clone(), "c2,1\nc3,x\n", "ki.csv:2: `c3,x` found"),
        (ligands.clone(), "c2,1\nc3,2\nc9,4\n", "no such ligands: c9"),
        (ligands.clone(), "c2,1\nc3,2\n", "values of 2 ligands found"),
    ] {
        scratch.write("ligands.sdf", &ligands);
        scratch.write("ki.csv", measured);
        let more: &[&str] = if measured.is_empty() { &[] } else { &["--measured", "ki.csv"] };
        let done = rank("two", more);
        done.assert_code(2);
        done.assert_stderr(&[told]);
        assert!(!scratch.path("two").exists());
    }
}
