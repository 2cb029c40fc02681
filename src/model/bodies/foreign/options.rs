use crate::model::bodies::validity::BoundsMeaning;
use crate::scene::{Centre, Up};
use std::path::Path;

/// What is taken where a scene leaves a choice. `None` leaves it to the reader, whose decision is a
/// note of the scene that names the option.
#[derive(Clone, Copy, Debug, Default)]
pub struct SceneOptions<'a> {
    /// Parasol: the `.robot` file.
    pub robot: Option<&'a Path>,
    /// Parasol: the `.query` file.
    pub query: Option<&'a Path>,
    /// Whether the insides of meshes are material.
    pub solid: Option<Solidity>,
    /// What the bounds hold.
    pub bounds: Option<BoundsMeaning>,
    /// Which point of a mesh is its origin. Of an OMPL.app scene this is about the robot.
    pub origin: Option<Centre>,
    /// OMPL.app: whether meshes are turned to y up.
    pub up: Option<Up>,
    /// OMPL.app: whether lengths of meshes are converted.
    pub unit: Option<Unit>,
    /// Vertices at most this far apart, a length of the scene, are joined.
    pub weld: Option<f64>,
    /// Parasol: how the numbers of Denavit and Hartenberg are composed.
    pub dh: Option<DhOrder>,
    /// URDF: the `.srdf` file.
    pub srdf: Option<&'a Path>,
    /// URDF: the group of the `.srdf` file whose joints move.
    pub group: Option<&'a str>,
}

/// Whether the insides of meshes are material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solidity {
    /// Of closed ones.
    Auto,
    /// Of all; an open one is an error.
    Yes,
    /// Of none: all are mere surfaces.
    No,
}

/// The unit of a mesh's lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Metres, by what the file says of its unit.
    Metres,
    /// The file's own.
    AsStored,
}

/// The order in which the numbers of Denavit and Hartenberg act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DhOrder {
    /// Rz(theta) Tz(d) Tx(a) Rx(alpha), as in Parasol's present library.
    Standard,
    /// Rx(alpha) Tx(a) Rz(theta) Tz(d), as in its older ones.
    Modified,
}

/// A kind of files that leave choices open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SceneKind {
    /// OMPL.app's `.cfg`.
    Ompl,
    /// Parasol's `.env`.
    Parasol,
    /// URDF.
    Urdf,
    /// A problem file.
    Problem,
}

impl SceneOptions<'_> {
    /// The first option that was given and that files of the kind leave no room for.
    pub(crate) fn misplaced(&self, kind: SceneKind) -> Option<&'static str> {
        use SceneKind::{Ompl, Parasol, Urdf};
        let options: [(&'static str, bool, &[SceneKind]); 11] = [
            ("--robot", self.robot.is_some(), &[Parasol]),
            ("--query", self.query.is_some(), &[Parasol]),
            ("--solid", self.solid.is_some(), &[Ompl, Parasol]),
            ("--bounds", self.bounds.is_some(), &[Ompl, Parasol]),
            ("--origin", self.origin.is_some(), &[Ompl, Parasol]),
            ("--up", self.up.is_some(), &[Ompl]),
            ("--unit", self.unit.is_some(), &[Ompl]),
            ("--weld", self.weld.is_some(), &[Ompl, Parasol]),
            ("--dh", self.dh.is_some(), &[Parasol]),
            ("--srdf", self.srdf.is_some(), &[Urdf]),
            ("--group", self.group.is_some(), &[Urdf]),
        ];
        let misplaced =
            |(_, given, kinds): &&(&str, bool, &[SceneKind])| *given && !kinds.contains(&kind);
        options.iter().find(misplaced).map(|(name, _, _)| *name)
    }
}
