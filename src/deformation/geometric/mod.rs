//! Geometric deformation (Bayazit, Lien and Amato, *Probabilistic Roadmap Motion Planning for Deformable Objects*, ICRA 2002, §6.2): the
//! triangles of the robot that collide are moved until they are free.
//!
//! Colliding triangles make [regions](regions). Each is pushed in one of several [directions](directions), the one in which the
//! [push](push) is shortest, or, where none frees it, toward a [smaller robot](guide) that is free; then it [settles](settle) against the
//! obstacle. [Smoothing](smoothing) restores the limits of edge lengths. As long as that makes triangles collide again, this is repeated.
//!
//! A shape is a pure function of the pose. It follows the pose continuously but where the choice among directions, or whether there is a region,
//! changes: there it jumps. `docs/deformable-geometric.md` says what of this the paper leaves open.

mod attempt;
mod directions;
mod guide;
mod push;
mod regions;
mod self_collision;
mod settle;
mod smoothing;
mod surface;
#[cfg(test)]
mod tests;
mod trial;

use self::attempt::Attempt;
use self::self_collision::SelfCollision;
use self::smoothing::Limits;
use self::surface::Surface;
use super::shape::lengths;
use super::{Deform, Deformed, Obstacles, Refusal, SoftBody};
use crate::model::deformable::GeometricSettings;
use crate::scene::Pose;
use parry3d_f64::math::Vector;
use std::sync::Arc;

/// Deformation of the robot's own triangles.
///
/// The energy of a shape is the sum of the displacements of all vertices from where they are at rest, a length.
pub struct Geometric {
    body: SoftBody,
    settings: GeometricSettings,
    highest_energy: f64,
    clearance: f64,
    obstacles: Arc<Obstacles>,
    surface: Surface,
    limits: Limits,
    uniform: Vec<Vector>,
    /// The vertices of the guides, in the robot's frame.
    guides: [Vec<Vector>; 2],
    /// The centroid of the robot at rest, in its frame.
    centroid: Vector,
    /// The diagonal of the robot's bounding box.
    size: f64,
    self_collision: Option<SelfCollision>,
}

impl Geometric {
    /// A method that deforms this robot among these obstacles. Shapes have at most `highest_energy`, a length that may be infinite, and are no nearer
    /// to obstacles than `clearance`.
    ///
    /// # Errors
    /// What of the settings is out of its range.
    pub fn new(
        body: &SoftBody,
        settings: &GeometricSettings,
        highest_energy: f64,
        clearance: f64,
        obstacles: Arc<Obstacles>,
    ) -> Result<Geometric, String> {
        if let Some((key, message)) = settings.complaint() {
            return Err(format!("{key}: {message}"));
        }
        lengths(highest_energy, clearance)?;
        let surface = Surface::new(body);
        let rest: Vec<Vector> = body.vertices().iter().copied().map(Vector::from_array).collect();
        let centroid = guide::centroid(body);
        let (min, max) = body.mesh().bounding_box();
        let diagonal = Vector::from_array(max) - Vector::from_array(min);
        let size = diagonal.dot(diagonal).sqrt();
        Ok(Geometric {
            guides: guide::guides(body, &surface, settings.guide, size),
            uniform: directions::uniform(settings.directions),
            self_collision: settings
                .refuse_self_collisions
                .then(|| SelfCollision::new(&surface, &rest)),
            size,
            body: body.clone(),
            settings: settings.clone(),
            highest_energy,
            clearance,
            obstacles,
            limits: Limits { shortest: settings.shortest, longest: settings.longest },
            surface,
            centroid,
        })
    }
}

impl Deform for Geometric {
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
        let rest: Vec<[f64; 3]> =
            self.body.vertices().iter().map(|vertex| pose.apply(*vertex)).collect();
        if self.obstacles.is_free_body(&self.body, &rest, self.clearance) {
            return Ok(Deformed { vertices: self.body.vertices().to_vec(), energy: 0.0 });
        }
        Attempt::new(self, pose, rest).deform()
    }

    /// The edges of a blend must keep their lengths within the limits, which two shapes may do and their blend not; and where shapes
    /// that meet themselves are refused, so are such blends.
    fn accepts_blend(&self, _pose: &Pose, vertices: &[[f64; 3]]) -> bool {
        let shape: Vec<Vector> = vertices.iter().copied().map(Vector::from_array).collect();
        self.limits.are_kept(&self.surface, &shape)
            && !self.self_collision.as_ref().is_some_and(|own| own.is_met(&self.surface, &shape))
    }
}
