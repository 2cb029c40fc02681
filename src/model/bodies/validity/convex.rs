//! Convex shapes as parry has them, and what is asked of pairs of them.
//!
//! Parry's searches for the distance of two shapes (GJK) have an absolute tolerance, 10⁻¹⁵ or so: of shapes that are
//! themselves smaller than some 10⁻⁶ it makes a collision of every gap. So a pair is first brought to a unit of length
//! in which the larger shape has a size between 1 and 2. The unit is a power of two, by which lengths are divided without
//! rounding: a scene of which all lengths are doubled or halved has the same verdicts, bit for bit.

use crate::scene;
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::details::closest_points_support_map_support_map;
use parry3d_f64::query::{ClosestPoints, DefaultQueryDispatcher, QueryDispatcher};
use parry3d_f64::shape::{Ball, Capsule, Cuboid, Cylinder, Segment, Shape, SupportMap, Triangle};

/// A convex shape. Cylinders and capsules stand along y.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Convex {
    Ball(Ball),
    Cuboid(Cuboid),
    Cylinder(Cylinder),
    Capsule(Capsule),
    /// A triangle with its first corner at the origin; corners may coincide.
    Triangle(Triangle),
}

impl Convex {
    /// The shape of a body and its pose in the body's frame; `None` for points and meshes.
    pub fn of(shape: &scene::Shape) -> Option<(Convex, Pose)> {
        let (shared, pose) = shape.to_parry()?;
        let ball = shared.as_ball().map(|ball| Convex::Ball(*ball));
        let cuboid = || shared.as_cuboid().map(|cuboid| Convex::Cuboid(*cuboid));
        let cylinder = || shared.as_cylinder().map(|cylinder| Convex::Cylinder(*cylinder));
        let capsule = || shared.as_capsule().map(|capsule| Convex::Capsule(*capsule));
        let convex = ball.or_else(cuboid).or_else(cylinder).or_else(capsule)?;
        Some((convex, pose))
    }

    /// A triangle, and the pose at which it stands when its corners are given in a frame that stands at `at`. Far from
    /// the frame's origin the differences of corners are exact where their coordinates are not small.
    pub fn triangle([a, b, c]: [Vector; 3], at: &Pose) -> (Convex, Pose) {
        let triangle = Triangle::new(Vector::ZERO, b - a, c - a);
        (Convex::Triangle(triangle), *at * Pose::from_translation(a))
    }

    /// The largest of the lengths that describe the shape.
    fn size(&self) -> f64 {
        match self {
            Convex::Ball(ball) => ball.radius,
            Convex::Cuboid(cuboid) => cuboid.half_extents.max_element(),
            Convex::Cylinder(cylinder) => cylinder.half_height.max(cylinder.radius),
            Convex::Capsule(capsule) => capsule.segment.a.y.abs().max(capsule.radius),
            Convex::Triangle(Triangle { b, c, .. }) => b.abs().max(c.abs()).max_element(),
        }
    }

    /// Whether parry's answers about the shape do not depend on the unit of length, except beside one of another kind.
    fn has_no_tolerance(&self) -> bool {
        matches!(self, Convex::Ball(_) | Convex::Cuboid(_))
    }

    /// The shape with all lengths multiplied by a factor.
    fn scaled(&self, factor: f64) -> Convex {
        match self {
            Convex::Ball(ball) => Convex::Ball(Ball::new(ball.radius * factor)),
            Convex::Cuboid(cuboid) => Convex::Cuboid(Cuboid::new(cuboid.half_extents * factor)),
            Convex::Cylinder(Cylinder { half_height, radius }) => {
                Convex::Cylinder(Cylinder::new(half_height * factor, radius * factor))
            }
            Convex::Capsule(Capsule { segment: Segment { a, b }, radius }) => {
                Convex::Capsule(Capsule::new(*a * factor, *b * factor, radius * factor))
            }
            Convex::Triangle(Triangle { a, b, c }) => {
                Convex::Triangle(Triangle::new(*a * factor, *b * factor, *c * factor))
            }
        }
    }

    fn as_shape(&self) -> &dyn Shape {
        match self {
            Convex::Ball(ball) => ball,
            Convex::Cuboid(cuboid) => cuboid,
            Convex::Cylinder(cylinder) => cylinder,
            Convex::Capsule(capsule) => capsule,
            Convex::Triangle(triangle) => triangle,
        }
    }

    fn as_support_map(&self) -> &dyn SupportMap {
        match self {
            Convex::Ball(ball) => ball,
            Convex::Cuboid(cuboid) => cuboid,
            Convex::Cylinder(cylinder) => cylinder,
            Convex::Capsule(capsule) => capsule,
            Convex::Triangle(triangle) => triangle,
        }
    }

    /// Whether the shape, at a pose, holds a point.
    pub fn holds(&self, at: &Pose, point: Vector) -> bool {
        let factor = 1.0 / unit_of(self.size());
        let local = at.inverse_transform_point(point) * factor;
        self.scaled(factor).as_shape().contains_local_point(local)
    }

    /// The smallest box along the axes of a frame that holds the shape at a pose in that frame.
    pub fn aabb(&self, at: &Pose) -> parry3d_f64::bounding_volume::Aabb {
        self.as_shape().compute_aabb(at)
    }
}

/// The largest power of two that is no larger than a length; 1 for lengths that are zero or next to it.
fn unit_of(length: f64) -> f64 {
    // The exponent without the digits.
    let unit = f64::from_bits(length.to_bits() & f64::INFINITY.to_bits());
    if unit > 0.0 && unit.is_finite() { unit } else { 1.0 }
}

/// Two shapes, and the pose of the second as seen from the first, in a unit of their size.
struct Pair {
    one: Convex,
    other: Convex,
    between: Pose,
    unit: f64,
}

impl Pair {
    fn new((one, at): (&Convex, &Pose), (other, other_at): (&Convex, &Pose)) -> Pair {
        let unit = unit_of(one.size().max(other.size()));
        let factor = 1.0 / unit;
        let mut between = at.inv_mul(other_at);
        between.translation *= factor;
        Pair { one: one.scaled(factor), other: other.scaled(factor), between, unit }
    }
}

/// Whether two shapes meet, touching included.
pub(super) fn meet(one: (&Convex, &Pose), other: (&Convex, &Pose)) -> bool {
    let ask = |between: &Pose, one: &Convex, other: &Convex| {
        DefaultQueryDispatcher
            .intersection_test(between, one.as_shape(), other.as_shape())
            .expect("parry tests every pair of our shapes")
            .intersecting
    };
    if one.0.has_no_tolerance() && other.0.has_no_tolerance() {
        return ask(&one.1.inv_mul(other.1), one.0, other.0);
    }
    let Pair { one, other, between, .. } = Pair::new(one, other);
    ask(&between, &one, &other)
}

/// The nearest points of two shapes, each in the frame in which the pose of its shape is given; `None` where they meet.
pub(crate) fn nearest(one: (&Convex, &Pose), other: (&Convex, &Pose)) -> Option<(Vector, Vector)> {
    let pair = Pair::new(one, other);
    let (first, second) = (pair.one.as_support_map(), pair.other.as_support_map());
    match closest_points_support_map_support_map(&pair.between, first, second, f64::MAX) {
        ClosestPoints::WithinMargin(p, q) => {
            let place = |at: &Pose, point: Vector| at.transform_point(point * pair.unit);
            Some((place(one.1, p), place(other.1, q)))
        }
        _ => None,
    }
}
