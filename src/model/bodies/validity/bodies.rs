//! Validity of a robot of rigid links among obstacles.

use super::BodyScratch;
use super::frame::Stance;
use super::gaps::GapPairs;
use super::meet::{Group, Meeting};
use super::piece::Piece;
use super::swept::Walls;
use crate::lanes::Lanes;
use crate::model::bodies::robot::{Hops, Rates, Robot, Speeds};
use crate::model::{Clearances, Contacts, Cost, Gaps, Model, Reason, Scratch, Validity};
use crate::scene::Body;
use crate::space::{BaseJoint, Space};
use bincode::{Decode, Encode};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose as ParryPose, Vector};
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::sync::OnceLock;

/// Which points of the robot must stay within the bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum BoundsMeaning {
    /// Every point of the robot (of a planar robot: in x and y).
    Body,
    /// Only the robot's reference point, the origin of its base's frame.
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

/// What is promised of a motion that is found valid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum MotionChecking {
    /// It is free at every time, with a small share of the resolution as tolerance.
    #[default]
    Swept,
    /// It is free at discrete steps no farther apart than the resolution.
    Sampled,
    /// At discrete steps no farther apart than the resolution it is free, or one of some fixed short motions leads from it to where
    /// the robot is free. Configurations are judged in the same way. It is a relaxation of the two others: the relaxation
    /// [`Penetration`](crate::model::Penetration) makes it.
    Penetrating {
        /// How far those motions lead at most, in the metric of the space.
        depth: f64,
    }, // new ones at the end, since ledgers know them by number
}

/// Validity of a robot among obstacles that stand still.
///
/// Bodies collide when their surfaces meet or when one lies wholly inside another that is solid.
/// Of a link with a padding ([`Robot::padding`]) obstacles already collide that are as near as that.
/// Links that are neighbours, or that [`Robot::may_touch`] names, may touch. [`MotionChecking`] says what is promised of
/// motions; `docs/validity.md` describes the methods.
pub struct BodyValidity {
    pub(super) space: Space,
    pub(super) robot: Robot,
    pub(super) speeds: Speeds,
    /// The joints, for how fast links move.
    pub(super) hops: Hops,
    pub(super) bounds: Bounds,
    pub(super) resolution: f64,
    pub(super) edges: MotionChecking,
    /// A bound on the distance of the robot's points from the base's origin.
    pub(super) reach: f64,
    /// The same with the padding of the links.
    pub(super) padded_reach: f64,
    pub(super) links: Vec<Moving>,
    pub(super) obstacles: Option<Group>,
    /// The obstacles' boxes.
    pub(super) boxes: Vec<Aabb>,
    /// Pairs of links that must not touch each other.
    pub(super) self_pairs: Vec<SelfPair>,
    /// Whether any body is solid while only its surface is in a tree.
    pub(super) solid: bool,
    /// A length greater than what rounding in double precision can add up to.
    pub(super) slack: f64,
    /// The instructions by which boxes are tested.
    pub(super) lanes: Lanes,
    /// Gaps of the robot and of the obstacles, found when they are first asked for.
    gap_pairs: OnceLock<GapPairs>,
}

/// A link that has bodies.
pub(super) struct Moving {
    pub link: usize,
    pub group: Group,
    /// The link with its padding, if it has one, which is what obstacles must not touch.
    padded: Option<Group>,
}

impl Moving {
    /// What obstacles must not touch.
    pub fn among_obstacles(&self) -> &Group {
        self.padded.as_ref().unwrap_or(&self.group)
    }
}

/// Two links with bodies, as indices into [`BodyValidity::links`]. A robot of a thousand links has half a
/// million pairs, so that whatever else concerns a pair is derived when it is needed.
pub(super) struct SelfPair {
    first: u32,
    second: u32,
}

/// A box in which all robot points are, as long as its reference point is within the bounds.
fn places_of(robot: &Robot, bounds: &Bounds, reach: f64) -> [Vector; 2] {
    let stands = robot.base.translation;
    let [low, high] = match robot.motion.translations() {
        0 => [stands; 2],
        2 => [bounds.min, bounds.max].map(|[x, y, _]| [x, y, 0.0]),
        _ => [bounds.min, bounds.max],
    };
    [
        Vector::from_array(low) - Vector::splat(reach),
        Vector::from_array(high) + Vector::splat(reach),
    ]
}

