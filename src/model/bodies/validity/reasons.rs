//! Why a configuration of bodies is not valid: every pair that meets, and how deep.
//!
//! Validity itself ends at the first pair that meets. Here every pair of bodies is looked at, by the same tests, so that
//! there is a reason exactly where a configuration is not valid.

use super::bodies::{BodyValidity, Bounds};
use super::frame::Stance;
use super::freedom::Freedom;
use super::meet::Meeting;
use crate::model::{BodyName, Reason, SOLE_LINK, out_of_range};
use parry3d_f64::bounding_volume::BoundingVolume;
use parry3d_f64::math::Vector;

/// The relative precision to which a depth is found.
const PRECISION: f64 = 1e-3;
/// The share of the scene's size below which a depth counts as none: the two only touch.
const TOUCH: f64 = 1e-9;

impl BodyValidity {
    /// The reasons why `q` is not valid; none if it is. With `depths` it is found how deep bodies have met, which takes a
    /// hundred times longer; without, every depth is NaN.
    pub(super) fn reasons_at(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        let mut reasons = out_of_range(&self.space, q);
        if !reasons.is_empty() {
            return reasons;
        }
        let mut stance = Stance::default();
        self.robot.link_poses(q, &mut stance.poses);
        stance.update_frames();
        if !self.decided_by_ball(q) {
            self.beyond_bounds(&stance, &mut reasons);
        }
        let mut stack = Vec::new();
        for meeting in self.meetings() {
            let [own, other] = [meeting.mover, meeting.still].map(|group| group.tree.body_nodes());
            for pair in self.near_pairs(&meeting, &stance) {
                let nodes = (own[pair.0], other[pair.1]);
                let meets = |stance: &Stance, stack: &mut Vec<(u32, u32)>| {
                    meeting.any_meet(nodes, stance, stack) || encloses(&meeting, pair, stance)
                };
                if !meets(&stance, &mut stack) {
                    continue;
                }
                let (depth, direction) = if depths {
                    self.way_out(&meeting, pair, &stance, |stance| meets(stance, &mut stack))
                } else {
                    (f64::NAN, [0.0; 3])
                };
                let (body, other) = self.names(&meeting, pair);
                let padding = match meeting.still_link {
                    None => self.robot.padding_of(meeting.mover_link),
                    Some(_) => 0.0,
                };
                reasons.push(Reason::Collision { body, other, depth, direction, padding });
            }
        }
        reasons
    }

    /// The links that reach beyond the bounds: of each the sides, and how far.
    fn beyond_bounds(&self, stance: &Stance, reasons: &mut Vec<Reason>) {
        let Bounds { min, max, .. } = self.bounds;
        for moving in &self.links {
            let frame = &stance.frames[moving.link];
            let to_link = frame.turn.transpose();
            let axes = [to_link.x_axis, to_link.y_axis, to_link.z_axis];
            for axis in 0..self.robot.motion.bounded_axes() {
                let origin = frame.shift.to_array()[axis];
                let extent = |direction: Vector| {
                    let elements = moving.group.tree.elements.iter();
                    elements.map(|element| element.extent(direction)).fold(f64::MIN, f64::max)
                };
                let above = origin + extent(axes[axis]) - max[axis];
                let below = min[axis] - (origin - extent(-axes[axis]));
                for (sign, by) in [('-', below), ('+', above)] {
                    if by > 0.0 {
                        let link = self.link_name(moving.link);
                        let side = format!("{sign}{}", ["x", "y", "z"][axis]);
                        reasons.push(Reason::Bounds { link, side, by });
                    }
                }
            }
        }
    }

    /// The pairs of bodies whose boxes meet.
    pub(super) fn near_pairs(&self, meeting: &Meeting, stance: &Stance) -> Vec<(usize, usize)> {
        let at = stance.pose(Some(meeting.mover_link));
        let other_at = stance.pose(meeting.still_link);
        let own: Vec<_> = meeting.mover.pieces.iter().map(|piece| piece.box_at(&at)).collect();
        let mut pairs = Vec::new();
        for (other, piece) in meeting.still.pieces.iter().enumerate() {
            let space = piece.box_at(&other_at).loosened(self.slack);
            let near = own.iter().enumerate().filter(|(_, own)| own.intersects(&space));
            pairs.extend(near.map(|(body, _)| (body, other)));
        }
        pairs
    }

