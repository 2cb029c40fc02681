use super::raw::MeshError;
use super::{LENGTH_MAX, Mesh, obj, stl};
use std::path::Path;

/// Reads a `.obj` or `.stl` file and multiplies its coordinates by `scale`.
///
/// # Errors
/// Names the file and the line or byte: unreadable, cut off, an index out of range, a number that
/// is not finite, no face at all, or none with an area.
pub fn read_mesh(path: &Path, scale: f64) -> Result<Mesh, MeshError> {
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    let read = match extension.as_deref() {
        Some("obj") => obj::read,
        Some("stl") => stl::read,
        _ => {
            return Err(MeshError::whole(path, "unknown kind of mesh; .obj or .stl expected"));
        }
    };
    let bytes = std::fs::read(path)
        .map_err(|error| MeshError::whole(path, format!("cannot read the mesh: {error}")))?;
    let raw = read(path, &bytes)?;
    if raw.triangles.is_empty() {
        return Err(MeshError::whole(path, "no faces found; at least one triangle expected"));
    }
    let farthest = raw.vertices.iter().flatten().fold(0.0f64, |most, value| most.max(value.abs()));
    if farthest * scale > LENGTH_MAX {
        let message =
            format!("coordinates up to {farthest:e} found; at most {LENGTH_MAX:e} expected");
        return Err(MeshError::whole(path, message));
    }
    let found = raw.triangles.len();
    let mesh = Mesh::weld(raw, scale);
    if mesh.triangles.is_empty() {
        return Err(MeshError::whole(
            path,
            format!("all {found} triangles have zero area; at least one with an area expected"),
        ));
    }
    Ok(mesh)
}