impl BodyValidity {
    /// Prepares the bodies. `edges` says what is promised of motions; `resolution` is a length; see [`Model::motion`](crate::model::Model::motion).
    pub fn new(
        space: Space,
        robot: &Robot,
        bounds: Bounds,
        edges: MotionChecking,
        resolution: f64,
        obstacles: &[Body],
    ) -> BodyValidity {
        let links = robot.links.iter().enumerate().filter_map(|(link, bodies)| {
            let group = Group::new(bodies.bodies.iter())?;
            let padding = robot.padding_of(link);
            let is_padded = padding > 0.0 && !obstacles.is_empty();
            let padded = is_padded.then(|| Group::padded(&bodies.bodies, padding)).flatten();
            Some(Moving { link, group, padded })
        });
        let links: Vec<Moving> = links.collect();
        // Where each link that has a surface stands among these.
        let mut places = vec![None; robot.links.len()];
        for (place, moving) in links.iter().enumerate() {
            places[moving.link] = Some(place as u32);
        }
        let pairs = robot.self_pairs().filter_map(|(low, high)| {
            Some(SelfPair { first: places[low]?, second: places[high]? })
        });
        let self_pairs = pairs.collect();
        let reach = robot.reach();
        let padded_reach = reach + robot.padding.iter().fold(0.0, |most, one| f64::max(most, *one));
        let obstacles = Group::of_obstacles(obstacles, places_of(robot, &bounds, reach));
        let boxes = obstacles.iter().flat_map(|group| &group.pieces);
        let far = |point: &[f64; 3]| Vector::from_array(*point).abs().max_element();
        let scale =
            [padded_reach, far(&bounds.min), far(&bounds.max), far(&robot.base.translation)];
        let scale = obstacles
            .iter()
            .flat_map(|group| &group.tree.elements)
            .fold(scale.into_iter().fold(0.0, f64::max), |most, element| {
                most.max(element.reach(&Rates::default()))
            });
        let groups = links.iter().map(|moving| &moving.group).chain(&obstacles);
        let solid = groups.into_iter().any(Group::has_insides);
        BodyValidity {
            space,
            speeds: robot.speeds(),
            hops: Hops::new(robot),
            robot: robot.clone(),
            bounds,
            resolution,
            edges,
            reach,
            padded_reach,
            boxes: boxes.map(|piece| piece.box_at(&ParryPose::IDENTITY)).collect(),
            links,
            obstacles,
            self_pairs,
            solid,
            slack: 1e-12 * scale,
            lanes: Lanes::widest(),
            gap_pairs: OnceLock::new(),
        }
    }

    /// Gaps of the robot and of the obstacles.
    pub(super) fn gap_pairs(&self) -> &GapPairs {
        self.gap_pairs.get_or_init(|| GapPairs::of(self))
    }

    /// Everything that could collide: every link with the obstacles, then the pairs of links that must not touch.
    pub(super) fn meetings(&self) -> impl Iterator<Item = Meeting<'_>> {
        let (slack, lanes) = (self.slack, self.lanes);
        let among = self.links.iter().filter_map(move |moving| {
            let still = self.obstacles.as_ref()?;
            let (mover, mover_link) = (moving.among_obstacles(), moving.link);
            Some(Meeting { mover, mover_link, still, still_link: None, slack, lanes })
        });
        let own = self.self_pairs.iter().map(move |pair| {
            let [still, mover] = self.links_of(pair);
            Meeting {
                mover: &mover.group,
                mover_link: mover.link,
                still: &still.group,
                still_link: Some(still.link),
                slack,
                lanes,
            }
        });
        among.chain(own)
    }

    /// The two links of a pair.
    fn links_of(&self, pair: &SelfPair) -> [&Moving; 2] {
        [pair.first, pair.second].map(|place| &self.links[place as usize])
    }

    /// Whether the ball around the base's origin that holds the robot is within the bounds: a cheap test that
    /// suffices for most configurations.
    pub(super) fn ball_inside(&self, q: &[f64]) -> bool {
        let Bounds { min, max, .. } = &self.bounds;
        let fixed = self.robot.motion == BaseJoint::Fixed;
        let centre = if fixed { &self.robot.base.translation } else { q };
        (0..self.robot.motion.bounded_axes())
            .all(|i| centre[i] - self.reach >= min[i] && centre[i] + self.reach <= max[i])
    }

    pub(super) fn walls(&self) -> Walls {
        let Bounds { min, max, .. } = self.bounds;
        Walls { min, max, axes: self.robot.motion.bounded_axes() }
    }

    /// Whether the robot is within the bounds however it is turned, so that no closer test of the bounds is needed.
    pub(super) fn decided_by_ball(&self, q: &[f64]) -> bool {
        self.bounds.meaning == BoundsMeaning::Reference || self.ball_inside(q)
    }

    /// Whether the robot is free at `q`; see [`Model::validity`]. Nothing is counted.
    pub(in crate::model) fn look(&self, q: &[f64], scratch: &mut BodyScratch) -> Validity {
        if !self.space.within_bounds(q) {
            return Validity::OutOfBounds;
        }
        let bounded = self.decided_by_ball(q);
        if bounded && self.keeps_away(q, q, 0.0) {
            return Validity::Valid;
        }
        self.robot.link_poses(q, &mut scratch.stance.poses);
        scratch.stance.update_frames();
        let held = bounded
            || self.links.iter().all(|Moving { link, group, .. }| {
                self.walls().hold(&group.tree, &scratch.stance.frames[*link])
            });
        if !held {
            return Validity::OutOfBounds;
        }
        let BodyScratch { stance, stacks, .. } = scratch;
        let touching =
            self.meetings().any(|meeting| meeting.surfaces_meet(stance, &mut stacks.pairs));
        if touching || self.encloses(stance) { Validity::Invalid } else { Validity::Valid }
    }

    /// Whether a solid mesh encloses anything, given that no surfaces meet.
    fn encloses(&self, stance: &Stance) -> bool {
        let either = |one: &Piece, at: &ParryPose, other: &Piece, other_at: &ParryPose| {
            one.encloses(at, other, other_at) || other.encloses(other_at, one, at)
        };
        let hollow = Group::is_hollow;
        self.links.iter().any(|moving| {
            let Some(obstacles) = &self.obstacles else { return false };
            let at = stance.pose(Some(moving.link));
            (hollow(&moving.group) || hollow(obstacles))
                && moving.group.pieces.iter().any(|piece| {
                    let near = piece.box_at(&at);
                    obstacles.pieces.iter().zip(&self.boxes).any(|(other, other_box)| {
                        near.intersects(other_box)
                            && either(piece, &at, other, &ParryPose::IDENTITY)
                    })
                })
        }) || self.self_pairs.iter().any(|pair| {
            let [first, second] = self.links_of(pair);
            let [at, other_at] = [first, second].map(|moving| stance.pose(Some(moving.link)));
            (hollow(&first.group) || hollow(&second.group))
                && first.group.pieces.iter().any(|piece| {
                    second.group.pieces.iter().any(|other| {
                        piece.box_at(&at).intersects(&other.box_at(&other_at))
                            && either(piece, &at, other, &other_at)
                    })
                })
        })
    }
}

