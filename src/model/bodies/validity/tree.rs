//! Bounding-volume hierarchies: binary trees of oriented bounding boxes over the elements of the bodies of a group.

use super::element::Element;
use super::light::{LightBox, PackedBoxes};
use super::obb::{Obb, UPRIGHT};
use parry3d_f64::math::Vector;
use std::sync::OnceLock;

/// Marks a node without children.
pub(super) const NONE: u32 = u32::MAX;
/// A box and the elements that lie in it.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub space: Obb,
    /// Index of the first of its two children, which stand side by side; [`NONE`] for a leaf.
    pub left: u32,
    /// Index of the node's element; of a node with several, the first of them.
    pub element: u32,
    /// Whether tests of a single configuration descend no farther: at leaves, and at nodes that hold a primitive
    /// and nothing else, since primitives are tested as a whole.
    pub ends: bool,
}

impl Node {
    pub fn is_leaf(&self) -> bool {
        self.left == NONE
    }
}

/// A binary tree with one element to a leaf. The root is node 0, and every body has a node that holds all of its
/// elements and no others.
#[derive(Debug)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    /// The boxes of the nodes, in single precision, as seen from the origin.
    pub boxes: Vec<LightBox>,
    /// The origin, in the frame of the elements.
    pub origin: Vector,
    /// How far the boxes reach from the origin.
    pub reach: f64,
    /// For each node, up to eight nodes below it that together hold all of its elements: the tree as one of eight children
    /// to a node, since boxes are tested eight at once.
    below: Vec<Below>,
    /// The boxes of such nodes, for each node to which that tree comes.
    packed: Vec<PackedBoxes>,
    pub elements: Vec<Element>,
    /// See [`Tree::body_nodes`]; found when it is first asked for.
    bodies: OnceLock<Vec<u32>>,
}

/// Nodes below a node that together hold all of its elements.
#[derive(Clone, Debug, Default)]
struct Below {
    nodes: [u32; WIDTH],
    /// How many they are; none for a leaf.
    count: u32,
    /// Index of their boxes in [`Tree::packed`], if the node is one of the tree of eight children to a node.
    packed: u32,
}

/// How many boxes are tested at once.
const WIDTH: usize = 8;

/// What building never splits at present: all elements of a body, or a single one.
#[derive(Clone, Copy)]
struct Unit {
    first: u32,
    count: u32,
}

/// From this depth on nodes are split into halves of equal length, so that no tree gets much deeper.
const DEPTH: u32 = 40;
/// Elements whose middle is as many of their radii from the frame's origin have an origin of their own.
const FAR_AWAY: f64 = 4.0;
/// Nodes of more units are split along the axes of their own box only, to save time.
const LONG: usize = 2000;

impl Tree {
    /// Builds the tree over elements of which those of one body stand together; `None` if there are none. Without an
    /// origin it is that of the frame, as bodies mostly stand about it, or the middle of the elements where these are far away.
    pub fn new(elements: Vec<Element>, origin: Option<Vector>) -> Option<Tree> {
        let mut units: Vec<Unit> = Vec::new();
        for (index, element) in elements.iter().enumerate() {
            match units.last_mut() {
                Some(unit) if elements[unit.first as usize].piece == element.piece => {
                    unit.count += 1;
                }
                _ => units.push(Unit { first: index as u32, count: 1 }),
            }
        }
        if units.is_empty() {
            return None;
        }
        let nodes = Vec::with_capacity(2 * elements.len());
        let mut tree = Tree {
            nodes,
            boxes: Vec::new(),
            origin: Vector::ZERO,
            reach: 0.0,
            below: Vec::new(),
            packed: Vec::new(),
            elements,
            bodies: OnceLock::new(),
        };
        let root = tree.node(&units);
        let origin = origin.unwrap_or(match root.space {
            Obb { centre, radius, .. } if centre.length() > FAR_AWAY * radius => centre,
            _ => Vector::ZERO,
        });
        tree.nodes.push(root);
        tree.grow(0, &mut units, 0);
        tree.boxes = tree.nodes.iter().map(|node| LightBox::new(&node.space, origin)).collect();
        let reach = |node: &Node| (node.space.centre - origin).length() + node.space.radius;
        tree.reach = tree.nodes.iter().map(reach).fold(0.0, f64::max);
        tree.origin = origin;
        tree.below = (0..tree.nodes.len() as u32).map(|at| tree.nodes_below(at)).collect();
        tree.pack();
        Some(tree)
    }

