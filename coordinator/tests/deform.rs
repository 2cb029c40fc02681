//! `roadmill deform`: what it prints, writes and refuses.

mod support;

use std::fs;
use support::Scratch;

/// A file of the repository.
fn repository(name: &str) -> String {
    format!("{}/../{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn a_run_of_a_deformable_robot_is_deformed_told_and_written() {
    let scratch = Scratch::new();
    scratch.build("run", &[&repository("problems/squeeze.toml"), "--threads", "2"], 0);
    let all = ["deform", "run", "--csv", "e.csv", "--obj", "frames", "--html", "p.html"];
    let done = scratch.run(&all);
    done.assert_code(0);
    for expected in ["bounding-box", "proved free", "tried", "CPU time"] {
        assert!(done.stdout.contains(expected), "{expected}: {}", done.stdout);
    }
    let table = fs::read_to_string(scratch.path("e.csv")).unwrap();
    let mut lines = table.lines();
    let head =
        "frame,share [1],edge,x [length],y [length],z [length],energy [length],volume [1],blend";
    assert_eq!(lines.next(), Some(head));
    let frames = lines.count();
    let written = fs::read_dir(scratch.path("frames")).unwrap().count();
    assert_eq!(written, frames + 1, "a file for each frame, and the obstacles");
    assert!(fs::read_to_string(scratch.path("p.html")).unwrap().starts_with("<!DOCTYPE html>"));
    // What is there is replaced only where that is asked for, by the same bytes.
    let refused = scratch.run(&["deform", "run", "--csv", "e.csv"]);
    refused.assert_code(2);
    assert!(refused.stderr.contains("--force replaces it"), "{}", refused.stderr);
    scratch.run(&["deform", "run", "--obj", "frames"]).assert_code(2);
    scratch.run(&[&all[..], &["--force"]].concat()).assert_code(0);
    assert_eq!(fs::read_to_string(scratch.path("e.csv")).unwrap(), table);
    // Without a clearance it is said that nothing is proved.
    let sampled = scratch.run(&["deform", "run", "--clearance", "0", "--step", "0.2"]);
    sampled.assert_code(0);
    assert!(sampled.stdout.contains("sampled"), "{}", sampled.stdout);
    // No energy at all is accepted: there is no path.
    let refused = scratch.run(&["deform", "run", "--highest-energy", "0"]);
    refused.assert_code(3);
    assert!(refused.stderr.contains("cannot be deformed"), "{}", refused.stderr);
    // A path that is given, for another body; and one whose second line is no configuration.
    scratch.write("path.csv", "x,y,z\n1,1,3\n1,2,3\n");
    let tetrahedron = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    scratch.write("other.obj", tetrahedron);
    let given = ["deform", "run", "--path", "path.csv", "--robot", "other.obj", "--csv", "-"];
    let done = scratch.run(&given);
    done.assert_code(0);
    assert!(done.stdout.starts_with("frame,") && done.stderr.contains("1 leg;"), "{}", done.stderr);
    scratch.write("path.csv", "x,y,z\n1,1,3\n1,2\n");
    let wrong = scratch.run(&given);
    wrong.assert_code(2);
    assert!(wrong.stderr.contains("path.csv:3: 2 values found; 3 expected"), "{}", wrong.stderr);
    scratch.write("path.csv", "x,y,z\n1,1,3\n1,2,3\n");
    scratch.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let open = scratch.run(&given);
    open.assert_code(2);
    assert!(open.stderr.contains("other.obj: "), "{}", open.stderr);
    // A path beyond the bounds, where nothing keeps shapes in.
    scratch.write("path.csv", "x,y,z\n1,1,3\n100,1,1\n");
    let outside = scratch.run(&["deform", "run", "--path", "path.csv"]);
    outside.assert_code(2);
    assert!(outside.stderr.contains("configuration 2 is beyond the bounds"), "{}", outside.stderr);
    // Settings have the same ranges as in a problem file.
    for option in ["--step", "--clearance"] {
        let tiny = scratch.run(&["deform", "run", option, "1e-300"]);
        tiny.assert_code(2);
        assert!(tiny.stderr.contains("a length of at least"), "{}", tiny.stderr);
    }
    // Steps so short that their frames would take gigabytes.
    let many = scratch.run(&["deform", "run", "--step", "0.00001"]);
    many.assert_code(3);
    assert!(many.stdout.contains("more frames than can be made"), "{}", many.stdout);
    // Runs of rigid robots have nothing to be deformed.
    scratch.build("maze", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    let rigid = scratch.run(&["deform", "maze"]);
    rigid.assert_code(2);
    assert!(rigid.stderr.contains("[deformable]"), "{}", rigid.stderr);
}

#[test]
fn places_that_are_not_fit_are_refused_before_the_work() {
    let scratch = Scratch::new();
    scratch.build("run", &[&repository("problems/squeeze.toml"), "--threads", "2"], 0);
    fs::create_dir(scratch.path("frames")).unwrap();
    let cases: [(&[&str], &str); 4] = [
        (&["--csv", "same", "--html", "same"], "--csv and --html name one file"),
        (&["--html", "none/page.html"], "its folder is not there"),
        (&["--csv", "frames/e.csv", "--obj", "frames"], "holds nothing but frames"),
        (&["--csv", "new/e.csv", "--obj", "new"], "holds nothing but frames"),
    ];
    for (options, expected) in cases {
        let refused = scratch.run(&[&["deform", "run"], options].concat());
        refused.assert_code(2);
        assert!(refused.stderr.contains(expected), "{options:?}: {}", refused.stderr);
        assert_eq!(refused.stdout, "", "nothing is looked for");
    }
    // What only has the name of a frame is no frame, and nothing beside it is removed.
    fs::create_dir(scratch.path("frames/frame-0002.obj")).unwrap();
    scratch.write("frames/frame-0001.obj", "");
    let refused = scratch.run(&["deform", "run", "--obj", "frames", "--force"]);
    refused.assert_code(2);
    assert!(refused.stderr.contains("holds frame-0002.obj"), "{}", refused.stderr);
    assert!(scratch.path("frames/frame-0001.obj").is_file());
    // The pages of two searches are the same bytes: they tell no times.
    for page in ["one.html", "other.html"] {
        scratch.run(&["deform", "run", "--html", page]).assert_code(0);
    }
    let page = |name| fs::read_to_string(scratch.path(name)).unwrap();
    assert!(page("one.html") == page("other.html") && !page("one.html").contains("CPU time"));
}
