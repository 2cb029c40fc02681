//! Shapes as OBJ files, which Blender, MeshLab and most other programs read.

use crate::deformation::{Frame, SoftBody};
use crate::scene::{Body, tessellate};
use std::fmt::Write;

/// The name of the file of a frame, counted from 0, of so many: `frame-0001.obj`, with more digits where there are more than 9999.
pub fn frame_name(index: usize, frames: usize) -> String {
    let digits = frames.max(1).ilog10().max(3) as usize + 1;
    format!("frame-{:0digits$}.obj", index + 1)
}

/// The robot's surface at a frame, in the world's frame. Vertices are in the order of the robot's at rest, so that programs can go
/// from one file to the next vertex by vertex. Numbers are written so that reading them back gives the same bits.
pub fn frame_obj(body: &SoftBody, frame: &Frame) -> String {
    let mut obj = String::from("o robot\n");
    put_surface(&mut obj, &frame.in_world(), body.triangles(), 1);
    obj
}

/// The obstacles in the world's frame, each as an object of its own. What is round has 32 corners around, on its surface.
pub fn obstacles_obj(obstacles: &[Body]) -> String {
    let (mut obj, mut first) = (String::new(), 1);
    for (index, body) in obstacles.iter().enumerate() {
        let surface = tessellate(&body.shape, 0.0);
        let vertices: Vec<[f64; 3]> =
            surface.vertices.iter().map(|vertex| body.pose.apply(*vertex)).collect();
        writeln!(obj, "o obstacle-{}", index + 1).expect("memory");
        put_surface(&mut obj, &vertices, &surface.triangles, first);
        first += vertices.len();
    }
    obj
}

/// Appends vertices, and triangles whose first vertex has the number `first` in the file.
fn put_surface(obj: &mut String, vertices: &[[f64; 3]], triangles: &[[u32; 3]], first: usize) {
    for [x, y, z] in vertices {
        writeln!(obj, "v {x} {y} {z}").expect("memory");
    }
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| corner as usize + first);
        writeln!(obj, "f {a} {b} {c}").expect("memory");
    }
}