    #[inline(always)]
    pub fn is_leaf(&self, node: u32) -> bool {
        self.below[node as usize].count == 0
    }

    /// For each body the node that holds all of its elements and no others.
    pub fn body_nodes(&self) -> &[u32] {
        self.bodies.get_or_init(|| {
            let last = self.elements.iter().map(|element| element.piece as usize + 1).max();
            let mut nodes = vec![0; last.unwrap_or(0)];
            self.sole_body(0, &mut nodes);
            nodes
        })
    }

    /// The body of all elements below a node, if there is only one; notes the node as that of this body, over the nodes
    /// below it.
    fn sole_body(&self, at: u32, nodes: &mut [u32]) -> Option<u32> {
        let node = &self.nodes[at as usize];
        let piece = if node.is_leaf() {
            Some(self.elements[node.element as usize].piece)
        } else {
            let children = [node.left, node.left + 1].map(|child| self.sole_body(child, nodes));
            children[0].filter(|piece| children[1] == Some(*piece))
        };
        if let Some(piece) = piece {
            nodes[piece as usize] = at;
        }
        piece
    }

    /// Up to eight nodes below a node that together hold all of its elements, with their boxes, the last of which is
    /// repeated where there are fewer than eight. The node is the root, or one of those below another; of a leaf there are
    /// none, and the boxes are any.
    #[inline(always)]
    pub fn children(&self, node: u32) -> (&[u32], &PackedBoxes) {
        let Below { nodes, count, packed } = &self.below[node as usize];
        (&nodes[..*count as usize], &self.packed[*packed as usize])
    }

    /// The boxes of nodes.
    #[inline(always)]
    pub fn gathered(&self, [a, b, c, d, e, f, g, h]: &[u32; WIDTH]) -> [&LightBox; WIDTH] {
        let boxes = &self.boxes;
        [
            &boxes[*a as usize],
            &boxes[*b as usize],
            &boxes[*c as usize],
            &boxes[*d as usize],
            &boxes[*e as usize],
            &boxes[*f as usize],
            &boxes[*g as usize],
            &boxes[*h as usize],
        ]
    }

    /// See [`Tree::children`]: starts from the two children in the binary tree, and replaces the largest node by its
    /// own two children until there are eight. Nodes at which tests of a single configuration end are kept whole.
    fn nodes_below(&self, at: u32) -> Below {
        let node = |at: u32| &self.nodes[at as usize];
        if node(at).is_leaf() {
            return Below::default();
        }
        let mut list = vec![node(at).left, node(at).left + 1];
        while list.len() < WIDTH {
            let inner = list.iter().enumerate().filter(|(_, at)| !node(**at).ends);
            let size = |at: u32| node(at).space.radius;
            let Some((place, _)) = inner.max_by(|(_, a), (_, b)| size(**a).total_cmp(&size(**b)))
            else {
                break;
            };
            let left = node(list[place]).left;
            list.splice(place..=place, [left, left + 1]);
        }
        let mut nodes = [list[list.len() - 1]; WIDTH];
        nodes[..list.len()].copy_from_slice(&list);
        Below { nodes, count: list.len() as u32, packed: 0 }
    }

    /// Packs the boxes below the nodes to which the tree of eight children to a node comes.
    fn pack(&mut self) {
        let mut todo = vec![0];
        while let Some(at) = todo.pop() {
            let Below { nodes, count, .. } = self.below[at as usize].clone();
            if count > 0 || self.packed.is_empty() {
                self.below[at as usize].packed = self.packed.len() as u32;
                self.packed.push(PackedBoxes::new(self.gathered(&nodes)));
                todo.extend(&nodes[..count as usize]);
            }
        }
    }

    fn of(&self, units: &[Unit]) -> impl Iterator<Item = &Element> {
        units.iter().flat_map(|Unit { first, count }| {
            self.elements[*first as usize..(*first + *count) as usize].iter()
        })
    }

    fn node(&self, units: &[Unit]) -> Node {
        let inside: Vec<&Element> = self.of(units).collect();
        let alone = inside.iter().all(|element| element.piece == inside[0].piece);
        let ends = inside.len() == 1 || alone && inside[0].primitive;
        Node { space: Obb::around(&inside), left: NONE, element: units[0].first, ends }
    }

