//! Scene files that are no good: every error names its file and line, and nothing panics.

use proptest::prelude::*;
use roadmill::model::bodies::foreign::{
    DhOrder, ForeignError, ForeignJointKind, ForeignScene, SceneOptions, Unit, read_ompl,
    read_parasol,
};
use roadmill::scene::{Shape, Up};
use std::path::Path;
use tempfile::TempDir;

const CUBE: &str = "1 8 12 36\n1 12\n1 1 1\n1 1 -1\n1 -1 1\n1 -1 -1\n-1 1 1\n-1 1 -1\n-1 -1 1\n-1 -1 -1\n\
                    1 3 -4\n1 4 -2\n5 6 -8\n5 8 -7\n1 2 -6\n1 6 -5\n3 7 -8\n3 8 -4\n1 5 -7\n1 7 -3\n2 4 -8\n2 8 -6\n";
const ENV: &str = "# a room\nBoundary Box [-9:9 ; -9:9; -9 : 9]\nMultibodies\n2\n\nPassive\ncube.g -c(1 0 0 1) 0 0 -5 0 45 0\n\
                   Passive\ncube.g -a(NONE) Fixed 0 0 5 0 0 90 # tail\n";
const ROBOT: &str = "4\n#VIZMO_COLOR 1 0 0\ncube.g -c (1 0 0 1) Volumetric Rotational\ncube.g Joint\ncube.g Joint\ncube.g Joint\n\
                     Adjacencies\n1\n1 3\nConnections\n3\n0 2 Revolute -0.5:0.5\n3 0 0 0 0 0  0 0 0 0  3 0 0 0 0 0\n\
                     2 3 NonActuated\n0 3 0 0 0 0  0 0 1 0  0 3 0 0 0 0\n0 1 Spherical -1:1 0:0.5\n-3 0 0 0 0 0  0 0 0 0  -3 0 0 0 0 0\n";
const QUERY: &str = "0 1 2 3 0 0 0.5  0.1 0.2 0.3\n# the goal\n0 1 2 3 0.5 0 0  0.1 0.2 -0.3\n";
const CFG: &str = "[problem]\nname = room\nrobot = cube.g\nworld = cube.g\nstart.x = 1\nstart.y = 2\nstart.z = 3\nstart.theta = 3.141592653589793\n\
                   start.axis.x = 0\nstart.axis.y = 0\nstart.axis.z = 2\ngoal.x = 0\ngoal.y = 0\ngoal.z = 5\ngoal.theta = 0\ngoal.axis.x = 0\n\
                   goal.axis.y = 0\ngoal.axis.z = 0\nvolume.min.x = -9\nvolume.min.y = -9\nvolume.min.z = -9\nvolume.max.x = 9\nvolume.max.y = 9\n\
                   volume.max.z = 9\nsampler = odd\n\n[planner]\nprm=\nprm=\n";

/// A folder with a scene of each kind.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (name, text) in [
        ("cube.g", CUBE),
        ("room.env", ENV),
        ("room.robot", ROBOT),
        ("room.query", QUERY),
        ("room.cfg", CFG),
    ] {
        std::fs::write(folder.path().join(name), text).expect("writing to a scratch folder");
    }
    folder
}

fn read(folder: &Path, name: &str) -> Result<ForeignScene, ForeignError> {
    match name {
        "room.cfg" => read_ompl(&folder.join(name), &SceneOptions::default()),
        _ => read_parasol(&folder.join("room.env"), &SceneOptions::default()),
    }
}

/// Reads the scene with other bytes in one of its files.
fn with(folder: &TempDir, name: &str, bytes: &[u8]) -> Result<ForeignScene, ForeignError> {
    std::fs::write(folder.path().join(name), bytes).expect("writing to a scratch folder");
    read(folder.path(), name)
}

fn text_of(name: &str) -> &'static str {
    match name {
        "cube.g" => CUBE,
        "room.env" => ENV,
        "room.robot" => ROBOT,
        "room.query" => QUERY,
        _ => CFG,
    }
}

