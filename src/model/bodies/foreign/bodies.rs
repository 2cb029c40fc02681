//! Mesh files as bodies.

use super::{ForeignBody, ForeignError, SceneOptions, Solidity};
use crate::digest::SourceFile;
use crate::model::bodies::shapes::found;
use crate::scene::{
    Body, MESH_ITEMS_MAX, MeshOptions, Pose, ReadMesh, Shape, WELD_SHARE, Weld, read_mesh_with,
};
use std::path::{Path, PathBuf};

/// Vertices nearer than this are one, a length of the scene. Exporters write six decimals, and some
/// write the same corner differently in the last.
const WELD: f64 = 1e-6;

/// A mesh file as the scene names it.
pub(super) struct Named<'a> {
    /// The scene file.
    pub scene: &'a Path,
    /// Its line.
    pub line: usize,
    /// The mesh file as written.
    pub file: &'a str,
}

impl Named<'_> {
    /// Where the file is: relative names start from the scene file's folder.
    pub fn path(&self) -> PathBuf {
        self.scene.parent().unwrap_or(Path::new("")).join(self.file)
    }

    pub fn error(&self, message: impl Into<String>) -> ForeignError {
        ForeignError::line(self.scene, self.line, message)
    }
}

/// Reads mesh files and counts what they come to.
pub(super) struct Meshes {
    triangles: usize,
    weld: Weld,
    /// The files read.
    pub sources: Vec<SourceFile>,
}

impl Meshes {
    pub fn new(options: &SceneOptions, notes: &mut Vec<String>) -> Meshes {
        let weld = options.weld.unwrap_or(WELD);
        notes.push(format!("vertices at most {weld:e} apart joined (--weld)"));
        Meshes { triangles: 0, weld: Weld::Length(weld), sources: Vec::new() }
    }

    /// Joins equal vertices, and others where that closes a mesh, as problem files do.
    pub fn as_stored() -> Meshes {
        Meshes { triangles: 0, weld: Weld::ToClose(WELD_SHARE), sources: Vec::new() }
    }

    /// Reads a mesh; the body stands at `pose`.
    pub fn body(
        &mut self,
        named: &Named,
        options: &MeshOptions,
        pose: Pose,
        solid: Solidity,
    ) -> Result<(ForeignBody, ReadMesh), ForeignError> {
        let file = named.path();
        let options = MeshOptions { weld: self.weld, ..*options };
        let read = read_mesh_with(&file, &options)
            .map_err(|error| ForeignError::mesh(error, named.scene, named.line))?;
        let source = SourceFile { path: named.file.to_owned(), digest: read.digest };
        if !self.sources.contains(&source) {
            self.sources.push(source);
        }
        // One line may name a large mesh, and many lines the same one.
        self.triangles += read.stored_triangles;
        if self.triangles > MESH_ITEMS_MAX {
            let message = format!("the scene's meshes have more than {MESH_ITEMS_MAX} triangles");
            return Err(named.error(message));
        }
        if solid == Solidity::Yes && read.odd_edges > 0 {
            let message = format!(
                "--solid yes, but {} is not closed ({} edges belong to an odd number of triangles)",
                file.display(),
                read.odd_edges
            );
            return Err(named.error(message));
        }
        let solid = solid != Solidity::No && read.odd_edges == 0;
        let body = Body { shape: Shape::Mesh(read.mesh.clone()), pose, solid };
        let counts = [read.stored_triangles, read.unique_triangles, read.odd_edges];
        let [stored_triangles, unique_triangles, odd_edges] = counts;
        Ok((ForeignBody { body, file, stored_triangles, unique_triangles, odd_edges }, read))
    }
}

/// Whether a mesh came to be solid, and why.
pub(super) fn why_solid(body: &Body, read: &ReadMesh, asked: Option<Solidity>) -> String {
    let solid = body.solid;
    match asked {
        Some(Solidity::Yes | Solidity::No) => format!("solid = {solid}, as asked"),
        _ => format!("solid = {solid}, as {} (--solid)", found(read.odd_edges, read.pairs)),
    }
}
