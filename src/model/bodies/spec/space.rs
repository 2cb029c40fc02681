use crate::model::bodies::validity::{BoundsMeaning, MotionChecking};
use crate::space::BaseJoint;
use serde::Deserialize;

/// Where the robot may be and how its motions are judged: the table `[space]`. The default is that of a robot whose base
/// stands still.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpaceSpec {
    pub(in crate::model::bodies) motion: Option<BaseJoint>,
    pub(in crate::model::bodies) min: Option<Vec<f64>>,
    pub(in crate::model::bodies) max: Option<Vec<f64>>,
    pub(in crate::model::bodies) bounds: Option<BoundsMeaning>,
    pub(in crate::model::bodies) resolution: Option<f64>,
    #[serde(default)]
    pub(in crate::model::bodies) edges: MotionChecking,
    pub(in crate::model::bodies) rotation_length: Option<f64>,
}

impl SpaceSpec {
    /// A base that moves so within a box of the world, whose corners `min` and `max` have one coordinate per bounded
    /// axis: x y of a planar robot, x y z of any other.
    pub fn new(
        motion: BaseJoint,
        min: impl Into<Vec<f64>>,
        max: impl Into<Vec<f64>>,
        bounds: BoundsMeaning,
    ) -> SpaceSpec {
        SpaceSpec {
            motion: Some(motion),
            min: Some(min.into()),
            max: Some(max.into()),
            bounds: Some(bounds),
            ..SpaceSpec::default()
        }
    }

    /// A base that stands still, in a box as large as the robot can reach.
    pub fn fixed() -> SpaceSpec {
        SpaceSpec { motion: Some(BaseJoint::Fixed), ..SpaceSpec::default() }
    }

    /// What must stay within the box.
    pub fn bounds(self, bounds: BoundsMeaning) -> SpaceSpec {
        SpaceSpec { bounds: Some(bounds), ..self }
    }

    /// The farthest that any robot point moves between two checks of a motion, a length. If nothing is said, it follows
    /// from the sizes of the box and of the robot.
    pub fn resolution(self, resolution: f64) -> SpaceSpec {
        SpaceSpec { resolution: Some(resolution), ..self }
    }

    /// What is promised of the motions along edges.
    pub fn edges(self, edges: MotionChecking) -> SpaceSpec {
        SpaceSpec { edges, ..self }
    }

    /// Length that one radian of rotation counts for in the metric. If nothing is said, it is the distance of the
    /// farthest robot point from the reference point.
    pub fn rotation_length(self, rotation_length: f64) -> SpaceSpec {
        SpaceSpec { rotation_length: Some(rotation_length), ..self }
    }
}