    /// The shortest translation of the moving body that was found after which `meets` says no: its length and direction.
    ///
    /// Tried are the 26 directions to the sides, edges and corners of a cube, along the world's axes, and the one from the
    /// middle of the other body's box; where the body moves in a plane or along a line only, what these directions have in it
    /// ([`Freedom`]). A direction is looked at closer only if the best way so far is longer than what it takes along it; then
    /// the border is found by halving.
    fn way_out(
        &self,
        meeting: &Meeting,
        (body, other): (usize, usize),
        stance: &Stance,
        mut meets: impl FnMut(&Stance) -> bool,
    ) -> (f64, [f64; 3]) {
        let own = meeting.mover.pieces[body].box_at(&stance.pose(Some(meeting.mover_link)));
        let other = meeting.still.pieces[other].box_at(&stance.pose(meeting.still_link));
        let mut is_free = |direction: Vector, length: f64| {
            let mut moved = stance.clone();
            let pose = &mut moved.poses[meeting.mover_link];
            let shifted = Vector::from_array(pose.translation) + direction * length;
            pose.translation = shifted.to_array();
            moved.update_frames();
            !meets(&moved)
        };
        // Moved so far along any direction, the boxes are apart.
        let far = 1.01 * (own.extents().length() + other.extents().length()) + self.slack;
        let mut best = (far, Vector::X);
        let freedom = Freedom::of(&self.robot, stance, meeting);
        for direction in freedom.within(&directions(own.center() - other.center())) {
            let (length, _) = best;
            if !is_free(direction, length) {
                continue;
            }
            let (mut meeting, mut free) = (0.0, length);
            while free - meeting > PRECISION * free && free > TOUCH * far {
                let middle = (meeting + free) / 2.0;
                if is_free(direction, middle) { free = middle } else { meeting = middle }
            }
            // Ways of one length to within the precision: the first direction stays.
            if free < (1.0 - 2.0 * PRECISION) * length {
                best = (free, direction);
            }
        }
        let (depth, direction) = best;
        if depth <= TOUCH * far {
            (0.0, direction.to_array())
        } else {
            (depth, direction.to_array())
        }
    }

    fn link_name(&self, link: usize) -> String {
        match &*self.robot.links {
            [_] => SOLE_LINK.to_owned(),
            links => links[link].name.clone(),
        }
    }

    fn names(&self, meeting: &Meeting, (body, other): (usize, usize)) -> (BodyName, BodyName) {
        let of_link = |link: usize, body: usize| {
            let of = self.robot.links[link].bodies.len();
            BodyName::Link { link: self.link_name(link), body, of }
        };
        let other = match meeting.still_link {
            Some(link) => of_link(link, other),
            None => BodyName::Obstacle { obstacle: other },
        };
        (of_link(meeting.mover_link, body), other)
    }
}

/// Whether one of two bodies is a solid mesh that encloses the other.
fn encloses(meeting: &Meeting, (body, other): (usize, usize), stance: &Stance) -> bool {
    let (one, at) = (&meeting.mover.pieces[body], stance.pose(Some(meeting.mover_link)));
    let (other, other_at) = (&meeting.still.pieces[other], stance.pose(meeting.still_link));
    one.encloses(&at, other, &other_at) || other.encloses(&other_at, one, &at)
}

