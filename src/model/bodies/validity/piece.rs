//! Bodies prepared for collision tests.

use super::inside::Inside;
use crate::scene::{Body, Shape};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::shape::{Shape as ParryShape, SharedShape};

/// A body prepared for collision tests.
pub(super) struct Piece {
    /// Of a primitive but for the point.
    primitive: Option<SharedShape>,
    /// Its frame in the link's or the world's.
    pose: Pose,
    /// The body's own frame in the link's or the world's (a cylinder's differs from its shape's).
    body: Pose,
    is_point: bool,
    /// Of a solid mesh.
    inside: Option<Inside>,
    /// In the body's frame.
    witnesses: Vec<Vector>,
    /// In the link's frame or the world's.
    aabb: Aabb,
}

impl Piece {
    pub fn new(body: &Body) -> Piece {
        let frame = body.pose.to_parry();
        let (primitive, pose) = match body.shape.to_parry() {
            Some((shape, local)) => (Some(shape), frame * local),
            None => (None, frame),
        };
        let inside = match &body.shape {
            Shape::Mesh(mesh) if body.solid => Some(Inside::new(mesh)),
            _ => None,
        };
        let aabb = match &body.shape {
            Shape::Mesh(mesh) => {
                let (min, max) = mesh.bounding_box();
                let own = Aabb::new(Vector::from_array(min), Vector::from_array(max));
                own.transform_by(&frame)
            }
            _ => match &primitive {
                Some(shape) => shape.compute_aabb(&pose),
                None => Aabb::new(frame.translation, frame.translation),
            },
        };
        let is_point = matches!(body.shape, Shape::Point);
        let witnesses = body.shape.witnesses().into_iter().map(Vector::from_array).collect();
        Piece { primitive, pose, body: frame, is_point, inside, witnesses, aabb }
    }

    pub fn is_point(&self) -> bool {
        self.is_point
    }

    /// The convex shape, unless the piece is a point or a mesh.
    pub fn primitive(&self) -> Option<&dyn ParryShape> {
        self.primitive.as_deref()
    }

    /// Where [`Piece::primitive`] stands when the link's frame stands at `link`.
    pub fn place(&self, link: &Pose) -> Pose {
        *link * self.pose
    }

    /// Whether a primitive holds a point of the world's frame; a mesh never does, but see
    /// [`Piece::encloses`].
    pub fn holds(&self, link: &Pose, point: Vector) -> bool {
        self.primitive.as_ref().is_some_and(|shape| shape.contains_point(&self.place(link), point))
    }

    /// Whether the piece has an inside that its surface does not show.
    pub fn is_hollow(&self) -> bool {
        self.inside.is_some()
    }

    /// A box around the piece in the world's frame.
    pub fn box_at(&self, link: &Pose) -> Aabb {
        self.aabb.transform_by(link)
    }

    /// Whether the piece, a solid mesh, encloses a point of the other's surface. Where their surfaces
    /// do not meet it then encloses one of its connected parts.
    pub fn encloses(&self, link: &Pose, other: &Piece, other_link: &Pose) -> bool {
        self.inside.as_ref().is_some_and(|inside| {
            other.witnesses.iter().any(|witness| {
                let world = (*other_link * other.body).transform_point(*witness);
                inside.contains((*link * self.body).inverse_transform_point(world))
            })
        })
    }
}
