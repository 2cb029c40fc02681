//! The surface of a robot as one mesh of triangles: what is deformed.

use crate::model::bodies::Bodies;
use crate::scene::{Body, Mesh, Shape, tessellate, tetrahedron};
use std::collections::BTreeMap;

/// The most triangles of a surface.
pub(super) const TRIANGLES_MAX: usize = 200_000;
/// An edge is halved at most so often.
const PASSES_MAX: usize = 12;

/// The surfaces of a robot's bodies in the robot's frame, as one mesh whose pieces are the bodies, whose edges are no longer than
/// `longest_edge`. It is closed where every mesh among the bodies is. See
/// [`Deformable::surface`](super::Deformable::surface).
pub(super) fn surface(bodies: &Bodies, longest_edge: f64) -> Mesh {
    let mut whole = Mesh { vertices: Vec::new(), triangles: Vec::new() };
    for body in bodies.robot.bodies() {
        let Mesh { vertices, triangles } = of_body(body);
        let first = whole.vertices.len() as u32;
        whole.vertices.extend(vertices);
        whole
            .triangles
            .extend(triangles.iter().map(|corners| corners.map(|corner| first + corner)));
    }
    for _ in 0..PASSES_MAX {
        match halved(&whole, longest_edge) {
            Some(finer) => whole = finer,
            None => break,
        }
    }
    whole
}

/// Whether an edge of a mesh is longer than this.
pub(super) fn has_longer_edge(mesh: &Mesh, longest: f64) -> bool {
    mesh.triangles.iter().any(|[a, b, c]| {
        [(a, b), (b, c), (c, a)]
            .into_iter()
            .any(|(one, other)| length(mesh, *one, *other) > longest)
    })
}

/// The longest edge of the box around a robot's bodies, along the axes of the robot's frame.
pub(super) fn longest_side(bodies: &Bodies) -> f64 {
    let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for vertex in bodies.robot.bodies().flat_map(|body| of_body(body).vertices) {
        for axis in 0..3 {
            min[axis] = min[axis].min(vertex[axis]);
            max[axis] = max[axis].max(vertex[axis]);
        }
    }
    (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max)
}

/// The surface of a body in the robot's frame, wound so that triangles are seen counter-clockwise from outside. A mesh keeps its vertices
/// and its flat triangles, without which it might not be closed. A point has no surface.
fn of_body(body: &Body) -> Mesh {
    let Mesh { vertices, mut triangles } = match &body.shape {
        Shape::Point => Mesh { vertices: Vec::new(), triangles: Vec::new() },
        Shape::Mesh(mesh) => mesh.clone(),
        round => {
            let surface = tessellate(round, 0.0);
            Mesh { vertices: surface.vertices, triangles: surface.triangles }
        }
    };
    let vertices: Vec<[f64; 3]> = vertices.iter().map(|vertex| body.pose.apply(*vertex)).collect();
    let first = vertices.first().copied().unwrap_or_default();
    let at = |corner: u32| vertices[corner as usize];
    let volume: f64 = triangles.iter().map(|corners| tetrahedron(first, corners.map(at))).sum();
    if volume < 0.0 {
        triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    Mesh { vertices, triangles }
}

/// The mesh with every edge halved that is longer than `longest`; `None` where there is none, or there would be too many
/// triangles. An edge is halved in all triangles that it belongs to, so that a closed mesh stays closed.
fn halved(mesh: &Mesh, longest: f64) -> Option<Mesh> {
    let mut vertices = mesh.vertices.clone();
    let mut middle_of: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let mut middle = |one: u32, other: u32| {
        if length(mesh, one, other) <= longest {
            return None;
        }
        let ends = [one.min(other), one.max(other)];
        Some(*middle_of.entry(ends).or_insert_with(|| {
            let [from, to] = ends.map(|end| mesh.vertices[end as usize]);
            vertices.push([0, 1, 2].map(|axis| from[axis] + (to[axis] - from[axis]) / 2.0));
            vertices.len() as u32 - 1
        }))
    };
    let mut triangles = Vec::new();
    for [a, b, c] in mesh.triangles.iter().copied() {
        let middles = [middle(a, b), middle(b, c), middle(c, a)];
        // Turned so that the halved edges come first.
        let ([a, b, c], middles) = match middles {
            [None, Some(_), _] => ([b, c, a], [middles[1], middles[2], middles[0]]),
            [_, None, Some(_)] => ([c, a, b], [middles[2], middles[0], middles[1]]),
            _ => ([a, b, c], middles),
        };
        match middles {
            [Some(ab), Some(bc), Some(ca)] => {
                triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            }
            [Some(ab), Some(bc), None] => triangles.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
            [Some(ab), None, None] => triangles.extend([[a, ab, c], [ab, b, c]]),
            _ => triangles.push([a, b, c]),
        }
    }
    let is_finer = triangles.len() > mesh.triangles.len() && triangles.len() <= TRIANGLES_MAX;
    is_finer.then_some(Mesh { vertices, triangles })
}

fn length(mesh: &Mesh, one: u32, other: u32) -> f64 {
    let [from, to] = [one, other].map(|corner| mesh.vertices[corner as usize]);
    let by = [0, 1, 2].map(|axis| to[axis] - from[axis]);
    (by[0] * by[0] + by[1] * by[1] + by[2] * by[2]).sqrt()
}
