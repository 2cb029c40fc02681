//! Deformable robots: shapes that give way to obstacles, and paths along which they do (Bayazit, Lien and Amato, *Probabilistic
//! Roadmap Motion Planning for Deformable Objects*, ICRA 2002; Bayazit's dissertation, 2003, chapter VI).
//!
//! A roadmap is built for a rigid robot that may be smaller than the robot itself, or penetrate obstacles
//! ([`Deformable`](crate::model::deformable)). What is here deforms the robot along a path of that roadmap until it is free of
//! obstacles, or says that it cannot be.

mod answer;
pub mod bounding_box;
mod bounds;
mod edge;
mod geometric;
mod obstacles;
mod path;
mod prepared;
mod query;
mod refusal;
mod robot;
mod search;
mod shape;
mod soft_body;

#[cfg(test)]
mod tests;

pub use answer::{DeformingAnswer, NoDeformedPath, RemovedEdge};
pub use bounding_box::BoundingBox;
pub use geometric::Geometric;
pub use obstacles::Obstacles;
pub use path::{Between, DeformedPath, Frame};
pub use prepared::PreparedRobot;
pub use query::{deform_path, deform_query};
pub use refusal::Refusal;
pub use robot::{DeformableRobot, Deformations};
pub use shape::{Deform, Deformed};
pub use soft_body::SoftBody;
