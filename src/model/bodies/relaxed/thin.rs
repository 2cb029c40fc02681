//! The robot with thinner shapes.

use crate::math;
use crate::model::bodies::robot::Robot;
use crate::model::relaxation::{CannotRelax, ThinRobot, between};
use crate::scene::{Mesh, Shape};
use std::collections::BTreeMap;

/// The robot whose shapes are thinner: every point of their surfaces is moved inward by the same length. Joints stay where they are.
///
/// Of a mesh every vertex moves along the mean of the normals of its triangles, each weighed by its angle at the vertex. The triangles stay, so that the
/// surface is closed if it was. Where a mesh is thinner than twice the length, or has a sharp edge, the surface may come to cross itself.
///
/// # Errors
/// Nothing is left of a shape: of a mesh where twice the length is not less than the longest edge of its box.
pub(super) fn thinned(robot: &Robot, asked: &ThinRobot, level: f64) -> Result<Robot, CannotRelax> {
    let by = between(asked.by, 0.0, level);
    let mut robot = robot.clone();
    for link in &mut robot.links {
        for body in &mut link.bodies {
            body.shape = thinner(&body.shape, by).ok_or_else(|| {
                let (found, link) = (body.shape.name(), &link.name);
                let message = format!(
                    "{by} found, which leaves nothing of a {found} of the link `{link}`; less than half of what shapes measure expected"
                );
                CannotRelax::new("by", message)
            })?;
        }
    }
    Ok(robot)
}

/// A shape with its surface moved inward; `None` of one of which nothing is left.
fn thinner(shape: &Shape, by: f64) -> Option<Shape> {
    let made = match shape {
        Shape::Point => return Some(Shape::Point),
        Shape::Mesh(mesh) => {
            let (min, max) = mesh.bounding_box();
            let longest = (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max);
            return (2.0 * by < longest).then(|| Shape::Mesh(thinner_mesh(mesh, by)));
        }
        Shape::Box { size } => Shape::Box { size: size.map(|edge| edge - 2.0 * by) },
        Shape::Sphere { radius } => Shape::Sphere { radius: radius - by },
        Shape::Cylinder { radius, height } => {
            Shape::Cylinder { radius: radius - by, height: height - 2.0 * by }
        }
        // Its height is that of the axis, around which all is nearer by the length.
        Shape::Capsule { radius, height } => {
            Shape::Capsule { radius: radius - by, height: *height }
        }
    };
    let measures = match &made {
        Shape::Box { size } => *size,
        Shape::Cylinder { radius, height } => [*radius, *height, *radius],
        Shape::Sphere { radius } | Shape::Capsule { radius, .. } => [*radius; 3],
        Shape::Point | Shape::Mesh(_) => [1.0; 3],
    };
    measures.iter().all(|measure| *measure > 0.0).then_some(made)
}

/// The mesh whose vertices have moved inward by a length.
fn thinner_mesh(mesh: &Mesh, by: f64) -> Mesh {
    let corner = |index: u32| mesh.vertices[index as usize];
    let faces: Vec<[u32; 3]> = mesh.faces().collect();
    let mut outward = vec![[0.0; 3]; mesh.vertices.len()];
    for (face, is_inward) in faces.iter().zip(inward_faces(mesh, &faces)) {
        let Some(normal) = normal_of(mesh, *face) else { continue };
        let way = if is_inward { -1.0 } else { 1.0 };
        let [a, b, c] = *face;
        for [at, next, last] in [[a, b, c], [b, c, a], [c, a, b]] {
            let sides = [minus(corner(next), corner(at)), minus(corner(last), corner(at))];
            let [Some(one), Some(other)] = sides.map(unit) else { continue };
            let angle = math::acos(dot(one, other).clamp(-1.0, 1.0));
            let sum = &mut outward[at as usize];
            *sum = [0, 1, 2].map(|axis| sum[axis] + way * angle * normal[axis]);
        }
    }
    let moved = |(vertex, normal): (&[f64; 3], &[f64; 3])| match unit(*normal) {
        Some(normal) => [0, 1, 2].map(|axis| vertex[axis] - by * normal[axis]),
        None => *vertex,
    };
    Mesh {
        vertices: mesh.vertices.iter().zip(&outward).map(moved).collect(),
        triangles: mesh.triangles.clone(),
    }
}

