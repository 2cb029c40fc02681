//! Discrete collision detection: whether the bodies of two groups meet at one configuration.

use super::convex::{Convex, meet, nearest};
use super::directions::triangles_meet;
use super::element::{Element, elements};
use super::frame::{Frame, Stance};
use super::light::{Eight, Frames, Stands, above, grain};
use super::origin;
use super::piece::Piece;
use super::tree::{Node, Tree};
use crate::lanes::{Lanes, with_widest_lanes};
use crate::scene::Body;
use fearless_simd::{Simd, f32x8};
use parry3d_f64::math::{Pose, Vector};

/// Bodies that move as one rigid body (those of a link, or all obstacles), in the frame of that link or of the world.
pub(super) struct Group {
    pub tree: Tree,
    pub pieces: Vec<Piece>,
}

/// Two groups to be tested for collisions. Everything is expressed in the frame of the second, `still` (that of a link,
/// or the world's for obstacles), so that only the first, `mover`, moves.
#[derive(Clone, Copy)]
pub(super) struct Meeting<'a> {
    pub mover: &'a Group,
    pub mover_link: usize,
    pub still: &'a Group,
    pub still_link: Option<usize>,
    /// A length greater than what rounding in double precision can add up to.
    pub slack: f64,
    /// The instructions by which boxes are tested.
    pub lanes: Lanes,
}

impl Meeting<'_> {
    /// The frame of the moving tree's origin as seen from the standing tree's origin, given the frame of the moving group
    /// as seen from the standing one.
    #[inline]
    pub fn between_origins(&self, frame: &Frame) -> Frame {
        let (own, other) = (self.mover.tree.origin, self.still.tree.origin);
        // Most links have the origin of their frame, which need not be turned.
        let at = if own == Vector::ZERO { frame.shift } else { frame.point(own) };
        Frame { turn: frame.turn, shift: at - other }
    }

    /// A length greater than what rounding in single precision can add up to where the moving tree's origin is one of
    /// these points as seen from the standing tree's, see [`light`](super::light).
    #[inline]
    pub fn grain(&self, [first, last]: [Vector; 2]) -> f32 {
        let (first, last) = (first.abs().max_element(), last.abs().max_element());
        grain(self.mover.tree.reach + first.max(last))
    }

    /// Whether a surface of one group meets a surface of the other, touching included. A primitive is solid and meets
    /// what lies inside it, too; whether a solid mesh encloses the other group is not tested here.
    pub fn surfaces_meet(&self, stance: &Stance, stack: &mut Vec<(u32, u32)>) -> bool {
        self.any_meet((0, 0), stance, stack)
    }

    /// The same for the parts of the two groups below a pair of nodes.
    pub fn any_meet(&self, pair: (u32, u32), stance: &Stance, stack: &mut Vec<(u32, u32)>) -> bool {
        let frame = stance.seen(self.mover_link, self.still_link);
        with_widest_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.any_meet_at(simd, pair, &frame, stance, stack),
        ))
    }

    #[inline(always)]
    fn any_meet_at<S: Simd>(
        &self,
        simd: S,
        pair: (u32, u32),
        frame: &Frame,
        stance: &Stance,
        stack: &mut Vec<(u32, u32)>,
    ) -> bool {
        let (own, other) = (&self.mover.tree, &self.still.tree);
        let local = &self.between_origins(frame);
        let frames: Frames<f32x8<S>> = Frames::new(simd, [local, local]);
        let room = above(self.slack) + self.grain([local.shift; 2]);
        let mut held = (pair.0, Stands::new(&frames, &same(simd, own, pair.0)));
        stack.clear();
        if held.1.may_meet(simd, &same(simd, other, pair.1), room) != 0 {
            stack.push(pair);
        }
        while let Some((i, j)) = stack.pop() {
            let (mover, still) = (&own.nodes[i as usize], &other.nodes[j as usize]);
            if !mover.ends && (still.ends || mover.space.radius > still.space.radius) {
                let (nodes, boxes) = own.children(i);
                let met = Stands::new(&frames, &Eight::load(simd, boxes)).may_meet(
                    simd,
                    &same(simd, other, j),
                    room,
                );
                let met = nodes.iter().enumerate().rev().filter(|(lane, _)| met >> lane & 1 == 1);
                stack.extend(met.map(|(_, i)| (*i, j)));
            } else if !still.ends {
                if held.0 != i {
                    held = (i, Stands::new(&frames, &same(simd, own, i)));
                }
                let (nodes, boxes) = other.children(j);
                let met = held.1.may_meet(simd, &Eight::load(simd, boxes), room);
                let met = nodes.iter().enumerate().rev().filter(|(lane, _)| met >> lane & 1 == 1);
                stack.extend(met.map(|(_, j)| (i, *j)));
            } else if self.ends_meet(mover, still, frame, stance) {
                return true;
            }
        }
        false
    }

    /// Whether the bodies meet of which two nodes hold an element or, of primitives, all elements.
    pub fn ends_meet(&self, mover: &Node, still: &Node, frame: &Frame, stance: &Stance) -> bool {
        let first = &self.mover.tree.elements[mover.element as usize];
        let second = &self.still.tree.elements[still.element as usize];
        if !first.primitive && !second.primitive {
            // Triangles with a padding are rounded.
            if first.radius > 0.0 {
                let corners = frame.points(&first.corners);
                return self.nearest(first, &corners, second, stance).distance <= 0.0;
            }
            return triangles_meet(self.lanes, &frame.points(&first.corners), &second.corners);
        }
        let (one, other) = (self.mover.piece(first), self.still.piece(second));
        let at = stance.pose(Some(self.mover_link));
        let other_at = stance.pose(self.still_link);
        let padding = one.padding();
        match (one.is_point(), other.is_point()) {
            (true, true) => false,
            (true, false) => other.holds(&other_at, one.pose_at(&at).translation),
            (false, true) => one.holds(&at, other.pose_at(&other_at).translation),
            (false, false) => {
                let (one, at) = part(one, first, &at);
                let (other, other_at) = part(other, second, &other_at);
                if padding > 0.0 {
                    let way = nearest((&other, &other_at), (&one, &at));
                    return way.is_none_or(|(p, q)| (p - q).length() <= padding);
                }
                meet((&other, &other_at), (&one, &at))
            }
        }
    }
}

