//! Bodies prepared for collision tests.

use super::convex::Convex;
use super::inside::Inside;
use crate::scene::{Body, Shape};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Vector};

/// A body prepared for collision tests.
pub(super) struct Piece {
    /// The shape as parry's, of a primitive other than a point.
    primitive: Option<Convex>,
    /// The pose of parry's shape in the link's frame or the world's.
    pose: Pose,
    /// The pose of the body in the link's frame or the world's. It differs from that of parry's shape for
    /// cylinders and capsules, whose axes parry has along y.
    body: Pose,
    is_point: bool,
    /// The test for containment, of a solid mesh.
    inside: Option<Inside>,
    /// A point of each connected part of the surface, in the body's frame.
    witnesses: Vec<Vector>,
    /// The bounding box in the link's frame or the world's, padding included.
    aabb: Aabb,
    /// By how much the body is thicker than [`Piece::primitive`] or the mesh, on all sides.
    padding: f64,
}

impl Piece {
    pub fn new(body: &Body) -> Piece {
        let frame = body.pose.to_parry();
        let (primitive, pose) = match Convex::of(&body.shape) {
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
                Some(shape) => shape.aabb(&pose),
                None => Aabb::new(frame.translation, frame.translation),
            },
        };
        let is_point = matches!(body.shape, Shape::Point);
        let witnesses = body.shape.witnesses().into_iter().map(Vector::from_array).collect();
        Piece { primitive, pose, body: frame, is_point, inside, witnesses, aabb, padding: 0.0 }
    }

    /// A body that is thicker by `padding` on all sides.
    pub fn padded(body: &Body, padding: f64) -> Piece {
        let piece = Piece::new(body);
        Piece { aabb: piece.aabb.loosened(padding), padding, ..piece }
    }

    /// By how much the body is thicker than its primitive or its mesh, on all sides.
    pub fn padding(&self) -> f64 {
        self.padding
    }

    pub fn is_point(&self) -> bool {
        self.is_point
    }

    /// The convex shape, unless the piece is a point or a mesh.
    pub fn primitive(&self) -> Option<&Convex> {
        self.primitive.as_ref()
    }

    /// The pose of [`Piece::primitive`] in the world, the link being at the pose `link`.
    pub fn pose_at(&self, link: &Pose) -> Pose {
        *link * self.pose
    }

    /// Whether a primitive holds a point of the world's frame; a mesh never does, but see
    /// [`Piece::encloses`].
    pub fn holds(&self, link: &Pose, point: Vector) -> bool {
        self.primitive.as_ref().is_some_and(|shape| shape.holds(&self.pose_at(link), point))
    }

    /// Whether the body is solid and holds a point that is given in the frame of its link, or in the world's; its padding does not count.
    pub fn holds_in_own_group(&self, point: Vector) -> bool {
        match (&self.inside, &self.primitive) {
            (Some(inside), _) => inside.contains(self.body.inverse_transform_point(point)),
            (None, Some(shape)) => shape.holds(&self.pose, point),
            (None, None) => false,
        }
    }

    /// Whether the body is a solid mesh: its inside is material, but only its surface is in the tree.
    pub fn is_hollow(&self) -> bool {
        self.inside.is_some()
    }

    /// A bounding box of the body in the world's frame.
    pub fn box_at(&self, link: &Pose) -> Aabb {
        self.aabb.transform_by(link)
    }

    /// Whether the body is a solid mesh that encloses a witness of the other body. Where the two surfaces do not
    /// meet, the connected part that the witness stands for is then wholly inside.
    pub fn encloses(&self, link: &Pose, other: &Piece, other_link: &Pose) -> bool {
        self.inside.as_ref().is_some_and(|inside| {
            other.witnesses.iter().any(|witness| {
                let world = (*other_link * other.body).transform_point(*witness);
                inside.contains((*link * self.body).inverse_transform_point(world))
            })
        })
    }
}
