use crate::scene::{Mesh, tetrahedron};

/// The robot at rest, as one surface of triangles in its own frame. The surface is closed; it may have several pieces, each of which is
/// turned so that its triangles are seen counter-clockwise from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SoftBody {
    mesh: Mesh,
    /// A vertex of each piece.
    witnesses: Vec<u32>,
}

impl SoftBody {
    /// A robot with this surface. Pieces that are turned inside out are turned.
    ///
    /// # Errors
    /// The surface has no triangles, is not closed, or neighbouring triangles of it are not turned the same way.
    pub fn new(mesh: Mesh) -> Result<SoftBody, String> {
        if mesh.triangles.is_empty() {
            return Err("a surface without triangles found; a closed mesh expected".to_owned());
        }
        if let Some(complaint) = mesh.surface_complaint() {
            return Err(complaint);
        }
        let mesh = turned_outward(mesh);
        Ok(SoftBody { witnesses: mesh.first_vertices(), mesh })
    }

    /// The first vertex of each piece of the surface, by its number.
    pub fn witnesses(&self) -> &[u32] {
        &self.witnesses
    }

    /// The vertices at rest, in the robot's frame.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.mesh.vertices
    }

    /// Corners of the triangles: indices of vertices. They are the same for every shape.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.mesh.triangles
    }

    /// The surface at rest.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The volume that a shape with these vertices encloses: the sum of the volumes of its pieces, also of one that is a cavity of another. By
    /// the signed volumes of the triangles' tetrahedra with the first vertex; the absolute value of their sum.
    pub fn volume(&self, vertices: &[[f64; 3]]) -> f64 {
        let at = |corner: u32| vertices[corner as usize];
        let sum: f64 =
            self.triangles().iter().map(|corners| tetrahedron(vertices[0], corners.map(at))).sum();
        (sum / 6.0).abs()
    }
}

/// The mesh with every piece turned whose signed volume is negative.
fn turned_outward(mut mesh: Mesh) -> Mesh {
    let (pieces, volumes) = (mesh.pieces(), mesh.volumes());
    for corners in &mut mesh.triangles {
        if pieces[corners[0] as usize].is_some_and(|piece| volumes[piece] < 0.0) {
            corners.swap(1, 2);
        }
    }
    mesh
}
