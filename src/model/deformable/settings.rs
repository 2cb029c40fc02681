//! What of a deformable robot a problem says, beside the bodies themselves: plain data.

use bincode::{Decode, Encode};
use serde::{Deserialize, Deserializer, Serialize};

/// How the rigid robot may collide while the roadmap is built, so that a path of the roadmap can be deformed into a free one
/// (Bayazit, Lien and Amato, *Probabilistic Roadmap Motion Planning for Deformable Objects*, ICRA 2002, §4).
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub enum Feasibility {
    /// A configuration is feasible if the robot is free there at one of these scales (§4.1).
    Scaled {
        /// Factors of the robot's size, from the largest down, each above 0 and at most 1. The first is 1: the robot itself.
        scales: Vec<f64>,
        /// The point that stays in its place, in the robot's frame.
        centre: [f64; 3],
    },
    /// A configuration is feasible if the robot is free there, or at the end of one of `vectors` random vectors of the
    /// configuration space that start there (§4.2).
    Penetrating {
        /// The length of the longest vector, in the metric of the space.
        depth: f64,
        /// How many vectors are tried.
        vectors: u32,
    },
}

/// How a query deforms the robot.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct DeformationSettings {
    /// By which method shapes are deformed.
    pub method: DeformationMethod,
    /// The highest energy of a shape that is accepted, a length; it may be infinite. What the energy is, the method says.
    pub highest_energy: f64,
    /// The least distance between an accepted shape and the obstacles, a length. Where it is above 0 the motion between two
    /// frames is proved free; where it is 0 shapes are free at the frames, and nothing is promised between them.
    pub clearance: f64,
    /// The farthest that any vertex of the shape may move, in the world's frame, from one frame of a path to the next, a length.
    pub step: f64,
}

/// The two ways of deforming a robot (§6).
#[derive(Clone, Debug, PartialEq, Serialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum DeformationMethod {
    /// A lattice around the robot is deformed, and the robot with it (§6.1).
    BoundingBox(BoundingBoxSettings),
    /// The triangles that collide are moved (§6.2).
    Geometric(GeometricSettings),
}

/// Deformation of the lattice that fills the robot's bounding box: ChainMail, then free-form deformation (§6.1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct BoundingBoxSettings {
    /// Points of the lattice along x, y and z of the robot's frame, each at least 2; `13 × 9 × 7` in the paper.
    #[serde(deserialize_with = "per_axis")]
    pub lattice: [u32; 3],
    /// The least distance of neighbouring points along each axis, as a share of their distance at rest: above 0, at most 1.
    #[serde(deserialize_with = "per_axis")]
    pub least: [f64; 3],
    /// The greatest distance of neighbouring points along each axis, as a share of their distance at rest: at least 1.
    #[serde(deserialize_with = "per_axis")]
    pub greatest: [f64; 3],
    /// How far neighbouring points may be displaced against one another along the two other axes, as a share of the
    /// distance at rest: at least 0.
    pub shear: f64,
    /// In which order movements are propagated.
    pub order: ChainMailOrder,
    /// How many sweeps of elastic relaxation follow.
    pub relaxation: u32,
    /// How points of the robot follow the lattice.
    pub interpolation: LatticeInterpolation,
}

impl Default for BoundingBoxSettings {
    fn default() -> BoundingBoxSettings {
        BoundingBoxSettings {
            lattice: [13, 9, 7],
            least: [0.5; 3],
            greatest: [1.5; 3],
            shear: 0.5,
            order: ChainMailOrder::Queue,
            relaxation: 10,
            interpolation: LatticeInterpolation::Trilinear,
        }
    }
}

/// One number for all axes, or one for each.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number, or three for x, y and z")]
enum PerAxis<T> {
    Same(T),
    Each([T; 3]),
}

fn per_axis<'de, D: Deserializer<'de>, T: Deserialize<'de> + Copy>(
    deserializer: D,
) -> Result<[T; 3], D::Error> {
    PerAxis::deserialize(deserializer).map(|given| match given {
        PerAxis::Same(value) => [value; 3],
        PerAxis::Each(values) => values,
    })
}

/// In which order ChainMail propagates movements. The accepted shape is the same with either.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum ChainMailOrder {
    /// By a queue, first in, first out: the paper's algorithm, after Gibson (1997).
    Queue,
    /// By breadth-first search from every pushed point, and then the points first that most of the searches came to, so that
    /// what cannot be deformed is refused early: the revised algorithm of Bayazit's dissertation (2003), chapter VI D.
    MostReached,
}

/// How points between those of the lattice follow them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum LatticeInterpolation {
    /// Trilinear within each cell: local, and exact for affine maps.
    Trilinear,
    /// By Bernstein polynomials over the whole lattice, as in Sederberg and Parry (1986): smooth.
    Bernstein,
}

/// Deformation of the robot's own triangles (§6.2).
#[derive(Clone, Debug, PartialEq, Serialize, Encode, Decode)]
pub struct GeometricSettings {
    /// How many directions, uniformly distributed, are tried beside the normals of colliding triangles.
    pub directions: u32,
    /// The shortest that an edge may become, as a share of its length at rest: at least 0, at most 1.
    pub shortest: f64,
    /// The longest that an edge may become, as a share of its length at rest: at least 1.
    pub longest: f64,
    /// How far along the surface a colliding region reaches beyond its triangles, a length: what is farther away is another
    /// region, which is pushed in a direction of its own.
    pub neighbourhood: f64,
    /// The scale of the robot toward which regions are moved where no direction frees them: above 0, below 1.
    pub guide: f64,
    /// The largest number of rounds of pushing and smoothing.
    pub rounds: u32,
    /// Whether shapes whose surface meets itself are refused.
    pub refuse_self_collisions: bool,
}
