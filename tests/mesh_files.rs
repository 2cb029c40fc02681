//! Meshes as other programs write them: what stands there once they are read, by verdicts about places in and
//! beside them.

use proptest::prelude::*;
use roadmill::problem::Problem;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The unit cube as quadrilaterals, seen from outside counter-clockwise.
const VERTICES: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 1.0, 0.0],
    [0.0, 1.0, 1.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, 1.0, 1.0],
];
const QUADS: [[usize; 4]; 6] =
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];

/// A cube of edge 0.1 beside one obstacle; its mesh table may say more after the file.
fn problem(file: &str, more: &str, start: [f64; 3]) -> String {
    format!(
        "[space]\nmotion = \"translation-3d\"\nmin = [-5, -5, -5]\nmax = [5, 5, 5]\nbounds = \"body\"\n\
         [robot]\nbodies = [{{ shape = {{ box = {{ size = [0.1, 0.1, 0.1] }} }} }}]\n[[obstacles]]\n\
         shape = {{ mesh = {{ file = \"{file}\"{more} }} }}\n[query]\nstart = {start:?}\ngoal = [4, 4, 4]\n"
    )
}

struct Scene(TempDir);

impl Scene {
    fn new() -> Scene {
        Scene(tempfile::tempdir().expect("a scratch folder"))
    }

    fn with(file: &str, bytes: &[u8]) -> Scene {
        let scene = Scene::new();
        fs::write(scene.path(file), bytes).expect("a mesh can be written");
        scene
    }

    fn path(&self, file: &str) -> std::path::PathBuf {
        self.0.path().join(file)
    }

    /// Loads the problem whose obstacle is the mesh and whose robot starts at `start`.
    fn load(&self, file: &str, more: &str, start: [f64; 3]) -> Result<Problem, String> {
        Problem::parse(&self.path("problem.toml"), &problem(file, more, start))
            .map_err(|error| error.to_string())
    }

    #[track_caller]
    fn assert_free(&self, file: &str, start: [f64; 3], free: bool) {
        match self.load(file, "", start) {
            Ok(_) => assert!(free, "{start:?} in {file} is free"),
            Err(error) => {
                assert!(!free && error.contains("a valid configuration expected"), "{error}")
            }
        }
    }
}