/// The directions along which a way out is looked for: the axes first, then the way from the other body, then aslant.
fn directions(apart: Vector) -> Vec<Vector> {
    let step = |digit: u32| f64::from(digit % 3) - 1.0;
    let grid = (0..27).map(|number| Vector::new(step(number), step(number / 3), step(number / 9)));
    let grid: Vec<Vector> = grid.filter(|way| *way != Vector::ZERO).collect();
    let is_axis = |way: &&Vector| way.length_squared() == 1.0;
    let axes = grid.iter().filter(is_axis).copied();
    let aslant = grid.iter().filter(|way| !is_axis(way)).map(|way| way.normalize());
    axes.chain(apart.try_normalize()).chain(aslant).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Problem;
    use std::path::Path;

    const SCENE: &str = r#"
[space]
motion = "translation-3d"
min = [0.0, 0.0, 0.0]
max = [9.0, 9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.5 } } }, { shape = { box = { size = [0.2, 0.2, 0.2] } }, position = [1.0, 0.0, 0.0] }]
[[obstacles]]
shape = { box = { size = [2.0, 2.0, 2.0] } }
position = [5.0, 5.0, 5.0]
[[obstacles]]
shape = { sphere = { radius = 0.5 } }
position = [1.0, 1.0, 1.0]
[[obstacles]]
shape = { sphere = { radius = 0.1 } }
position = [8.0, 8.0, 8.0]
"#;

    fn reasons(q: [f64; 3]) -> Vec<Reason> {
        let problem = Problem::parse(Path::new("scene.toml"), SCENE);
        let problem = problem.unwrap_or_else(|error| panic!("{error}"));
        problem.model().description().prepare().reasons(&q, true)
    }

    /// A collision's body, obstacle and depth; the direction is a unit vector.
    fn collision(reason: &Reason) -> (usize, usize, f64, [f64; 3]) {
        let Reason::Collision { body, other, depth, direction, .. } = reason else {
            panic!("{reason:?} is no collision")
        };
        let (BodyName::Link { body, of: 2, .. }, BodyName::Obstacle { obstacle }) = (body, other)
        else {
            panic!("{body:?} and {other:?} found")
        };
        assert!((Vector::from_array(*direction).length() - 1.0).abs() < 1e-12);
        (*body, *obstacle, *depth, *direction)
    }

    #[test]
    fn every_pair_that_meets_is_named_with_its_depth() {
        // The ball's middle is 0.9 above the box's upper face: the ball reaches nothing; the small box does not either.
        assert_eq!(reasons([5.0, 5.0, 6.9]), []);
        // 0.3 above: the ball is 0.2 deep, and the box of the robot, whose lower face is 0.2 above, is free.
        let found = reasons([5.0, 5.0, 6.3]);
        assert_eq!(found.len(), 1, "{found:?}");
        let (body, obstacle, depth, direction) = collision(&found[0]);
        assert_eq!((body, obstacle, direction), (0, 0, [0.0, 0.0, 1.0]));
        assert!((depth - 0.2).abs() < 1e-3 && depth >= 0.2, "{depth}");
        // Both of the robot's bodies in the box.
        let found = reasons([4.5, 5.0, 5.0]);
        let pairs: Vec<_> = found.iter().map(collision).map(|(b, o, ..)| (b, o)).collect();
        assert_eq!(pairs, [(0, 0), (1, 0)]);
    }

    #[test]
    fn the_way_out_of_a_ball_leads_from_middle_to_middle() {
        let (x, y) = (1.3, 1.4);
        let found = reasons([x, y, 1.0]);
        let (.., depth, [dx, dy, dz]) = collision(&found[0]);
        let apart = (0.3f64 * 0.3 + 0.4 * 0.4).sqrt();
        assert!((depth - (1.0 - apart)).abs() < 2e-3, "{depth}");
        assert!((dx - 0.6).abs() < 1e-9 && (dy - 0.8).abs() < 1e-9 && dz == 0.0);
    }

    #[test]
    fn bounds_are_named_by_side_and_ranges_by_value() {
        // The ball reaches 0.3 beyond the least x.
        let found = reasons([0.2, 3.0, 3.0]);
        let [Reason::Bounds { link, side, by }] = &found[..] else { panic!("{found:?}") };
        assert_eq!((&**link, &**side), ("robot", "-x"));
        assert!((by - 0.3).abs() < 1e-12, "{by}");
        let found = reasons([3.0, -1.0, 3.0]);
        let expected = Reason::Range { dof: "y".to_owned(), value: -1.0, min: 0.0, max: 9.0 };
        assert_eq!(found, [expected]);
    }

    /// Over drawn configurations: there are reasons exactly where a configuration is not valid, of shipped robots of all
    /// families, and a robot moved out by the depth of its one collision is free.
    #[test]
    fn there_are_reasons_exactly_where_a_configuration_is_not_valid() {
        use crate::model::Scratch;
        use crate::seed::{Purpose, Seed};
        for name in ["walls", "hook", "maze", "maze3d", "stick2", "stick4", "gantry"] {
            let problem = Problem::load(Path::new(&format!("problems/{name}.toml")));
            let problem = problem.unwrap_or_else(|error| panic!("{error}"));
            let model = problem.model().description().prepare();
            let space = model.space().clone();
            let mut stream = Seed::of_evaluator(3, name).stream(Purpose::Sampling);
            let (mut q, scratch) = (vec![0.0; space.len()], &mut Scratch::new());
            let mut refused = 0;
            for _ in 0..300 {
                space.sample_uniform(&mut stream, &mut q);
                let found = model.reasons(&q, false);
                assert_eq!(
                    found.is_empty(),
                    model.is_valid(&q, scratch),
                    "{name} at {q:?}: {found:?}"
                );
                refused += usize::from(!found.is_empty());
                let moves = space.translations();
                if let ([Reason::Collision { other: BodyName::Obstacle { .. }, .. }], 2..) =
                    (&found[..], moves)
                {
                    let found = model.reasons(&q, true);
                    let [Reason::Collision { depth, direction, .. }] = &found[..] else {
                        panic!("{found:?}")
                    };
                    assert!(
                        moves == 3 || direction[2] == 0.0,
                        "{name}: {direction:?} leads out of the plane"
                    );
                    let mut moved = q.clone();
                    for axis in 0..moves {
                        moved[axis] += depth * direction[axis];
                    }
                    let still = model.reasons(&moved, false);
                    let same = |reason: &Reason| match (reason, &found[0]) {
                        (
                            Reason::Collision { body, other, .. },
                            Reason::Collision { body: before, other: met, .. },
                        ) => (body, other) == (before, met),
                        _ => false,
                    };
                    assert!(!still.iter().any(same), "{name} at {q:?}: {found:?}, then {still:?}");
                }
            }
            assert!(refused > 0, "{name}: nothing was refused");
        }
    }
}
