//! Where a link is to be: a pose with tolerances, which many configurations may have.

/// A pose for a link, with tolerances: the end of a query given by where something is to be rather than by values.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseGoal {
    /// The name of the link.
    pub link: String,
    /// Where its origin is to be in the world's frame, lengths.
    pub position: [f64; 3],
    /// How it is to be turned in the world's frame, a unit quaternion `w x y z`; `None` if that does not matter.
    pub rotation: Option<[f64; 4]>,
    /// How far from the position the origin may be, a length; `None` for a 10 000th of how far the robot reaches.
    pub position_tolerance: Option<f64>,
    /// By which angle the link may be turned from the rotation, in radians; `None` for a thousandth.
    pub orientation_tolerance: Option<f64>,
}

/// What was found at a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseFound {
    /// Configurations that were accepted, in the order in which they were found.
    pub configurations: Vec<Vec<f64>>,
    /// From how many starts was searched.
    pub starts: usize,
    /// How many of these came to the pose.
    pub reached: usize,
    /// The tolerances that held: a length, and an angle in radians.
    pub tolerances: [f64; 2],
    /// The nearest that any start came to the pose: a length, and an angle in radians.
    pub nearest: [f64; 2],
}
