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

    /// Whether a blend of two shapes that the method gave, vertex by vertex in straight lines, is one that the method allows as far as the
    /// material is concerned, where the robot's frame has this pose. That it is free of obstacles is tested by whoever asks.
    ///
    /// Every blend is, unless a method says otherwise: where all that a method demands of a shape are bounds of linear functions of its
    /// vertices, what two shapes keep their blends keep.
    fn accepts_blend(&self, _pose: &Pose, _vertices: &[[f64; 3]]) -> bool {
        true
    }
}

/// Checks the lengths that every method of deformation has.
pub(super) fn lengths(highest_energy: f64, clearance: f64) -> Result<(), String> {
    // Each written so that NaN fails it.
    let fits = highest_energy >= 0.0;
    if !fits {
        return Err(format!("highest_energy: {highest_energy} found; at least 0 expected"));
    }
    let fits = clearance >= 0.0 && clearance.is_finite();
    if !fits {
        return Err(format!("clearance: {clearance} found; a length of at least 0 expected"));
    }
    Ok(())
}