/// The box of one node in every lane.
#[inline(always)]
fn same<S: Simd>(simd: S, tree: &Tree, node: u32) -> Eight<S> {
    Eight::same(simd, &tree.boxes[node as usize])
}

/// An element as a convex shape.
pub(super) struct Support {
    pub shape: Convex,
    /// The shape's pose in the world.
    pub at: Pose,
    /// How far the element reaches beyond the shape.
    pub thick: f64,
}

impl Group {
    /// Makes a group of the bodies of a link; `None` if there are none.
    pub fn new<'a>(bodies: impl Iterator<Item = &'a Body>) -> Option<Group> {
        Group::about(bodies, |_| None)
    }

    /// Makes a group of the bodies of a link that are thicker by `padding` on all sides; `None` if there are none.
    pub fn padded(bodies: &[Body], padding: f64) -> Option<Group> {
        let (mut surface, mut pieces) = (Vec::new(), Vec::new());
        for body in bodies {
            let index = pieces.len() as u32;
            // Of round shapes the thicker one is of the same kind.
            if let Some(shape) = body.shape.thickened(padding) {
                let thicker = Body { shape, ..body.clone() };
                surface.extend(elements(&thicker, index));
                pieces.push(Piece::new(&thicker));
            } else {
                let thicker = |e: Element| Element { radius: e.radius + padding, ..e };
                surface.extend(elements(body, index).into_iter().map(thicker));
                pieces.push(Piece::padded(body, padding));
            }
        }
        Tree::new(surface, None).map(|tree| Group { tree, pieces })
    }

    /// Makes a group of obstacles, given a box in which the robot is; `None` if there are none.
    pub fn of_obstacles(bodies: &[Body], robot: [Vector; 2]) -> Option<Group> {
        Group::about(bodies.iter(), |elements| Some(origin::among(elements, robot)))
    }

    fn about<'a>(
        bodies: impl Iterator<Item = &'a Body>,
        origin: impl FnOnce(&[Element]) -> Option<Vector>,
    ) -> Option<Group> {
        let mut surface = Vec::new();
        let mut pieces = Vec::new();
        for body in bodies {
            surface.extend(elements(body, pieces.len() as u32));
            pieces.push(Piece::new(body));
        }
        let origin = origin(&surface);
        Tree::new(surface, origin).map(|tree| Group { tree, pieces })
    }

    /// Whether a solid mesh is among them.
    pub fn is_hollow(&self) -> bool {
        self.pieces.iter().any(Piece::is_hollow)
    }

    /// Whether any body is solid while only its surface is in the tree: a solid mesh or a box.
    pub fn has_insides(&self) -> bool {
        let side = |element: &Element| element.primitive && element.normal != Vector::ZERO;
        self.is_hollow() || self.tree.elements.iter().any(side)
    }

    fn piece(&self, element: &Element) -> &Piece {
        &self.pieces[element.piece as usize]
    }

    /// An element as a convex shape, given where its group stands in the world.
    pub fn support(&self, element: &Element, at: &Pose) -> Support {
        let piece = self.piece(element);
        match piece.primitive() {
            Some(shape) if element.flat => {
                Support { shape: *shape, at: piece.pose_at(at), thick: piece.padding() }
            }
            _ => {
                let (shape, at) = Convex::triangle(element.corners, at);
                Support { shape, at, thick: element.radius }
            }
        }
    }
}

/// What is tested: the body as a whole, if it is a primitive, else the triangle of it that the element is; and its pose
/// in the world.
fn part(piece: &Piece, element: &Element, at: &Pose) -> (Convex, Pose) {
    match piece.primitive() {
        Some(shape) => (*shape, piece.pose_at(at)),
        None => Convex::triangle(element.corners, at),
    }
}
