//! What deformed shapes are judged by: obstacles that stand still, made ready for questions about triangles, segments and points.
//!
//! Meshes and boxes are triangles, exactly; round shapes are what they are, no triangles. All lengths are in the scene's unit, and
//! all points in the world's frame. Touching counts as meeting, and so does a gap below 10⁻¹² of the size of the coordinates (10⁻⁹
//! for cylinders, whose distance is found by an iteration): what is found free here meets nothing by any other judge either.

mod element;
mod hits;
mod surface;
#[cfg(test)]
mod tests;

use crate::lanes::Lanes;
use crate::model::bodies::validity::Inside;
use crate::scene::{Body, Shape, box_surface};
use element::{Element, Round};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use smallvec::SmallVec;

/// The share of the size of coordinates below which a gap is none.
const TOUCHING: f64 = 1e-12;

/// Obstacles in the world's frame, made ready for questions about shapes.
pub struct Obstacles {
    /// The surfaces, in parts.
    elements: Vec<Element>,
    /// The boxes of the parts.
    tree: Bvh,
    /// What has an inside.
    solids: Vec<Solid>,
    /// A point of each connected piece of each obstacle.
    witnesses: Vec<Vector>,
    /// The largest size of a coordinate.
    size: f64,
    /// The instructions by which triangles are tested; no result depends on them.
    lanes: Lanes,
}

/// An obstacle with an inside.
struct Solid {
    pose: ParryPose,
    aabb: Aabb,
    inside: Filled,
}

/// What tells whether a point is inside.
enum Filled {
    Box(Vector),
    Round(Round),
    Mesh(Box<Inside>),
}

impl Obstacles {
    /// Obstacles of these bodies. Of meshes those have an inside that are closed and [solid](Body::solid).
    pub fn new(bodies: &[Body]) -> Obstacles {
        let (mut elements, mut solids, mut witnesses) = (Vec::new(), Vec::new(), Vec::new());
        for body in bodies {
            let pose = body.pose.to_parry();
            let place = |point: &[f64; 3]| pose.transform_point(Vector::from_array(*point));
            witnesses.extend(body.shape.witnesses().iter().map(place));
            let first = elements.len();
            let facets = |vertices: &[[f64; 3]], triangles: &[[u32; 3]]| {
                let facet = |corners: &[u32; 3]| {
                    Element::Facet(corners.map(|corner| place(&vertices[corner as usize])))
                };
                triangles.iter().map(facet).collect::<Vec<_>>()
            };
            let filled = match &body.shape {
                Shape::Mesh(mesh) => {
                    elements.extend(facets(&mesh.vertices, &mesh.triangles));
                    let has_inside = body.solid && mesh.is_closed();
                    has_inside.then(|| Filled::Mesh(Box::new(Inside::new(mesh))))
                }
                Shape::Box { size } => {
                    let (corners, triangles) = box_surface(*size);
                    elements.extend(facets(&corners, &triangles));
                    Some(Filled::Box(Vector::from_array(*size) / 2.0))
                }
                Shape::Point => {
                    elements.push(Element::Round(Round::ball(0.0), pose));
                    None
                }
                Shape::Sphere { .. } | Shape::Cylinder { .. } | Shape::Capsule { .. } => {
                    let round = Round::of(&body.shape);
                    elements.extend(round.map(|round| Element::Round(round, pose)));
                    round.map(Filled::Round)
                }
            };
            let boxes = elements[first..].iter().map(Element::aabb);
            let aabb = boxes
                .reduce(|one, other| Aabb::new(one.mins.min(other.mins), one.maxs.max(other.maxs)));
            if let (Some(inside), Some(aabb)) = (filled, aabb) {
                solids.push(Solid { pose, aabb, inside });
            }
        }
        let boxes: Vec<Aabb> = elements.iter().map(Element::aabb).collect();
        let size = boxes.iter().fold(0.0, |most, b: &Aabb| {
            f64::max(most, b.mins.abs().max(b.maxs.abs()).max_element())
        });
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        Obstacles { elements, tree, solids, witnesses, size, lanes: Lanes::widest() }
    }

