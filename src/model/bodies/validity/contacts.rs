//! Where bodies meet, and in which direction they come apart there.
//!
//! Of two bodies that meet, the planes of the elements that meet suggest directions: of a solid body by its outer sides, so that a body
//! that has come in goes out where it came from; of an open surface by both sides. Where elements have no plane (balls, capsules) the direction
//! leads from the one's axis to the other's. Each two elements are given the direction in which they are soonest apart. One that leads into the inside of one
//! of the bodies there has to be shorter by several times: a bar that has gone through a wall leaves it on the side where less of it is.
//!
//! In what direction a configuration has to move for that is found by differences of where the links stand, which are the same for joints
//! of all kinds.

use super::BodyScratch;
use super::bodies::{BodyValidity, Bounds};
use super::element::Element;
use super::frame::{Frame, Stance};
use super::freedom::Freedom;
use super::meet::{Group, Meeting};
use super::piece::Piece;
use super::triangles::nearest_points;
use crate::model::{Contact, Contacts, Scratch};
use parry3d_f64::math::Vector;
use std::collections::BTreeMap;

/// The most pairs of elements that are looked at, of two bodies.
const PAIRS_MAX: usize = 400;
/// How far each number of a configuration moves for differences: an angle in radians, or the same share of the scene's size as a length.
const DIFFERENCE: f64 = 1e-5;
/// How many directions two bodies suggest at most, and beyond which cosine two of them are one.
const DIRECTIONS_MAX: usize = 32;
const ALIKE: f64 = 0.999;
/// How many times shorter the way out has to be in a direction that leads inward.
const INWARD: f64 = 4.0;
/// At which share of a triangle's size beside it its inner side is looked for.
const BESIDE: f64 = 1e-4;

/// A contact in the frame of the standing group.
struct Touch {
    point: Vector,
    normal: Vector,
    depth: f64,
}

/// Two elements that meet, in the frame of the standing group.
struct Standing<'a> {
    /// Of the moving element.
    corners: [Vector; 3],
    radius: f64,
    other: &'a Element,
    /// The nearest points of the two, without their radii.
    nearest: (Vector, Vector),
    /// The directions in which the moving element leaves by its own plane, and by that of the other element: one if the body is solid, two of an open
    /// surface, none of what has no plane.
    own_sides: Vec<Vector>,
    other_sides: Vec<Vector>,
}

/// Where the links stand when one number of a configuration is a little less, and a little more.
pub(super) struct Moved {
    pub by: f64,
    pub less: Stance,
    pub more: Stance,
}

impl Contacts for BodyValidity {
    fn contacts(&self, q: &[f64], most: usize, scratch: &mut Scratch) -> Vec<Contact> {
        let scratch: &mut BodyScratch = scratch.for_configuration();
        let mut stance = Stance::default();
        self.robot.link_poses(q, &mut stance.poses);
        stance.update_frames();
        let stack = &mut scratch.stacks.pairs;
        let mut found: Vec<(Touch, usize, Option<usize>)> = Vec::new();
        for meeting in self.meetings() {
            let freedom = Freedom::of(&self.robot, &stance, &meeting);
            for pair in self.near_pairs(&meeting, &stance) {
                let touches = meeting.touches(pair, freedom, &stance, stack);
                let links = (meeting.mover_link, meeting.still_link);
                found.extend(touches.into_iter().map(|touch| (touch, links.0, links.1)));
            }
        }
        // The sort keeps the order of what is equally deep.
        found.sort_by(|(one, ..), (other, ..)| other.depth.total_cmp(&one.depth));
        found.truncate(most);
        if found.is_empty() {
            return Vec::new();
        }
        let moved = self.moved_stances(q);
        found.iter().map(|found| contact_of(found, &stance, &moved)).collect()
    }
}

impl BodyValidity {
    /// Where the links stand beside a configuration, for every number by which it can be moved.
    pub(super) fn moved_stances(&self, q: &[f64]) -> Vec<Moved> {
        let numbers = self.space.cube_dimensions();
        let Bounds { min, max, .. } = self.bounds;
        let sizes = (0..self.robot.motion.bounded_axes()).map(|axis| max[axis] - min[axis]);
        let scale = sizes.fold(self.reach, f64::max);
        let mut by = vec![0.0; numbers];
        let mut moved = q.to_vec();
        let mut at = |by: &[f64]| {
            self.space.moved(q, by, &mut moved);
            let mut stance = Stance::default();
            self.robot.link_poses(&moved, &mut stance.poses);
            stance.update_frames();
            stance
        };
        (0..numbers)
            .map(|number| {
                let little = DIFFERENCE * if self.is_length(number) { scale } else { 1.0 };
                by[number] = -little;
                let less = at(&by);
                by[number] = little;
                let more = at(&by);
                by[number] = 0.0;
                Moved { by: little, less, more }
            })
            .collect()
    }

