//! What a problem asks of a deformable robot, before anything is checked.

use super::settings::{BoundingBoxSettings, GeometricSettings};
use crate::model::ScaleCentre;
use crate::model::bodies::BodiesSpec;
use crate::source::{ProblemError, Source};
use serde::{Deserialize, Deserializer};

/// A deformable robot among rigid obstacles, as a problem asks for it: the tables of bodies and the table `[deformable]`,
/// which `docs/deformable.md` describes. Nothing is checked before the problem is built.
#[derive(Clone, Debug, PartialEq)]
pub struct DeformableSpec {
    pub(super) bodies: BodiesSpec,
    pub(super) table: Table,
}

impl DeformableSpec {
    /// These bodies, with a robot that gives way: free at one of six scales from 1 to 0.5 while the roadmap is built, and
    /// deformed by its bounding box later.
    pub fn new(bodies: BodiesSpec) -> DeformableSpec {
        DeformableSpec { bodies, table: Table::default() }
    }

    /// How the rigid robot may collide while the roadmap is built.
    pub fn feasibility(mut self, feasibility: FeasibilitySpec) -> DeformableSpec {
        self.table.feasibility = feasibility;
        self
    }

    /// By which method shapes are deformed.
    pub fn method(mut self, method: MethodSpec) -> DeformableSpec {
        self.table.method = method;
        self
    }

    /// The highest energy of a shape that is accepted, a length. If nothing is said, it is infinite.
    pub fn highest_energy(mut self, energy: f64) -> DeformableSpec {
        self.table.highest_energy = Some(energy);
        self
    }

    /// The least distance between an accepted shape and the obstacles, a length. If nothing is said, it is a quarter of the
    /// resolution.
    pub fn clearance(mut self, length: f64) -> DeformableSpec {
        self.table.clearance = Some(length);
        self
    }

    /// The farthest that a vertex of the shape may move from one frame of a path to the next, a length. If nothing is said, it
    /// is the resolution.
    pub fn step(mut self, length: f64) -> DeformableSpec {
        self.table.step = Some(length);
        self
    }

    /// The longest that edges of the robot's triangles are: longer ones are split. If nothing is said, it is a 16th of the
    /// longest edge of the robot's bounding box.
    pub fn longest_edge(mut self, length: f64) -> DeformableSpec {
        self.table.longest_edge = Some(length);
        self
    }

    /// Changes what is asked of the bodies.
    pub fn change_bodies(self, change: impl FnOnce(BodiesSpec) -> BodiesSpec) -> DeformableSpec {
        DeformableSpec { bodies: change(self.bodies), ..self }
    }
}

/// The table `[deformable]`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Table {
    pub feasibility: FeasibilitySpec,
    pub method: MethodSpec,
    #[serde(deserialize_with = "energy")]
    pub highest_energy: Option<f64>,
    pub clearance: Option<f64>,
    pub step: Option<f64>,
    pub longest_edge: Option<f64>,
}

/// How the rigid robot may collide while the roadmap is built, as a problem asks for it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "FeasibilityKeys")]
pub enum FeasibilitySpec {
    /// As far as a smaller robot is free.
    Scaled {
        /// Which smaller robots there are.
        scales: Scales,
        /// The point of the robot's frame that stays in its place.
        centre: ScaleCentre,
    },
    /// As far as a short motion would free it.
    Penetrating {
        /// The length of the longest motion, in the metric of the space.
        depth: f64,
        /// How many motions are tried.
        vectors: u32,
    },
}

/// The scales of a ladder.
#[derive(Clone, Debug, PartialEq)]
pub enum Scales {
    /// These, from 1 down.
    Listed(Vec<f64>),
    /// So many, evenly spaced from 1 to the least.
    Even {
        /// How many there are.
        count: u32,
        /// The least of them.
        least: f64,
    },
}

/// The least scale of an even ladder, unless the problem says otherwise.
const LEAST: f64 = 0.5;
/// The number of random vectors, unless the problem says otherwise; that of the paper (§4.2).
const VECTORS: u32 = 20;

impl Default for FeasibilitySpec {
    fn default() -> FeasibilitySpec {
        let scales = Scales::Even { count: 6, least: LEAST };
        FeasibilitySpec::Scaled { scales, centre: ScaleCentre::Centroid }
    }
}

/// The keys of feasibility in a problem file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FeasibilityKeys {
    scales: Option<ScalesKey>,
    least: Option<f64>,
    centre: Option<ScaleCentre>,
    depth: Option<f64>,
    vectors: Option<u32>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected the number of scales, or a list of them")]
