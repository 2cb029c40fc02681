use super::Refusal;
use crate::scene::Pose;

/// A shape of the robot that is free at a configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// The vertices in the robot's frame, in the order of the robot's at rest. What is checked are these numbers, moved by the pose.
    pub vertices: Vec<[f64; 3]>,
    /// The energy of the deformation: a sum of displacements, a length. 0 of the shape at rest.
    pub energy: f64,
}

/// A method that deforms a robot where it collides.
pub trait Deform {
    /// A shape of the robot that is free where the robot's frame has this pose in the world's: the shape at rest where that
    /// is free. It is a pure function of the pose.
    ///
    /// # Errors
    /// Why there is none.
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal>;
}
