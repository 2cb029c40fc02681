//! The problem file as it is written, before anything is checked.

use crate::connect::{AmongKind, ComponentPairs, Nearest, WithinKind};
use crate::evaluate::EvaluatorKind;
use crate::sampler::{SamplerKind, Uniform};
use crate::schedule::Adaptive;
use crate::space::Motion;
use crate::validity::{BoundsMeaning, Edges};
use serde::Deserialize;
use std::path::PathBuf;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    pub name: Option<String>,
    pub seed: Option<u64>,
    pub space: SpaceTable,
    pub robot: RobotTable,
    #[serde(default)]
    pub obstacles: Vec<BodyTable>,
    pub query: Option<QueryTable>,
    #[serde(default)]
    pub img: ImgTable,
    #[serde(default)]
    pub strategies: Vec<StrategyTable>,
    pub evaluators: Option<Vec<EvaluatorKind>>,
    #[serde(default)]
    pub limits: LimitsTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpaceTable {
    pub motion: Motion,
    pub min: Vec<f64>,
    pub max: Vec<f64>,
    pub bounds: BoundsMeaning,
    pub resolution: Option<f64>,
    #[serde(default)]
    pub edges: Edges,
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
    },
}

fn one() -> f64 {
    1.0
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QueryTable {
    pub start: Vec<f64>,
    pub goal: Vec<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImgTable {
    pub sets_per_round: Option<u64>,
    pub schedule: Option<ScheduleTable>,
}

/// Labels over and over, or a policy.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected an array of labels, or { adaptive = { rounds = … } }")]
pub(super) enum ScheduleTable {
    Labels(Vec<String>),
    Policy(PolicyTable),
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum PolicyTable {
    Adaptive(Adaptive),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StrategyTable {
    pub label: String,
    #[serde(default = "default_nodes")]
    pub nodes: u64,
    pub sampler: SamplerKind,
    #[serde(default = "default_within")]
    pub within: WithinKind,
    #[serde(default = "default_among")]
    pub among: AmongKind,
}

fn default_nodes() -> u64 {
    50
}

fn default_within() -> WithinKind {
    WithinKind::Nearest(Nearest::default())
}

fn default_among() -> AmongKind {
    AmongKind::ComponentPairs(ComponentPairs::default())
}

impl StrategyTable {
    /// The strategy of a problem that names none.
    pub fn uniform() -> StrategyTable {
        StrategyTable {
            label: "uniform".to_owned(),
            nodes: default_nodes(),
            sampler: SamplerKind::Uniform(Uniform::default()),
            within: default_within(),
            among: default_among(),
        }
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LimitsTable {
    pub nodes: Option<u64>,
    pub sets: Option<u64>,
    pub seconds: Option<f64>,
}
