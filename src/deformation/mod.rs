//! Deformable robots: shapes that give way to obstacles, and paths along which they do (Bayazit, Lien and Amato, *Probabilistic
//! Roadmap Motion Planning for Deformable Objects*, ICRA 2002; Bayazit's dissertation, 2003, chapter VI).
//!
//! A roadmap is built for a rigid robot that may be smaller than the robot itself, or penetrate obstacles
//! ([`Deformable`](crate::model::deformable)). What is here deforms the robot along a path of that roadmap until it is free of
//! obstacles, or says that it cannot be.

mod geometric;
mod obstacles;
mod refusal;
mod shape;
mod soft_body;

pub use geometric::Geometric;
pub use obstacles::Obstacles;
pub use refusal::Refusal;
pub use shape::{Deform, Deformed};
pub use soft_body::SoftBody;
