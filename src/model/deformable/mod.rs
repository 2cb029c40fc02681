//! Robots that give way: rigid bodies whose robot may collide while the roadmap is built, as far as it can be deformed later.
//!
//! The description is [`Deformable`]: bodies as of any rigid robot, how that robot may collide ([`Feasibility`]), and how it is
//! deformed ([`DeformationSettings`]). The model judges the rigid robot alone, which may be smaller
//! (`scaled.rs`) or overlap obstacles (`penetrating.rs`). [`deformation`](crate::deformation) deforms it along paths of the roadmap.
//! `docs/deformable.md` says what the model is and what a result means. After O. B. Bayazit, J.-M. Lien, N. M. Amato,
//! *Probabilistic Roadmap Motion Planning for Deformable Objects*, ICRA 2002, §4.

mod describe;
mod penetrating;
mod resolve;
mod scaled;
mod settings;
mod sound;
mod spec;
mod surface;
#[cfg(test)]
mod tests;
mod weight;
mod write;

pub use settings::{
    BoundingBoxSettings, ChainMailOrder, DeformationMethod, DeformationSettings, Feasibility,
    GeometricSettings, LatticeInterpolation,
};
pub use spec::{DeformableSpec, FeasibilitySpec, GeometricSpec, MethodSpec, Scales};

use super::bodies::{Bodies, Scaling};
use super::{
    CannotRelax, Description, Documents, Figure, Model, ModelKind, NodeValue, PoseFound, PoseGoal,
    Relaxation, RelaxedModel, Resolve, SceneChange,
};
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::seed::Seed;
use crate::source::{ProblemError, Source, place_of};
use crate::space::Space;
use bincode::{Decode, Encode};
use penetrating::PenetratingBodies;
use scaled::ScaledBodies;

const SCALE: &[NodeValue] = &[NodeValue { name: "scale", unit: "1" }];
const DEPTH: &[NodeValue] = &[NodeValue { name: "depth", unit: "length" }];

/// A robot that gives way, among rigid obstacles: plain data, complete in itself.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Deformable {
    /// The robot at rest, of one link, and the obstacles.
    pub(crate) bodies: Bodies,
    /// How the rigid robot may collide while the roadmap is built.
    pub(crate) feasibility: Feasibility,
    /// How a query deforms the robot.
    pub(crate) deformation: DeformationSettings,
    /// The longest that edges of the robot's triangles are: longer ones are split. A length.
    pub(crate) longest_edge: f64,
}

impl Deformable {
    /// The robot at rest, and the obstacles.
    pub fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// How the rigid robot may collide while the roadmap is built.
    pub fn feasibility(&self) -> &Feasibility {
        &self.feasibility
    }

    /// How a query deforms the robot.
    pub fn deformation(&self) -> &DeformationSettings {
        &self.deformation
    }

    /// The longest that edges of the robot's triangles are, a length.
    pub fn longest_edge(&self) -> f64 {
        self.longest_edge
    }

    /// The surface of the robot at rest in the robot's frame: what is deformed, checked and promised.
    ///
    /// It is a closed mesh, wound so that triangles are seen counter-clockwise from outside, with one piece for each body
    /// of the robot; bodies that overlap stay pieces that overlap. A mesh keeps its vertices, boxes have their corners, and round shapes have 32 vertices
    /// around their axis, which lie on the shape: the surface is within the shape. Edges longer than
    /// [`Deformable::longest_edge`] are halved until none is.
    pub fn surface(&self) -> Mesh {
        surface::surface(&self.bodies, self.longest_edge)
    }

    /// The method of deformation that is asked for; what it leaves open follows from the size of the robot, as in a problem file.
    pub fn method(&self, asked: &MethodSpec) -> DeformationMethod {
        resolve::method(asked, surface::longest_side(&self.bodies))
    }

    /// The same with another robot, a mesh in the robot's frame: a path that was found for one robot can be given to another, as in the paper's
    /// sliding experiment (§7). Only how that robot is deformed is meant by it; the roadmap is the first robot's. The longest edge and, of the
    /// geometric method, the neighbourhood are scaled by the longest sides of the two robots' bounding boxes.
    ///
    /// # Errors
    /// What is wrong with the mesh: it is not closed, say.
    pub fn with_robot(&self, mesh: &Mesh) -> Result<Deformable, String> {
        let mut other = self.clone();
        let body = Body { shape: Shape::Mesh(mesh.clone()), pose: Pose::IDENTITY, solid: true };
        let links = &mut other.bodies.robot.links;
        links.iter_mut().for_each(|link| link.bodies = vec![body.clone()]);
        if let Some(complaint) = mesh.surface_complaint() {
            return Err(complaint);
        }
        // Lengths that follow from the size of the robot grow with it.
        let grown = surface::longest_side(&other.bodies) / surface::longest_side(&self.bodies);
        other.longest_edge *= grown;
        if let DeformationMethod::Geometric(settings) = &mut other.deformation.method {
            settings.neighbourhood *= grown;
        }
        other.sound().map(|()| other)
    }

