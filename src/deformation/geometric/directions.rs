//! The directions in which a region may be moved.

use super::regions::Region;
use super::surface::Surface;
use crate::deformation::Obstacles;
use crate::math;
use parry3d_f64::math::Vector;
use std::f64::consts::PI;

/// Directions nearer to each other than an angle with this cosine (about 10°) are tried once.
const SAME: f64 = 0.985;

/// The directions of §6.2 for a region, each followed by its inverse: (ii) the mean normal of the obstacles' colliding triangles, by
/// area, and (i) that of the robot's; then each of the normals of (ii) and (i), in the order of the triangles; then (iii) the
/// given uniformly distributed ones. Means come first since a region can most often be pushed along one, and the
/// sooner a good direction is known, the sooner others are given up. One that is nearly the same as one before is left out.
///
/// `shape` is the robot's vertices in the world's frame, and a triangle of the obstacles collides if it is nearer than `reach`.
pub(super) fn directions(
    surface: &Surface,
    region: &Region,
    shape: &[Vector],
    obstacles: &Obstacles,
    reach: f64,
    uniform: &[Vector],
) -> Vec<Vector> {
    let mut of_robot = Vec::new();
    let mut of_obstacles = Vec::new();
    for index in &region.colliding {
        let corners = surface.triangles[*index as usize].map(|corner| shape[corner as usize]);
        of_robot.push(area_vector(corners));
        obstacles.near_triangles(corners.map(|corner| corner.to_array()), reach, &mut |corners| {
            of_obstacles.push(area_vector(corners.map(Vector::from_array)));
        });
    }
    let mean = |vectors: &[Vector]| vectors.iter().fold(Vector::ZERO, |sum, vector| sum + *vector);
    let means = [mean(&of_obstacles), mean(&of_robot)];
    let singles = of_obstacles.iter().chain(&of_robot);
    let mut directions: Vec<Vector> = Vec::new();
    for vector in means.iter().chain(singles).chain(uniform) {
        let Some(direction) = unit(*vector) else { continue };
        for direction in [direction, -direction] {
            if directions.iter().all(|known| known.dot(direction) < SAME) {
                directions.push(direction);
            }
        }
    }
    directions
}

/// Directions that cover the sphere evenly: a spherical Fibonacci set (Á. González, *Measurement of areas on a sphere using
/// Fibonacci and latitude–longitude lattices*, Mathematical Geosciences 42, 2010). The paper says *uniformly selected*; a fixed set
/// needs no random numbers, so that the shape is a function of the pose.
pub(super) fn uniform(count: u32) -> Vec<Vector> {
    let golden = PI * (3.0 - 5f64.sqrt());
    let direction = |index: u32| {
        let z = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
        let (across, angle) = ((1.0 - z * z).sqrt(), golden * f64::from(index));
        Vector::new(across * math::cos(angle), across * math::sin(angle), z)
    };
    (0..count).map(direction).collect()
}

/// Two unit vectors at right angles to a unit vector and to each other.
pub(super) fn across(direction: Vector) -> [Vector; 2] {
    let [x, y, z] = direction.to_array().map(f64::abs);
    let axis = if x <= y && x <= z {
        Vector::X
    } else if y <= z {
        Vector::Y
    } else {
        Vector::Z
    };
    let first = unit(direction.cross(axis)).unwrap_or(Vector::X);
    [first, direction.cross(first)]
}

/// The vector of length 1 in the same direction; `None` of one that has none.
pub(super) fn unit(vector: Vector) -> Option<Vector> {
    let length = vector.dot(vector).sqrt();
    (length > 0.0 && length.is_finite()).then(|| vector / length)
}

/// The normal of a triangle, as long as twice its area.
fn area_vector([a, b, c]: [Vector; 3]) -> Vector {
    (b - a).cross(c - a)
}
