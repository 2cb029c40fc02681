//! The elements in the leaves of bounding-volume hierarchies: triangles of meshes and boxes, and rounded hulls in
//! place of the other primitives.

use crate::model::bodies::robot::Rates;
use crate::scene::{Body, Shape, box_surface};
use parry3d_f64::math::Vector;

/// All points within `radius` of the convex hull of three corners: a triangle, or, where corners coincide, a
/// capsule, a ball or a point. A cylinder is represented by the capsule around it, marked `flat`.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// The corners in the frame of the tree: a link's or the world's.
    pub corners: [Vector; 3],
    pub radius: f64,
    /// Index of the body that the element belongs to.
    pub piece: u32,
    /// Whether that body is a primitive. At a single configuration it is then tested as a whole.
    pub primitive: bool,
    /// Whether the element is a capsule around a cylinder, so that it is larger than the body.
    pub flat: bool,
    /// A vector along the normal of a triangle; zero where there is no normal.
    pub normal: Vector,
}

impl Element {
    fn new([a, b, c]: [Vector; 3], radius: f64, piece: u32) -> Element {
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        // The normal of a triangle thinner than this would be all rounding; the triangle is treated as a segment.
        let thin = normal.length() <= 1e-14 * u.length() * v.length();
        let normal = if thin { Vector::ZERO } else { normal };
        Element { corners: [a, b, c], radius, piece, primitive: false, flat: false, normal }
    }

    /// The least and the largest `p · axis` over the element's points (of a cylinder: over the capsule's), for a unit
    /// vector `axis`.
    pub fn span(&self, axis: Vector) -> (f64, f64) {
        let [a, b, c] = self.corners.map(|corner| axis.dot(corner));
        (a.min(b).min(c) - self.radius, a.max(b).max(c) + self.radius)
    }

    /// The largest `p · direction` over the body's points in the element, for a unit vector `direction`: its support
    /// in that direction. Of a cylinder it is exact.
    pub fn extent(&self, direction: Vector) -> f64 {
        let [a, b, c] = self.corners;
        let thick = match (self.flat, (a - b).try_normalize()) {
            (true, Some(axis)) => self.radius * axis.cross(direction).length(),
            _ => self.radius,
        };
        direction.dot(a).max(direction.dot(b)).max(direction.dot(c)) + thick
    }

    /// A bound on the distance of the element's points from the axis or the point about which a motion turns it.
    pub fn reach(&self, rates: &Rates) -> f64 {
        let [a, b, c] = self.corners;
        rates.distance(a).max(rates.distance(b)).max(rates.distance(c)).max(0.0) + self.radius
    }
}

/// The surface of a body as elements, in the frame of its link or of the world. `piece` is the index of the body.
pub(super) fn elements(body: &Body, piece: u32) -> Vec<Element> {
    let frame = body.pose.to_parry();
    let place = |p: [f64; 3]| frame.transform_point(Vector::from_array(p));
    let rod = |radius: f64, height: f64| {
        let ends = [height / 2.0, -height / 2.0].map(|z| place([0.0, 0.0, z]));
        Element::new([ends[0], ends[1], ends[0]], radius, piece)
    };
    let surface = |vertices: &[[f64; 3]], triangles: Vec<[u32; 3]>| {
        let corner = |index: u32| place(vertices[index as usize]);
        triangles.into_iter().map(|t| Element::new(t.map(corner), 0.0, piece)).collect()
    };
    let mut elements: Vec<Element> = match &body.shape {
        Shape::Point => vec![rod(0.0, 0.0)],
        Shape::Sphere { radius } => vec![rod(*radius, 0.0)],
        Shape::Capsule { radius, height } => vec![rod(*radius, *height)],
        Shape::Cylinder { radius, height } => {
            vec![Element { flat: true, ..rod(*radius, *height) }]
        }
        Shape::Box { size } => {
            let (corners, triangles) = box_surface(*size);
            surface(&corners, triangles)
        }
        Shape::Mesh(mesh) => surface(&mesh.vertices, mesh.faces().collect()),
    };
    let primitive = !matches!(body.shape, Shape::Mesh(_));
    elements.iter_mut().for_each(|element| element.primitive = primitive);
    elements
}
