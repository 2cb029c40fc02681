//! Validity of a robot of rigid links among obstacles.

use super::piece::{Piece, Placed};
use super::scratch::Hit;
use super::{Scratch, State, Validity};
use crate::robot::{Robot, Speeds};
use crate::scene::Body;
use crate::space::Space;
use bincode::{Decode, Encode};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::Vector;
use serde::{Deserialize, Serialize};

/// Which points of the robot the bounds hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum BoundsMeaning {
    /// Every point of the robot stays inside (of a planar robot: in x and y).
    Body,
    /// Only the robot's reference point, the origin of its frame, does.
    Reference,
}

/// The box that bounds the robot, in the world's frame.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Bounds {
    /// Least x, y and z; z is not used for planar robots.
    pub min: [f64; 3],
    /// Largest x, y and z.
    pub max: [f64; 3],
    /// What must stay inside.
    pub meaning: BoundsMeaning,
}

/// Validity of a robot among obstacles that stand still.
///
/// Bodies collide when their surfaces meet or when one lies wholly inside another that is solid.
/// Links that are neighbours, or that [`Robot::may_touch`] names, may touch. Motions are checked at
/// discrete steps: no robot point moves farther between two checks than the resolution, by the bounds
/// of [`Speeds`].
pub struct BodyValidity {
    space: Space,
    robot: Robot,
    speeds: Speeds,
    bounds: Bounds,
    resolution: f64,
    /// A bound on the distance of the robot's points from the base's origin.
    reach: f64,
    pieces: Vec<LinkPiece>,
    obstacles: Vec<(Piece, Placed)>,
    /// Pairs of pieces that must not touch each other.
    self_pairs: Vec<(usize, usize)>,
}

/// A piece of the robot.
struct LinkPiece {
    link: usize,
    piece: Piece,
    /// A bound on the distance of its points from the link's origin.
    reach: f64,
}

impl BodyValidity {
    /// Prepares the bodies. `resolution` is a length; see [`Validity::motion`].
    pub fn new(
        space: Space,
        robot: &Robot,
        bounds: Bounds,
        resolution: f64,
        obstacles: &[Body],
    ) -> BodyValidity {
        let mut pieces = Vec::new();
        for (link, bodies) in robot.links.iter().map(|link| &link.bodies).enumerate() {
            for body in bodies {
                let reach = body.shape.reach(&body.pose);
                pieces.push(LinkPiece { link, piece: Piece::new(body), reach });
            }
        }
        let of = |link: usize| {
            let pieces: &Vec<LinkPiece> = &pieces;
            (0..pieces.len()).filter(move |i| pieces[*i].link == link)
        };
        let mut self_pairs = Vec::new();
        for (low, high) in robot.self_pairs() {
            for first in of(low) {
                self_pairs.extend(of(high).map(|second| (first, second)));
            }
        }
        let place = |body| {
            let piece = Piece::new(body);
            let placed = piece.in_world();
            (piece, placed)
        };
        BodyValidity {
            space,
            speeds: robot.speeds(),
            reach: robot.reach(),
            robot: robot.clone(),
            bounds,
            resolution,
            pieces,
            obstacles: obstacles.iter().map(place).collect(),
            self_pairs,
        }
    }

    fn in_bounds(&self, q: &[f64], scratch: &Scratch) -> bool {
        if !self.space.within_bounds(q) {
            return false;
        }
        if self.bounds.meaning == BoundsMeaning::Reference {
            return true;
        }
        let Bounds { min, max, .. } = &self.bounds;
        let axes = self.robot.motion.bounded_axes();
        // The ball about the base's origin settles most configurations.
        let centre = scratch.poses[0].translation;
        let near = |i: usize| centre[i] - self.reach >= min[i] && centre[i] + self.reach <= max[i];
        (0..axes).all(near)
            || self.pieces.iter().all(|LinkPiece { link, piece, .. }| {
                piece.is_between(&scratch.poses[*link].to_parry(), axes, min, max)
            })
    }

    fn hit(&self, hit: Hit, scratch: &Scratch) -> bool {
        let place = |piece: &LinkPiece| piece.piece.place(&scratch.poses[piece.link].to_parry());
        match hit {
            Hit::Obstacle { piece, obstacle } => {
                let (Some(piece), Some((other, at))) =
                    (self.pieces.get(piece), self.obstacles.get(obstacle))
                else {
                    return false;
                };
                piece.piece.collides(&place(piece), other, at)
            }
            Hit::Own { pair } => {
                let Some((first, second)) = self.self_pairs.get(pair) else { return false };
                let (first, second) = (&self.pieces[*first], &self.pieces[*second]);
                first.piece.collides(&place(first), &second.piece, &place(second))
            }
        }
    }

    fn look(&self, q: &[f64], scratch: &mut Scratch) -> State {
        self.robot.place(q, &mut scratch.poses);
        if !self.in_bounds(q, scratch) {
            return State::OutOfBounds;
        }
        if self.collides(scratch) { State::Colliding } else { State::Free }
    }

    /// Whether the robot as placed touches anything it must not.
    fn collides(&self, scratch: &mut Scratch) -> bool {
        if scratch.last_hit.is_some_and(|hit| self.hit(hit, scratch)) {
            return true;
        }
        for (index, LinkPiece { link, piece, reach }) in self.pieces.iter().enumerate() {
            let frame = scratch.poses[*link].to_parry();
            let reach = Vector::splat(*reach);
            let near = Aabb::new(frame.translation - reach, frame.translation + reach);
            let mut placed = None;
            for (obstacle, (other, at)) in self.obstacles.iter().enumerate() {
                if near.intersects(&at.aabb) {
                    let placed = placed.get_or_insert_with(|| piece.place(&frame));
                    if piece.collides(placed, other, at) {
                        scratch.last_hit = Some(Hit::Obstacle { piece: index, obstacle });
                        return true;
                    }
                }
            }
        }
        for pair in 0..self.self_pairs.len() {
            if self.hit(Hit::Own { pair }, scratch) {
                scratch.last_hit = Some(Hit::Own { pair });
                return true;
            }
        }
        false
    }
}

impl Validity for BodyValidity {
    fn state(&self, q: &[f64], scratch: &mut Scratch) -> State {
        scratch.asked.configurations += 1;
        self.look(q, scratch)
    }

    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> bool {
        scratch.asked.motions += 1;
        let steps = self.steps(a, b, refinement);
        let mut between = std::mem::take(&mut scratch.between);
        between.clear();
        between.resize(a.len(), 0.0);
        let mut free = true;
        // Halving the gaps finds a blocked motion soonest; every step is visited once.
        let mut stride = steps.next_power_of_two();
        'steps: while stride > 1 {
            stride /= 2;
            for i in (stride..steps).step_by(2 * stride as usize) {
                let t = i as f64 / steps as f64;
                self.space.interpolate(a, b, t, &mut between);
                if self.look(&between, scratch) != State::Free {
                    free = false;
                    break 'steps;
                }
            }
        }
        scratch.between = between;
        free
    }

    fn obstructed(&self) -> bool {
        !self.obstacles.is_empty() || !self.self_pairs.is_empty()
    }

    fn steps(&self, a: &[f64], b: &[f64], refinement: u32) -> u64 {
        let step = self.resolution / f64::from(refinement);
        (self.speeds.farthest(&self.robot, a, b) / step).ceil().max(1.0) as u64
    }
}