    /// Whether a number by which a configuration can be moved is a length.
    fn is_length(&self, number: usize) -> bool {
        let mut at = 0;
        for factor in self.space.factors() {
            let numbers = if factor.kind == crate::space::FactorKind::Rotation { 3 } else { 1 };
            if (at..at + numbers).contains(&number) {
                return self.space.dofs()[factor.at].unit == "length";
            }
            at += numbers;
        }
        false
    }
}

/// Where a point fixed to a link, given as the link stands in one stance, is when the link stands as in another.
pub(super) fn carried(stance: &Stance, link: usize, point: Vector, to: &Stance) -> Vector {
    let frame = &stance.frames[link];
    let own = frame.turn.transpose() * (point - frame.shift);
    to.frames[link].point(own)
}

/// The contact in the world's frame, with its rates.
fn contact_of(
    (touch, mover, still): &(Touch, usize, Option<usize>),
    stance: &Stance,
    moved: &[Moved],
) -> Contact {
    let to_world = |v: Vector| match still {
        None => v,
        Some(link) => stance.frames[*link].direction(v),
    };
    let point = match still {
        None => touch.point,
        Some(link) => stance.frames[*link].point(touch.point),
    };
    let normal = to_world(touch.normal);
    let rate = |Moved { by, less, more }: &Moved| {
        let way =
            |link: usize| carried(stance, link, point, more) - carried(stance, link, point, less);
        let apart = way(*mover) - still.map_or(Vector::ZERO, way);
        normal.dot(apart) / (2.0 * by)
    };
    Contact {
        point: point.to_array(),
        normal: normal.to_array(),
        depth: touch.depth,
        rates: moved.iter().map(rate).collect(),
    }
}