    fn grow(&mut self, at: usize, units: &mut [Unit], depth: u32) {
        if let [Unit { first, count }] = *units {
            if count > 1 {
                let mut single: Vec<Unit> =
                    (first..first + count).map(|first| Unit { first, count: 1 }).collect();
                self.grow(at, &mut single, depth);
            }
            return;
        }
        let middle = self.part(at, units, depth);
        let (low, high) = units.split_at_mut(middle);
        let left = self.nodes.len();
        self.nodes[at].left = left as u32;
        let children = [self.node(low), self.node(high)];
        self.nodes.extend(children);
        self.grow(left, low, depth + 1);
        self.grow(left + 1, high, depth + 1);
    }

    /// Chooses the split of a node by the surface area heuristic, trying every place along the axes of the node's box
    /// and, of short lists, of the tree's frame. Sorts the units along the best axis and returns the place.
    fn part(&self, at: usize, units: &mut [Unit], depth: u32) -> usize {
        let own = self.nodes[at].space.axes;
        let mut frames = vec![own];
        if units.len() <= LONG && own.iter().any(|axis| !UPRIGHT.contains(axis)) {
            frames.push(UPRIGHT);
        }
        let half = units.len() / 2;
        let mut best = (f64::INFINITY, Vec::new(), half);
        for axes in frames {
            let boxes: Vec<(Vector, Vector)> = units.iter().map(|u| self.span(*u, axes)).collect();
            for axis in 0..3 {
                // Whole numbers side by side are sorted faster than numbers that are looked up.
                let middles = boxes.iter().zip(&*units).zip(0u32..);
                let mut keyed: Vec<(i64, u32, u32)> = middles
                    .map(|(((low, high), unit), i)| {
                        (ordered(low[axis] + high[axis]), unit.first, i)
                    })
                    .collect();
                keyed.sort_unstable();
                let order: Vec<u32> = keyed.into_iter().map(|(_, _, i)| i).collect();
                let (cost, place) = if depth < DEPTH {
                    cheapest(&order, &boxes, units)
                } else {
                    let (low, high) = union(order.iter().map(|i| boxes[*i as usize]));
                    (-(high - low)[axis], half)
                };
                if cost < best.0 {
                    best = (cost, order, place);
                }
            }
        }
        let sorted: Vec<Unit> = match best.1.is_empty() {
            true => units.to_vec(),
            false => best.1.iter().map(|i| units[*i as usize]).collect(),
        };
        units.copy_from_slice(&sorted);
        best.2
    }

    fn span(&self, unit: Unit, axes: [Vector; 3]) -> (Vector, Vector) {
        union(self.of(&[unit]).map(|element| {
            let [x, y, z] = axes.map(|axis| element.span(axis));
            (Vector::new(x.0, y.0, z.0), Vector::new(x.1, y.1, z.1))
        }))
    }
}

/// A whole number that orders numbers as [`f64::total_cmp`] does.
fn ordered(number: f64) -> i64 {
    let bits = number.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

fn union(boxes: impl Iterator<Item = (Vector, Vector)>) -> (Vector, Vector) {
    let nothing = (Vector::INFINITY, Vector::NEG_INFINITY);
    boxes.fold(nothing, |(low, high), (from, to)| (low.min(from), high.max(to)))
}

/// The cheapest place to cut a sorted list of units, and its cost: the surface of the box on either side times the
/// number of elements there, summed.
fn cheapest(order: &[u32], boxes: &[(Vector, Vector)], units: &[Unit]) -> (f64, usize) {
    let surface = |(low, high): (Vector, Vector)| {
        let Vector { x, y, z } = high - low;
        x * y + y * z + z * x
    };
    let n = order.len();
    let mut after = vec![0.0; n];
    let (mut around, mut count) = ((Vector::INFINITY, Vector::NEG_INFINITY), 0.0);
    for place in (1..n).rev() {
        let i = order[place] as usize;
        around = union([around, boxes[i]].into_iter());
        count += f64::from(units[i].count);
        after[place] = surface(around) * count;
    }
    let mut best = (f64::INFINITY, n / 2);
    (around, count) = ((Vector::INFINITY, Vector::NEG_INFINITY), 0.0);
    for place in 1..n {
        let i = order[place - 1] as usize;
        around = union([around, boxes[i]].into_iter());
        count += f64::from(units[i].count);
        let cost = surface(around) * count + after[place];
        if cost < best.0 {
            best = (cost, place);
        }
    }
    best
}