/// What is particular to bodies.
impl BodyValidity {
    /// The model of bodies, if that is what a model is.
    pub fn of(model: &dyn Model) -> Option<&BodyValidity> {
        (model as &dyn Any).downcast_ref()
    }

    /// Number of equal steps into which the motion from `a` to `b` is cut so that no robot point moves farther
    /// than the problem's resolution divided by `refinement` in one of them.
    pub fn steps(&self, a: &[f64], b: &[f64], refinement: u32) -> u64 {
        let step = self.resolution / f64::from(refinement);
        (self.speeds.farthest(&self.robot, a, b) / step).ceil().max(1.0) as u64
    }
}

impl Model for BodyValidity {
    fn space(&self) -> &Space {
        &self.space
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        self.look(q, scratch.for_configuration())
    }

    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        self.judge(a, b, refinement, scratch.for_motion()).then_some(Cost::Metric)
    }

    fn among(&self, bodies: &[Body]) -> Option<Box<dyn Model>> {
        let (space, edges, resolution) = (self.space.clone(), self.edges, self.resolution);
        let model = BodyValidity::new(space, &self.robot, self.bounds, edges, resolution, bodies);
        Some(Box::new(BodyValidity { self_pairs: Vec::new(), ..model }))
    }

    fn may_meet(&self, a: &[f64], b: &[f64], scratch: &mut Scratch) -> bool {
        self.swept_box_meets(a, b, scratch.of_model())
    }

    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        self.reasons_at(q, depths)
    }

    fn is_obstructed(&self) -> bool {
        self.obstacles.is_some() || !self.self_pairs.is_empty()
    }

    fn touching_box(&self) -> Option<[[f64; 3]; 2]> {
        if !self.self_pairs.is_empty() || self.robot.motion.translations() == 0 {
            return None;
        }
        let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
        let [low, high] = self
            .boxes
            .iter()
            .fold(nothing, |[low, high], one| [low.min(one.mins), high.max(one.maxs)]);
        let reach = Vector::splat(self.padded_reach + self.slack);
        (!self.boxes.is_empty()).then(|| [(low - reach).to_array(), (high + reach).to_array()])
    }

    fn clearances(&self) -> Option<&dyn Clearances> {
        Some(self)
    }

    fn contacts(&self) -> Option<&dyn Contacts> {
        Some(self)
    }

    fn gaps(&self) -> Option<&dyn Gaps> {
        let gaps: &dyn Gaps = self;
        (!self.gap_pairs().is_empty()).then_some(gaps)
    }
}
