//! Rigid robots and linkages among obstacles that stand still.
//!
//! The description is [`Bodies`]; [`BodyValidity`] is the model made from it. `docs/problems.md` says how a
//! problem file describes them, `docs/validity.md` how motions are judged.

mod describe;
mod figure;
pub mod foreign;
mod import;
mod linkage;
mod read;
pub mod robot;
mod shapes;
mod sound;
mod tables;
pub mod validity;
mod write;

pub use import::import;
pub use validity::BodyValidity;

use super::{Description, Documents, Figure, Model, ModelKind, ReadTables};
use crate::scene::Body;
use crate::source::{ProblemError, Source};
use crate::space::Space;
use bincode::{Decode, Encode};
use robot::Robot;
use validity::{Bounds, MotionChecking};

/// A robot of rigid links among rigid obstacles: plain data, complete in itself (meshes included).
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Bodies {
    /// The box that bounds the robot.
    pub bounds: Bounds,
    /// The farthest that any robot point moves between two checks of a motion; a length.
    pub resolution: f64,
    /// What is promised of the motions along edges.
    pub edges: MotionChecking,
    /// Length that one radian of rotation counts for in the metric.
    pub rotation_length: f64,
    /// The robot.
    pub robot: Robot,
    /// The obstacles in the world's frame.
    pub obstacles: Vec<Body>,
}

impl Bodies {
    /// The model itself, with what is particular to bodies.
    pub fn validity(&self) -> BodyValidity {
        let motions = (self.edges, self.resolution);
        BodyValidity::new(self.space(), &self.robot, self.bounds, motions, &self.obstacles)
    }
}

impl ReadTables for Bodies {
    const TABLES: &'static [&'static str] = &["space", "robot", "obstacles"];

    fn read(source: &Source, notes: &mut Vec<String>) -> Result<Bodies, ProblemError> {
        read::read(source, notes)
    }
}

impl Description for Bodies {
    fn space(&self) -> Space {
        let Bounds { min, max, .. } = self.bounds;
        self.robot.space(min, max, self.rotation_length)
    }

    fn sound(&self) -> Result<(), String> {
        sound::sound(self)
    }

    fn prepare(&self) -> Box<dyn Model> {
        Box::new(self.validity())
    }

    fn difference(&self, other: &ModelKind) -> Option<&'static str> {
        // Without `..`: whoever adds a field has to compare it here.
        let Bodies { bounds, resolution, edges, rotation_length, robot, obstacles } = self;
        let Some(other) = other.bodies() else { return Some("the kind of model") };
        let parts = [
            // Before what follows from them where a file says nothing of it.
            ("the robot", *robot == other.robot),
            ("an obstacle", *obstacles == other.obstacles),
            ("the space's bounds", *bounds == other.bounds),
            ("the resolution", *resolution == other.resolution),
            ("what is promised of edges", *edges == other.edges),
            ("the rotation length", *rotation_length == other.rotation_length),
        ];
        parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
    }

    fn describe(&self, out: &mut String) {
        describe::describe(self, out).expect("writing to memory cannot fail");
    }

    fn write(&self, documents: &mut Documents) {
        write::write(self, documents);
    }

    fn figure(&self) -> Option<&dyn Figure> {
        Some(self)
    }
}

#[cfg(test)]
mod tests;