impl Meeting<'_> {
    /// Where two bodies of the groups meet. Of a body that another one encloses, so that no elements meet, the place is where their surfaces are
    /// nearest.
    fn touches(
        &self,
        (body, other): (usize, usize),
        freedom: Freedom,
        stance: &Stance,
        stack: &mut Vec<(u32, u32)>,
    ) -> Vec<Touch> {
        let nodes = (self.mover.tree.body_nodes()[body], self.still.tree.body_nodes()[other]);
        let mut pairs = Vec::new();
        self.pairs_within(nodes, 0.0, stance, stack, &mut pairs);
        if pairs.is_empty() && self.is_inside((body, other), stance) {
            pairs.extend(self.nearest_pair(nodes, stance, stack));
        }
        let frame = stance.seen(self.mover_link, self.still_link);
        let mut sides = [BTreeMap::new(), BTreeMap::new()];
        let pairs: Vec<Standing> =
            pairs.into_iter().map(|pair| self.standing(pair, &frame, &mut sides)).collect();
        let directions = self.directions(&pairs, freedom, stance);
        pairs.iter().filter_map(|pair| pair.touch(&directions)).collect()
    }

    /// The directions that the elements of two bodies suggest, in the frame of the standing group, as far as the bodies can move in them, those that are alike once.
    fn directions(&self, pairs: &[Standing], freedom: Freedom, stance: &Stance) -> Vec<Vector> {
        let turn = self.still_link.map(|link| stance.frames[link].turn);
        let mut suggested: Vec<Vector> = Vec::new();
        for direction in pairs.iter().flat_map(Standing::directions) {
            if suggested.len() == DIRECTIONS_MAX {
                break;
            }
            if suggested.iter().all(|other| other.dot(direction) <= ALIKE) {
                suggested.push(direction);
            }
        }
        let Some(turn) = turn else { return freedom.within(&suggested) };
        let in_world: Vec<Vector> = suggested.iter().map(|direction| turn * *direction).collect();
        let back = turn.transpose();
        freedom.within(&in_world).into_iter().map(|direction| back * direction).collect()
    }

    /// Whether one of two bodies holds the other, whose surfaces do not meet.
    fn is_inside(&self, (body, other): (usize, usize), stance: &Stance) -> bool {
        let (one, at) = (&self.mover.pieces[body], stance.pose(Some(self.mover_link)));
        let (other, other_at) = (&self.still.pieces[other], stance.pose(self.still_link));
        let holds = |piece: &Piece, at, held: &Piece, held_at| {
            piece.encloses(at, held, held_at) || piece.holds(at, held.box_at(held_at).center())
        };
        holds(one, &at, other, &other_at) || holds(other, &other_at, one, &at)
    }

    /// The pairs of elements below two nodes that are no farther apart than `within`.
    fn pairs_within(
        &self,
        nodes: (u32, u32),
        within: f64,
        stance: &Stance,
        stack: &mut Vec<(u32, u32)>,
        pairs: &mut Vec<(u32, u32)>,
    ) {
        let frame = stance.seen(self.mover_link, self.still_link);
        let (movers, stills) = (&self.mover.tree.nodes, &self.still.tree.nodes);
        stack.clear();
        stack.push(nodes);
        while let Some((i, j)) = stack.pop() {
            let (mover, still) = (&movers[i as usize], &stills[j as usize]);
            if super::clearance::apart(&mover.space, &still.space, &frame) - self.slack > within {
                continue;
            }
            if !mover.is_leaf() && (still.is_leaf() || mover.space.radius > still.space.radius) {
                stack.extend([(mover.left + 1, j), (mover.left, j)]);
            } else if !still.is_leaf() {
                stack.extend([(i, still.left + 1), (i, still.left)]);
            } else {
                let element = &self.mover.tree.elements[mover.element as usize];
                let other = &self.still.tree.elements[still.element as usize];
                let corners = element.corners.map(|corner| frame.point(corner));
                if self.nearest(element, &corners, other, stance).distance <= within {
                    pairs.push((mover.element, still.element));
                    if pairs.len() == PAIRS_MAX {
                        return;
                    }
                }
            }
        }
    }

    /// The pair of elements below two nodes that are nearest to one another, found by looking within twice as far until there are some.
    fn nearest_pair(
        &self,
        nodes: (u32, u32),
        stance: &Stance,
        stack: &mut Vec<(u32, u32)>,
    ) -> Option<(u32, u32)> {
        let frame = stance.seen(self.mover_link, self.still_link);
        let radius = |group: &Group, node: u32| group.tree.nodes[node as usize].space.radius;
        let far = 2.0 * (radius(self.mover, nodes.0) + radius(self.still, nodes.1));
        let mut within = 1e-3 * far;
        while within <= far {
            let mut pairs = Vec::new();
            self.pairs_within(nodes, within, stance, stack, &mut pairs);
            let distance = |pair: &(u32, u32)| {
                let element = &self.mover.tree.elements[pair.0 as usize];
                let corners = element.corners.map(|corner| frame.point(corner));
                let other = &self.still.tree.elements[pair.1 as usize];
                self.nearest(element, &corners, other, stance).distance
            };
            let nearest = pairs.into_iter().map(|pair| (distance(&pair), pair));
            let nearest =
                nearest.min_by(|(one, a), (other, b)| one.total_cmp(other).then(a.cmp(b)));
            if let Some((_, pair)) = nearest {
                return Some(pair);
            }
            within *= 2.0;
        }
        None
    }

    /// Two elements as they stand, in the frame of the standing group.
    fn standing<'a>(
        &'a self,
        (own, other): (u32, u32),
        frame: &Frame,
        sides: &mut [BTreeMap<u32, Vec<Vector>>; 2],
    ) -> Standing<'a> {
        let element = &self.mover.tree.elements[own as usize];
        let other_element = &self.still.tree.elements[other as usize];
        let corners = element.corners.map(|corner| frame.point(corner));
        let nearest = nearest_points(self.lanes, &corners, &other_element.corners);
        let mut sides_of = |which: usize, index: u32, element: &Element, group: &Group| {
            let sides = sides[which].entry(index);
            sides
                .or_insert_with(|| outer_sides(element, &group.pieces[element.piece as usize]))
                .clone()
        };
        // The moving element leaves against its own outer side.
        let own_sides = sides_of(0, own, element, self.mover).into_iter();
        let own_sides = own_sides.map(|side| -frame.direction(side)).collect();
        let other_sides = sides_of(1, other, other_element, self.still);
        Standing {
            corners,
            radius: element.radius,
            other: other_element,
            nearest,
            own_sides,
            other_sides,
        }
    }
}

