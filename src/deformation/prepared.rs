use super::bounds::sides;
use super::path::movement;
use super::{BoundingBox, Deform, DeformableRobot, Geometric, Obstacles, SoftBody};
use crate::model::Description;
use crate::model::deformable::{Deformable, DeformationMethod, DeformationSettings};
use crate::scene::Pose;
use crate::space::Space;
use std::sync::Arc;

/// The pose of the robot's frame in the world's at a configuration.
type PoseAt = Box<dyn Fn(&[f64]) -> Pose>;

/// The deformable robot of a problem, made ready to be deformed among the problem's obstacles.
///
/// Where the problem's bounds must hold the whole robot, and not its reference point alone, their sides are obstacles, too: shapes are pushed back
/// from them. A shape may come up to the bounds themselves.
pub struct PreparedRobot {
    space: Space,
    pose: PoseAt,
    body: SoftBody,
    obstacles: Arc<Obstacles>,
    method: Box<dyn Deform>,
    settings: DeformationSettings,
}

impl PreparedRobot {
    /// The robot of a description, deformed by these settings instead of the description's own.
    ///
    /// # Errors
    /// What is wrong with the settings, or with the robot's surface.
    pub fn new(
        description: &Deformable,
        settings: DeformationSettings,
    ) -> Result<PreparedRobot, String> {
        let body = SoftBody::new(description.surface())?;
        let bodies = description.bodies();
        if let Some(complaint) = settings.complaint(bodies) {
            return Err(complaint);
        }
        let robot = bodies.robot().clone();
        let reach = movement(&vec![[0.0; 3]; body.vertices().len()], body.vertices());
        let DeformationSettings { highest_energy, clearance, .. } = settings;
        let mut around = bodies.obstacles().to_vec();
        around.extend(sides(&bodies.bounds(), robot.motion.bounded_axes(), clearance, reach));
        let obstacles = Arc::new(Obstacles::new(&around));
        let among = obstacles.clone();
        let method: Box<dyn Deform> = match &settings.method {
            DeformationMethod::BoundingBox(of) => {
                Box::new(BoundingBox::new(&body, of, highest_energy, clearance, among)?)
            }
            DeformationMethod::Geometric(of) => {
                Box::new(Geometric::new(&body, of, highest_energy, clearance, among)?)
            }
        };
        let pose = move |q: &[f64]| {
            let mut poses = Vec::with_capacity(1);
            robot.link_poses(q, &mut poses);
            poses[0]
        };
        let space = description.space();
        let prepared =
            PreparedRobot { space, pose: Box::new(pose), body, obstacles, method, settings };
        prepared.robot().complaint().map_or(Ok(prepared), Err)
    }

    /// The robot at rest.
    pub fn body(&self) -> &SoftBody {
        &self.body
    }

    /// What a query needs of it. Its method can be replaced by another around it, which counts, say.
    pub fn robot(&self) -> DeformableRobot<'_> {
        DeformableRobot {
            space: &self.space,
            pose: &*self.pose,
            body: &self.body,
            method: &*self.method,
            obstacles: &self.obstacles,
            highest_energy: self.settings.highest_energy,
            clearance: self.settings.clearance,
            step: self.settings.step,
        }
    }
}
