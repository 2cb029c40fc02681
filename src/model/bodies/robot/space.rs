//! The configuration space of a robot, and how far a motion can carry its points.

use super::{JointKind, Link, Mimic, Robot};
use crate::math;
use crate::scene::Pose;
use crate::space::{Dof, Factor, FactorKind, Space, rigid_factors};

impl Robot {
    /// The configuration space. The base's reference point lies in the box `min`..`max`, and a radian
    /// of its rotation counts as `rotation_length` in the metric. A radian of a joint counts as the
    /// distance that the farthest point beyond it can have from its origin; a sliding joint counts by
    /// its length. A joint that others follow counts as far as a unit of it can carry any point, by way of all of them.
    pub fn space(&self, min: [f64; 3], max: [f64; 3], rotation_length: f64) -> Space {
        let (mut parts, mut dofs) = rigid_factors(self.motion, min, max, rotation_length);
        let reaches = self.reaches();
        let followed = self.followed();
        let mut value = 0;
        for (link, reach) in self.links.iter().zip(&reaches) {
            let Some(joint) = &link.joint else { continue };
            let own = value;
            value += joint.kind.values();
            let (kind, mut weight, unit) = match joint.kind {
                JointKind::Fixed
                | JointKind::Locked
                | JointKind::RevoluteMimic { .. }
                | JointKind::PrismaticMimic { .. } => continue,
                JointKind::Spherical => {
                    let weight = reach.of_joint;
                    parts.push(Factor { kind: FactorKind::Rotation, at: dofs.len(), weight });
                    for value in ["qw", "qx", "qy", "qz"] {
                        dofs.push(Dof { name: format!("{}-{value}", joint.name), unit: "1" });
                    }
                    continue;
                }
                JointKind::Revolute { limits: None, .. } => {
                    (FactorKind::Angle, reach.of_joint, "rad")
                }
                JointKind::Revolute { limits: Some(limits), .. } => {
                    let kind = FactorKind::Real { min: limits.min, max: limits.max };
                    (kind, reach.of_joint, "rad")
                }
                JointKind::Prismatic { limits, .. } => {
                    (FactorKind::Real { min: limits.min, max: limits.max }, 1.0, "length")
                }
            };
            if followed.contains(&(own as u32)) {
                weight = self.way_of_a_unit(own, &reaches);
            }
            parts.push(Factor { kind, at: dofs.len(), weight });
            dofs.push(Dof { name: joint.name.clone(), unit });
        }
        Space::new(parts, dofs, self.motion.translations())
    }

    /// A bound on the distance of the robot's points from the base's origin, over all configurations; a length.
    pub fn reach(&self) -> f64 {
        self.reaches()[0].of_link
    }

    /// The reaches of all links.
    fn reaches(&self) -> Vec<Reach> {
        let bodies = |link: &Link| {
            let own = link.bodies.iter();
            own.fold(0.0f64, |most, body| most.max(body.shape.reach(&body.pose)))
        };
        let own = self.links.iter().map(|link| Reach { of_link: bodies(link), of_joint: 0.0 });
        let mut reaches: Vec<Reach> = own.collect();
        // From the last link to the first: children come after their parents, so that a link is complete
        // when its turn comes.
        for (index, link) in self.links.iter().enumerate().rev() {
            let Some(joint) = &link.joint else { continue };
            let slide = match joint.kind {
                JointKind::Prismatic { limits, .. } => limits.min.abs().max(limits.max.abs()),
                JointKind::PrismaticMimic { mimic, .. } => mimic.size(self.size(mimic.value)),
                JointKind::Fixed
                | JointKind::Locked
                | JointKind::Revolute { .. }
                | JointKind::RevoluteMimic { .. }
                | JointKind::Spherical => 0.0,
            };
            let beyond = slide + length(&joint.after) + reaches[index].of_link;
            reaches[index].of_joint = beyond;
            let parent = &mut reaches[joint.parent as usize];
            parent.of_link = parent.of_link.max(length(&joint.before) + beyond);
        }
        reaches
    }

