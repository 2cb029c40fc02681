//! The robot scaled down, toward which regions are moved where no push frees them.

use super::regions::{Region, whole};
use super::settle::{Moved, settle};
use super::surface::Surface;
use super::trial::Trial;
use crate::deformation::{Obstacles, SoftBody};
use parry3d_f64::math::Vector;

/// Moves a region toward the corresponding vertices of the guide, which is free: the region alone, if it is free once its
/// colliding triangles are where the guide's are; otherwise the whole surface, which is free at the guide.
pub(super) fn pull(
    surface: &Surface,
    region: &Region,
    obstacles: &Obstacles,
    reach: f64,
    shape: &[Vector],
    guide: &[Vector],
) -> Vec<Moved> {
    let targets = |region: &Region| -> Vec<Vector> {
        let target = |(vertex, weight): &(u32, f64)| {
            let at = shape[*vertex as usize];
            at + (guide[*vertex as usize] - at) * *weight
        };
        region.vertices.iter().map(target).collect()
    };
    let near = targets(region);
    let mut trial = Trial::new(surface, region, obstacles, reach, shape);
    if trial.is_free(near.iter().copied()) {
        return settle(&mut trial, &near);
    }
    let all = whole(surface, 1.0 / region.slope);
    settle(&mut Trial::new(surface, &all, obstacles, reach, shape), &targets(&all))
}

/// The centroid of what the surface encloses; the mean of the vertices where it encloses nothing.
pub(super) fn centroid(body: &SoftBody) -> Vector {
    let vertices: Vec<Vector> = body.vertices().iter().copied().map(Vector::from_array).collect();
    let mean = vertices.iter().fold(Vector::ZERO, |sum, vertex| sum + *vertex) / vertices.len() as f64;
    let (mut volume, mut moment) = (0.0, Vector::ZERO);
    for corners in body.triangles() {
        let [a, b, c] = corners.map(|corner| vertices[corner as usize] - mean);
        let tetrahedron = a.dot(b.cross(c));
        volume += tetrahedron;
        moment += (a + b + c) * (tetrahedron / 4.0);
    }
    let centroid = moment / volume;
    if centroid.is_finite() { mean + centroid } else { mean }
}
