//! Scenes of other programs: the table of what they must look like once read, valid starts and goals,
//! and files that are no good.
//!
//! The scenes are not part of the repository. They are looked for in the folder that `ROADMILL_DATA`
//! names; with `ROADMILL_REQUIRE_DATA=1` their absence is a failure.

#[path = "support/scenes.rs"]
mod scenes;

use roadmill::model::bodies::foreign::{
    Base, ForeignBody, ForeignJointKind, ForeignScene, SceneOptions, read_ompl, read_parasol,
};
use roadmill::model::bodies::validity::BoundsMeaning;
use roadmill::problem::Problem;
use roadmill::scene::{Pose, Shape};
use roadmill::space::BaseJoint;
use scenes::{Expected, TABLE, data};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

fn ompl(data: &Path, name: &str) -> ForeignScene {
    read_ompl(&data.join("scenes/ompl").join(name), &SceneOptions::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn parasol(data: &Path, name: &str) -> ForeignScene {
    let path = data.join("scenes/parasol").join(name);
    read_parasol(&path, &SceneOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn read(data: &Path, name: &str) -> ForeignScene {
    if name.ends_with(".cfg") { ompl(data, name) } else { parasol(data, name) }
}

/// Stored and unique triangles, odd edges, and the box at the bodies' poses. Several bodies count as
/// one surface: blocks that stand side by side share a face.
fn measured(bodies: &[ForeignBody]) -> ([usize; 3], [[f64; 2]; 3]) {
    let stored = bodies.iter().map(|body| body.stored_triangles).sum();
    let mut frame = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let mut triangles = BTreeSet::new();
    let mut edges: BTreeMap<_, usize> = BTreeMap::new();
    for ForeignBody { body, .. } in bodies {
        let Shape::Mesh(mesh) = &body.shape else { panic!("foreign bodies are meshes") };
        let placed: Vec<[f64; 3]> = mesh.vertices.iter().map(|v| body.pose.apply(*v)).collect();
        for vertex in &placed {
            for (range, value) in frame.iter_mut().zip(vertex) {
                *range = [range[0].min(*value), range[1].max(*value)];
            }
        }
        for corners in &mesh.triangles {
            let micro = |corner: u32| placed[corner as usize].map(|x| (x * 1e6).round() as i64);
            let mut corners = corners.map(micro);
            corners.sort_unstable();
            if triangles.insert(corners) {
                for (a, b) in [(0, 1), (0, 2), (1, 2)] {
                    *edges.entry((corners[a], corners[b])).or_default() += 1;
                }
            }
        }
    }
    let counts = match bodies {
        [body] => [stored, body.unique_triangles, body.odd_edges],
        _ => [stored, triangles.len(), edges.values().filter(|count| *count % 2 == 1).count()],
    };
    (counts, frame)
}

#[test]
fn the_scenes_look_as_the_table_says() {
    let Some(data) = data() else { return };
    let mut wrong = Vec::new();
    for (name, world, robot) in TABLE {
        let scene = read(&data, name);
        let robots = scene.links[0].bodies.as_slice();
        for (what, bodies, expected) in
            [("world", scene.obstacles.as_slice(), world), ("robot", robots, robot)]
        {
            let Expected { counts, frame } = expected;
            let (found, found_frame) = measured(bodies);
            let near = |i: usize| (0..2).all(|j| (found_frame[i][j] - frame[i][j]).abs() < 1e-3);
            if found != *counts || !(0..3).all(near) {
                wrong.push(format!(
                    "{name} {what}: {found:?} {found_frame:.3?}, not {counts:?} {frame:.3?}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// A scene becomes a problem only if its start and goal are valid.
#[test]
fn scenes_are_problems_with_valid_starts_and_goals() {
    let Some(data) = data() else { return };
    let mut wrong = Vec::new();
    for name in scenes::ALL {
        let folder = if name.ends_with(".cfg") { "scenes/ompl" } else { "scenes/parasol" };
        match Problem::load(&data.join(folder).join(name)) {
            Ok(problem) => assert!(problem.query().is_some(), "{name}"),
            Err(error) => wrong.push(error.to_string()),
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn both_dialects_say_the_same() {
    let Some(data) = data() else { return };
    for (new, old) in [
        ("LTunnel/tunnel.env", "LTunnel/tunnel-vizmo.env"),
        ("STunnel/tunnel.env", "STunnel/tunnel-vizmo.env"),
        ("SerialWalls/serial.env", "SerialWalls/serial-vizmo.env"),
        ("alpha1.6/alpha.env", "alpha1.6/alpha-vizmo.env"),
        ("bug_trap1.0/bug-trap.env", "bug_trap1.0/bug-trap-vizmo.env"),
        ("flange_1.0/flange.env", "flange_1.0/flange-vizmo.env"),
        ("Box/box.env", "Box/box-vizmo.env"),
    ] {
        let (new, old) = (parasol(&data, new), parasol(&data, old));
        assert_eq!(new.links, old.links);
        assert_eq!(new.obstacles, old.obstacles);
        assert_eq!((new.base, new.bounds, new.query), (old.base, old.bounds, old.query));
    }
}

#[test]
fn planar_scenes_are_planar_and_notes_say_what_was_guessed() {
    let Some(data) = data() else { return };
    let maze = parasol(&data, "Maze/maze.env");
    assert_eq!(maze.base, Base::Moving(BaseJoint::Translation2d));
    assert_eq!(maze.query, Some((vec![0.0, 34.0], vec![0.0, -34.0])));
    assert_eq!((maze.bounds.min, maze.bounds.max), ([-38.5, -35.0, 0.0], [38.8, 35.0, 0.0]));
    assert_eq!(maze.bounds.meaning, BoundsMeaning::Body);
    let walls = parasol(&data, "SerialWalls/serial.env");
    assert!(walls.notes.iter().any(|note| note.contains("query: serial-vizmo.query")));
    let alpha = ompl(&data, "alpha-1.5.cfg");
    for expected in
        ["sampler = obstacle_based passed over", "turned from z up", "mean of the vertices"]
    {
        assert!(alpha.notes.iter().any(|note| note.contains(expected)), "{:?}", alpha.notes);
    }
    assert_eq!(alpha.bounds.meaning, BoundsMeaning::Reference);
}

#[test]
fn the_box_is_a_linkage_of_six_panels() {
    let Some(data) = data() else { return };
    let scene = parasol(&data, "Box/box.env");
    let parents: Vec<_> = scene.links.iter().map(|l| l.joint.as_ref().map(|j| j.parent)).collect();
    assert_eq!(parents, [None, Some(0), Some(0), Some(1), Some(2), Some(4)]);
    let names: Vec<_> = scene.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["link1", "link2", "link4", "link3", "link5", "link6"]);
    assert_eq!(scene.base, Base::Fixed(Pose::IDENTITY));
    let half = std::f64::consts::FRAC_PI_2;
    assert_eq!(scene.query, Some((vec![0.0; 5], vec![half; 5])));
    for joint in scene.links.iter().filter_map(|link| link.joint.as_ref()) {
        let ForeignJointKind::Revolute { axis, min, max } = joint.kind else { panic!("{joint:?}") };
        assert_eq!((axis, min, max), ([0.0, 0.0, 1.0], -2.0 * half, 2.0 * half));
    }
    // Unfolded, all panels lie in the plane z = 0, side by side; folded, they stand on the first.
    let (start, goal) = scene.query.clone().unwrap();
    let flat = scenes::extents(&scene, &start);
    assert!(flat.iter().all(|[_, _, [low, high]]| *low > -0.021 && *high < 0.021), "{flat:?}");
    let near = |found: [f64; 2], expected: [f64; 2]| {
        assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-6), "{found:?} {expected:?}");
    };
    near(flat[0][0], [-10.0, 10.0]);
    near(flat[1][0], [10.0, 15.0]);
    near(flat[2][1], [-15.2, -10.0]);
    let folded = scenes::extents(&scene, &goal);
    near(folded[1][0], [9.98, 10.02]);
    assert!(folded[1][2][1] - folded[1][2][0] > 4.9, "{folded:?}");
}
