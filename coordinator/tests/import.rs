//! Problems and scenes written out as problem files.

mod support;

use std::fs;
use support::Scratch;

/// A tetrahedron, and one with another bottom, two of whose corners are near each other.
const CLOSED: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const OPEN: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0.001\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 5 2 3\n";
const CFG: &str = "[problem]\nname = a/b c\nrobot = robot.obj\nworld = world.obj\nstart.x = 3\nstart.y = 3\n\
                   start.z = 3\nstart.theta = 0\nstart.axis.x = 0\nstart.axis.y = 0\nstart.axis.z = 1\n\
                   goal.x = 7\ngoal.y = 7\ngoal.z = 7\ngoal.theta = 1\ngoal.axis.x = 0\ngoal.axis.y = 1\n\
                   goal.axis.z = 1\nvolume.min.x = 0\nvolume.min.y = 0\nvolume.min.z = 0\n\
                   volume.max.x = 9\nvolume.max.y = 9\nvolume.max.z = 9\n";
const ENV: &str =
    "Boundary Box [-9:9; -9:9; -9:9]\nMultibodies\n1\nPassive\nworld.obj 0 0 0 0 0 0\n";
const ROBOT: &str = "2\nrobot.obj Volumetric Rotational\nrobot.obj Joint\nConnections\n1\n0 1 Revolute -0.5:0.5\n\
                     0 0 0 0 0 0  0.5 2 0 0  0 0 0 0 0 0\n";

fn scratch() -> Scratch {
    let scratch = Scratch::new();
    for (name, text) in [
        ("robot.obj", CLOSED),
        ("world.obj", OPEN),
        ("room.cfg", CFG),
        ("room.env", ENV),
        ("room.robot", ROBOT),
    ] {
        scratch.write(name, text);
    }
    scratch
}

/// The last line of `check`.
fn digest(scratch: &Scratch, arguments: &[&str]) -> String {
    let done = scratch.run(&[&["check"], arguments].concat());
    done.assert_code(0);
    done.stdout.lines().last().expect("a line").to_owned()
}

#[test]
fn an_imported_scene_is_the_same_problem() {
    let scratch = scratch();
    for (scene, out) in [("room.cfg", "ompl.toml"), ("room.env", "parasol.toml")] {
        let done = scratch.run(&["import", scene, "--out", out]);
        done.assert_code(0);
        assert_eq!(digest(&scratch, &[out]), digest(&scratch, &[scene]));
        assert_eq!(done.stdout.trim_end(), digest(&scratch, &[scene]));
        let text = fs::read_to_string(scratch.path(out)).expect("it is written");
        assert!(text.starts_with("# ") && text.contains("(--solid)"), "{text}");
    }
    // The two links are the same mesh.
    let meshes = |name: &str| fs::read_dir(scratch.path(name)).expect("a folder").count();
    assert_eq!(meshes("parasol-meshes"), 2);
    let cfg = fs::read_to_string(scratch.path("ompl.toml")).expect("it is written");
    assert!(cfg.contains("name = \"a-b-c\"\n"), "{cfg}");
}

#[test]
fn nothing_is_overwritten_or_left_half_written() {
    let scratch = scratch();
    let import = |arguments: &[&str]| {
        scratch.run(&[&["import", "room.cfg", "--out", "out/room.toml"], arguments].concat())
    };
    // No such folder.
    import(&[]).assert_code(2);
    fs::create_dir(scratch.path("out")).expect("a folder");
    import(&[]).assert_code(0);
    let names = || {
        let entries = fs::read_dir(scratch.path("out")).expect("a folder");
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(names(), ["room-meshes", "room.toml"]);
    let refused = import(&[]);
    refused.assert_code(2);
    refused.assert_stderr(&["out/room.toml: exists already", "--force"]);
    scratch.write("out/room.toml", "mine");
    scratch.write("out/room-meshes/old.obj", "of an older import");
    import(&["--force"]).assert_code(0);
    assert!(!scratch.path("out/room-meshes/old.obj").exists());
    assert_eq!(digest(&scratch, &["out/room.toml"]), digest(&scratch, &["room.cfg"]));
    // A folder with anything else in it is not an import's.
    scratch.write("out/room-meshes/notes.txt", "mine");
    let refused = import(&["--force"]);
    refused.assert_code(2);
    refused.assert_stderr(&["out/room-meshes: holds other things"]);
    assert!(scratch.path("out/room-meshes/notes.txt").exists());
    assert_eq!(names(), ["room-meshes", "room.toml"]);
    for out in ["room.cfg", "out", ".toml"] {
        let refused = scratch.run(&["import", "room.cfg", "--out", out]);
        refused.assert_code(2);
        refused.assert_stderr(&["a NAME.toml expected"]);
    }
}

#[test]
fn every_guess_can_be_overridden() {
    let scratch = scratch();
    for (scene, option, value, note) in [
        ("room.cfg", "--solid", "no", "robot: solid = false, as asked"),
        ("room.cfg", "--bounds", "body", "hold every robot point"),
        ("room.cfg", "--origin", "stored", "robot: solid = true"),
        ("room.cfg", "--weld", "0.5", "apart joined"),
        ("room.env", "--solid", "no", "solid = false, as asked"),
        ("room.env", "--bounds", "reference", "hold the reference point"),
        ("room.env", "--origin", "stored", "origin as stored"),
        ("room.env", "--dh", "modified", "configuration"),
    ] {
        let (own, with) = ([scene], [scene, option, value]);
        assert_ne!(digest(&scratch, &own), digest(&scratch, &with), "{option}");
        let done = scratch.run(&[&["check"], &with[..]].concat());
        assert!(done.stdout.contains(note), "{note} in\n{}", done.stdout);
        if option != "--weld" {
            let guess = scratch.run(&["check", scene]).stdout;
            assert!(guess.contains(&format!("({option})")), "{option} in\n{guess}");
        }
    }
    for (arguments, fragments) in [
        (
            ["room.cfg", "--solid", "yes"],
            ["room.cfg:4: --solid yes, but ", "world.obj is not closed"],
        ),
        (["room.cfg", "--robot", "room.robot"], ["room.cfg: --robot found", "OMPL.app"]),
        (["room.env", "--up", "y"], ["room.env: --up found", "Parasol"]),
        (["room.env", "--weld", "nan"], ["--weld", "0 or a length"]),
        (["room.toml", "--solid", "no"], ["room.toml: --solid found", "a problem file"]),
        (["room.toml", "--query", "room.query"], ["room.toml: --query found", "a problem file"]),
    ] {
        let done = scratch.run(&[&["check"], &arguments[..]].concat());
        done.assert_code(2);
        done.assert_stderr(&fragments);
    }
}
