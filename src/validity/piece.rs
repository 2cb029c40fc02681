//! Bodies prepared for collision tests.

use super::inside::Inside;
use super::triangles::meshes_meet;
use crate::scene::{Body, Shape};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::{DefaultQueryDispatcher, QueryDispatcher};
use parry3d_f64::shape::SharedShape;

/// Where a piece stands in the world's frame.
pub(super) struct Placed {
    pose: Pose,
    body: Pose,
    pub aabb: Aabb,
}

/// A body prepared for collision tests. A point has no shape.
pub(super) struct Piece {
    shape: Option<SharedShape>,
    /// The shape's frame in the link's or the world's.
    pose: Pose,
    /// The body's own frame in the link's or the world's (a cylinder's differs from its shape's).
    body: Pose,
    form: Shape,
    inside: Option<Inside>,
    /// In the body's frame.
    witnesses: Vec<Vector>,
    /// Of an obstacle: its box in the world's frame.
    aabb: Aabb,
}

impl Piece {
    pub fn new(body: &Body) -> Piece {
        let frame = body.pose.to_parry();
        let (shape, pose) = match body.shape.to_parry() {
            Some((shape, local)) => (Some(shape), frame * local),
            None => (None, frame),
        };
        let inside = match &body.shape {
            Shape::Mesh(mesh) if body.solid => Some(Inside::new(mesh)),
            _ => None,
        };
        let origin = Vector::from_array(body.pose.translation);
        let aabb = match &shape {
            Some(shape) => shape.compute_aabb(&pose),
            None => Aabb::new(origin, origin),
        };
        let witnesses = body.shape.witnesses().into_iter().map(Vector::from_array).collect();
        Piece { shape, pose, body: frame, form: body.shape.clone(), inside, witnesses, aabb }
    }

    /// The piece where its link's frame stands at `link`.
    pub fn place(&self, link: &Pose) -> Placed {
        let pose = *link * self.pose;
        let body = *link * self.body;
        let aabb = match &self.shape {
            Some(shape) => shape.compute_aabb(&pose),
            None => Aabb::new(pose.translation, pose.translation),
        };
        Placed { pose, body, aabb }
    }

    /// The piece where its link's frame is the world's.
    pub fn in_world(&self) -> Placed {
        Placed { pose: self.pose, body: self.body, aabb: self.aabb }
    }

    /// Whether the surfaces of two pieces meet or one lies wholly inside the other and that one is
    /// solid.
    pub fn collides(&self, at: &Placed, other: &Piece, other_at: &Placed) -> bool {
        if !at.aabb.intersects(&other_at.aabb) {
            return false;
        }
        let touching = match (&self.shape, &other.shape) {
            (None, None) => false,
            (None, Some(shape)) => holds_point(shape, other_at, at),
            (Some(shape), None) => holds_point(shape, at, other_at),
            (Some(shape), Some(other_shape)) => {
                let pos12 = other_at.pose.inv_mul(&at.pose);
                match (other_shape.as_trimesh(), shape.as_trimesh()) {
                    (Some(mesh1), Some(mesh2)) => meshes_meet(&pos12, mesh1, mesh2),
                    _ => {
                        DefaultQueryDispatcher
                            .intersection_test(&pos12, &*other_shape.0, &*shape.0)
                            .expect("parry tests every pair of our shapes")
                            .intersecting
                    }
                }
            }
        };
        touching || other.encloses(other_at, self, at) || self.encloses(at, other, other_at)
    }

    /// Whether the piece holds a point of the other.
    fn encloses(&self, at: &Placed, other: &Piece, other_at: &Placed) -> bool {
        let Some(inside) = &self.inside else {
            return false;
        };
        other.witnesses.iter().any(|witness| {
            let world = other_at.body.transform_point(*witness);
            inside.contains(at.body.inverse_transform_point(world))
        })
    }

    /// Whether the piece lies between `min` and `max` along the first `axes` of the world's axes.
    pub fn is_between(&self, link: &Pose, axes: usize, min: &[f64; 3], max: &[f64; 3]) -> bool {
        let frame = *link * self.body;
        [Vector::X, Vector::Y, Vector::Z].iter().enumerate().take(axes).all(|(i, axis)| {
            let direction = frame.rotation.inverse() * *axis;
            let centre = frame.translation.to_array()[i];
            centre + self.form.extent(direction.to_array()) <= max[i]
                && centre - self.form.extent((-direction).to_array()) >= min[i]
        })
    }
}

/// A mesh has no inside for parry; [`Piece::encloses`] knows better.
fn holds_point(shape: &SharedShape, at: &Placed, point: &Placed) -> bool {
    shape.as_trimesh().is_none() && shape.contains_point(&at.pose, point.pose.translation)
}
