use crate::scene::Mesh;

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

/// The mesh with every piece turned whose signed volume is negative.
fn turned_outward(mut mesh: Mesh) -> Mesh {
    let pieces = mesh.pieces();
    let piece_of = |corners: &[u32; 3]| pieces[corners[0] as usize].unwrap_or_default();
    let count = pieces.iter().flatten().max().map_or(0, |last| last + 1);
    let mut volumes = vec![0.0; count];
    // Tetrahedra have a corner of the piece in common, so that little is lost to rounding far from the origin.
    let mut origins: Vec<Option<[f64; 3]>> = vec![None; count];
    for corners in &mesh.triangles {
        let piece = piece_of(corners);
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        let origin = *origins[piece].get_or_insert(a);
        let [a, b, c] = [a, b, c].map(|point| [0, 1, 2].map(|axis| point[axis] - origin[axis]));
        volumes[piece] += a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    for corners in &mut mesh.triangles {
        if volumes[piece_of(corners)] < 0.0 {
            corners.swap(1, 2);
        }
    }
    mesh
}
