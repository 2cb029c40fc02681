//! On which parts of surfaces the witnesses of a clearance lie, and how far the robot is from the bounds.

use super::bodies::{BodyValidity, Bounds, BoundsMeaning};
use super::clearance::Best;
use super::element::Element;
use super::frame::Frame;
use super::tree::Tree;
use crate::model::{PartKind, SurfacePart, Witnesses};
use crate::space::BaseJoint;
use parry3d_f64::math::Vector;

/// The share of a triangle's size within which a point counts as on an edge or a corner.
const NEAR: f64 = 1e-9;

impl BodyValidity {
    /// The parts of a clearance that was found last, while the links stand as then.
    pub(super) fn parts(&self, best: &Best, frames: &[Frame]) -> Option<Witnesses> {
        let Best { clearance, order } = *best;
        let moving = self.links.iter().find(|moving| moving.link == order.link)?;
        let mover = &moving.among_obstacles().tree.elements[order.mover as usize];
        let tree = &self.obstacles.as_ref()?.tree;
        let still = &tree.elements[order.still as usize];
        let [on_robot, on_obstacle] =
            [clearance.on_robot, clearance.on_obstacle].map(Vector::from_array);
        let outward = (on_robot - on_obstacle).try_normalize().unwrap_or(Vector::ZERO);
        let frame = &frames[order.link];
        let back = frame.turn.transpose();
        let own = moving.among_obstacles().tree.elements.as_slice();
        let part = |element: &Element, elements: &[Element], index: u32, point, outward| {
            let first = elements.partition_point(|other| other.piece < element.piece);
            let triangle = index as usize - first;
            self.part(element, triangle, point, outward)
        };
        let of_obstacle = part(still, &tree.elements, order.still, on_obstacle, outward);
        let of_robot =
            part(mover, own, order.mover, back * (on_robot - frame.shift), back * -outward);
        let of_robot = SurfacePart { link: Some(order.link), ..of_robot };
        Some(Witnesses { clearance, of_obstacle, of_robot })
    }

    /// The part of an element that a witness lies on.
    fn part(
        &self,
        element: &Element,
        triangle: usize,
        point: Vector,
        outward: Vector,
    ) -> SurfacePart {
        // The part is of the triangle, not of the rounded one around it.
        let core = point - outward * element.radius;
        let (kind, triangle, point) = match element.primitive {
            true => (PartKind::Convex, 0, point),
            false => (region(element, core, self.slack), triangle, core),
        };
        SurfacePart {
            link: None,
            body: element.piece as usize,
            triangle,
            kind,
            point: point.to_array(),
            outward: outward.to_array(),
        }
    }

    /// See [`Clearances::room`](crate::model::Clearances::room); `frames` are those of the links at `q`.
    pub(super) fn room_at(&self, q: &[f64], frames: &[Frame]) -> [[f64; 2]; 3] {
        let Bounds { min, max, meaning } = &self.bounds;
        let fixed = self.robot.motion == BaseJoint::Fixed;
        let base = if fixed { &self.robot.base.translation } else { q };
        let mut room = [[f64::INFINITY; 2]; 3];
        let axes = self.robot.motion.bounded_axes();
        for (axis, room) in room.iter_mut().enumerate().take(axes) {
            let (low, high) = match meaning {
                BoundsMeaning::Reference => (base[axis], base[axis]),
                BoundsMeaning::Body => self.extent(axis, frames),
            };
            *room = [low - min[axis], max[axis] - high];
        }
        room
    }

    /// The least and the largest coordinate of the robot's points along an axis of the world.
    fn extent(&self, axis: usize, frames: &[Frame]) -> (f64, f64) {
        let spans = self.links.iter().map(|moving| {
            let frame = &frames[moving.link];
            let to_world = frame.turn.transpose();
            let along = [to_world.x_axis, to_world.y_axis, to_world.z_axis][axis];
            let origin = frame.shift[axis];
            let tree = &moving.group.tree;
            (origin - support(tree, -along), origin + support(tree, along))
        });
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        spans.fold(nothing, |(low, high), (from, to)| (low.min(from), high.max(to)))
    }
}

/// The largest `p · direction` over the points of a tree's elements.
fn support(tree: &Tree, direction: Vector) -> f64 {
    let mut most = f64::NEG_INFINITY;
    let mut open = vec![0];
    while let Some(at) = open.pop() {
        let node = &tree.nodes[at as usize];
        if node.is_leaf() {
            most = most.max(tree.elements[node.element as usize].extent(direction));
            continue;
        }
        let [x, y, z] = node.space.axes.map(|axis| axis.dot(direction).abs());
        let half = node.space.half;
        let reach = half.x * x + half.y * y + half.z * z;
        if node.space.centre.dot(direction) + reach > most {
            open.extend([node.left, node.left + 1]);
        }
    }
    most
}

/// Whether a point of a triangle is one of its corners, on one of its edges or inside, up to rounding.
fn region(element: &Element, point: Vector, slack: f64) -> PartKind {
    let corners = element.corners;
    let side = |i: usize| corners[(i + 1) % 3] - corners[i];
    let size = (0..3).fold(0.0, |most, i| f64::max(most, side(i).length()));
    let near = slack.max(NEAR * size);
    let at = |i: usize| corners[i].to_array();
    if let Some(i) = (0..3).find(|i| (point - corners[*i]).length() <= near) {
        return PartKind::Vertex([at(i)]);
    }
    let on_edge = |i: &usize| {
        let along = side(*i).try_normalize().unwrap_or(Vector::ZERO);
        (point - corners[*i]).cross(along).length() <= near
    };
    match (0..3).find(on_edge) {
        Some(i) => PartKind::Edge([at(i), at((i + 1) % 3)]),
        None => PartKind::Face([at(0), at(1), at(2)]),
    }
}
