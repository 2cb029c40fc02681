//! Smaller robots, toward which regions are moved where no push frees them.

use super::surface::Surface;
use crate::deformation::{Obstacles, SoftBody};
use crate::scene::{Body, Pose, Shape, tetrahedron};
use parry3d_f64::math::Vector;

/// How often the inward ways of neighbours are averaged, so that those at edges of the body do not cross.
const AVERAGED: u32 = 4;
/// Where rays into the body begin, as a share of its size from the surface.
const INSIDE: f64 = 1e-6;

/// The guides of a robot, in its frame, in the order in which they are tried. The scale is the setting `guide`.
///
/// The paper's is the robot scaled about its centroid, which is the second here. But a smaller elbow is not within the elbow. The first is therefore the
/// robot made thinner: each vertex moved inward along the normal, so that the body's thickness there is the scale times what it was. Of a ball
/// the two are the same.
pub(super) fn guides(
    body: &SoftBody,
    surface: &Surface,
    scale: f64,
    size: f64,
) -> [Vec<Vector>; 2] {
    let rest: Vec<Vector> = body.vertices().iter().copied().map(Vector::from_array).collect();
    let centre = centroid(body);
    let inward = inward(body, surface, &rest, size);
    let thinner = |(vertex, inward): (&Vector, &Vector)| *vertex + *inward * (1.0 - scale);
    let scaled = |vertex: &Vector| centre + (*vertex - centre) * scale;
    [rest.iter().zip(&inward).map(thinner).collect(), rest.iter().map(scaled).collect()]
}

/// Per vertex the way inward to the middle of the body: half of the way to where the surface is met again.
fn inward(body: &SoftBody, surface: &Surface, rest: &[Vector], size: f64) -> Vec<Vector> {
    let shape = Shape::Mesh(body.mesh().clone());
    let itself = Obstacles::new(&[Body { shape, pose: Pose::IDENTITY, solid: true }]);
    let mut normals = vec![Vector::ZERO; rest.len()];
    for corners in body.triangles() {
        let [a, b, c] = corners.map(|corner| rest[corner as usize]);
        for corner in corners {
            normals[*corner as usize] += (b - a).cross(c - a);
        }
    }
    let outward = if surface.volumes(rest).iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    let mut depths = vec![0.0; rest.len()];
    for (vertex, normal) in normals.iter_mut().enumerate() {
        *normal = super::directions::unit(*normal).unwrap_or(Vector::ZERO) * -outward;
        let ends = [INSIDE * size, size].map(|depth| (rest[vertex] + *normal * depth).to_array());
        if let Some(hit) = itself.first_hit(ends[0], ends[1]) {
            depths[vertex] = hit * size / 2.0;
        }
    }
    // Half the thickness changes along the surface by no more than the way along it, so that the ends of a rod do not go in farther than
    // its sides do.
    loop {
        let mut is_changed = false;
        for edge in &surface.edges {
            let [a, b] = edge.ends.map(|end| end as usize);
            for (one, other) in [(a, b), (b, a)] {
                if depths[one] > depths[other] + edge.length {
                    depths[one] = depths[other] + edge.length;
                    is_changed = true;
                }
            }
        }
        if !is_changed {
            break;
        }
    }
    let mut inward: Vec<Vector> =
        normals.iter().zip(&depths).map(|(normal, depth)| *normal * *depth).collect();
    for _ in 0..AVERAGED {
        let before = inward.clone();
        for (vertex, way) in (0u32..).zip(&mut inward) {
            let neighbours = surface.neighbours(vertex);
            if neighbours.is_empty() {
                continue;
            }
            let sum =
                neighbours.iter().fold(Vector::ZERO, |sum, (next, _)| sum + before[*next as usize]);
            *way = (*way + sum / neighbours.len() as f64) / 2.0;
        }
    }
    inward
}

/// The centroid of what the surface encloses; the mean of the vertices where it encloses nothing.
pub(super) fn centroid(body: &SoftBody) -> Vector {
    let vertices: Vec<Vector> = body.vertices().iter().copied().map(Vector::from_array).collect();
    let sum = vertices.iter().fold(Vector::ZERO, |sum, vertex| sum + *vertex);
    let mean = sum / vertices.len() as f64;
    let (mut volume, mut moment) = (0.0, Vector::ZERO);
    for corners in body.triangles() {
        let corners = corners.map(|corner| vertices[corner as usize]);
        let six_volumes = tetrahedron(mean.to_array(), corners.map(|corner| corner.to_array()));
        let [a, b, c] = corners.map(|corner| corner - mean);
        volume += six_volumes;
        moment += (a + b + c) * (six_volumes / 4.0);
    }
    let centroid = moment / volume;
    if centroid.is_finite() { mean + centroid } else { mean }
}
