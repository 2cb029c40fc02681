//! Robots: links, the joints between them, and where they stand at a configuration.
//!
//! A robot is a tree of links. The base moves as [`BaseJoint`] says; every other link is moved by a joint
//! of an earlier one. A rigid body is a robot of one link. A configuration holds the base's values, then
//! those of the joints in the order of their links; joints that are fixed, locked or follow another have none.

mod drives;
mod joint;
mod layout;
mod locked;
mod mimics;
mod pairs;
mod rates;
mod space;

pub(crate) use drives::Drive;
pub use joint::{Joint, JointKind, Limits, Mimic, TURN_MAX};
pub(super) use locked::lock;
pub(super) use mimics::mimic_complaint;
pub(super) use mimics::{Follower, couple};
pub(crate) use rates::{Hops, Rates, Steady};
pub use space::Speeds;

use crate::math;
use crate::scene::{Body, Pose};
use crate::space::BaseJoint;
use bincode::{Decode, Encode};

/// The most links that a robot may have. A robot of so many has half a million pairs of links, each of which is
/// stored, and looked at for every configuration.
pub const LINKS_MAX: usize = 1000;

/// A robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// How the base, link 0, moves.
    pub motion: BaseJoint,
    /// Where the base stands when its motion is [`BaseJoint::Fixed`]: its frame in the world's.
    pub base: Pose,
    /// The links. The base comes first, every other link after its parent.
    pub links: Vec<Link>,
    /// Pairs of links, the lower index first, that may touch one another although they are not
    /// neighbours.
    pub may_touch: Vec<(u32, u32)>,
    /// Per link: how near to it obstacles are already in the way, a length; empty where it is zero for all. Other links and
    /// the bounds may come as near as they like.
    pub padding: Vec<f64>,
}

/// A link: bodies that move as one.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Link {
    /// Its name.
    pub name: String,
    /// Its bodies, in the link's frame. A link may have none.
    pub bodies: Vec<Body>,
    /// What moves it; `None` of the base alone.
    pub joint: Option<Joint>,
}

impl Robot {
    /// A rigid body.
    pub fn rigid(motion: BaseJoint, bodies: Vec<Body>) -> Robot {
        let base = Link { name: "body".to_owned(), bodies, joint: None };
        Robot {
            motion,
            base: Pose::IDENTITY,
            links: vec![base],
            may_touch: Vec::new(),
            padding: Vec::new(),
        }
    }

    /// All bodies, link after link.
    pub fn bodies(&self) -> impl Iterator<Item = &Body> {
        self.links.iter().flat_map(|link| &link.bodies)
    }

    /// How near to a link obstacles are already in the way, a length.
    pub fn padding_of(&self, link: usize) -> f64 {
        self.padding.get(link).copied().unwrap_or(0.0)
    }

    fn base_pose(&self, q: &[f64]) -> Pose {
        match self.motion {
            BaseJoint::Fixed => self.base,
            BaseJoint::Translation2d => Pose { translation: [q[0], q[1], 0.0], ..Pose::IDENTITY },
            BaseJoint::Rigid2d => {
                let (sine, cosine) = (math::sin(q[2] / 2.0), math::cos(q[2] / 2.0));
                Pose { translation: [q[0], q[1], 0.0], rotation: [cosine, 0.0, 0.0, sine] }
            }
            BaseJoint::Translation3d => Pose { translation: [q[0], q[1], q[2]], ..Pose::IDENTITY },
            BaseJoint::Rigid3d => {
                Pose { translation: [q[0], q[1], q[2]], rotation: [q[3], q[4], q[5], q[6]] }
            }
        }
    }

    /// All bodies where they stand in the world's frame at the configuration `q`.
    pub fn bodies_at(&self, q: &[f64]) -> Vec<Body> {
        let mut poses = Vec::new();
        self.link_poses(q, &mut poses);
        let placed = self.links.iter().zip(&poses).flat_map(|(link, pose)| {
            link.bodies.iter().map(|body| Body { pose: pose.then(&body.pose), ..body.clone() })
        });
        placed.collect()
    }

    /// The point by which a configuration is drawn, in the world's frame: the base's reference point,
    /// or, where the base stands still, the origin of the last link.
    pub fn marker(&self, q: &[f64]) -> [f64; 3] {
        let mut poses = Vec::new();
        self.link_poses(q, &mut poses);
        let moving = if self.motion == BaseJoint::Fixed { poses.last() } else { poses.first() };
        moving.map_or([0.0; 3], |pose| pose.translation)
    }

    /// Places the links: `poses` becomes, for every link, its frame in the world's at the
    /// configuration `q`.
    pub fn link_poses(&self, q: &[f64], poses: &mut Vec<Pose>) {
        poses.clear();
        let first = self.motion.values();
        let mut at = first;
        for link in &self.links {
            let pose = match &link.joint {
                None => self.base_pose(q),
                Some(joint) => {
                    let own = at..at + joint.kind.values();
                    at = own.end;
                    let moved = match joint.kind.mimic() {
                        None => joint.pose(&q[own]),
                        Some(mimic) => joint.pose(&[mimic.at(&q[first..])]),
                    };
                    poses[joint.parent as usize].then(&moved)
                }
            };
            poses.push(pose);
        }
    }
}

#[cfg(test)]
pub(crate) mod mimics_tests;
#[cfg(test)]
mod rates_reference;
#[cfg(test)]
pub(crate) mod rates_tests;
#[cfg(test)]
mod tests;
