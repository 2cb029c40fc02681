use serde::Deserialize;

/// Where something stands: a position, and an orientation or a turn. The default is the frame it is given in.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameSpec {
    #[serde(default)]
    pub(in crate::model::bodies) position: [f64; 3],
    pub(in crate::model::bodies) orientation: Option<[f64; 4]>,
    pub(in crate::model::bodies) turn: Option<TurnSpec>,
}

/// A rotation about an axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::model::bodies) struct TurnSpec {
    pub axis: [f64; 3],
    pub degrees: f64,
}

impl FrameSpec {
    /// A frame at a position `x y z`, lengths, that is not turned.
    pub fn at(position: [f64; 3]) -> FrameSpec {
        FrameSpec { position, ..FrameSpec::default() }
    }

    /// Turns the frame by a quaternion `w x y z` of any length but zero.
    pub fn orientation(self, orientation: [f64; 4]) -> FrameSpec {
        FrameSpec { orientation: Some(orientation), ..self }
    }

    /// Turns the frame by so many degrees about an axis. It takes the place of an orientation: of the two, one may be
    /// given.
    pub fn turn(self, axis: [f64; 3], degrees: f64) -> FrameSpec {
        FrameSpec { turn: Some(TurnSpec { axis, degrees }), ..self }
    }
}