impl Standing<'_> {
    /// The directions that its planes suggest, or, where it has none, the one from the standing element to the moving one.
    fn directions(&self) -> Vec<Vector> {
        let (p, q) = self.nearest;
        match self.own_sides.is_empty() && self.other_sides.is_empty() {
            true => (p - q).try_normalize().into_iter().collect(),
            false => [&self.own_sides[..], &self.other_sides[..]].concat(),
        }
    }

    /// How far the moving element has to be translated along a unit vector to be wholly beyond the other.
    fn depth(&self, normal: Vector) -> f64 {
        let along = |corner: &Vector| normal.dot(*corner);
        let lowest = self.corners.iter().map(along).fold(f64::MAX, f64::min) - self.radius;
        let highest = self.other.corners.iter().map(along).fold(f64::MIN, f64::max);
        highest + self.other.radius - lowest
    }

    /// Whether a direction leads into the inside of one of two solid bodies here.
    fn is_inward(&self, direction: Vector) -> bool {
        let into = |sides: &[Vector]| matches!(sides, [side] if side.dot(direction) < -1e-9);
        into(&self.own_sides) || into(&self.other_sides)
    }

    /// In which of some directions the elements are soonest apart, and how far that is.
    fn touch(&self, directions: &[Vector]) -> Option<Touch> {
        let measured = directions.iter().map(|normal| {
            let depth = self.depth(*normal).max(0.0);
            let weight = if self.is_inward(*normal) { INWARD } else { 1.0 };
            (weight * depth, depth, *normal)
        });
        let best = measured.min_by(|(one, ..), (other, ..)| one.total_cmp(other));
        let (_, depth, normal) = best?;
        let (p, q) = self.nearest;
        Some(Touch { point: (p + q) / 2.0, normal, depth })
    }
}

