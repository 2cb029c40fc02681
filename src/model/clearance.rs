use super::Scratch;

/// The distance of the robot's surface from the nearest obstacle's surface, and the nearest points of the two (the
/// witnesses of the distance).
///
/// Ties go to the obstacle named first, then to its first triangle, then to the robot's first link and triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// The distance of the surfaces, in the scene's unit: 0 where they meet. It is positive inside an obstacle, too:
    /// [`Model::validity`](super::Model::validity) tells whether the robot is inside.
    pub distance: f64,
    /// The nearest point of the robot, in the world's frame.
    pub on_robot: [f64; 3],
    /// The nearest point of the obstacle, in the world's frame.
    pub on_obstacle: [f64; 3],
    /// Index of the obstacle.
    pub obstacle: usize,
}

/// The capability of a model whose robot moves among obstacles: how far the nearest one is.
pub trait Clearances {
    /// The shortest way from the robot at `q` to an obstacle; `None` if there are none.
    fn clearance(&self, q: &[f64], scratch: &mut Scratch) -> Option<Clearance>;
}