enum ScalesKey {
    Count(u32),
    Listed(Vec<f64>),
}

impl TryFrom<FeasibilityKeys> for FeasibilitySpec {
    type Error = &'static str;

    fn try_from(keys: FeasibilityKeys) -> Result<FeasibilitySpec, &'static str> {
        let (scales, least, centre) = match keys {
            FeasibilityKeys {
                scales: None,
                least: None,
                centre: None,
                depth: Some(depth),
                vectors,
            } => {
                let vectors = vectors.unwrap_or(VECTORS);
                return Ok(FeasibilitySpec::Penetrating { depth, vectors });
            }
            FeasibilityKeys { scales: Some(scales), least, centre, depth: None, vectors: None } => {
                (scales, least, centre)
            }
            _ => {
                return Err(
                    "`scales`, with `least` and `centre` if need be, expected, or `depth`, with `vectors` if need be",
                );
            }
        };
        let scales = match (scales, least) {
            (ScalesKey::Count(count), least) => {
                Scales::Even { count, least: least.unwrap_or(LEAST) }
            }
            (ScalesKey::Listed(scales), None) => Scales::Listed(scales),
            (ScalesKey::Listed(_), Some(_)) => {
                return Err("`least` found beside a list of scales; the number of scales expected");
            }
        };
        Ok(FeasibilitySpec::Scaled { scales, centre: centre.unwrap_or_default() })
    }
}

/// By which method shapes are deformed, as a problem asks for it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MethodSpec {
    /// A lattice around the robot is deformed, and the robot with it.
    BoundingBox(BoundingBoxSettings),
    /// The triangles that collide are moved.
    Geometric(GeometricSpec),
}

impl Default for MethodSpec {
    fn default() -> MethodSpec {
        MethodSpec::BoundingBox(BoundingBoxSettings::default())
    }
}

/// What is asked of the deformation of triangles: [`GeometricSettings`], but that the neighbourhood may be left open.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GeometricSpec {
    /// See [`GeometricSettings::directions`]; 12 if nothing is said.
    pub directions: u32,
    /// See [`GeometricSettings::shortest`]; 0.3 if nothing is said.
    pub shortest: f64,
    /// See [`GeometricSettings::longest`]; 3 if nothing is said.
    pub longest: f64,
    /// See [`GeometricSettings::neighbourhood`]. If nothing is said, it is a quarter of the longest edge of the robot's
    /// bounding box.
    pub neighbourhood: Option<f64>,
    /// See [`GeometricSettings::guide`]; 0.5 if nothing is said.
    pub guide: f64,
    /// See [`GeometricSettings::rounds`]; 50 if nothing is said.
    pub rounds: u32,
    /// See [`GeometricSettings::refuse_self_collisions`]; such shapes are refused if nothing is said.
    pub refuse_self_collisions: bool,
}

impl Default for GeometricSpec {
    fn default() -> GeometricSpec {
        GeometricSpec {
            directions: 12,
            shortest: 0.3,
            longest: 3.0,
            neighbourhood: None,
            guide: 0.5,
            rounds: 50,
            refuse_self_collisions: true,
        }
    }
}

impl From<GeometricSettings> for GeometricSpec {
    fn from(settings: GeometricSettings) -> GeometricSpec {
        let GeometricSettings {
            directions,
            shortest,
            longest,
            neighbourhood,
            guide,
            rounds,
            refuse_self_collisions,
        } = settings;
        let neighbourhood = Some(neighbourhood);
        GeometricSpec {
            directions,
            shortest,
            longest,
            neighbourhood,
            guide,
            rounds,
            refuse_self_collisions,
        }
    }
}

/// An energy as a problem file writes it.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected an energy, or \"none\"")]
enum EnergyKey {
    Highest(f64),
    Word(NoLimit),
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum NoLimit {
    None,
}

fn energy<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    EnergyKey::deserialize(deserializer).map(|key| match key {
        EnergyKey::Highest(energy) => Some(energy),
        EnergyKey::Word(NoLimit::None) => Some(f64::INFINITY),
    })
}

#[derive(Deserialize)]
struct Tables {
    deformable: Table,
}

/// Reads the tables.
pub(super) fn read(source: &Source) -> Result<DeformableSpec, ProblemError> {
    let Tables { deformable: table } = source.tables()?;
    Ok(DeformableSpec { bodies: source.tables()?, table })
}
