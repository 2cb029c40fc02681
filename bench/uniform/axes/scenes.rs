//! The environments of Figures 5.6 and 5.13, as their text describes them, for a point.

use super::boxes::{Cuboid, carve};
use roadmill::model::bodies::foreign::{SceneOptions, read_parasol};
use roadmill::model::bodies::validity::BoundsMeaning;
use roadmill::model::bodies::{BodiesSpec, BodySpec, RobotSpec, ShapeSpec, SpaceSpec};
use roadmill::problem::Problem;
use roadmill::scene::Shape;
use roadmill::space::BaseJoint;
use std::path::PathBuf;

/// An environment in which a point moves.
pub struct Scene {
    pub problem: Problem,
    /// The width of the narrowest place that has to be passed.
    pub width: f64,
    /// The longest side of the bounds.
    pub longest_side: f64,
}

/// Where the point may be.
struct Bounds {
    min: Vec<f64>,
    max: Vec<f64>,
}

impl Bounds {
    /// A square or a cube.
    fn cube(low: f64, high: f64, dimensions: usize) -> Bounds {
        Bounds { min: vec![low; dimensions], max: vec![high; dimensions] }
    }
}

/// A point among obstacles, and perhaps the ends of a query.
fn scene(
    name: &str,
    bounds: Bounds,
    obstacles: impl IntoIterator<Item = BodySpec>,
    query: Option<[Vec<f64>; 2]>,
    width: f64,
) -> Scene {
    let Bounds { min, max } = bounds;
    let longest_side = min.iter().zip(&max).fold(0.0, |most, (a, b)| f64::max(most, b - a));
    let motion = if min.len() == 2 { BaseJoint::Translation2d } else { BaseJoint::Translation3d };
    let space = SpaceSpec::new(motion, min, max, BoundsMeaning::Reference);
    let robot = RobotSpec::new().body(ShapeSpec::Point {});
    let builder = Problem::builder(name, BodiesSpec::new(space, robot).obstacles(obstacles));
    let builder = match query {
        Some([start, goal]) => builder.query(start, goal),
        None => builder,
    };
    let problem = builder.build().unwrap_or_else(|error| panic!("{name}: {error}"));
    Scene { problem, width, longest_side }
}

/// Half of the distance between the two blocks.
const HALF_GAP: f64 = 0.25;
/// Half of the side of the space with the two blocks.
pub const HALF_SIDE: f64 = 2.0;

/// Two unit blocks beside each other in the middle of the space (Figure 5.6, a and b): the axis is the line or the plane of all points
/// with x = 0.
pub fn blocks(dimensions: usize) -> Scene {
    // In the plane blocks are high, so that no point in them is nearest to their upper and lower sides.
    let height = if dimensions == 2 { 100.0 } else { 1.0 };
    let of_side = |side: f64| {
        let shape = ShapeSpec::Box { size: [1.0, 1.0, height] };
        BodySpec::new(shape).at([side * (HALF_GAP + 0.5), 0.0, 0.0])
    };
    let bounds = Bounds::cube(-HALF_SIDE, HALF_SIDE, dimensions);
    scene(&format!("blocks-{dimensions}d"), bounds, [-1.0, 1.0].map(of_side), None, 2.0 * HALF_GAP)
}

/// The passage of Obstacle 1, 2 and 3.
pub const PASSAGE: Cuboid = Cuboid { min: [4.75, 3.0, 3.0], max: [5.25, 7.0, 7.0] };
/// How thick the two blocks are that make the passage of Obstacle 1, 2 and 3.
pub const THICKNESSES: [f64; 3] = [0.25, 1.0, 3.0];

/// Two blocks with the passage between them in a cube of side 10 (Figure 5.6, c to e).
pub fn obstacle(thickness: f64) -> Scene {
    let Cuboid { min, max } = PASSAGE;
    let left = Cuboid::new([min[0] - thickness, min[1], min[2]], [min[0], max[1], max[2]]);
    let right = Cuboid::new([max[0], min[1], min[2]], [max[0] + thickness, max[1], max[2]]);
    let blocks = [left, right].map(|block| block.body());
    scene("obstacle", Bounds::cube(0.0, 10.0, 3), blocks, None, max[0] - min[0])
}

/// The width of the tunnel.
const TUNNEL: f64 = 0.4;
/// How thick the walls of the tunnel are, and the wall through which it leads.
const TUNNEL_WALL: f64 = 0.1;

