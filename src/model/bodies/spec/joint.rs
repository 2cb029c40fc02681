use super::FrameSpec;
use serde::Deserialize;

/// The joint by which a link hangs on another: the table `joint` of a link.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSpec {
    pub(in crate::model::bodies) name: Option<String>,
    pub(in crate::model::bodies) parent: Option<String>,
    pub(in crate::model::bodies) kind: JointKindSpec,
    pub(in crate::model::bodies) mimic: Option<MimicSpec>,
    #[serde(default)]
    pub(in crate::model::bodies) before: FrameSpec,
    #[serde(default)]
    pub(in crate::model::bodies) after: FrameSpec,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(in crate::model::bodies) enum JointKindSpec {
    Fixed {},
    Spherical {},
    Revolute { axis: [f64; 3], degrees: Option<[f64; 2]>, radians: Option<[f64; 2]> },
    Prismatic { axis: [f64; 3], range: Option<[f64; 2]> },
    Locked {},
}

/// How a joint follows another: the table `mimic` of a joint.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::model::bodies) struct MimicSpec {
    pub link: String,
    #[serde(default = "one")]
    pub multiplier: f64,
    #[serde(default)]
    pub offset: f64,
}

fn one() -> f64 {
    1.0
}

impl JointSpec {
    /// A joint that does not move.
    pub fn fixed() -> JointSpec {
        JointSpec::of(JointKindSpec::Fixed {})
    }

    /// A joint that turns in every way.
    pub fn spherical() -> JointSpec {
        JointSpec::of(JointKindSpec::Spherical {})
    }

    /// A joint that turns about an axis as far as it likes.
    pub fn revolute(axis: [f64; 3]) -> JointSpec {
        JointSpec::of(JointKindSpec::Revolute { axis, degrees: None, radians: None })
    }

    /// A joint that turns about an axis, with a least and a largest angle in degrees.
    pub fn revolute_in_degrees(axis: [f64; 3], degrees: [f64; 2]) -> JointSpec {
        JointSpec::of(JointKindSpec::Revolute { axis, degrees: Some(degrees), radians: None })
    }

    /// A joint that turns about an axis, with a least and a largest angle in radians.
    pub fn revolute_in_radians(axis: [f64; 3], radians: [f64; 2]) -> JointSpec {
        JointSpec::of(JointKindSpec::Revolute { axis, degrees: None, radians: Some(radians) })
    }

    /// A joint that slides along an axis, with a least and a largest length.
    pub fn prismatic(axis: [f64; 3], range: [f64; 2]) -> JointSpec {
        JointSpec::of(JointKindSpec::Prismatic { axis, range: Some(range) })
    }

    /// A joint that slides along an axis as another joint moves: [`JointSpec::mimic`] says which and how.
    pub fn prismatic_mimic(axis: [f64; 3]) -> JointSpec {
        JointSpec::of(JointKindSpec::Prismatic { axis, range: None })
    }

    /// A joint that could move and is held where it is: links on its two sides are as far from being neighbours as if it
    /// moved.
    pub fn locked() -> JointSpec {
        JointSpec::of(JointKindSpec::Locked {})
    }

    /// Lets the joint have no value of its own: its value is `multiplier` times that of the joint of another link, plus
    /// `offset`. Limits that it has narrow the other joint's.
    pub fn mimic(self, link: impl Into<String>, multiplier: f64, offset: f64) -> JointSpec {
        JointSpec { mimic: Some(MimicSpec { link: link.into(), multiplier, offset }), ..self }
    }

    fn of(kind: JointKindSpec) -> JointSpec {
        let (before, after) = (FrameSpec::default(), FrameSpec::default());
        JointSpec { name: None, parent: None, kind, mimic: None, before, after }
    }

    /// The joint's name; that of its link if nothing is said.
    pub fn name(self, name: impl Into<String>) -> JointSpec {
        JointSpec { name: Some(name.into()), ..self }
    }

    /// The link on which the joint's own link hangs, one that is given before it. If nothing is said, it is the last
    /// of these.
    pub fn parent(self, link: impl Into<String>) -> JointSpec {
        JointSpec { parent: Some(link.into()), ..self }
    }

    /// Where the joint stands in the parent's frame.
    pub fn before(self, frame: FrameSpec) -> JointSpec {
        JointSpec { before: frame, ..self }
    }

    /// Where the link stands in the frame that the joint moves.
    pub fn after(self, frame: FrameSpec) -> JointSpec {
        JointSpec { after: frame, ..self }
    }
}
