//! Bodies: shapes with poses, and the files that meshes come from.
//!
//! Lengths are in the scene's own unit, whatever it is; nothing in roadmill converts units.
//! Rotations are unit quaternions `w x y z`; a pose maps body coordinates to the frame it is
//! given in: `p ↦ rotation · p + translation`.

mod byu;
mod closing;
mod collada;
mod mesh;
mod obj;
mod ply;
mod polygon;
mod pose;
mod raw;
mod read;
mod shape;
mod stl;
mod tessellate;
mod weld;
#[cfg(test)]
mod weld_tests;

pub use mesh::Mesh;
pub(crate) use mesh::tetrahedron;
pub use pose::Pose;
pub use raw::{MESH_ITEMS_MAX, MeshError, UpAxis};
pub use read::{Centre, MeshOptions, ReadMesh, Up, is_mesh_file, read_mesh, read_mesh_with};
pub use shape::{Shape, box_surface};
pub(crate) use tessellate::{Surface, tessellate};
pub use weld::{WELD_SHARE, Weld};

use bincode::{Decode, Encode};

/// The largest length or coordinate that a scene may have: far beyond any use, and small enough for
/// its powers to stay finite.
pub const LENGTH_MAX: f64 = 1e30;

/// A shape at a pose: an obstacle in the world's frame, or a part of the robot in the robot's.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Body {
    /// The shape in its own frame.
    pub shape: Shape,
    /// Where it stands.
    pub pose: Pose,
    /// Whether its inside is material too. Primitives always are; a mesh may be a mere surface.
    pub solid: bool,
}
