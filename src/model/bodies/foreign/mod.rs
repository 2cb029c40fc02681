//! Scenes of other programs, OMPL.app's `.cfg` and Parasol's `.env`, `.robot` and `.query`, and robots,
//! URDF and SRDF, read into plain data in this crate's conventions.
//!
//! `docs/foreign.md` says what each reader takes and ignores. Whatever a file leaves open and a reader
//! decides is a line in [`ForeignScene::notes`].

mod bodies;
mod error;
mod frames;
mod ompl;
mod options;
mod parasol;
mod srdf;
mod urdf;

pub use error::ForeignError;
pub use ompl::read_ompl;
pub(crate) use options::SceneKind;
pub use options::{DhOrder, SceneOptions, Solidity, Unit};
pub use parasol::read_parasol;
pub(crate) use parasol::{is_parasol_path, read_parasol_path};
pub use srdf::{
    EndEffector, Group, GroupState, Member, Srdf, VirtualJoint, VirtualKind, read_srdf,
};
pub use urdf::{UrdfRobot, read_urdf};

use crate::digest::SourceFile;
use crate::model::bodies::validity::Bounds;
use crate::scene::{Body, Pose};
use crate::space::BaseJoint;
use std::path::PathBuf;

/// A scene: a robot, what stands in its way, where it may be, and where it is to go.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignScene {
    /// Its name: the file's own, or the file's without its extension.
    pub name: String,
    /// How the robot's first link moves.
    pub base: Base,
    /// The box that holds the robot, in the world's frame. Of planar robots z is 0 and not used.
    pub bounds: Bounds,
    /// The obstacles in the world's frame.
    pub obstacles: Vec<ForeignBody>,
    /// The robot's links: the base first, every other after its parent. A rigid robot has one.
    pub links: Vec<ForeignLink>,
    /// Pairs of links, the lower index first, that may touch although no joint joins them.
    pub may_touch: Vec<(usize, usize)>,
    /// Start and goal: the values of the base (none of a fixed one; `x y`, `x y theta`, `x y z` or
    /// `x y z qw qx qy qz`), then one value in radians per moving joint, in the order of the links.
    pub query: Option<(Vec<f64>, Vec<f64>)>,
    /// What the reader decided or passed over, for people to read.
    pub notes: Vec<String>,
    /// The files that it was read from, the one that names the others first.
    pub sources: Vec<SourceFile>,
}

/// How a robot's first link moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base {
    /// Not at all: the link's frame in the world's.
    Fixed(Pose),
    /// As a rigid body.
    Moving(BaseJoint),
}

/// A mesh at its place, and the file it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignBody {
    /// The body: an obstacle in the world's frame, or part of a link in the link's.
    pub body: Body,
    /// The mesh file.
    pub file: PathBuf,
    /// Triangles in the file, repeated and flat ones included.
    pub stored_triangles: usize,
    /// Triangles with three different corners, repeated ones counted once.
    pub unique_triangles: usize,
    /// Edges that an odd number of those share, flat triangles included: 0 for a closed surface.
    pub odd_edges: usize,
}

/// A link: bodies that move as one.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignLink {
    /// Its name.
    pub name: String,
    /// Its bodies; a link between the two turns of a spherical joint has none.
    pub bodies: Vec<ForeignBody>,
    /// What moves it; `None` of the base alone.
    pub joint: Option<ForeignJoint>,
}

/// A joint: the link's frame in its parent's is `before · motion(value) · after`.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignJoint {
    /// Its name.
    pub name: String,
    /// Index of the parent link, less than the link's own.
    pub parent: usize,
    /// How it moves.
    pub kind: ForeignJointKind,
    /// The joint's frame in the parent link's.
    pub before: Pose,
    /// The link's frame in the joint's as moved.
    pub after: Pose,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForeignJointKind {
    /// Not at all.
    Fixed,
    /// Turns about an axis through the joint's origin, by an angle in radians.
    Revolute {
        /// Unit vector in the joint's frame.
        axis: [f64; 3],
        /// Least angle.
        min: f64,
        /// Largest angle.
        max: f64,
    },
}
