//! Where the scenes are, what they must look like, and scenes as problems.

use roadmill::math;
use roadmill::model::bodies::foreign::{Base, ForeignJointKind, ForeignScene};
use roadmill::scene::{Pose, Shape};
use std::path::PathBuf;

/// The folder of `ROADMILL_DATA`, or `None`, said aloud.
pub fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("ROADMILL_DATA").map(PathBuf::from);
    if let Some(folder) = folder.filter(|folder| folder.join("scenes").is_dir()) {
        return Some(folder);
    }
    let required = std::env::var_os("ROADMILL_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "ROADMILL_DATA names no folder with `scenes` in it");
    println!("skipped: ROADMILL_DATA names no folder with `scenes` in it");
    None
}

pub struct Expected {
    /// Triangles as stored, unique ones, edges with an odd number of them.
    pub counts: [usize; 3],
    /// Least and largest x, y and z.
    pub frame: [[f64; 2]; 3],
}

const fn expected(counts: [usize; 3], frame: [[f64; 2]; 3]) -> Expected {
    Expected { counts, frame }
}

/// Scene, world and robot, as an importer that solved them reads them.
pub const TABLE: &[(&str, Expected, Expected)] = &[
    (
        "cubicles.cfg",
        expected([626, 313, 17], [[-508.882, 319.618], [-230.129, 531.871], [-123.750, 101.000]]),
        expected([40, 20, 0], [[-22.242, 24.440], [-46.736, 32.159], [-14.873, 14.459]]),
    ),
    (
        "Easy.cfg",
        expected([176, 88, 8], [[14.460, 457.960], [-24.250, 321.250], [-504.855, -72.855]]),
        expected([56, 28, 0], [[-19.281, 37.947], [-17.906, 36.094], [-24.839, 23.667]]),
    ),
    (
        "Twistycool.cfg",
        expected([176, 88, 8], [[14.460, 457.960], [-24.250, 321.250], [-504.855, -72.855]]),
        expected([56, 28, 0], [[-19.281, 37.947], [-17.906, 36.094], [-24.839, 23.667]]),
    ),
    (
        "alpha-1.5.cfg",
        expected([2016, 1008, 612], [[-131.868, 106.824], [-42.493, 125.332], [-91.763, -3.074]]),
        expected([2016, 1008, 612], [[-51.266, 193.711], [-48.842, 54.820], [-88.500, 53.632]]),
    ),
    (
        "bugtrap.cfg",
        expected([5212, 2606, 612], [[3.037, 29.993], [-17.486, 17.573], [-13.267, 13.267]]),
        expected([264, 66, 0], [[-5.761, 5.772], [-2.810, 2.783], [-0.714, 0.714]]),
    ),
    (
        "LTunnel/tunnel.env",
        expected([172, 156, 24], [[-25.0, 25.0], [-15.088, 22.0], [-13.0, 13.0]]),
        expected([12, 12, 0], [[-0.950, 0.950], [-0.950, 0.950], [-0.950, 0.950]]),
    ),
    (
        "STunnel/tunnel.env",
        expected([52, 52, 12], [[-3.571, 3.429], [-2.857, 2.143], [-4.429, 4.571]]),
        expected([12, 12, 0], [[-0.030, 0.030], [-0.030, 0.030], [-0.030, 0.030]]),
    ),
    (
        "alpha1.6/alpha.env",
        expected([972, 972, 0], [[-3.675, 56.952], [-4.744, 37.883], [-6.522, 16.005]]),
        expected([972, 972, 0], [[-14.590, 47.634], [-12.503, 24.645], [-10.631, 8.675]]),
    ),
    (
        "bug_trap1.0/bug-trap.env",
        expected([3212, 3212, 0], [[-15.827, 14.319], [-11.476, 16.184], [-17.842, 18.583]]),
        expected([132, 66, 0], [[-0.692, 0.722], [-0.714, 0.714], [-5.911, 5.911]]),
    ),
    (
        "flange_1.0/flange.env",
        expected([990, 990, 0], [[1.165, 2.835], [1.165, 2.835], [1.790, 2.000]]),
        expected([5306, 5306, 0], [[-0.937, 1.117], [-0.624, 0.624], [-0.870, 0.776]]),
    ),
    (
        "SerialWalls/serial.env",
        expected([216, 216, 0], [[0.0, 4.0], [0.0, 4.0], [-5.0, 14.0]]),
        expected([12, 12, 0], [[-0.750, 0.750], [-0.125, 0.125], [-0.125, 0.125]]),
    ),
];

/// All scenes.
pub const ALL: &[&str] = &[
    "cubicles.cfg",
    "Easy.cfg",
    "Twistycool.cfg",
    "alpha-1.5.cfg",
    "bugtrap.cfg",
    "LTunnel/tunnel.env",
    "STunnel/tunnel.env",
    "alpha1.6/alpha.env",
    "bug_trap1.0/bug-trap.env",
    "flange_1.0/flange.env",
    "SerialWalls/serial.env",
    "Maze/maze.env",
    "Maze/maze-vizmo.env",
    "Heterogeneous/heterogeneous2D.env",
    "Heterogeneous/heterogeneous2D-vizmo.env",
    "Box/box.env",
];

/// Least and largest x, y and z of every link at the joints' values.
pub fn extents(scene: &ForeignScene, values: &[f64]) -> Vec<[[f64; 2]; 3]> {
    let Base::Fixed(base) = scene.base else { panic!("{} has a moving base", scene.name) };
    let mut values = values.iter();
    // To the world's frame through pose after pose, the innermost first.
    let mut chains: Vec<Vec<Pose>> = Vec::new();
    let mut extents = Vec::new();
    for link in &scene.links {
        let chain = match &link.joint {
            None => vec![base],
            Some(joint) => {
                let mut chain = chains[joint.parent].clone();
                let mut motion = base;
                if let ForeignJointKind::Revolute { axis: [x, y, z], .. } = joint.kind {
                    let half = values.next().expect("a value per joint") / 2.0;
                    let (sine, cosine) = (math::sin(half), math::cos(half));
                    motion.rotation = [cosine, x * sine, y * sine, z * sine];
                    motion.translation = [0.0; 3];
                }
                chain.extend([joint.before, motion, joint.after]);
                chain
            }
        };
        let mut frame = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for body in &link.bodies {
            let Shape::Mesh(mesh) = &body.body.shape else { panic!("foreign bodies are meshes") };
            for vertex in &mesh.vertices {
                let own = body.body.pose.apply(*vertex);
                let placed = chain.iter().rev().fold(own, |point, pose| pose.apply(point));
                for (range, value) in frame.iter_mut().zip(placed) {
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
        chains.push(chain);
        extents.push(frame);
    }
    extents
}
