use super::Scratch;

/// The shortest way from the robot's surface to that of an obstacle.
///
/// Among equally near ones it is that of the obstacle named first, then of its first triangle, then of
/// the robot's first link and triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// The distance of the surfaces: 0 where they meet. Inside an obstacle it is the distance to the obstacle's
    /// surface; only [`Model::validity`](super::Model::validity) knows of insides.
    pub distance: f64,
    /// Where the way ends on the robot, in the world's frame.
    pub on_robot: [f64; 3],
    /// Where the way ends on the obstacle, in the world's frame.
    pub on_obstacle: [f64; 3],
    /// Index of the obstacle.
    pub obstacle: usize,
}

/// The capability of a model whose robot moves among obstacles: how far the nearest one is.
pub trait Clearances {
    /// The shortest way from the robot at `q` to an obstacle; `None` if there are none.
    fn clearance(&self, q: &[f64], scratch: &mut Scratch) -> Option<Clearance>;
}