    /// Whether a point is within a solid obstacle.
    pub fn contains(&self, point: [f64; 3]) -> bool {
        let point = Vector::from_array(point);
        self.solids.iter().any(|solid| solid.contains(point))
    }

    /// The least share of the segment from one point to another at which it meets a surface, from 0 to 1; `None` where it meets none.
    pub fn first_hit(&self, from: [f64; 3], to: [f64; 3]) -> Option<f64> {
        self.hits(from, to).map(|(first, _)| first)
    }

    /// The greatest share of the segment from one point to another at which it meets a surface, from 0 to 1; `None` where it meets
    /// none.
    pub fn last_hit(&self, from: [f64; 3], to: [f64; 3]) -> Option<f64> {
        self.hits(from, to).map(|(_, last)| last)
    }

    /// The least and the greatest share of a segment at which it meets a surface.
    fn hits(&self, from: [f64; 3], to: [f64; 3]) -> Option<(f64, f64)> {
        let (from, to) = (Vector::from_array(from), Vector::from_array(to));
        let (low, high) = (from.min(to), from.max(to));
        let crossed = |node: &BvhNode| {
            overlap(node, low, high, 0.0)
                && hits::line_meets_box(from, to, node.mins(), node.maxs())
        };
        let mut found: Option<(f64, f64)> = None;
        for leaf in self.tree.leaves(crossed) {
            self.elements[leaf as usize].hits(from, to, &mut |share| {
                let (first, last) = found.unwrap_or((share, share));
                found = Some((first.min(share), last.max(share)));
            });
        }
        found
    }

    /// Whether a triangle is nearer than `clearance` to a surface, or, of a clearance of 0, meets it. Round shapes are solid here: they
    /// are near to what is within them.
    pub fn is_near(&self, triangle: [[f64; 3]; 3], clearance: f64) -> bool {
        let corners = triangle.map(Vector::from_array);
        let (margin, low, high) = self.margin(&corners, clearance);
        self.tree.leaves(|node| overlap(node, low, high, margin)).any(|leaf| {
            self.elements[leaf as usize].is_near(self.lanes, &corners, margin, self.size)
        })
    }

    /// Calls `f` with every surface triangle of obstacles that is nearer than `clearance` to a triangle, in the order of the obstacles
    /// and of their triangles: its corners, counter-clockwise from outside where the obstacle's are. Of round shapes it is
    /// a triangle in the plane that touches the surface where it is nearest.
    pub fn near_triangles(
        &self,
        triangle: [[f64; 3]; 3],
        clearance: f64,
        f: &mut dyn FnMut([[f64; 3]; 3]),
    ) {
        let corners = triangle.map(Vector::from_array);
        let (margin, low, high) = self.margin(&corners, clearance);
        let mut near: SmallVec<[u32; 32]> =
            self.tree.leaves(|node| overlap(node, low, high, margin)).collect();
        near.sort_unstable();
        for leaf in near {
            let element = &self.elements[leaf as usize];
            if element.is_near(self.lanes, &corners, margin, self.size) {
                f(element.facet(self.lanes, &corners).map(|corner| corner.to_array()));
            }
        }
    }

    /// How near counts as near, and the box of a triangle.
    fn margin(&self, corners: &[Vector; 3], clearance: f64) -> (f64, Vector, Vector) {
        let [a, b, c] = *corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let size = self.size.max(low.abs().max(high.abs()).max_element());
        (clearance.max(0.0) + TOUCHING * size, low, high)
    }
}

/// Whether a node's box is no farther than `margin` from another along each axis.
fn overlap(node: &BvhNode, low: Vector, high: Vector, margin: f64) -> bool {
    let margin = Vector::splat(margin);
    (node.mins() - margin).cmple(high).all() && low.cmple(node.maxs() + margin).all()
}

impl Solid {
    fn contains(&self, point: Vector) -> bool {
        if !(self.aabb.mins.cmple(point).all() && point.cmple(self.aabb.maxs).all()) {
            return false;
        }
        let local = self.pose.inverse_transform_point(point);
        match &self.inside {
            Filled::Box(half) => local.abs().cmple(*half).all(),
            Filled::Round(round) => round.holds(local),
            Filled::Mesh(inside) => inside.contains(local),
        }
    }
}
