use std::fmt;

/// Why a robot cannot be deformed at a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The centre toward which points are pushed lies in an obstacle, and so does every other guide.
    NoGuide,
    /// What is pushed aside cannot keep its distances from its neighbours.
    Limits,
    /// After all rounds of the method the shape still meets an obstacle, or is nearer to one than it may be.
    Collides,
    /// The surface of the shape meets itself.
    SelfCollision,
    /// The shape is free, but its energy is this, higher than is accepted.
    Energy(f64),
    /// Between two configurations that are almost the same the shape jumps: a vertex moves as far as this, and a blend of the two shapes
    /// meets an obstacle.
    Jump(f64),
    /// A motion would have more frames than can be made: the step, or the clearance, is too short for it.
    Frames,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Refusal::NoGuide => write!(f, "its middle is within an obstacle"),
            Refusal::Limits => write!(f, "the limits of the material"),
            Refusal::Collides => write!(f, "no shape that was tried is free"),
            Refusal::SelfCollision => write!(f, "the shape meets itself"),
            Refusal::Energy(energy) => {
                write!(f, "an energy of {energy}, above the highest that is accepted")
            }
            Refusal::Jump(moved) => write!(f, "the shape jumps: a vertex by {moved}"),
            Refusal::Frames => write!(f, "more frames than can be made"),
        }
    }
}