#[test]
fn joint_values_follow_the_indices_of_bodies_and_become_ours() {
    let folder = folder();
    let scene = read(folder.path(), "room.env").unwrap_or_else(|error| panic!("{error}"));
    let links: Vec<_> = scene.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(links, ["cube", "0-1-theta", "cube-1", "cube-2", "cube-3"]);
    let parents: Vec<_> = scene.links.iter().map(|l| l.joint.as_ref().map(|j| j.parent)).collect();
    assert_eq!(parents, [None, Some(0), Some(1), Some(0), Some(3)]);
    let kinds: Vec<_> =
        scene.links[1..].iter().map(|link| link.joint.as_ref().unwrap().kind).collect();
    let pi = std::f64::consts::PI;
    let turns = |axis, min: f64, max: f64| ForeignJointKind::Revolute {
        axis,
        min: min * pi,
        max: max * pi,
    };
    let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    assert_eq!(
        kinds,
        [turns(z, -1.0, 1.0), turns(x, 0.0, 0.5), turns(z, -0.5, 0.5), ForeignJointKind::Fixed]
    );
    // By indices, 0–1 comes before 0–2, although the file gives it last.
    let (start, _) = scene.query.unwrap();
    let half = 0.5f64.sqrt();
    let expected = [1.0, 2.0, 3.0, half, 0.0, 0.0, half, 0.1 * pi, 0.2 * pi, 0.3 * pi];
    assert!(start.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{start:?}");
    assert_eq!(scene.may_touch, [(2, 4)]);
    // Translations of the fixed joint: 0 3 0, d = 1, 0 3 0.
    let fixed = scene.links[4].joint.as_ref().unwrap();
    let origin = fixed.before.apply(fixed.after.apply([0.0; 3]));
    assert_eq!(origin, [0.0, 6.0, 1.0]);
    assert!(
        scene.notes.iter().any(|note| note.starts_with("line 14: alpha a d theta read as")),
        "{:?}",
        scene.notes
    );
}

#[test]
fn denavit_and_hartenberg_act_in_the_order_that_is_asked_for() {
    let folder = folder();
    let dh = "0 2 Revolute -0.5:0.5\n3 0 0 0 0 0  1.5707963267948966 2 1 0  3";
    let robot = ROBOT.replace("0 2 Revolute -0.5:0.5\n3 0 0 0 0 0  0 0 0 0  3", dh);
    assert_ne!(robot, ROBOT);
    std::fs::write(folder.path().join("room.robot"), robot).unwrap();
    let read = |dh| {
        let options = SceneOptions { dh: Some(dh), ..SceneOptions::default() };
        read_parasol(&folder.path().join("room.env"), &options).unwrap()
    };
    // 3 0 0, then d and a before or after the quarter turn about x, then 3 0 0.
    for (order, expected) in
        [(DhOrder::Standard, [8.0, 0.0, 1.0]), (DhOrder::Modified, [8.0, -1.0, 0.0])]
    {
        let scene = read(order);
        let joint = scene.links[3].joint.as_ref().unwrap();
        let origin = joint.before.apply(joint.after.apply([0.0; 3]));
        assert!((0..3).all(|i| (origin[i] - expected[i]).abs() < 1e-12), "{origin:?}");
    }
    // Of a spherical joint the turn about x comes first, and its value with it.
    let scene = read(DhOrder::Modified);
    let names: Vec<_> = scene.links.iter().filter_map(|link| link.joint.as_ref()).collect();
    assert_eq!([&names[0].name, &names[1].name], ["0-1-alpha", "0-1-theta"]);
    let values = scene.query.unwrap().0.split_off(7);
    let expected = [0.2, 0.1, 0.3].map(|share| share * std::f64::consts::PI);
    assert!(values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{values:?}");
}

#[test]
fn an_ompl_scene_turns_by_radians_about_its_axis() {
    let folder = folder();
    let scene = read(folder.path(), "room.cfg").unwrap_or_else(|error| panic!("{error}"));
    let (start, goal) = scene.query.unwrap();
    assert!((start[6] - 1.0).abs() < 1e-12 && start[3].abs() < 1e-12, "{start:?}");
    assert_eq!(goal, [0.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0]);
    assert!(scene.links[0].bodies[0].body.solid && !scene.obstacles[0].body.solid);
    assert!(
        scene.notes.contains(&"line 25: sampler = odd passed over".to_owned()),
        "{:?}",
        scene.notes
    );
}

/// A triangle in half metres, z up.
const TRIANGLE: &str = "<COLLADA version=\"1.4.1\"><asset><unit meter=\"0.5\"/><up_axis>Z_UP</up_axis></asset>\n\
    <library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"9\">0 0 0 4 0 0 0 2 6</float_array>\n\
    <technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\"/></technique_common></source>\n\
    <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\n\
    <triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>\n\
    <library_visual_scenes><visual_scene id=\"s\"><node><instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>\n\
    <scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";

#[test]
fn unit_and_upward_axis_of_a_mesh_are_taken_or_left_as_asked() {
    let folder = folder();
    std::fs::write(folder.path().join("triangle.dae"), TRIANGLE).unwrap();
    let cfg = CFG.replace("world = cube.g", "world = triangle.dae");
    std::fs::write(folder.path().join("room.cfg"), cfg).unwrap();
    let last_corner = |options: SceneOptions| {
        let scene = read_ompl(&folder.path().join("room.cfg"), &options).unwrap();
        let Shape::Mesh(mesh) = &scene.obstacles[0].body.shape else { panic!("a mesh") };
        let said = ["--unit", "--up"].map(|word| scene.notes.iter().any(|n| n.contains(word)));
        (mesh.vertices[2], said)
    };
    let guessed = SceneOptions::default();
    let stored = SceneOptions { unit: Some(Unit::AsStored), ..guessed };
    assert_eq!(last_corner(guessed), ([0.0, 3.0, -1.0], [true, true]));
    assert_eq!(last_corner(stored), ([0.0, 6.0, -2.0], [false, true]));
    let stored = SceneOptions { up: Some(Up::AsStored), ..guessed };
    assert_eq!(last_corner(stored), ([0.0, 1.0, 3.0], [true, false]));
}

/// The older dialect, with the robot in the `.env`, as Vizmo wrote it.
const VIZMO: &str = "Boundary Box [-15:15 ; -2:2 ; -3:3]\n\nMultibodies\n3\n\nActive\n1\n#VIZMO_COLOR 1 0 0\n\
                     cube.g Volumetric Rotational\nConnections\n0\n\nPassive\ncube.g 9 0 0 0 0 0\n\nPassive\ncube.g -9 0 0 0 90 0\n";

#[test]
fn every_dialect_of_vizmo_says_the_same() {
    let folder = folder();
    fs_write(&folder, "room.query", "0 1 0 0 0 0 0\n0 -1 0 0 0 0 0\n");
    let read_as = |env: &str, name: &str| {
        fs_write(&folder, name, env);
        let options = SceneOptions::default();
        read_parasol(&folder.path().join(name), &options).unwrap_or_else(|error| panic!("{error}"))
    };
    let mut expected = read_as(VIZMO, "room.env");
    assert_eq!((expected.bounds.min, expected.bounds.max), ([-15.0, -2.0, -3.0], [15.0, 2.0, 3.0]));
    assert_eq!((expected.obstacles.len(), expected.links.len()), (2, 1));
    for (from, to) in [
        ("[-15:15 ; -2:2 ; -3:3]", "-15:15 -2:2 -3:3"),
        ("[-15:15 ; -2:2 ; -3:3]", "-15:15; -2 :2;\n-3: 3"),
        ("Box [-15:15 ; -2:2 ; -3:3]", "BOX [ -15:15 ; -2:2 ; -3:3 ]"),
        ("Passive\ncube.g -9", "Internal\ncube.g -9"),
        ("Multibodies", "MULTIBODIES"),
        ("Passive\ncube.g 9", "passive # a wall\ncube.g -c(1 0 0 1) Fixed 9"),
    ] {
        let changed = VIZMO.replacen(from, to, 1);
        assert_ne!(changed, VIZMO, "{from}");
        for text in [
            changed.clone(),
            changed.replace('\n', "\r\n"),
            format!("\u{feff}# caf\u{e9}\n{changed}"),
        ] {
            let found = read_as(&text, "room.env");
            expected.notes.clone_from(&found.notes);
            expected.sources.clone_from(&found.sources);
            assert_eq!(found, expected, "{text}");
        }
    }
    // Two intervals are enough for a planar robot.
    let planar = VIZMO.replace("Volumetric Rotational", "Planar Translational");
    fs_write(&folder, "room.query", "0 1 0\n0 -1 0\n");
    for bounds in ["Box -15:15 -2:2", "Box2D -15:15 -2:2", "Box2D [-15:15 ; -2:2]"] {
        let scene = read_as(&planar.replace("Box [-15:15 ; -2:2 ; -3:3]", bounds), "room.env");
        assert_eq!((scene.bounds.min, scene.bounds.max), ([-15.0, -2.0, 0.0], [15.0, 2.0, 0.0]));
    }
}

fn fs_write(folder: &TempDir, name: &str, text: &str) {
    std::fs::write(folder.path().join(name), text).expect("writing to a scratch folder");
}

#[test]
fn errors_name_file_and_line() {
    for (name, from, to, expected) in [
        ("room.env", "Box [", "Sphere [", "room.env:2: a boundary `Sphere` is not supported"),
        ("room.env", "-9 : 9]", "9 : -9]", "room.env:2: `9:-9` found; an interval"),
        ("room.env", "; -9 : 9]", "]", "room.env:2: a box of 2 intervals found; 3 expected"),
        ("room.env", "2\n\nPassive", "3\n\nPassive", "room.env:9: cut off; body 3 of 3"),
        (
            "room.env",
            "2\n\nPassive",
            "1\n\nPassive",
            "room.env:8: `Passive` found; the end after 1",
        ),
        (
            "room.env",
            "Passive\ncube.g -a",
            "Surface\ncube.g -a",
            "room.env:8: `Surface` not supported; `Passive`, `Internal` or `Active` expected",
        ),
        (
            "room.env",
            "[-9:9 ; -9:9; -9 : 9]",
            "-9:9 9:-9 -9:9",
            "room.env:2: `9:-9` found; an interval",
        ),
        ("room.env", "[-9:9 ; -9:9; -9 : 9]", "-9:9", "room.env:2: 1 intervals found; 3 expected"),
        ("room.env", "[-9:9 ; -9:9; -9 : 9]", "", "room.env:2: a boundary without intervals"),
        ("room.env", "-a(NONE)", "-a(SURFACE)", "room.env:9: `-a(SURFACE)` not supported"),
        ("room.env", "0 0 -5 0 45", "0 0 nan 0 45", "room.env:7: `nan` found; x y z of a pose"),
        ("room.env", "cube.g -c", "lost.g -c", "lost.g: cannot read the mesh"),
        ("room.env", "cube.g -c", "room.env -c", "room.env: unknown kind of mesh"),
        ("room.robot", "Volumetric", "Spherical", "room.robot:3: `spherical` found; `Planar`"),
        (
            "room.robot",
            "Volumetric Rotational",
            "Joint",
            "room.robot:6: no base among the 4 bodies",
        ),
        (
            "room.robot",
            "2 3 NonActuated",
            "2 4 NonActuated",
            "room.robot:14: body 4 does not exist",
        ),
        ("room.robot", "2 3 NonActuated", "2 1 NonActuated", "room.robot:17: body 1 hangs on two"),
        // Bodies 2 and 3 hang on one another.
        (
            "room.robot",
            "0 2 Revolute",
            "3 2 Revolute",
            "room.robot:12: body 2 does not hang on the base",
        ),
        ("room.robot", "-0.5:0.5", "0.5", "room.robot:12: `0.5` found; limits min:max"),
        ("room.robot", "-0.5:0.5", "0.5:-0.5", "room.robot:12: `0.5:-0.5` found; limits min:max"),
        ("room.robot", "-0.5:0.5", "-1e9:1e9", "room.robot:12: `-1e9:1e9` found; limits min:max"),
        ("room.robot", "0 2 Revolute", "0 2 Prismatic", "room.robot:12: `Prismatic` found; `Revol"),
        (
            "room.robot",
            "4\n#VIZMO",
            "1000000000\n#VIZMO",
            "room.robot:1: 1000000000 bodies found; at most 1000",
        ),
        (
            "room.env",
            "2\n\nPassive",
            "1000000000\n\nPassive",
            "room.env:9: cut off; body 3 of 1000000000",
        ),
        (
            "room.query",
            "0.1 0.2 0.3",
            "0.1 0.2 0.3 0.4",
            "room.query:1: 11 numbers found; the robot",
        ),
        (
            "room.robot",
            "Connections\n3",
            "Connections\n2",
            "room.robot:15: body 1 does not hang on the base",
        ),
        (
            "room.query",
            "0.1 0.2 0.3",
            "0.1 0.2",
            "room.query:1: 9 numbers found; the robot's index and 9",
        ),
        ("room.query", "0 1 2 3 0.5", "1 1 2 3 0.5", "room.query:3: robot `1` found"),
        (
            "room.query",
            "0 1 2 3 0.5 0 0  0.1 0.2 -0.3",
            "",
            "room.query:3: cut off; 1 configurations",
        ),
        (
            "cube.g",
            "3 8 -4",
            "3 9 -4",
            "cube.g:18: vertex 9 of a face does not exist; there are 8 (named in ",
        ),
        ("room.cfg", "goal.x = 0\n", "", "room.cfg:24: goal.x is missing"),
        (
            "room.cfg",
            "goal.x = 0\n",
            "goal.x = 0\ngoal.x = 0\n",
            "room.cfg:13: goal.x found again; line 12",
        ),
        ("room.cfg", "goal.z = 5", "goal.z = inf", "room.cfg:14: goal.z = `inf` found"),
        (
            "room.cfg",
            "goal.theta = 0",
            "goal.theta = 1",
            "room.cfg:16: goal.axis = [0.0, 0.0, 0.0] found",
        ),
        (
            "room.cfg",
            "volume.max.y = 9",
            "volume.max.y = -9",
            "room.cfg:23: volume.max.y = -9 found",
        ),
        ("room.cfg", "[problem]", "[problem", "room.cfg:1: `[problem` found"),
        ("room.cfg", "name = room", "name room", "room.cfg:2: `name room` found"),
        ("room.cfg", "world = cube.g", "world = .", "unknown kind of mesh"),
    ] {
        let folder = folder();
        let text = text_of(name).replacen(from, to, 1);
        assert_ne!(text, text_of(name), "{from}");
        let error = with(&folder, name, text.as_bytes()).expect_err(to).to_string();
        assert!(
            error.contains(expected) || expected.starts_with("cannot"),
            "{error}, not {expected}"
        );
    }
}

#[test]
fn files_beside_the_scene_are_taken_only_without_a_doubt() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    std::fs::rename(path("room.query"), path("other.query")).unwrap();
    let scene = read(folder.path(), "room.env").unwrap();
    assert!(scene.query.is_some());
    assert!(scene.notes.iter().any(|note| note.starts_with("query: other.query")));
    std::fs::write(path("third.query"), QUERY).unwrap();
    let error = read(folder.path(), "room.env").unwrap_err().to_string();
    assert!(error.contains("which .query? other.query, third.query stand beside it"), "{error}");
    let named = read_parasol(
        &path("room.env"),
        &SceneOptions { query: Some(&path("third.query")), ..SceneOptions::default() },
    );
    assert_eq!(named.unwrap().query, scene.query);
    std::fs::remove_file(path("room.robot")).unwrap();
    let error = read(folder.path(), "room.env").unwrap_err().to_string();
    assert!(error.ends_with("no .robot beside it; a robot expected"), "{error}");
}

#[test]
fn cut_off_files_are_errors_or_scenes_and_never_panics() {
    let folder = folder();
    for name in ["room.env", "room.robot", "room.query", "room.cfg"] {
        let text = text_of(name);
        for end in 0..text.len() {
            if let Err(error) = with(&folder, name, &text.as_bytes()[..end]) {
                assert!(error.to_string().contains(name), "{error}");
            }
        }
        with(&folder, name, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    }
}

proptest! {
    #[test]
    fn changed_files_never_panic(
        kind in 0usize..5,
        at in 0usize..1000,
        bytes in proptest::collection::vec(any::<u8>(), 0..4),
        word in "[0-9-]{1,3}|1e30|nan|999999999|Active|Joint|Fixed|[:;\\[\\]()#=\n ]{1,3}",
    ) {
        let folder = folder();
        let name = ["cube.g", "room.env", "room.robot", "room.query", "room.cfg"][kind];
        let text = text_of(name).as_bytes();
        let at = at % text.len();
        for new in [bytes.as_slice(), word.as_bytes()] {
            let mut changed = text.to_vec();
            changed.splice(at..(at + new.len()).min(text.len()), new.iter().copied());
            if let Err(error) = with(&folder, name, &changed) {
                prop_assert!(error.to_string().contains('.'), "{}", error);
            }
        }
    }
}
