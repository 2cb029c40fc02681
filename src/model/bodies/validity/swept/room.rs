//! Whether bodies stand inside the bounds, and whether they stay there during a motion.

use super::clock::Clock;
use super::span::SampleRange;
use super::{BEND, Stacks};
use crate::model::bodies::robot::Rates;
use crate::model::bodies::validity::frame::Frame;
use crate::model::bodies::validity::tree::{Node, Tree};

/// The bounds: an axis-aligned box in the world's frame, of which the first `axes` coordinates count.
#[derive(Clone, Copy)]
pub(in crate::model::bodies::validity) struct Walls {
    pub min: [f64; 3],
    pub max: [f64; 3],
    pub axes: usize,
}

impl Walls {
    /// Whether all elements of a tree are inside.
    pub fn hold(&self, tree: &Tree, frame: &Frame) -> bool {
        self.hold_below(tree, 0, frame)
    }

    fn hold_below(&self, tree: &Tree, at: u32, frame: &Frame) -> bool {
        let node = &tree.nodes[at as usize];
        self.room(tree, node, frame) >= 0.0
            || !node.is_leaf()
                && self.hold_below(tree, node.left, frame)
                && self.hold_below(tree, node.left + 1, frame)
    }

    /// The least distance from the sides of a node's box, or, of a leaf, of its element; negative where it reaches
    /// beyond a side.
    fn room(&self, tree: &Tree, node: &Node, frame: &Frame) -> f64 {
        let to_world = frame.turn.transpose();
        let along = [to_world.x_axis, to_world.y_axis, to_world.z_axis];
        let origin = frame.shift.to_array();
        (0..self.axes).fold(f64::INFINITY, |least, i| {
            // How far it reaches from the origin of its frame along the axis, and in the opposite direction.
            let (above, below) = if node.is_leaf() {
                let element = &tree.elements[node.element as usize];
                (element.extent(along[i]), element.extent(-along[i]))
            } else {
                let [x, y, z] = node.space.axes.map(|own| own.dot(along[i]).abs());
                let half = node.space.half;
                let reach = half.x * x + half.y * y + half.z * z;
                let centre = node.space.centre.dot(along[i]);
                (reach + centre, reach - centre)
            };
            least.min(self.max[i] - (origin[i] + above)).min(origin[i] - below - self.min[i])
        })
    }
}

/// Whether at every sample every element is farther from the sides than its points can leave their straight lines
/// within one step. Then all are inside at all times, since a box that holds both ends of a straight line holds the
/// line.
pub(in crate::model::bodies::validity) fn stays_inside(
    walls: &Walls,
    tree: &Tree,
    link: usize,
    rates: &Rates,
    clock: &mut Clock,
    Stacks { inside: open, .. }: &mut Stacks,
) -> bool {
    let time = 1.0 / clock.samples as f64;
    let least = bend_of(&tree.nodes[0], rates) * time * time / 8.0;
    open.clear();
    open.push((0, SampleRange { from: 0, to: clock.samples }));
    while let Some((at, span)) = open.pop() {
        let node = &tree.nodes[at as usize];
        let mut room = |sample: u64| walls.room(tree, node, &clock.at(sample).frames[link]);
        let ends = room(span.from).min(room(span.to));
        let chord = span.length() as f64 * time;
        let bend = bend_of(node, rates) * chord * chord / 8.0;
        if ends >= least + bend {
            continue;
        }
        if node.is_leaf() && ends < least {
            return false;
        }
        if span.length() > 1 && (node.is_leaf() || bend > BEND * node.space.radius) {
            let middle = span.from + span.length() / 2;
            open.push((at, SampleRange { from: middle, ..span }));
            open.push((at, SampleRange { to: middle, ..span }));
        } else if !node.is_leaf() {
            open.push((node.left + 1, span));
            open.push((node.left, span));
        }
    }
    true
}

/// A bound on the second derivatives of the paths of a node's points.
fn bend_of(node: &Node, rates: &Rates) -> f64 {
    rates.bend_at(node.space.radius + rates.distance(node.space.centre))
}
