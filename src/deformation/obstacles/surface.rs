//! Whether a closed surface is free of obstacles.

use super::{Obstacles, overlap};
use crate::deformation::SoftBody;
use crate::model::bodies::validity::{Inside, crossing};
use crate::scene::Mesh;
use parry3d_f64::math::Vector;

impl Obstacles {
    /// Whether a closed surface, with vertices in the world's frame and triangles as indices of vertices, is free: no triangle is
    /// nearer than `clearance` to an obstacle, no obstacle is within the surface, and no piece of it within a solid obstacle.
    pub fn is_free(&self, vertices: &[[f64; 3]], triangles: &[[u32; 3]], clearance: f64) -> bool {
        let mesh = || Mesh { vertices: vertices.to_vec(), triangles: triangles.to_vec() };
        self.surfaces_are_apart(vertices, triangles, clearance)
            && !mesh().witnesses().iter().any(|point| self.contains(*point))
            && !self.are_within(vertices, triangles)
    }

    /// The same of a shape of a robot, whose pieces are known already.
    pub fn is_free_body(&self, body: &SoftBody, vertices: &[[f64; 3]], clearance: f64) -> bool {
        let triangles = body.triangles();
        !body.witnesses().iter().any(|index| self.contains(vertices[*index as usize]))
            && self.surfaces_are_apart(vertices, triangles, clearance)
            && !self.are_within(vertices, triangles)
    }

    /// Whether no triangle is nearer than `clearance` to an obstacle's surface.
    fn surfaces_are_apart(
        &self,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        clearance: f64,
    ) -> bool {
        let (low, high) = bounding_box(vertices, triangles);
        let (margin, ..) = self.margin(&[low, high, low], clearance);
        // Obstacles are often all far away.
        self.tree.leaves(|node| overlap(node, low, high, margin)).next().is_none()
            || !triangles.iter().any(|corners| {
                self.is_near(corners.map(|corner| vertices[corner as usize]), clearance)
            })
    }

    /// Whether a piece of an obstacle is within a closed surface that meets none.
    fn are_within(&self, vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> bool {
        let (low, high) = bounding_box(vertices, triangles);
        let near = self.witnesses.iter().filter(|p| low.cmple(**p).all() && p.cmple(high).all());
        // Whether the surface is turned consistently, and how its pieces lie in one another, is looked at where counting does not tell.
        let mut inside: Option<Inside> = None;
        near.into_iter().any(|witness| {
            let (mut winding, mut crossings) = (0, 0);
            for corners in triangles {
                let corners = corners.map(|corner| vertices[corner as usize]);
                let crossed = crossing(&corners, witness.to_array());
                winding += crossed;
                crossings += crossed.abs();
            }
            match (winding, crossings) {
                (_, 0) => false,
                (_, odd) if odd % 2 == 1 => true,
                _ => inside
                    .get_or_insert_with(|| {
                        let (vertices, triangles) = (vertices.to_vec(), triangles.to_vec());
                        Inside::new(&Mesh { vertices, triangles })
                    })
                    .contains(*witness),
            }
        })
    }
}

fn bounding_box(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> (Vector, Vector) {
    let (mut low, mut high) = (Vector::INFINITY, Vector::NEG_INFINITY);
    for corner in triangles.iter().flatten() {
        let point = Vector::from_array(vertices[*corner as usize]);
        (low, high) = (low.min(point), high.max(point));
    }
    (low, high)
}
