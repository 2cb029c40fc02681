use super::raw::{MeshError, RawMesh, UpAxis};
use super::weld::{Weld, Welded};
use super::{LENGTH_MAX, Mesh, byu, collada, obj, ply, stl};
use crate::digest::Digest;
use crate::source::read_file;
use std::path::Path;

/// Which point of a mesh becomes the origin of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Centre {
    /// The file's own origin.
    #[default]
    AsStored,
    /// The mean of the vertices as the file stores them, before equal ones are joined. Of a COLLADA
    /// file, the vertices as its importers store them: apart where normals differ, once for every
    /// group of triangles or lines that uses them.
    VertexMean,
}

/// Whether a file that says which way is up is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Up {
    /// Coordinates stay as they are.
    #[default]
    AsStored,
    /// Turned to y up as importers do: z up (x, y, z) becomes (x, z, −y), x up (−y, x, z).
    Y,
}

/// How a mesh file is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshOptions {
    /// What coordinates are multiplied by along x, y and z, after the mesh has been turned and centred.
    /// Negative factors mirror.
    pub scale: [f64; 3],
    /// Which vertices are one.
    pub weld: Weld,
    /// The origin.
    pub centre: Centre,
    /// The turn.
    pub up: Up,
}

impl Default for MeshOptions {
    fn default() -> MeshOptions {
        let weld = Weld::Length(0.0);
        MeshOptions { scale: [1.0; 3], weld, centre: Centre::AsStored, up: Up::AsStored }
    }
}

/// A mesh, and what is to be known of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadMesh {
    /// The mesh.
    pub mesh: Mesh,
    /// Triangles in the file, repeated and flat ones included.
    pub stored_triangles: usize,
    /// Triangles with three different corners once near vertices are joined, repeated ones counted once.
    pub unique_triangles: usize,
    /// Edges that an odd number of those share: 0 for a closed surface.
    pub odd_edges: usize,
    /// Pairs of triangles with the same corners that the mesh keeps: walls with material on either side.
    pub pairs: usize,
    /// Where vertices that are not equal had to be joined to close the surface ([`Weld::ToClose`]): how far apart
    /// such vertices are at most, a length, and how many edges are open if equal ones only are joined.
    pub closed_by: Option<(f64, usize)>,
    /// The mean that became the origin, in the file's unit (after the turn); zero where it was not
    /// asked for.
    pub centre: [f64; 3],
    /// Which way is up, where the file says so.
    pub up: Option<UpAxis>,
    /// Metres per unit of length, where the file says so. Nothing is converted.
    pub unit_metres: Option<f64>,
    /// Digest of the file's bytes.
    pub digest: Digest,
}

/// Reads a `.obj`, `.stl`, `.ply`, `.dae` or `.g` file and multiplies its coordinates by `scale`.
///
/// # Errors
/// Names the file and the line or byte: unreadable, cut off, an index out of range, a number that
/// is not finite, no face at all, or none with an area.
pub fn read_mesh(path: &Path, scale: f64) -> Result<Mesh, MeshError> {
    let options = MeshOptions { scale: [scale; 3], ..MeshOptions::default() };
    read_mesh_with(path, &options).map(|read| read.mesh)
}

/// Reads a mesh file by its extension, which is one of those of [`read_mesh`].
///
/// # Errors
/// As [`read_mesh`].
pub fn read_mesh_with(path: &Path, options: &MeshOptions) -> Result<ReadMesh, MeshError> {
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    let read = match extension.as_deref() {
        Some("obj") => obj::read,
        Some("stl") => stl::read,
        Some("ply") => ply::read,
        Some("dae") => collada::read,
        Some("g") => byu::read,
        _ => {
            let message = "unknown kind of mesh; .obj, .stl, .ply, .dae or .g expected";
            return Err(MeshError::whole(path, message));
        }
    };
    let bytes = read_file(path)
        .map_err(|error| MeshError::whole(path, format!("cannot read the mesh: {error}")))?;
    finish(path, read(path, &bytes)?, options, Digest::of(&bytes))
}

fn finish(
    path: &Path,
    mut raw: RawMesh,
    options: &MeshOptions,
    digest: Digest,
) -> Result<ReadMesh, MeshError> {
    if raw.triangles.is_empty() {
        return Err(MeshError::whole(path, "no faces found; at least one triangle expected"));
    }
    let scale = options.scale.iter().fold(0.0f64, |most, factor| most.max(factor.abs()));
    check_size(path, &raw, scale)?;
    if options.up == Up::Y {
        turn_to_y_up(&mut raw);
    }
    let mut centre = [0.0; 3];
    if options.centre == Centre::VertexMean {
        check_size(path, &raw, 1.0)?;
        centre = mean(&raw.vertices);
        for vertex in &mut raw.vertices {
            *vertex = [0, 1, 2].map(|axis| vertex[axis] - centre[axis]);
        }
        check_size(path, &raw, scale)?;
    }
    let stored_triangles = raw.triangles.len();
    let (up, unit_metres) = (raw.up, raw.unit_metres);
    let welded = Mesh::weld(&raw, options.scale, options.weld);
    let Welded { mesh, unique_triangles, odd_edges, pairs, closed_by } = welded;
    if mesh.triangles.is_empty() {
        let message = format!(
            "all {stored_triangles} triangles have zero area; at least one with an area expected"
        );
        return Err(MeshError::whole(path, message));
    }
    Ok(ReadMesh {
        mesh,
        stored_triangles,
        unique_triangles,
        odd_edges,
        pairs,
        closed_by,
        centre,
        up,
        unit_metres,
        digest,
    })
}

fn check_size(path: &Path, raw: &RawMesh, scale: f64) -> Result<(), MeshError> {
    let farthest = raw.vertices.iter().flatten().fold(0.0f64, |most, value| most.max(value.abs()));
    if farthest * scale > LENGTH_MAX {
        let message =
            format!("coordinates up to {farthest:e} found; at most {LENGTH_MAX:e} expected");
        return Err(MeshError::whole(path, message));
    }
    Ok(())
}

fn turn_to_y_up(raw: &mut RawMesh) {
    for [x, y, z] in &mut raw.vertices {
        (*x, *y, *z) = match raw.up {
            Some(UpAxis::Z) => (*x, *z, -*y),
            Some(UpAxis::X) => (-*y, *x, *z),
            Some(UpAxis::Y) | None => (*x, *y, *z),
        };
    }
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for point in points {
        for axis in 0..3 {
            sum[axis] += point[axis];
        }
    }
    sum.map(|total| total / points.len() as f64)
}
