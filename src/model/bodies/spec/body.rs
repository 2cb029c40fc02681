use super::frame::{FrameSpec, TurnSpec};
use crate::scene::WELD_SHARE;
use serde::Deserialize;
use std::path::PathBuf;

/// A shape and where it stands: an obstacle in the world's frame, or a part of a link in the link's.
///
/// ```
/// use roadmill::model::bodies::{BodySpec, ShapeSpec};
///
/// let tetrahedron = ShapeSpec::triangles(
///     vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
/// );
/// let body = BodySpec::new(tetrahedron).at([2.0, 0.0, 0.0]).turn([0.0, 0.0, 1.0], 90.0).solid(true);
/// # let _ = body;
/// ```
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodySpec {
    pub(in crate::model::bodies) shape: ShapeSpec,
    // The keys of a frame stand among those of the body, so that a key of neither is found out.
    #[serde(default)]
    position: [f64; 3],
    orientation: Option<[f64; 4]>,
    turn: Option<TurnSpec>,
    #[serde(default)]
    pub(in crate::model::bodies) solid: Solid,
}

impl BodySpec {
    /// A shape that stands at the origin of the frame it is given in.
    pub fn new(shape: ShapeSpec) -> BodySpec {
        BodySpec {
            shape,
            position: [0.0; 3],
            orientation: None,
            turn: None,
            solid: Solid::default(),
        }
    }

    /// The shape.
    pub fn shape(&self) -> &ShapeSpec {
        &self.shape
    }

    /// Another shape in the same place.
    pub fn shaped(self, shape: ShapeSpec) -> BodySpec {
        BodySpec { shape, ..self }
    }

    /// Puts the shape's origin at a position `x y z`, lengths.
    pub fn at(self, position: [f64; 3]) -> BodySpec {
        BodySpec { position, ..self }
    }

    /// Turns the shape by a quaternion `w x y z` of any length but zero.
    pub fn orientation(self, orientation: [f64; 4]) -> BodySpec {
        BodySpec { orientation: Some(orientation), ..self }
    }

    /// Turns the shape by so many degrees about an axis. It takes the place of an orientation: of the two, one may be
    /// given.
    pub fn turn(self, axis: [f64; 3], degrees: f64) -> BodySpec {
        BodySpec { turn: Some(TurnSpec { axis, degrees }), ..self }
    }

    /// Says whether the inside of a mesh is material too. If nothing is said, it is where the mesh is closed. Other
    /// shapes always are solid.
    pub fn solid(self, solid: bool) -> BodySpec {
        BodySpec { solid: if solid { Solid::Yes } else { Solid::No }, ..self }
    }

    pub(in crate::model::bodies) fn frame(&self) -> FrameSpec {
        let (position, orientation) = (self.position, self.orientation);
        FrameSpec { position, orientation, turn: self.turn.clone() }
    }
}

impl From<ShapeSpec> for BodySpec {
    fn from(shape: ShapeSpec) -> BodySpec {
        BodySpec::new(shape)
    }
}

/// A shape in its own frame.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ShapeSpec {
    /// The origin alone: a robot without extent.
    Point {},
    /// A box centred on the origin.
    Box {
        /// Edge lengths along x, y and z.
        size: [f64; 3],
    },
    /// A ball centred on the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A cylinder about the z axis, centred on the origin.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Length along z.
        height: f64,
    },
    /// A cylinder about the z axis with a half ball on either end, centred on the origin.
    Capsule {
        /// Its radius.
        radius: f64,
        /// Length along z without the half balls.
        height: f64,
    },
    /// The triangles of a file.
    Mesh {
        /// The file: `.obj`, `.stl`, `.ply`, `.dae` or `.g`. A relative path starts from the folder of the problem file,
        /// or from what [`ProblemBuilder::folder`](crate::problem::ProblemBuilder::folder) says.
        file: PathBuf,
        /// What coordinates are multiplied by.
        #[serde(default = "one")]
        scale: f64,
        /// The share of the mesh's size that vertices may be apart and be one, where that closes the surface; 0 for
        /// none, at most 0.01.
        #[serde(default = "weld_share")]
        weld: f64,
    },
    /// Triangles in memory, which become what a file with the same ones would: equal vertices are joined, flat and
    /// repeated triangles dropped.
    #[serde(skip)]
    Triangles {
        /// Vertices `x y z`.
        vertices: Vec<[f64; 3]>,
        /// Corners of the triangles: indices of vertices, the first of which is 0.
        triangles: Vec<[u32; 3]>,
        /// What coordinates are multiplied by.
        scale: f64,
        /// As of [`ShapeSpec::Mesh`].
        weld: f64,
    },
}

impl ShapeSpec {
    /// The triangles of a file, as [`ShapeSpec::Mesh`] with scale 1.
    pub fn mesh_file(file: impl Into<PathBuf>) -> ShapeSpec {
        ShapeSpec::Mesh { file: file.into(), scale: one(), weld: weld_share() }
    }

    /// Triangles in memory, as [`ShapeSpec::Triangles`] with scale 1.
    pub fn triangles(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> ShapeSpec {
        ShapeSpec::Triangles { vertices, triangles, scale: one(), weld: weld_share() }
    }
}

fn one() -> f64 {
    1.0
}

fn weld_share() -> f64 {
    WELD_SHARE
}

/// `"auto"`, `true` or `false`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(from = "SolidWord")]
pub(in crate::model::bodies) enum Solid {
    #[default]
    Auto,
    Yes,
    No,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected \"auto\", true or false")]
enum SolidWord {
    Flag(bool),
    Word(AutoWord),
}

#[derive(Deserialize)]
enum AutoWord {
    #[serde(rename = "auto")]
    Auto,
}

impl From<SolidWord> for Solid {
    fn from(word: SolidWord) -> Solid {
        match word {
            SolidWord::Flag(true) => Solid::Yes,
            SolidWord::Flag(false) => Solid::No,
            SolidWord::Word(AutoWord::Auto) => Solid::Auto,
        }
    }
}