    /// The bodies with the robot, and its padding, scaled about a point of the robot's frame that stays in its place. At a scale of 1
    /// they are what they are, to the bit.
    pub(super) fn scaled(&self, scale: f64, centre: [f64; 3]) -> Bodies {
        let mut bodies = self.bodies.clone();
        if scale == 1.0 {
            return bodies;
        }
        let scaling = Scaling { centre, factors: [scale; 3] };
        for body in bodies.robot.links.iter_mut().flat_map(|link| &mut link.bodies) {
            *body = scaling
                .of(body)
                .expect("with one factor for all axes every shape stays of its kind");
        }
        bodies.robot.padding.iter_mut().for_each(|length| *length *= scale);
        bodies
    }
}

impl Resolve for Deformable {
    type Spec = DeformableSpec;

    const TABLES: &'static [&'static str] = &["deformable", "space", "robot", "obstacles"];

    fn spec(source: &Source) -> Result<DeformableSpec, ProblemError> {
        spec::read(source)
    }

    fn resolve(
        spec: &DeformableSpec,
        source: &Source,
        notes: &mut Vec<String>,
    ) -> Result<Deformable, ProblemError> {
        resolve::resolve(spec, source, notes)
    }

    fn to_spec(&self) -> DeformableSpec {
        resolve::to_spec(self)
    }
}

impl Description for Deformable {
    fn space(&self) -> Space {
        self.bodies.space()
    }

    fn node_values(&self) -> &'static [NodeValue] {
        match self.feasibility {
            Feasibility::Scaled { .. } => SCALE,
            Feasibility::Penetrating { .. } => DEPTH,
        }
    }

    fn cost_unit(&self) -> &'static str {
        match self.feasibility {
            Feasibility::Scaled { .. } => "1",
            Feasibility::Penetrating { .. } => "length",
        }
    }

    fn has_directed_costs(&self) -> bool {
        true
    }

    fn sound(&self) -> Result<(), String> {
        self.bodies.sound()?;
        let complaint = self.complaint();
        complaint.map_or(Ok(()), |(place, message)| Err(format!("{}: {message}", place_of(&place))))
    }

    fn prepare(&self) -> Box<dyn Model> {
        match &self.feasibility {
            Feasibility::Scaled { scales, centre } => {
                let scaled = |scale: &f64| (*scale, self.scaled(*scale, *centre).validity());
                Box::new(ScaledBodies::new(scales.iter().map(scaled).collect()))
            }
            Feasibility::Penetrating { depth, vectors } => {
                Box::new(PenetratingBodies::new(self.bodies.validity(), *depth, *vectors))
            }
        }
    }

    fn difference(&self, other: &ModelKind) -> Option<&'static str> {
        // Without `..`: whoever adds a field has to compare it here.
        let Deformable { bodies, feasibility, deformation, longest_edge } = self;
        let Some(other) = other.deformable() else { return Some("the kind of model") };
        bodies.difference(&ModelKind::Bodies(other.bodies.clone())).or_else(|| {
            let parts = [
                ("how the rigid robot may collide", *feasibility == other.feasibility),
                ("how the robot is deformed", *deformation == other.deformation),
                ("the longest edge of the robot's triangles", *longest_edge == other.longest_edge),
            ];
            parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
        })
    }

    fn change(&self, _after: &ModelKind) -> Result<SceneChange, String> {
        Err("the model has a deformable robot, of which every node's scale or depth follows from all obstacles; rigid bodies expected"
            .to_owned())
    }

    fn describe(&self, out: &mut String) {
        describe::describe(self, out).expect("writing to memory cannot fail");
    }

    fn write(&self, documents: &mut Documents) {
        write::write(self, documents);
    }

    fn configurations_at(
        &self,
        goal: &PoseGoal,
        seed: &Seed,
        accept: &mut dyn FnMut(&mut [f64]) -> bool,
    ) -> Result<PoseFound, (&'static str, String)> {
        self.bodies.configurations_at(goal, seed, accept)
    }

    fn relaxed(&self, relaxation: &Relaxation, _level: f64) -> Result<RelaxedModel, CannotRelax> {
        let expected = "rigid bodies expected, as a deformable robot's feasibility is a relaxation";
        Err(CannotRelax::unknown(relaxation, "a deformable robot", expected))
    }

    fn figure(&self) -> Option<&dyn Figure> {
        Some(&self.bodies)
    }
}