fn obj(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> String {
    let mut text = String::new();
    for [x, y, z] in vertices {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for face in faces {
        let corners: Vec<String> = face.iter().map(|corner| (corner + 1).to_string()).collect();
        writeln!(text, "f {}", corners.join(" ")).unwrap();
    }
    text
}

fn cube() -> String {
    obj(&VERTICES, &QUADS.map(|quad| quad.to_vec()))
}

fn halves([a, b, c, d]: [usize; 4]) -> [[usize; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// A text `.stl` of triangles, whose corners `place` puts in their places.
fn stl(triangles: &[[usize; 3]], mut place: impl FnMut(usize) -> [f64; 3]) -> String {
    let mut text = "solid cube\n".to_owned();
    for triangle in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for corner in triangle {
            let [x, y, z] = place(*corner);
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid cube\n"
}

fn cube_stl() -> String {
    let triangles: Vec<[usize; 3]> = QUADS.into_iter().flat_map(halves).collect();
    stl(&triangles, |corner| VERTICES[corner])
}

fn cube_binary_stl() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(12u32.to_le_bytes());
    for triangle in QUADS.into_iter().flat_map(halves) {
        bytes.extend([0; 12]);
        for value in triangle.iter().flat_map(|corner| VERTICES[*corner]) {
            bytes.extend((value as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// The cube is solid, and nothing stands above it.
#[track_caller]
fn assert_cube(file: &str, bytes: &[u8]) {
    let scene = Scene::with(file, bytes);
    scene.assert_free(file, [0.5; 3], false);
    scene.assert_free(file, [0.5, 0.5, 0.94], false);
    scene.assert_free(file, [0.5, 0.5, 1.06], true);
    scene.assert_free(file, [-0.06, 0.5, 0.5], true);
}

#[test]
fn a_cube_stands_there_however_its_obj_is_written() {
    let cube = cube();
    let marked = |mark: &str| [mark.as_bytes(), cube.as_bytes()].concat();
    assert_cube("cube.obj", cube.as_bytes());
    assert_cube("marked.obj", &marked("\u{feff}"));
    let utf16 = |text: &str| text.encode_utf16().flat_map(u16::to_be_bytes).collect::<Vec<u8>>();
    assert_cube("utf16.obj", &utf16(&format!("\u{feff}{cube}")));
    assert_cube("mac.obj", cube.replace('\n', "\r").as_bytes());
    assert_cube("continued.obj", cube.replace("f 1 2", "f 1 \\\n 2").as_bytes());
    let named = [b"# caf\xe9 \\\no W\xfcrfel\n".as_slice(), cube.as_bytes()].concat();
    assert_cube("latin.obj", &named);
}

#[test]
fn a_cube_stands_there_however_its_stl_is_written() {
    let text = cube_stl();
    assert_cube("cube.stl", text.as_bytes());
    assert_cube("capitals.stl", text.to_uppercase().as_bytes());
    assert_cube("marked.stl", [b"\xef\xbb\xbf", text.as_bytes()].concat().as_slice());
    let latin = [b"solid W\xfcrfel".as_slice(), &text.as_bytes()["solid cube".len()..]].concat();
    assert_cube("latin.stl", &latin);
    assert_cube("ended.stl", [text.as_bytes(), b"\x1a"].concat().as_slice());
    assert_cube("binary.stl", &cube_binary_stl());
    assert_cube("trailing.stl", [cube_binary_stl(), b"\r\n".to_vec()].concat().as_slice());
    let scene = Scene::with("cut.stl", &cube_binary_stl()[..300]);
    let error = scene.load("cut.stl", "", [2.0; 3]).unwrap_err();
    assert!(
        error.contains("a binary .stl that is cut off: 300 bytes found, 684 expected"),
        "{error}"
    );
}

/// A U lying on its back, whose caps are one face each.
#[test]
fn a_notch_in_a_face_is_free() {
    let outline = [[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]];
    let at = |z: f64| outline.map(|[x, y]| [f64::from(x), f64::from(y), z]);
    let vertices = [at(0.0), at(1.0)].concat();
    for first in 0..8 {
        let cap = |from: usize| (0..8).map(|i| from + (i + first) % 8).collect::<Vec<_>>();
        let mut faces = vec![cap(0).into_iter().rev().collect(), cap(8)];
        faces.extend((0..8).map(|i| vec![i, (i + 1) % 8, 8 + (i + 1) % 8, 8 + i]));
        let scene = Scene::with("u.obj", obj(&vertices, &faces).as_bytes());
        scene.assert_free("u.obj", [1.5, 2.0, 1.0], true);
        scene.assert_free("u.obj", [1.5, 2.0, 0.5], true);
        scene.assert_free("u.obj", [0.5, 2.0, 0.5], false);
        scene.assert_free("u.obj", [1.5, 0.5, 0.98], false);
    }
}

#[test]
fn faces_that_say_no_surface_are_errors_with_their_line() {
    for (faces, expected) in [
        ("f 1 2 3 4\n", "faces.obj:9: a face that crosses itself: its sides"),
        ("f 1 2 4 3\nq 5 6 8 7\n", "faces.obj:10: `q` found; a line of a Wavefront .obj expected"),
    ] {
        let text = obj(&VERTICES, &[]) + faces;
        let scene = Scene::with("faces.obj", text.as_bytes());
        let error = scene.load("faces.obj", "", [2.0; 3]).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
}

/// Two cubes side by side in one file, each closed.
#[test]
fn bricks_with_a_common_face_are_solid() {
    let second = VERTICES.map(|[x, y, z]| [x + 1.0, y, z]);
    let mut faces: Vec<Vec<usize>> = QUADS.map(|quad| quad.to_vec()).to_vec();
    faces.extend(QUADS.map(|quad| quad.map(|corner| corner + 8).to_vec()));
    let scene = Scene::with("bricks.obj", obj(&[VERTICES, second].concat(), &faces).as_bytes());
    for x in [0.5, 1.0, 1.5] {
        scene.assert_free("bricks.obj", [x, 0.5, 0.5], false);
    }
    scene.assert_free("bricks.obj", [2.06, 0.5, 0.5], true);
    let problem = scene.load("bricks.obj", "", [3.0; 3]).unwrap();
    let note = "obstacle 0: solid = true, as the mesh is closed but for walls within it, 2 pairs of equal triangles";
    assert!(problem.notes.contains(&note.to_owned()), "{:?}", problem.notes);
    assert_eq!(again(&problem).model, problem.model);
}

/// Writes a problem and reads it again.
fn again(problem: &Problem) -> Problem {
    let scene = Scene::new();
    let written = problem.to_toml("meshes");
    fs::create_dir(scene.path("meshes")).unwrap();
    for (name, text) in &written.files {
        fs::write(scene.path("meshes").join(name), text).unwrap();
    }
    fs::write(scene.path("again.toml"), &written.text).unwrap();
    Problem::load(&scene.path("again.toml")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn vertices_are_one_within_a_share_of_the_size_that_can_be_chosen() {
    let triangles: Vec<[usize; 3]> = QUADS.into_iter().flat_map(halves).collect();
    let noisy = |noise: f64| {
        let mut sign = 1.0;
        stl(&triangles, |corner| {
            sign = -sign;
            VERTICES[corner].map(|value| value + sign * noise)
        })
    };
    for (noise, more, solid) in [
        (1e-16, "", true),
        (3e-7, "", true),
        (3e-7, ", weld = 1e-9", false),
        (1e-16, ", weld = 0", false),
        (1e-4, "", false),
        (1e-4, ", weld = 0.001", true),
    ] {
        let scene = Scene::with("cube.stl", noisy(noise).as_bytes());
        let inside = scene.load("cube.stl", more, [0.5; 3]);
        assert_eq!(inside.is_err(), solid, "{noise} {more}");
        let problem = scene.load("cube.stl", more, [2.0; 3]).unwrap();
        let said = problem.notes.iter().any(|note| note.contains("apart joined, without which"));
        assert_eq!(said, solid, "{:?}", problem.notes);
        assert_eq!(again(&problem).digest(), problem.digest());
    }
    let scene = Scene::with("cube.stl", noisy(0.0).as_bytes());
    for wrong in ["-1e-9", "0.02", "nan"] {
        let error = scene.load("cube.stl", &format!(", weld = {wrong}"), [2.0; 3]).unwrap_err();
        assert!(error.contains("from 0 to 0.01 expected"), "{error}");
    }
}

proptest! {
    /// Triangles in any order, some of them several times, with corners that differ by rounding.
    #[test]
    fn verdicts_do_not_depend_on_how_a_cube_is_stored(
        order in Just((0..12).collect::<Vec<usize>>()).prop_shuffle(),
        repeated in proptest::collection::vec((0usize..12, any::<bool>()), 0..6),
        noise in proptest::collection::vec(-2i8..3, 162),
        place in [-0.2f64..1.2, -0.2f64..1.2, -0.2f64..1.2],
    ) {
        let all: Vec<[usize; 3]> = QUADS.into_iter().flat_map(halves).collect();
        let mut triangles: Vec<[usize; 3]> = order.iter().map(|i| all[*i]).collect();
        for (which, turned) in repeated {
            let [a, b, c] = all[which];
            triangles.push(if turned { [a, c, b] } else { [b, c, a] });
        }
        let mut noise = noise.into_iter().cycle();
        let text = stl(&triangles, |corner| {
            VERTICES[corner].map(|value| value + f64::from(noise.next().unwrap_or(0)) * 1e-16)
        });
        // The robot's edge is 0.1: what decides is not rounding.
        let gap = place.map(|x| (x - 0.5).abs() - 0.55).into_iter().fold(f64::MIN, f64::max);
        prop_assume!(gap.abs() > 1e-9);
        let found = Scene::with("cube.stl", text.as_bytes()).load("cube.stl", "", place);
        prop_assert_eq!(found.is_ok(), gap > 0.0, "{:?}", found.err());
    }
}

#[test]
fn what_is_no_regular_file_is_refused_without_waiting() {
    let scene = Scene::new();
    rustix::fs::mkfifoat(rustix::fs::CWD, scene.path("pipe.stl"), rustix::fs::Mode::RWXU).unwrap();
    fs::create_dir(scene.path("folder.obj")).unwrap();
    for (file, found) in [("pipe.stl", "a named pipe found"), ("folder.obj", "a folder found")] {
        let error = scene.load(file, "", [2.0; 3]).unwrap_err();
        assert!(error.contains(found), "{error}");
    }
    for (name, kind) in
        [("p.toml", "problem"), ("p.env", "scene"), ("p.cfg", "scene"), ("p.urdf", "scene")]
    {
        rustix::fs::mkfifoat(rustix::fs::CWD, scene.path(name), rustix::fs::Mode::RWXU).unwrap();
        let error = Problem::load(&scene.path(name)).unwrap_err().to_string();
        assert!(error.contains(&format!("cannot read the {kind}: a named pipe found")), "{error}");
    }
    let error = Problem::load(Path::new("/dev/zero")).unwrap_err().to_string();
    assert_eq!(
        error,
        "/dev/zero: cannot read the problem: a device found; a regular file expected"
    );
}

#[test]
fn escape_sequences_do_not_reach_the_terminal() {
    let escape = "\u{1b}[31m\u{7}";
    let scene = Scene::with("m.obj", format!("{escape} 0 0 0\n").as_bytes());
    let error = scene.load("m.obj", "", [2.0; 3]).unwrap_err();
    assert!(error.contains("`\\u{1b}[31m\\u{7}` found") && !error.contains('\u{1b}'), "{error}");
    let error = Problem::load(&scene.path("lost\u{1b}c\n.toml")).unwrap_err().to_string();
    assert!(error.contains("lost\\u{1b}c\\n.toml"), "{error}");
    let urdf = "<robot name=\"r\"><link name=\"a&#10;x\"><visual><geometry><box size=\"1 1 1\"/></geometry>\
                <material name=\"\"><texture/></material></visual></link><link name=\"b\"><collision>\
                <geometry><box size=\"1 1 1\"/></geometry></collision></link><joint name=\"j\" type=\"continuous\">\
                <parent link=\"a&#10;x\"/><child link=\"b\"/></joint></robot>";
    fs::write(scene.path("r.urdf"), urdf).unwrap();
    let problem = Problem::load(&scene.path("r.urdf")).unwrap();
    let shown = problem.describe() + &problem.notes.join("");
    assert!(shown.contains("link `a\\nx` has only shapes") && !shown.contains("a\nx"), "{shown}");
}
