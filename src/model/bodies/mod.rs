//! Rigid robots and linkages among obstacles that stand still.
//!
//! The description is [`Bodies`]; [`BodyValidity`] is the model made from it. `docs/problems.md` says how a
//! problem file describes them, `docs/validity.md` how motions are judged.

mod again;
mod change;
mod describe;
mod figure;
pub mod foreign;
mod import;
mod inverse_kinematics;
mod linkage;
mod locks;
mod padding;
mod relaxed;
mod resolve;
pub mod robot;
mod robot_files;
mod shapes;
mod sound;
mod spec;
mod touching_lines;
pub mod validity;
mod with_function;
mod write;

pub(in crate::model) use relaxed::{Scaling, centroid};
pub(in crate::model) use resolve::{FINEST, diagonal_of};
pub(crate) use sound::body_sound;

pub use import::import;
pub use spec::{
    AttachSpec, BodiesSpec, BodySpec, FrameSpec, JointSpec, LinkSpec, RobotSpec, ShapeSpec,
    SpaceSpec,
};
pub use validity::BodyValidity;

use super::{
    CannotRelax, Description, Documents, Figure, Model, ModelKind, PoseFound, PoseGoal, Relaxation,
    RelaxedModel, Resolve, ScaleRobot, SceneChange, ValidityFunction,
};
use crate::scene::Body;
use crate::seed::Seed;
use crate::source::{ProblemError, Source};
use crate::space::Space;
use bincode::{Decode, Encode};
use relaxed::BodiesWithPenetration;
use robot::Robot;
use validity::{Bounds, MotionChecking};
use with_function::BodiesWithFunction;

/// A robot of rigid links among rigid obstacles: plain data, complete in itself (meshes included).
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Bodies {
    /// The box that bounds the robot.
    pub(crate) bounds: Bounds,
    /// The farthest that any robot point moves between two checks of a motion; a length.
    pub(crate) resolution: f64,
    /// What is promised of the motions along edges.
    pub(crate) edges: MotionChecking,
    /// Length that one radian of rotation counts for in the metric.
    pub(crate) rotation_length: f64,
    /// The robot.
    pub(crate) robot: Robot,
    /// The obstacles in the world's frame.
    pub(crate) obstacles: Vec<Body>,
}

impl Bodies {
    /// The box that bounds the robot.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The farthest that any robot point moves between two checks of a motion; a length.
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// What is promised of the motions along edges.
    pub fn edges(&self) -> MotionChecking {
        self.edges
    }

    /// Length that one radian of rotation counts for in the metric.
    pub fn rotation_length(&self) -> f64 {
        self.rotation_length
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The obstacles in the world's frame.
    pub fn obstacles(&self) -> &[Body] {
        &self.obstacles
    }

    /// The key `may_touch` of a problem file with the pairs of links, of those that must not touch, that touch in all or in
    /// none of `samples` configurations drawn uniformly by the base seed, as MoveIt's Setup Assistant finds them.
    pub fn may_touch_lines(&self, samples: u64, base_seed: u64) -> String {
        touching_lines::lines(self, samples, base_seed)
    }

    /// The model itself, with what is particular to bodies.
    pub fn validity(&self) -> BodyValidity {
        let (edges, resolution) = (self.edges, self.resolution);
        let obstacles = &self.obstacles;
        BodyValidity::new(self.space(), &self.robot, self.bounds, edges, resolution, obstacles)
    }
}

impl Resolve for Bodies {
    type Spec = BodiesSpec;

    const TABLES: &'static [&'static str] = &["space", "robot", "obstacles"];

    fn spec(source: &Source) -> Result<BodiesSpec, ProblemError> {
        source.tables()
    }

    fn resolve(
        spec: &BodiesSpec,
        source: &Source,
        notes: &mut Vec<String>,
    ) -> Result<Bodies, ProblemError> {
        resolve::resolve(spec, source, notes)
    }

    fn to_spec(&self) -> BodiesSpec {
        again::spec_of(self)
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
        match self.edges {
            MotionChecking::Penetrating { depth } => {
                Box::new(BodiesWithPenetration::new(self.validity(), depth))
            }
            MotionChecking::Swept | MotionChecking::Sampled => Box::new(self.validity()),
        }
    }

    fn takes_function(&self) -> Result<(), &'static str> {
        match self.edges {
            MotionChecking::Sampled => Ok(()),
            MotionChecking::Swept => Err("space.edges: \"swept\" found"),
            MotionChecking::Penetrating { .. } => Err("space.edges: penetrating found"),
        }
    }

    fn prepare_with(&self, function: &ValidityFunction) -> Box<dyn Model> {
        Box::new(BodiesWithFunction::new(self.validity(), function.clone()))
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

    fn change(&self, after: &ModelKind) -> Result<SceneChange, String> {
        change::change(self, after)
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

    fn usual_relaxation(&self) -> Option<Relaxation> {
        Some(Relaxation::ScaleRobot(ScaleRobot::default()))
    }

    fn relaxed(&self, relaxation: &Relaxation, level: f64) -> Result<RelaxedModel, CannotRelax> {
        relaxed::relaxed(self, relaxation, level)
    }

    fn configurations_at(
        &self,
        goal: &PoseGoal,
        seed: &Seed,
        accept: &mut dyn FnMut(&mut [f64]) -> bool,
    ) -> Result<PoseFound, (&'static str, String)> {
        inverse_kinematics::configurations_at(self, goal, seed, accept)
    }
}

#[cfg(test)]
mod tests;
