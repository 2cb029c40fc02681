//! Parts of obstacles' surfaces: triangles and round shapes.

use super::hits;
use crate::lanes::Lanes;
use crate::model::bodies::validity::{Convex, nearest, nearest_points, separating_axis};
use crate::scene::Shape;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::{Pose, Vector};

/// The share of the size of coordinates below which a gap to a cylinder is none: the iteration that finds it is no more exact.
const CYLINDER_TOUCHING: f64 = 1e-9;

/// A part of an obstacle's surface.
pub(super) enum Element {
    /// A triangle's corners in the world's frame.
    Facet([Vector; 3]),
    /// A round shape and its pose in the world's frame.
    Round(Round, Pose),
}

/// A round shape about the z axis of its frame.
#[derive(Clone, Copy)]
pub(super) struct Round {
    pub radius: f64,
    /// Half the length of the axis, without what is round at its ends.
    pub half: f64,
    /// The shape for parry and its pose, of a shape with flat ends: a cylinder.
    pub flat: Option<(Convex, Pose)>,
}

impl Round {
    /// A ball; a point, if the radius is 0.
    pub fn ball(radius: f64) -> Round {
        Round { radius, half: 0.0, flat: None }
    }

    /// A shape that is round; `None` of others.
    pub fn of(shape: &Shape) -> Option<Round> {
        match shape {
            Shape::Sphere { radius } => Some(Round::ball(*radius)),
            Shape::Capsule { radius, height } => {
                Some(Round { radius: *radius, half: height / 2.0, flat: None })
            }
            Shape::Cylinder { radius, height } => {
                Some(Round { radius: *radius, half: height / 2.0, flat: Convex::of(shape) })
            }
            Shape::Point | Shape::Box { .. } | Shape::Mesh(_) => None,
        }
    }

    /// Whether a point of the shape's frame is within it.
    pub fn holds(&self, point: Vector) -> bool {
        let axial =
            if self.flat.is_some() { point.z } else { point.z.clamp(-self.half, self.half) };
        let away = point - Vector::Z * axial;
        let within = self.flat.is_none() || point.z.abs() <= self.half;
        within && away.length_squared() <= self.radius * self.radius
    }

    /// The point of the surface nearest to a point of the shape's frame, and the outward normal there. At the axis the normal is
    /// along x or, at a point of a ball's, along z.
    fn surface_near(&self, point: Vector) -> (Vector, Vector) {
        let radial = Vector::new(point.x, point.y, 0.0);
        let side = radial.try_normalize().unwrap_or(Vector::X);
        if self.flat.is_none() {
            let core = Vector::Z * point.z.clamp(-self.half, self.half);
            let on_axis = if self.half > 0.0 { side } else { Vector::Z };
            let normal = (point - core).try_normalize().unwrap_or(on_axis);
            return (core + normal * self.radius, normal);
        }
        let up = if point.z < 0.0 { -1.0 } else { 1.0 };
        let (to_side, to_end) = (self.radius - radial.length(), self.half - point.z.abs());
        if to_end < to_side {
            let at = radial.clamp_length_max(self.radius);
            (at + Vector::Z * (up * self.half), Vector::Z * up)
        } else {
            let height = point.z.clamp(-self.half, self.half);
            (side * self.radius + Vector::Z * height, side)
        }
    }

    fn core(&self, pose: &Pose) -> [Vector; 3] {
        let end = pose.transform_point(Vector::Z * self.half);
        [end, pose.transform_point(Vector::Z * -self.half), end]
    }
}

impl Element {
    pub fn aabb(&self) -> Aabb {
        match self {
            Element::Facet([a, b, c]) => Aabb::new(a.min(*b).min(*c), a.max(*b).max(*c)),
            Element::Round(round, pose) => {
                let [a, b, _] = round.core(pose);
                let by = Vector::splat(round.radius);
                Aabb::new(a.min(b) - by, a.max(b) + by)
            }
        }
    }

    /// Calls `f` with the shares of a segment at which it meets the surface.
    pub fn hits(&self, from: Vector, to: Vector, f: &mut dyn FnMut(f64)) {
        match self {
            Element::Facet(corners) => hits::facet(from, to, corners).into_iter().for_each(f),
            Element::Round(round, pose) => {
                let [from, to] = [from, to].map(|p| pose.inverse_transform_point(p));
                hits::round(from, to, round).into_iter().flatten().for_each(f);
            }
        }
    }

    /// Whether a triangle is no farther than `margin` away. `size` is that of coordinates.
    pub fn is_near(&self, lanes: Lanes, corners: &[Vector; 3], margin: f64, size: f64) -> bool {
        match self {
            Element::Facet(other) => {
                separating_axis(lanes, corners, other, margin).is_none() && {
                    let (p, q) = nearest_points(lanes, corners, other);
                    (p - q).length_squared() <= margin * margin
                }
            }
            Element::Round(round, pose) => {
                let reach = round.radius + margin;
                // Most triangles near a ball have a corner within reach of it, or are beside it along an axis.
                if round.half == 0.0 && round.flat.is_none() {
                    let away = corners.map(|corner| corner - pose.translation);
                    if away.iter().any(|corner| corner.length_squared() <= reach * reach) {
                        return true;
                    }
                    let [a, b, c] = away;
                    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
                    if low.max(-high).max_element() > reach {
                        return false;
                    }
                }
                let core = round.core(pose);
                let (p, q) = nearest_points(lanes, corners, &core);
                let near = (p - q).length_squared() <= reach * reach;
                // A cylinder is within the capsule around it.
                near && round.flat.is_none_or(|(shape, at)| {
                    let (triangle, triangle_at) = Convex::triangle(*corners, &Pose::IDENTITY);
                    let way = nearest((&shape, &(*pose * at)), (&triangle, &triangle_at));
                    way.is_none_or(|(p, q)| (p - q).length() <= margin + CYLINDER_TOUCHING * size)
                })
            }
        }
    }

    /// The surface near a triangle: of a triangle itself, of a round shape a triangle in the plane that touches it there, about as
    /// large as the shape is wide.
    pub fn facet(&self, lanes: Lanes, corners: &[Vector; 3]) -> [Vector; 3] {
        match self {
            Element::Facet(other) => *other,
            Element::Round(round, pose) => {
                let (near, _) = nearest_points(lanes, corners, &round.core(pose));
                let flat = round.flat.and_then(|(shape, at)| {
                    let (triangle, triangle_at) = Convex::triangle(*corners, &Pose::IDENTITY);
                    nearest((&shape, &(*pose * at)), (&triangle, &triangle_at))
                });
                let between = flat.and_then(|(p, q)| Some((p, (q - p).try_normalize()?)));
                let (at, normal) = match between {
                    Some((on_surface, outward)) => (
                        pose.inverse_transform_point(on_surface),
                        pose.rotation.inverse() * outward,
                    ),
                    None => round.surface_near(pose.inverse_transform_point(near)),
                };
                let u = normal.any_orthonormal_vector() * round.radius.max(f64::MIN_POSITIVE);
                let v = normal.cross(u);
                let half = 0.75f64.sqrt();
                [at + u, at - u * 0.5 + v * half, at - u * 0.5 - v * half]
                    .map(|corner| pose.transform_point(corner))
            }
        }
    }
}
