//! The other side of a race: a program that works on scenes of surfaces.

use roadmill::model::bodies::validity::BoundsMeaning;
use roadmill::model::bodies::{BodiesSpec, BodySpec, ShapeSpec};
use roadmill::problem::Problem;
use roadmill::scene::{Body, Shape, box_surface};
use roadmill::space::BaseJoint;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// The problem as the peer sees it: OMPL and FCL know no solids and no bounds of bodies, so both sides
/// race with surfaces and with bounds that hold the reference point.
pub fn surfaces(path: &Path) -> Problem {
    let problem = Problem::load(path).unwrap_or_else(|error| panic!("{error}"));
    empty(&changed(&problem, |bodies| {
        bodies.change_space(|space| space.bounds(BoundsMeaning::Reference))
    }))
}

/// The problem with other bodies.
pub fn changed(problem: &Problem, change: impl FnOnce(BodiesSpec) -> BodiesSpec) -> Problem {
    let builder = problem.to_builder().change_model(|model| model.change_bodies(change));
    builder.build().unwrap_or_else(|error| panic!("{}: {error}", problem.name()))
}

/// Makes mere surfaces of all meshes and boxes.
pub fn empty(problem: &Problem) -> Problem {
    let surface = |body: BodySpec| match body.shape() {
        ShapeSpec::Triangles { .. } => body.solid(false),
        ShapeSpec::Box { size } => {
            let (corners, triangles) = box_surface(*size);
            body.shaped(ShapeSpec::triangles(corners.to_vec(), triangles)).solid(false)
        }
        _ => body,
    };
    changed(problem, |bodies| bodies.change_each_body(surface))
}

/// Whether the peer knows robots and obstacles of this kind: meshes, of which one moves freely.
pub fn suits(problem: &Problem) -> bool {
    let described = problem.model().bodies().expect("bodies");
    let mut bodies = described.robot().bodies().chain(described.obstacles());
    described.robot().links.len() == 1
        && described.robot().motion == BaseJoint::Rigid3d
        && bodies.all(|body| matches!(body.shape, Shape::Mesh(_)))
}

/// The scene as text for the peer.
pub fn scene_text(problem: &Problem) -> String {
    let mut text = String::new();
    let described = problem.model().bodies().expect("bodies");
    let bounds = described.bounds();
    for value in bounds.min.iter().chain(&bounds.max) {
        write!(text, "{value} ").expect("memory");
    }
    writeln!(text, "{} {}", described.resolution(), described.robot().reach()).expect("memory");
    let robot: Vec<Body> = described.robot().bodies().cloned().collect();
    for bodies in [described.obstacles(), &robot] {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for body in bodies {
            let Shape::Mesh(mesh) = &body.shape else { panic!("a scene of meshes expected") };
            let first = vertices.len();
            vertices.extend(mesh.vertices.iter().map(|vertex| body.pose.apply(*vertex)));
            let shifted = |corners: &[u32; 3]| corners.map(|corner| corner as usize + first);
            triangles.extend(mesh.triangles.iter().map(shifted));
        }
        writeln!(text, "{} {}", vertices.len(), triangles.len()).expect("memory");
        for [x, y, z] in vertices {
            writeln!(text, "{x} {y} {z}").expect("memory");
        }
        for [a, b, c] in triangles {
            writeln!(text, "{a} {b} {c}").expect("memory");
        }
    }
    text
}

/// Configurations that belong together on one line each, with a number of steps.
pub fn pairs_text<'a>(
    pairs: impl Iterator<Item = (&'a [f64], &'a [f64])>,
    steps: impl Iterator<Item = u64>,
) -> String {
    let mut text = String::new();
    for ((a, b), steps) in pairs.zip(steps) {
        for value in a.iter().chain(b) {
            write!(text, "{value} ").expect("memory");
        }
        writeln!(text, "{steps}").expect("memory");
    }
    text
}

/// The verdicts that the peer wrote.
pub fn verdicts(path: &str) -> Vec<bool> {
    let text = std::fs::read_to_string(path).expect("verdicts");
    text.lines().map(|line| line == "1").collect()
}

/// Runs the peer; the numbers that it prints, CPU seconds first.
pub fn run(peer: &str, words: &[&str]) -> Vec<f64> {
    let output = Command::new(peer).args(words).output().expect("the peer starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    text.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}
