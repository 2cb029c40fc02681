use crate::scene::Mesh;

/// The robot at rest, as one surface of triangles in its own frame. The surface is closed; it may have several pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct SoftBody {
    mesh: Mesh,
}

impl SoftBody {
    /// A robot with this surface.
    ///
    /// # Errors
    /// The surface has no triangles, or is not closed.
    pub fn new(mesh: Mesh) -> Result<SoftBody, String> {
        if mesh.triangles.is_empty() {
            return Err("a surface without triangles found; a closed mesh expected".to_owned());
        }
        match mesh.odd_edges() {
            0 => Ok(SoftBody { mesh }),
            open => Err(format!("a mesh with {open} open edges found; a closed mesh expected")),
        }
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

    /// The volume that a shape with these vertices encloses, by the signed volumes of its triangles' tetrahedra with the first
    /// vertex; its absolute value.
    pub fn volume(&self, vertices: &[[f64; 3]]) -> f64 {
        let origin = vertices[0];
        let from = |corner: u32| {
            let point = vertices[corner as usize];
            [0, 1, 2].map(|axis| point[axis] - origin[axis])
        };
        let mut sum = 0.0;
        for [a, b, c] in self.triangles() {
            let (a, b, c) = (from(*a), from(*b), from(*c));
            sum += a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
        (sum / 6.0).abs()
    }
}