/// The directions in which one leaves a triangle, in the frame of its group: the normal on the outer side of a solid body, both normals of an
/// open surface; none of what has no plane.
fn outer_sides(element: &Element, piece: &Piece) -> Vec<Vector> {
    let Some(normal) = element.normal.try_normalize() else { return Vec::new() };
    let middle = (element.corners[0] + element.corners[1] + element.corners[2]) / 3.0;
    let size = (element.corners[1] - element.corners[0]).length();
    let is_solid = |side: Vector| piece.holds_in_own_group(middle + side * (BESIDE * size));
    match [normal, -normal].map(is_solid) {
        [true, false] => vec![-normal],
        [false, true] => vec![normal],
        _ => vec![normal, -normal],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Model, Reason};
    use crate::problem::Problem;
    use crate::seed::{Purpose, Seed};
    use std::path::Path;

    const SCENE: &str = r#"
[space]
motion = "MOTION"
min = [-9.0, -9.0, -9.0]
max = [9.0, 9.0, 9.0]
bounds = "reference"
[robot]
bodies = [{ shape = { ROBOT } }]
[[obstacles]]
shape = { OBSTACLE }
"#;

    fn contacts(robot: &str, obstacle: &str, motion: &str, q: &[f64]) -> Vec<Contact> {
        let text =
            SCENE.replace("MOTION", motion).replace("ROBOT", robot).replace("OBSTACLE", obstacle);
        let text = match motion.ends_with("2d") {
            true => text
                .replace("9.0, -9.0, -9.0]", "9.0, -9.0]")
                .replace("9.0, 9.0, 9.0]", "9.0, 9.0]"),
            false => text,
        };
        let problem = Problem::parse(Path::new("scene.toml"), &text);
        let problem = problem.unwrap_or_else(|error| panic!("{error}"));
        let model = problem.model().description().prepare();
        let found = model.contacts().expect("bodies have contacts");
        found.contacts(q, 100, &mut Scratch::new())
    }

    const BALL: &str = "sphere = { radius = 0.5 }";
    const CUBE: &str = "box = { size = [2.0, 2.0, 2.0] }";

    #[test]
    fn a_ball_leaves_a_box_by_the_side_it_came_in() {
        // The ball's middle is 0.3 above the upper side, so that the ball is 0.2 deep.
        let found = contacts(BALL, CUBE, "translation-3d", &[0.1, 0.2, 1.3]);
        let Contact { normal, depth, rates, .. } = &found[0];
        assert_eq!(*normal, [0.0, 0.0, 1.0]);
        assert!((depth - 0.2).abs() < 1e-12, "{depth}");
        assert!((rates[2] - 1.0).abs() < 1e-9 && rates[0].abs() < 1e-9, "{rates:?}");
        // Wholly inside, nearest to the side of least x.
        let found =
            contacts("sphere = { radius = 0.05 }", CUBE, "translation-3d", &[-0.9, 0.0, 0.0]);
        assert_eq!(found[0].normal, [-1.0, 0.0, 0.0]);
        assert!((found[0].depth - 0.15).abs() < 1e-12, "{:?}", found[0]);
        assert_eq!(contacts(BALL, CUBE, "translation-3d", &[0.0, 0.0, 1.6]), []);
    }

    #[test]
    fn balls_part_from_middle_to_middle_and_turn_as_levers_do() {
        let found = contacts(
            BALL,
            "sphere = { radius = 1.0 }",
            "rigid-3d",
            &[0.6, 0.8, 0.0, 1.0, 0.0, 0.0, 0.0],
        );
        let [Contact { normal, depth, rates, .. }] = &found[..] else { panic!("{found:?}") };
        assert!((normal[0] - 0.6).abs() < 1e-12 && (normal[1] - 0.8).abs() < 1e-12);
        assert!((depth - 0.5).abs() < 1e-12);
        // A ball that turns about its middle moves nothing.
        assert!(rates[3..].iter().all(|rate| rate.abs() < 1e-9), "{rates:?}");
        // The end of a rod, 1 from its middle, is pushed up: turning about y lifts or lowers it.
        let found = contacts(
            "box = { size = [2.0, 0.2, 0.2] }",
            CUBE,
            "rigid-3d",
            &[1.8, 0.0, 1.05, 1.0, 0.0, 0.0, 0.0],
        );
        for Contact { normal, depth, rates, point } in &found {
            assert_eq!(*normal, [0.0, 0.0, 1.0], "{found:?}");
            assert!(*depth < 0.05 + 1e-9, "{depth}");
            assert!((rates[4] + (point[0] - 1.8)).abs() < 1e-6, "{rates:?} at {point:?}");
        }
        assert!((found[0].depth - 0.05).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_bar_that_has_gone_through_a_wall_leaves_it_where_less_of_it_is() {
        let bar = "box = { size = [3.0, 0.2, 0.2] }";
        let wall = "box = { size = [0.4, 4.0, 4.0] }";
        let found = contacts(bar, wall, "translation-3d", &[-1.0, 0.1, 0.3]);
        assert!(found.iter().all(|contact| contact.normal == [-1.0, 0.0, 0.0]), "{found:?}");
        assert!((found[0].depth - 0.7).abs() < 1e-9, "{found:?}");
        // In a plane nothing gets out across it, thin as the two may be there.
        let flat = "box = { size = [3.0, 0.2, 0.01] }";
        let found = contacts(flat, wall, "rigid-2d", &[-1.0, 0.1, 0.0]);
        assert!(found.iter().all(|contact| contact.normal == [-1.0, 0.0, 0.0]), "{found:?}");
    }

    /// Over drawn configurations of shipped robots of all families: there are contacts exactly where bodies collide, and the
    /// rates are those by which the pairs' depths change.
    #[test]
    fn there_are_contacts_exactly_where_bodies_collide() {
        for name in ["walls", "hook", "maze", "maze3d", "stick2", "stick4", "gantry", "cage"] {
            let problem = Problem::load(Path::new(&format!("problems/{name}.toml")));
            let problem = problem.unwrap_or_else(|error| panic!("{error}"));
            let model = problem.model().description().prepare();
            let space = model.space().clone();
            let mut stream = Seed::of_evaluator(5, name).stream(Purpose::Sampling);
            let (mut q, scratch) = (vec![0.0; space.len()], &mut Scratch::new());
            let mut colliding = 0;
            for _ in 0..200 {
                space.sample_uniform(&mut stream, &mut q);
                let collides = |reason: &Reason| matches!(reason, Reason::Collision { .. });
                let expected = model.reasons(&q, false).iter().any(collides);
                let found = model.contacts().expect("bodies").contacts(&q, 50, scratch);
                assert_eq!(!found.is_empty(), expected, "{name} at {q:?}");
                colliding += usize::from(expected);
                for Contact { normal, depth, rates, .. } in &found {
                    let length = Vector::from_array(*normal).length();
                    assert!((length - 1.0).abs() < 1e-9 && *depth >= 0.0, "{name} at {q:?}");
                    assert_eq!(rates.len(), space.cube_dimensions());
                    assert!(rates.iter().all(|rate| rate.is_finite()));
                }
                assert!(found.windows(2).all(|pair| pair[0].depth >= pair[1].depth));
                scratch_is_no_part(&*model, &q, &found);
            }
            assert!(colliding > 0, "{name}");
        }
    }

    /// What was asked before changes no answer.
    fn scratch_is_no_part(model: &dyn Model, q: &[f64], found: &[Contact]) {
        let again = model.contacts().expect("bodies").contacts(q, 50, &mut Scratch::new());
        assert_eq!(again, found);
    }
}