/// Per triangle whether its normal, by its winding, points into the mesh.
///
/// A mesh may be wound either way, or every triangle in another, as in files of older models. Two triangles with an edge in common, which no third one has, lie on
/// one surface, so that the one tells of the other; of each patch of such triangles the first is looked at by rays.
fn inward_faces(mesh: &Mesh, faces: &[[u32; 3]]) -> Vec<bool> {
    // Per edge the triangles at it, and whether each goes along it from the lower vertex to the higher.
    let mut at_edges: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (index, [a, b, c]) in faces.iter().enumerate() {
        for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
            let edge = [from.min(to), from.max(to)];
            at_edges.entry(edge).or_default().push((index, from < to));
        }
    }
    let mut next_to: Vec<Vec<(usize, bool)>> = vec![Vec::new(); faces.len()];
    for pair in at_edges.values() {
        if let [(one, up), (other, also_up)] = pair[..] {
            let is_wound_alike = up != also_up;
            next_to[one].push((other, is_wound_alike));
            next_to[other].push((one, is_wound_alike));
        }
    }
    let mut known: Vec<Option<bool>> = vec![None; faces.len()];
    for first in 0..faces.len() {
        if known[first].is_some() {
            continue;
        }
        known[first] = Some(points_inward(mesh, faces[first]));
        let mut open = vec![first];
        while let Some(face) = open.pop() {
            for (other, is_wound_alike) in &next_to[face] {
                if known[*other].is_none() {
                    known[*other] = known[face].map(|inward| inward == *is_wound_alike);
                    open.push(*other);
                }
            }
        }
    }
    known.into_iter().map(|inward| inward.unwrap_or(false)).collect()
}

/// Directions of the rays by which inside and outside are told apart; none lies along an axis, as faces of CAD models do.
const RAYS: [[f64; 3]; 5] = [
    [0.217, 0.551, 0.806],
    [-0.713, 0.301, 0.633],
    [0.409, -0.823, 0.394],
    [-0.351, -0.467, -0.812],
    [0.857, 0.243, -0.454],
];
/// How far from a triangle its two sides are looked at, as a share of the longest of its edges.
const OFF: f64 = 1e-3;

/// Whether the normal of a triangle points into the mesh: of its two sides that from which more of the rays cross the surface an odd number of times is inside.
/// Where both are alike the winding decides.
fn points_inward(mesh: &Mesh, face: [u32; 3]) -> bool {
    let Some(normal) = normal_of(mesh, face) else { return false };
    let [a, b, c] = face.map(|index| mesh.vertices[index as usize]);
    let edges = [minus(b, a), minus(c, b), minus(a, c)].map(|edge| dot(edge, edge).sqrt());
    let longest = edges.into_iter().fold(0.0, f64::max);
    let inside_votes = |way: f64| {
        let at = [0, 1, 2]
            .map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0 + way * OFF * longest * normal[axis]);
        RAYS.iter().filter(|ray| crossings(mesh, at, **ray) % 2 == 1).count()
    };
    inside_votes(1.0) > inside_votes(-1.0)
}

/// The normal of a triangle by its winding, of length 1; `None` where the triangle is too small to have one.
fn normal_of(mesh: &Mesh, face: [u32; 3]) -> Option<[f64; 3]> {
    let [a, b, c] = face.map(|index| mesh.vertices[index as usize]);
    unit(cross(minus(b, a), minus(c, a)))
}

/// How many triangles of a mesh a ray crosses (T. Möller, B. Trumbore, *Fast, minimum storage ray-triangle intersection*, 1997).
fn crossings(mesh: &Mesh, from: [f64; 3], ray: [f64; 3]) -> usize {
    let crosses = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|index| mesh.vertices[index as usize]);
        let (u, v) = (minus(b, a), minus(c, a));
        let (p, t) = (cross(ray, v), minus(from, a));
        let determinant = dot(u, p);
        let q = cross(t, u);
        let [first, second, along] =
            [dot(t, p), dot(ray, q), dot(v, q)].map(|value| value / determinant);
        determinant != 0.0 && first >= 0.0 && second >= 0.0 && first + second <= 1.0 && along > 0.0
    };
    mesh.faces().filter(crosses).count()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The vector of length 1 in the same direction; `None` of one without a direction.
fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(v, v).sqrt();
    (length > 0.0).then(|| v.map(|value| value / length))
}