    /// The bounds by which motions are cut into steps.
    pub fn speeds(&self) -> Speeds {
        let reaches = self.reaches();
        let joints = self.links.iter().zip(&reaches).filter_map(|(link, reach)| {
            match link.joint.as_ref()?.kind {
                JointKind::Fixed | JointKind::Locked => None,
                JointKind::Revolute { .. } | JointKind::Spherical => Some(reach.of_joint),
                JointKind::Prismatic { .. } => Some(1.0),
                JointKind::RevoluteMimic { mimic, .. } => {
                    Some(reach.of_joint * mimic.multiplier.abs())
                }
                JointKind::PrismaticMimic { mimic, .. } => Some(mimic.multiplier.abs()),
            }
        });
        Speeds { base: reaches[0].of_link, joints: joints.collect(), turning_on: self.turning_on() }
    }

    /// How far the farthest point goes, at most, while the joint of a value moves by one unit of it, and with it the
    /// joints that follow it.
    fn way_of_a_unit(&self, value: usize, reaches: &[Reach]) -> f64 {
        let mut at = 0;
        let mut farthest = 0.0f64;
        // For every link the sum over the joints on the way to it.
        let mut ways: Vec<f64> = Vec::with_capacity(self.links.len());
        for (link, reach) in self.links.iter().zip(reaches) {
            let way = link.joint.as_ref().map_or(0.0, |joint| {
                let own = at;
                at += joint.kind.values();
                let follows = |mimic: &Mimic| mimic.value as usize == value;
                let share = match &joint.kind {
                    JointKind::Revolute { .. } if own == value => reach.of_joint,
                    JointKind::Prismatic { .. } if own == value => 1.0,
                    JointKind::RevoluteMimic { mimic, .. } if follows(mimic) => {
                        reach.of_joint * mimic.multiplier.abs()
                    }
                    JointKind::PrismaticMimic { mimic, .. } if follows(mimic) => {
                        mimic.multiplier.abs()
                    }
                    _ => 0.0,
                };
                ways[joint.parent as usize] + share
            });
            farthest = farthest.max(way);
            ways.push(way);
        }
        farthest
    }
}

/// Bounds on distances over all configurations.
struct Reach {
    /// Of all points of a link, and of the links that it carries, from its origin.
    of_link: f64,
    /// Of the same points from the origin of the joint that moves the link; 0 of the base, which has none.
    of_joint: f64,
}

/// Bounds on how far robot points move, computed once per robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Speeds {
    /// Length per radian of the base's rotation.
    base: f64,
    /// Per moving joint: the length that any robot point moves per unit of its value, or per radian of its
    /// turn; of a joint that follows another per unit of the other's value.
    joints: Vec<f64>,
    /// The values that joints follow and that wrap, in rising order: indices from the first value after the base's.
    turning_on: Vec<u32>,
}

impl Speeds {
    /// A bound on the length of the way of any robot point along the interpolation from `a` to `b`: the
    /// base's translation, and for every turn its angle times the distance of the farthest point that
    /// it can move.
    pub fn farthest(&self, robot: &Robot, a: &[f64], b: &[f64]) -> f64 {
        let motion = robot.motion;
        let mut square = 0.0;
        for i in 0..motion.translations() {
            square += (b[i] - a[i]) * (b[i] - a[i]);
        }
        let mut farthest = square.sqrt() + self.base * motion.angle_between(a, b);
        let first = motion.values();
        let mut at = first;
        let mut speeds = self.joints.iter();
        for joint in robot.links.iter().filter_map(|link| link.joint.as_ref()) {
            let change = match joint.kind {
                JointKind::Fixed | JointKind::Locked => continue,
                JointKind::RevoluteMimic { mimic, .. }
                | JointKind::PrismaticMimic { mimic, .. } => {
                    let other = first + mimic.value as usize;
                    match self.turning_on.binary_search(&mimic.value) {
                        Ok(_) => math::angle_between(a[other], b[other]),
                        Err(_) => (a[other] - b[other]).abs(),
                    }
                }
                JointKind::Revolute { limits: None, .. } => math::angle_between(a[at], b[at]),
                JointKind::Revolute { .. } | JointKind::Prismatic { .. } => (a[at] - b[at]).abs(),
                JointKind::Spherical => {
                    let dot: f64 = (at..at + 4).map(|i| a[i] * b[i]).sum();
                    2.0 * math::acos(dot.abs())
                }
            };
            farthest += change * speeds.next().expect("a speed per joint");
            at += joint.kind.values();
        }
        farthest
    }
}

fn length(pose: &Pose) -> f64 {
    let [x, y, z] = pose.translation;
    (x * x + y * y + z * z).sqrt()
}
