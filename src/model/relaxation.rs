//! Relaxed constraints: how a model becomes an easier one of the same kind.

use crate::methods::Complaint;
use crate::model::ModelKind;
use crate::scene::LENGTH_MAX;
use serde::{Deserialize, Serialize};

/// How the constraints of a model are relaxed, as the key `kind` of the table `[relaxation]` says it.
///
/// Together with a *level* it makes a relaxed model ([`Description::relaxed`](crate::model::Description::relaxed)). A level is a
/// number from 0 to 1: at 1 the model is the problem's own, at 0 it is as relaxed as the settings allow, and in between every number
/// that a relaxation changes goes from the one to the other in a straight line.
///
/// After O. B. Bayazit, *Solving motion planning problems by iterative relaxation of constraints* (dissertation, Texas A&M
/// University, 2003), chapter III C.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Relaxation {
    /// The robot's shapes become smaller.
    ScaleRobot(ScaleRobot),
    /// Obstacles become smaller or larger.
    ScaleObstacles(ScaleObstacles),
    /// The robot may overlap obstacles, and itself, as far as a short motion would free it.
    Penetration(Penetration),
    /// A joint more, which a linkage does not have.
    ExtraJoint(ExtraJoint),
    /// Higher energies are valid.
    Energy(HigherEnergy),
    /// The robot's meshes become thinner.
    ThinRobot(ThinRobot),
}

/// The robot's shapes scaled about a centre, each link's own; joints stay where they are. At level 0 they have the factor `least`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScaleRobot {
    /// The factor at level 0: above 0, below 1.
    #[serde(default = "default_least")]
    pub least: f64,
    /// What stays in its place, in each link's own frame.
    #[serde(default)]
    pub centre: ScaleCentre,
    /// Along which axes of each link's frame.
    #[serde(default)]
    pub axes: ScaleAxes,
}

impl Default for ScaleRobot {
    fn default() -> ScaleRobot {
        let (centre, axes) = (ScaleCentre::default(), ScaleAxes::default());
        ScaleRobot { least: default_least(), centre, axes }
    }
}

fn default_least() -> f64 {
    0.1
}

/// Every vertex of the robot's meshes moved inward, by `by` at level 0 and by `(1 − level) · by` in general: a tube becomes a thinner tube
/// along the same curve, where scaling would make it a smaller one. M. Saha, J.-C. Latombe, Y.-C. Chang and F. Prinz (*Finding narrow passages with
/// probabilistic roadmaps: the small-step retraction method*, Autonomous Robots 2005) make robots and obstacles thinner so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThinRobot {
    /// By how much at level 0: a length, less than half of what the thinnest part measures. Of a mesh, whose parts nobody can tell apart, less
    /// than half of the longest edge of its box is asked for.
    pub by: f64,
}

/// Obstacles scaled about a centre. At level 0 they have the factor `factor`: below 1 they are smaller, above 1 larger, which makes
/// room where an obstacle has an opening, as between the prongs of the alpha puzzle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScaleObstacles {
    /// The factor at level 0: above 0, at most 1000, and not 1.
    pub factor: f64,
    /// Which obstacles, by their numbers in the file, the first of which is 0; all if nothing is said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub obstacles: Option<Vec<usize>>,
    /// What stays in its place, in the world's frame; the centroid is that of each obstacle.
    #[serde(default)]
    pub centre: ScaleCentre,
    /// Along which axes of the world's frame.
    #[serde(default)]
    pub axes: ScaleAxes,
}

/// A configuration is valid, too, if one is that a short motion from it leads to: by the distance `depth` at level 0, and by
/// `(1 − level) · depth` in general.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Penetration {
    /// The length of that motion at level 0, in the metric of the space: less than the largest distance in the space, at which nearly everything
    /// would be valid.
    pub depth: f64,
}

/// A joint more between a link and the link that it hangs on. Its value is within `range` at level 0, and within
/// `(1 − level) · range` in general.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExtraJoint {
    /// The link that the joint moves, with all that hangs on it: any but the base.
    pub link: String,
    /// Along or about which axis it moves the link.
    pub kind: ExtraJointKind,
}

/// How the extra joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ExtraJointKind {
    /// It slides along an axis of the frame of the link's own joint.
    Prismatic {
        /// The axis.
        axis: [f64; 3],
        /// Least and largest length at level 0; 0 is within.
        range: [f64; 2],
    },
    /// It turns about an axis of the frame of the link's own joint.
    Revolute {
        /// The axis.
        axis: [f64; 3],
        /// Least and largest angle at level 0, in degrees; 0 is within.
        degrees: [f64; 2],
    },
}

