//! How bodies are drawn.

use super::Bodies;
use super::validity::BoundsMeaning;
use crate::model::{Figure, Placement};
use crate::scene::Body;
use crate::space::BaseJoint;

impl Figure for Bodies {
    fn is_planar(&self) -> bool {
        self.robot.motion.bounded_axes() == 2
    }

    fn bounds(&self) -> [[f64; 3]; 2] {
        let planar = |corner: [f64; 3]| [corner[0], corner[1], 0.0];
        let corners = [self.bounds.min, self.bounds.max];
        if self.is_planar() { corners.map(planar) } else { corners }
    }

    fn is_held_by_bounds(&self) -> bool {
        self.bounds.meaning == BoundsMeaning::Body
    }

    fn marker(&self, q: &[f64]) -> [f64; 3] {
        self.robot.marker(q)
    }

    fn base(&self) -> BaseJoint {
        self.robot.motion
    }

    fn obstacles(&self) -> &[Body] {
        &self.obstacles
    }

    fn links(&self) -> Vec<&[Body]> {
        self.robot.links.iter().map(|link| &link.bodies[..]).collect()
    }

    fn placement(&self, q: &[f64]) -> Placement {
        let mut poses = Vec::new();
        self.robot.link_poses(q, &mut poses);
        // Of a linkage that stands, the last link is what the marker shows.
        let stands = self.robot.motion == BaseJoint::Fixed;
        Placement { poses, marked: stands.then(|| self.robot.links.len() - 1) }
    }
}
