use crate::scene::{Body, Pose};
use crate::space::BaseJoint;

/// The capability of a model that can be drawn: what pictures and animations show of it. Lengths are in the
/// problem's unit, points in the world's frame.
pub trait Figure {
    /// Whether everything lies in the plane z = 0 and is seen from above.
    fn is_planar(&self) -> bool;

    /// The least and the largest corner of the box that bounds it; planar ones lie at z = 0.
    fn bounds(&self) -> [[f64; 3]; 2];

    /// Whether these bounds hold every point that is drawn, the robot's included.
    fn is_held_by_bounds(&self) -> bool;

    /// The point by which a configuration is drawn.
    fn marker(&self, q: &[f64]) -> [f64; 3];

    /// How the base of what is drawn moves, and with it everything else: its values come first in a configuration.
    fn base(&self) -> BaseJoint {
        BaseJoint::Fixed
    }

    /// What stands still.
    fn obstacles(&self) -> &[Body] {
        &[]
    }

    /// The bodies of each link that moves, in the link's own frame.
    fn links(&self) -> Vec<&[Body]> {
        Vec::new()
    }

    /// Where these links stand at a configuration.
    fn placement(&self, _q: &[f64]) -> Placement {
        Placement::default()
    }

    /// Of a model of an energy over the plane: the energy at a point, for contour lines.
    fn energy_at(&self, _x: f64, _y: f64) -> Option<f64> {
        None
    }
}

/// Where the links of a [`Figure`] stand.
#[derive(Clone, Debug, Default)]
pub struct Placement {
    /// Per link its frame in the world's.
    pub poses: Vec<Pose>,
    /// Index of the link that the marker belongs to, where that is not the whole robot.
    pub marked: Option<usize>,
}

fn placed(bodies: &[Body], pose: &Pose) -> impl Iterator<Item = Body> {
    bodies.iter().map(|body| Body { pose: pose.then(&body.pose), ..body.clone() })
}

impl dyn Figure + '_ {
    /// All bodies that move, where they stand at `q`.
    pub fn bodies_at(&self, q: &[f64]) -> Vec<Body> {
        let placement = self.placement(q);
        let links = self.links().into_iter().zip(&placement.poses);
        links.flat_map(|(bodies, pose)| placed(bodies, pose)).collect()
    }

    /// The bodies of one link where they stand at `q`.
    pub fn bodies_of_link(&self, link: usize, q: &[f64]) -> Vec<Body> {
        placed(self.links()[link], &self.placement(q).poses[link]).collect()
    }
}