/// The highest energy that is valid: `highest` at level 0, the model's own at level 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HigherEnergy {
    /// The highest valid energy at level 0, in the model's unit: above the model's own.
    pub highest: f64,
}

/// What stays in its place while shapes are scaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected \"centroid\" or [x, y, z]")]
pub enum ScaleCentre {
    /// The centroid of the surface of the shapes that are scaled together.
    #[default]
    #[serde(with = "centroid_word")]
    Centroid,
    /// A point.
    Point([f64; 3]),
}

/// Along which axes shapes are scaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected \"all\" or three of true and false, for x, y and z")]
pub enum ScaleAxes {
    /// Along all three, so that shapes stay similar.
    #[default]
    #[serde(with = "all_word")]
    All,
    /// Along some of x, y and z.
    Some([bool; 3]),
}

/// Reads and writes a unit variant of an untagged enum as one word.
macro_rules! word {
    ($module:ident, $word:literal) => {
        mod $module {
            use serde::{Deserialize, Deserializer, Serializer, de::Error};

            pub fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str($word)
            }

            pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
                let word = String::deserialize(deserializer)?;
                let expected = concat!("`", $word, "` expected");
                (word == $word).then_some(()).ok_or_else(|| Error::custom(expected))
            }
        }
    };
}

word!(centroid_word, "centroid");
word!(all_word, "all");

/// The largest factor by which obstacles are scaled.
const FACTOR_MAX: f64 = 1000.0;
/// The least factor by which shapes are scaled.
const FACTOR_MIN: f64 = 1e-3;

impl Relaxation {
    /// Its name in a problem file.
    pub fn name(&self) -> &'static str {
        match self {
            Relaxation::ScaleRobot(_) => "scale-robot",
            Relaxation::ScaleObstacles(_) => "scale-obstacles",
            Relaxation::Penetration(_) => "penetration",
            Relaxation::ExtraJoint(_) => "extra-joint",
            Relaxation::Energy(_) => "energy",
            Relaxation::ThinRobot(_) => "thin-robot",
        }
    }

    /// What is wrong with the settings, as far as that can be said without the model.
    pub fn complaint(&self) -> Option<Complaint> {
        // Written so that NaN fails them.
        match self {
            Relaxation::ScaleRobot(ScaleRobot { least, centre, axes }) => {
                let fits = (FACTOR_MIN..1.0).contains(least);
                let expected = "a factor from 0.001 to below 1, at which nothing is relaxed,";
                let of_least = (!fits).then(|| Complaint::new("least", least, expected));
                of_least.or_else(|| centre.complaint()).or_else(|| axes.complaint())
            }
            Relaxation::ScaleObstacles(ScaleObstacles { factor, obstacles: _, centre, axes }) => {
                let fits = (FACTOR_MIN..=FACTOR_MAX).contains(factor) && *factor != 1.0;
                let expected =
                    "a factor from 0.001 to 1000, other than 1, at which nothing is relaxed,";
                let of_factor = (!fits).then(|| Complaint::new("factor", factor, expected));
                of_factor.or_else(|| centre.complaint()).or_else(|| axes.complaint())
            }
            Relaxation::Penetration(Penetration { depth }) => {
                Complaint::of_length("depth", *depth, LENGTH_MAX)
            }
            Relaxation::ExtraJoint(ExtraJoint { kind, .. }) => {
                let (ExtraJointKind::Prismatic { range, .. }
                | ExtraJointKind::Revolute { degrees: range, .. }) = kind;
                let (key, most, expected) = match kind {
                    ExtraJointKind::Prismatic { .. } => {
                        let expected = "a length from -1e30 to 0 and a larger one from 0 to 1e30";
                        ("range", LENGTH_MAX, expected)
                    }
                    ExtraJointKind::Revolute { .. } => {
                        let expected = "an angle from -360 to 0 and a larger one from 0 to 360";
                        ("degrees", 360.0, expected)
                    }
                };
                let [least, largest] = *range;
                let fits = (-most..=0.0).contains(&least) && (0.0..=most).contains(&largest);
                let found = format!("{range:?}");
                (!(fits && least < largest)).then(|| Complaint::new(key, found, expected))
            }
            Relaxation::Energy(HigherEnergy { highest }) => (!highest.is_finite())
                .then(|| Complaint::new("highest", highest, "a finite energy")),
            Relaxation::ThinRobot(ThinRobot { by }) => Complaint::of_length("by", *by, LENGTH_MAX),
        }
    }
}

