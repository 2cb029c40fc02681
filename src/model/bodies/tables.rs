//! The tables of a problem file that describe rigid robots and obstacles, as they are written, before anything is
//! checked.

use super::validity::{BoundsMeaning, MotionChecking};
use crate::scene::WELD_SHARE;
use crate::space::BaseJoint;
use serde::Deserialize;
use std::path::PathBuf;

/// All of them; the other tables of the file are not looked at.
#[derive(Deserialize)]
pub(super) struct Tables {
    pub space: SpaceTable,
    pub robot: RobotTable,
    #[serde(default)]
    pub obstacles: Vec<BodyTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpaceTable {
    pub motion: BaseJoint,
    pub min: Vec<f64>,
    pub max: Vec<f64>,
    pub bounds: BoundsMeaning,
    pub resolution: Option<f64>,
    #[serde(default)]
    pub edges: MotionChecking,
    pub rotation_length: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RobotTable {
    pub name: Option<String>,
    pub urdf: Option<PathBuf>,
    #[serde(default)]
    pub bodies: Vec<BodyTable>,
    pub base: Option<FrameTable>,
    #[serde(default)]
    pub links: Vec<LinkTable>,
    #[serde(default)]
    pub may_touch: Vec<[String; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LinkTable {
    pub name: String,
    #[serde(default)]
    pub bodies: Vec<BodyTable>,
    pub joint: JointTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointTable {
    pub name: Option<String>,
    pub parent: Option<String>,
    pub kind: JointKindTable,
    #[serde(default)]
    pub before: FrameTable,
    #[serde(default)]
    pub after: FrameTable,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum JointKindTable {
    Fixed {},
    Spherical {},
    Revolute { axis: [f64; 3], degrees: Option<[f64; 2]>, radians: Option<[f64; 2]> },
    Prismatic { axis: [f64; 3], range: [f64; 2] },
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FrameTable {
    #[serde(default)]
    pub position: [f64; 3],
    pub orientation: Option<[f64; 4]>,
    pub turn: Option<TurnTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyTable {
    pub shape: ShapeTable,
    #[serde(default)]
    pub position: [f64; 3],
    pub orientation: Option<[f64; 4]>,
    pub turn: Option<TurnTable>,
    #[serde(default)]
    pub solid: Solid,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TurnTable {
    pub axis: [f64; 3],
    pub degrees: f64,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum ShapeTable {
    Point {},
    Box {
        size: [f64; 3],
    },
    Sphere {
        radius: f64,
    },
    Cylinder {
        radius: f64,
        height: f64,
    },
    Capsule {
        radius: f64,
        height: f64,
    },
    Mesh {
        file: PathBuf,
        #[serde(default = "one")]
        scale: f64,
        #[serde(default = "weld_share")]
        weld: f64,
    },
}

fn one() -> f64 {
    1.0
}

fn weld_share() -> f64 {
    WELD_SHARE
}

/// `"auto"`, `true` or `false`.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(from = "SolidWord")]
pub(super) enum Solid {
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
