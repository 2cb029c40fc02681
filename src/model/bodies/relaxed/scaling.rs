//! Shapes scaled about a point, along some axes.

use crate::model::relaxation::ScaleCentre;
use crate::scene::{Body, Mesh, Pose, Shape, box_surface};
use std::f64::consts::PI;

/// A map of space onto itself: each axis is multiplied by a factor about a point that stays.
pub(in crate::model) struct Scaling {
    /// What stays in its place.
    pub centre: [f64; 3],
    /// Per axis the factor.
    pub factors: [f64; 3],
}

impl Scaling {
    /// The map with one factor along some axes, for bodies in one frame that are scaled together.
    pub fn new(bodies: &[Body], centre: ScaleCentre, axes: [bool; 3], factor: f64) -> Scaling {
        let centre = match centre {
            ScaleCentre::Centroid => centroid(bodies),
            ScaleCentre::Point(point) => point,
        };
        Scaling { centre, factors: axes.map(|is_scaled| if is_scaled { factor } else { 1.0 }) }
    }

    /// Where a point comes to lie.
    fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let moved = |axis: usize| {
            self.centre[axis] + self.factors[axis] * (point[axis] - self.centre[axis])
        };
        [moved(0), moved(1), moved(2)]
    }

    /// The one factor of all axes, if there is one.
    fn uniform(&self) -> Option<f64> {
        let [x, y, z] = self.factors;
        (x == y && y == z).then_some(x)
    }

    /// The scaled body. With one factor for all axes a shape stays of its kind. Else a mesh stays a mesh, and a box becomes one, in
    /// the frame in which the body is given.
    ///
    /// # Errors
    /// Says which shape cannot be scaled along some axes only, as it would be none of its kind any more.
    pub fn of(&self, body: &Body) -> Result<Body, String> {
        if let Some(factor) = self.uniform() {
            let translation = self.apply(body.pose.translation);
            let pose = Pose { translation, ..body.pose };
            return Ok(Body { shape: similar(&body.shape, factor), pose, solid: body.solid });
        }
        let map = |points: &[[f64; 3]]| -> Vec<[f64; 3]> {
            points.iter().map(|point| self.apply(body.pose.apply(*point))).collect()
        };
        let (vertices, triangles) = match &body.shape {
            Shape::Mesh(Mesh { vertices, triangles }) => (map(vertices), triangles.clone()),
            Shape::Box { size } => {
                let (corners, triangles) = box_surface(*size);
                (map(&corners), triangles)
            }
            Shape::Point => {
                let translation = self.apply(body.pose.translation);
                return Ok(Body { pose: Pose { translation, ..body.pose }, ..body.clone() });
            }
            other => {
                return Err(format!(
                    "a {} found, which is none any more when some axes are scaled only; axes = \"all\", or meshes and boxes, expected",
                    other.name()
                ));
            }
        };
        let shape = Shape::Mesh(Mesh { vertices, triangles });
        Ok(Body { shape, pose: Pose::IDENTITY, solid: body.solid })
    }
}

/// A shape multiplied by a factor about the origin of its frame.
fn similar(shape: &Shape, factor: f64) -> Shape {
    match shape {
        Shape::Point => Shape::Point,
        Shape::Box { size } => Shape::Box { size: size.map(|edge| edge * factor) },
        Shape::Sphere { radius } => Shape::Sphere { radius: radius * factor },
        Shape::Cylinder { radius, height } => {
            Shape::Cylinder { radius: radius * factor, height: height * factor }
        }
        Shape::Capsule { radius, height } => {
            Shape::Capsule { radius: radius * factor, height: height * factor }
        }
        Shape::Mesh(Mesh { vertices, triangles }) => {
            let scaled = |vertex: &[f64; 3]| vertex.map(|value| value * factor);
            let vertices = vertices.iter().map(scaled).collect();
            Shape::Mesh(Mesh { vertices, triangles: triangles.clone() })
        }
    }
}

/// The centroid of the surfaces of bodies, each weighed by its area, in the frame in which they are given; of bodies without a
/// surface the mean of their origins, and without bodies the origin.
pub(in crate::model) fn centroid(bodies: &[Body]) -> [f64; 3] {
    let parts: Vec<(f64, [f64; 3])> = bodies.iter().flat_map(surface_parts).collect();
    let area: f64 = parts.iter().map(|(area, _)| area).sum();
    let weight = |own: f64| if area > 0.0 { own / area } else { 1.0 / parts.len() as f64 };
    let mut centroid = [0.0; 3];
    for (own, point) in &parts {
        for (sum, value) in centroid.iter_mut().zip(point) {
            *sum += weight(*own) * value;
        }
    }
    centroid
}

/// The area and the centroid of each triangle of a mesh, or of the surface of another shape.
fn surface_parts(body: &Body) -> Vec<(f64, [f64; 3])> {
    let area = match &body.shape {
        Shape::Mesh(mesh) => {
            let part = |corners: [u32; 3]| {
                let corners = corners.map(|corner| body.pose.apply(mesh.vertices[corner as usize]));
                let [a, b, c] = corners;
                let mean = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
                (area_of(corners), mean)
            };
            return mesh.faces().map(part).collect();
        }
        Shape::Point => 0.0,
        Shape::Box { size: [x, y, z] } => 2.0 * (x * y + y * z + z * x),
        Shape::Sphere { radius } => 4.0 * PI * radius * radius,
        Shape::Cylinder { radius, height } => 2.0 * PI * radius * (radius + height),
        Shape::Capsule { radius, height } => 2.0 * PI * radius * (2.0 * radius + height),
    };
    vec![(area, body.pose.translation)]
}

fn area_of([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt() / 2.0
}