impl Relaxation {
    /// What is relaxed at a level, and by how much: `factor 0.55` of a robot that is scaled, say.
    pub fn amount_at(&self, level: f64) -> String {
        let left = 1.0 - level;
        match self {
            Relaxation::ScaleRobot(ScaleRobot { least: factor, .. })
            | Relaxation::ScaleObstacles(ScaleObstacles { factor, .. }) => {
                format!("factor {:.4}", between(*factor, 1.0, level))
            }
            Relaxation::Penetration(Penetration { depth }) => format!("depth {:.4}", depth * left),
            Relaxation::ThinRobot(ThinRobot { by }) => format!("thinner by {:.4}", by * left),
            Relaxation::ExtraJoint(_) => format!("range times {left:.4}"),
            Relaxation::Energy(_) => format!("{left:.4} of the higher energy"),
        }
    }
}

impl ScaleCentre {
    fn complaint(self) -> Option<Complaint> {
        let ScaleCentre::Point(point) = self else { return None };
        let fits = point.iter().all(|value| value.abs() <= LENGTH_MAX);
        let found = format!("{point:?}");
        (!fits).then(|| Complaint::new("centre", found, "lengths from -1e30 to 1e30"))
    }
}

impl ScaleAxes {
    /// Per axis whether shapes are scaled along it.
    pub fn each(self) -> [bool; 3] {
        match self {
            ScaleAxes::All => [true; 3],
            ScaleAxes::Some(axes) => axes,
        }
    }

    fn complaint(self) -> Option<Complaint> {
        let none = self.each() == [false; 3];
        none.then(|| Complaint::new("axes", "[false, false, false]", "at least one true"))
    }
}

/// A number that is `relaxed` at level 0 and `own` at level 1.
pub(crate) fn between(relaxed: f64, own: f64, level: f64) -> f64 {
    relaxed + (own - relaxed) * level
}

/// The highest valid energy at a level, of a model that has one.
///
/// # Errors
/// The relaxation is of another kind, every energy is valid, or the highest at level 0 is not above the model's own.
pub(crate) fn relaxed_energy(
    relaxation: &Relaxation,
    own: Option<f64>,
    level: f64,
    model: &str,
) -> Result<f64, CannotRelax> {
    let Relaxation::Energy(HigherEnergy { highest }) = relaxation else {
        return Err(CannotRelax::unknown(relaxation, model, "energy expected"));
    };
    let Some(own) = own else {
        let expected = "a model with a highest valid energy expected";
        return Err(CannotRelax::new(
            "",
            format!("energy found, but every energy is valid; {expected}"),
        ));
    };
    if *highest <= own {
        let message =
            format!("{highest} found; more than the model's own highest, {own}, expected");
        return Err(CannotRelax::new("highest", message));
    }
    Ok(between(*highest, own, level))
}

/// A model at a level of a relaxation.
#[derive(Clone, Debug, PartialEq)]
pub struct RelaxedModel {
    /// The model.
    pub model: ModelKind,
    /// Where in its configurations the value stands that those of the problem do not have: that of an extra joint.
    pub extra_value: Option<usize>,
}

impl RelaxedModel {
    /// A relaxed model whose configurations have the values of the problem's own.
    pub fn new(model: ModelKind) -> RelaxedModel {
        RelaxedModel { model, extra_value: None }
    }

    /// The configuration of the relaxed model that a configuration of the problem is: with the extra joint at 0.
    pub fn lifted(&self, q: &[f64]) -> Vec<f64> {
        let mut lifted = q.to_vec();
        if let Some(at) = self.extra_value {
            lifted.insert(at, 0.0);
        }
        lifted
    }

    /// What is left of a configuration of the relaxed model without the value of the extra joint.
    pub fn dropped(&self, q: &[f64]) -> Vec<f64> {
        let mut dropped = q.to_vec();
        if let Some(at) = self.extra_value {
            dropped.remove(at);
        }
        dropped
    }
}

/// Why a model cannot be relaxed as is asked: by which key of the relaxation, what was found and what is expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CannotRelax {
    /// The key of the relaxation's settings that is wrong; empty where it is the kind itself.
    pub key: &'static str,
    /// What was found and what is expected.
    pub message: String,
}

impl CannotRelax {
    /// What is wrong with a setting.
    pub fn new(key: &'static str, message: impl Into<String>) -> CannotRelax {
        CannotRelax { key, message: message.into() }
    }

    /// The model does not know this kind of relaxation.
    pub fn unknown(kind: &Relaxation, model: &str, known: &str) -> CannotRelax {
        let message = format!("{} found, which {model} cannot be relaxed by; {known}", kind.name());
        CannotRelax::new("", message)
    }
}