/// A tunnel in the shape of an S with thin walls through a thin wall between the halves of a cube of side 10, the ends in opposite
/// corners (Figure 5.13 b).
pub fn s_tunnel() -> Scene {
    let corners = [[3.0, 7.5], [3.0, 6.5], [7.0, 6.5], [7.0, 3.5], [3.0, 3.5], [3.0, 2.5]];
    let corners = corners.map(|[x, z]| [x, 5.0, z]);
    let (inner, outer) = (TUNNEL / 2.0, TUNNEL / 2.0 + TUNNEL_WALL);
    let wall =
        Cuboid::new([0.0, 0.0, 5.0 - TUNNEL_WALL / 2.0], [10.0, 10.0, 5.0 + TUNNEL_WALL / 2.0]);
    let mut laid = vec![(wall, true)];
    laid.extend(legs(&corners).map(|leg| (Cuboid::around(leg, outer), true)));
    laid.extend(legs(&corners).map(|leg| (Cuboid::around(leg, inner), false)));
    // The ends are open.
    for (end, toward) in [(corners[0], 1.0), (corners[5], -1.0)] {
        let beyond = [end[0], end[1], end[2] + toward * TUNNEL_WALL];
        laid.push((Cuboid::around([end, beyond], inner), false));
    }
    let ends = [vec![0.5, 0.5, 9.5], vec![9.5, 9.5, 0.5]];
    let walls = carve(&laid);
    let walls = walls.iter().map(Cuboid::body);
    scene("s-tunnel", Bounds::cube(0.0, 10.0, 3), walls, Some(ends), TUNNEL)
}

fn legs(corners: &[[f64; 3]]) -> impl Iterator<Item = [[f64; 3]; 2]> {
    corners.windows(2).map(|pair| [pair[0], pair[1]])
}

/// The side of a bug trap.
const TRAP: f64 = 10.0;
/// How thick its walls are.
const TRAP_WALL: f64 = 0.1;
/// How far its entrance reaches into it.
const ENTRANCE: f64 = 3.0;

/// A bug trap (Figure 5.13 d): a cube in a cube of twice its side, hollow, with an entrance that leads into it as a square tube;
/// `opening` is the tube's width as a share of the trap's side. The start is in the trap and the goal outside.
pub fn bug_trap(opening: f64) -> Scene {
    let (low, high, middle) = (0.5 * TRAP, 1.5 * TRAP, TRAP);
    let width = opening * TRAP;
    let shell = Cuboid::new([low; 3], [high; 3]);
    let hollow = Cuboid::new([low + TRAP_WALL; 3], [high - TRAP_WALL; 3]);
    let tube = |reach: f64| {
        let (least, most) = (middle - reach, middle + reach);
        Cuboid::new([high - ENTRANCE, least, least], [high, most, most])
    };
    let laid = [
        (shell, true),
        (hollow, false),
        (tube(width / 2.0 + TRAP_WALL), true),
        (tube(width / 2.0), false),
    ];
    let walls = carve(&laid);
    let walls = walls.iter().map(Cuboid::body);
    let ends = [vec![8.0, 8.0, 8.0], vec![18.0, 3.0, 3.0]];
    scene("bug-trap", Bounds::cube(0.0, 2.0 * TRAP, 3), walls, Some(ends), width)
}

/// The folder of Parasol's scenes in that of `ROADMILL_DATA`, or `None`, said aloud.
pub fn parasol() -> Option<PathBuf> {
    let data = std::env::var_os("ROADMILL_DATA").map(PathBuf::from);
    let found = data.map(|data| data.join("scenes/parasol")).filter(|folder| folder.is_dir());
    if found.is_none() {
        println!("skipped: ROADMILL_DATA names no folder with `scenes/parasol` in it");
    }
    found
}

/// How many times higher the planar scenes are made.
const HIGHER: f64 = 1000.0;

/// Parasol's planar scene in a file, for a point in the place of its robot. Its obstacles are made higher, so that no point in them is
/// nearest to their upper and lower sides; at z = 0, where the point moves, they stay as they are.
fn of_parasol(name: &str, file: &str, width: f64) -> Option<Scene> {
    let path = parasol()?.join(file);
    let read = read_parasol(&path, &SceneOptions::default());
    let read = read.unwrap_or_else(|error| panic!("{error}"));
    let obstacles = read.obstacles.iter().map(|obstacle| {
        let Shape::Mesh(mesh) = &obstacle.body.shape else { panic!("{file}: meshes expected") };
        let high = |vertex: &[f64; 3]| {
            let [x, y, z] = obstacle.body.pose.apply(*vertex);
            [x, y, HIGHER * z]
        };
        let vertices = mesh.vertices.iter().map(high).collect();
        BodySpec::new(ShapeSpec::triangles(vertices, mesh.triangles.clone())).solid(true)
    });
    let (start, goal) = read.query.expect("the scene has a query");
    let (min, max) = (read.bounds.min[..2].to_vec(), read.bounds.max[..2].to_vec());
    Some(scene(name, Bounds { min, max }, obstacles, Some([start, goal]), width))
}

/// Parasol's Maze (Figure 5.13 a): corridors 3 wide.
pub fn maze() -> Option<Scene> {
    of_parasol("2d-maze", "Maze/maze.env", 3.0)
}

/// Parasol's Heterogeneous (Figure 5.13 c), made for a robot 1.07 wide.
pub fn heterogeneous() -> Option<Scene> {
    of_parasol("2d-heterogeneous", "Heterogeneous/heterogeneous2D.env", 1.07)
}
