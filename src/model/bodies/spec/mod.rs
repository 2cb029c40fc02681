//! Rigid robots and obstacles as a problem asks for them, before anything is checked: the tables of a problem file, and
//! what a program makes instead. One file per piece.

mod body;
mod frame;
mod joint;
mod robot;
mod space;

pub use body::{BodySpec, ShapeSpec};
pub use frame::FrameSpec;
pub use joint::JointSpec;
pub use robot::{AttachSpec, LinkSpec, RobotSpec};
pub use space::SpaceSpec;

pub(super) use body::Solid;
pub(super) use joint::{JointKindSpec, MimicSpec};
pub(super) use robot::{ALL_OTHERS, PaddingSpec};

use serde::Deserialize;

/// A robot of rigid links among rigid obstacles, as a problem asks for it: the tables `[space]`, `[robot]` and
/// `[[obstacles]]` of a problem file, which `docs/problems.md` describes. Nothing is checked before the problem is
/// built.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct BodiesSpec {
    #[serde(default)]
    pub(super) space: SpaceSpec,
    pub(super) robot: RobotSpec,
    #[serde(default)]
    pub(super) obstacles: Vec<BodySpec>,
}

impl BodiesSpec {
    /// A robot in a space without obstacles.
    pub fn new(space: SpaceSpec, robot: RobotSpec) -> BodiesSpec {
        BodiesSpec { space, robot, obstacles: Vec::new() }
    }

    /// Adds an obstacle; its frame is the world's.
    pub fn obstacle(mut self, obstacle: impl Into<BodySpec>) -> BodiesSpec {
        self.obstacles.push(obstacle.into());
        self
    }

    /// Takes these obstacles instead of those given before.
    pub fn obstacles(self, obstacles: impl IntoIterator<Item = BodySpec>) -> BodiesSpec {
        BodiesSpec { obstacles: obstacles.into_iter().collect(), ..self }
    }

    /// Changes each body of the robot and each obstacle.
    pub fn change_each_body(mut self, mut change: impl FnMut(BodySpec) -> BodySpec) -> BodiesSpec {
        let links = self.robot.links.iter_mut().map(|link| &mut link.bodies);
        let attached = self.robot.attach.iter_mut().map(|attached| &mut attached.bodies);
        for bodies in links.chain(attached).chain([&mut self.robot.bodies, &mut self.obstacles]) {
            *bodies = std::mem::take(bodies).into_iter().map(&mut change).collect();
        }
        self
    }

    /// Changes what is asked of the space.
    pub fn change_space(self, change: impl FnOnce(SpaceSpec) -> SpaceSpec) -> BodiesSpec {
        BodiesSpec { space: change(self.space), ..self }
    }
}
