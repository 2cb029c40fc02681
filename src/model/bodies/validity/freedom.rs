//! In which directions a link can move against another, or against the obstacles, by the joints between the two.
//!
//! A planar arm moves in its plane whatever its joints do, so that a way out of a collision that leads out of the plane is
//! none. The directions are those of the joints where they stand: a joint that turns moves points at right angles to its
//! axis, one that slides along it.

use super::frame::Stance;
use super::meet::Meeting;
use crate::model::bodies::robot::{Joint, JointKind, Robot};
use crate::space::BaseJoint;
use parry3d_f64::math::Vector;

/// Directions whose sine or cosine of the angle between is at most this count as parallel, or as at right angles: files give
/// right angles with few digits.
const PARALLEL: f64 = 1e-4;
/// What a unit vector has of a plane or a line is no direction if it is shorter.
const SHORT: f64 = 1e-6;

/// The directions in which a link can move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Freedom {
    /// All.
    Space,
    /// Those at right angles to a unit vector.
    Plane(Vector),
    /// The two along a unit vector.
    Line(Vector),
}

/// The joints met so far.
#[derive(Default)]
struct Axes {
    /// The axis of the joints that turn, as long as these are parallel.
    turning: Option<Vector>,
    /// The first two directions of joints that slide which are not parallel.
    sliding: [Option<Vector>; 2],
    /// Whether there is no plane in which all motions are.
    in_space: bool,
}

impl Freedom {
    /// How the moving link of a meeting can move against the standing one, or against the obstacles, near where the links
    /// stand. Of links that no joint moves against one another all directions count.
    pub fn of(robot: &Robot, stance: &Stance, meeting: &Meeting) -> Freedom {
        let mut axes = Axes::default();
        for joint in joints_between(robot, meeting.mover_link, meeting.still_link) {
            axes.take(joint, stance);
        }
        if meeting.still_link.is_none() {
            match robot.motion {
                BaseJoint::Fixed => {}
                BaseJoint::Rigid2d => axes.turn(Vector::Z),
                BaseJoint::Translation2d => {
                    axes.slide(Vector::X);
                    axes.slide(Vector::Y);
                }
                BaseJoint::Translation3d | BaseJoint::Rigid3d => axes.in_space = true,
            }
        }
        axes.freedom()
    }

    /// What unit vectors have in these directions, each direction once, in the order of the vectors.
    pub fn within(self, vectors: &[Vector]) -> Vec<Vector> {
        let mut found: Vec<Vector> = Vec::new();
        for vector in vectors {
            let inside = match self {
                Freedom::Space => *vector,
                Freedom::Plane(normal) => *vector - normal * normal.dot(*vector),
                Freedom::Line(axis) => axis * axis.dot(*vector),
            };
            if inside.length() < SHORT {
                continue;
            }
            // A vector that lies within them stays what it is to the last bit.
            let inside = if inside == *vector { inside } else { inside.normalize() };
            if !found.iter().any(|other| (*other - inside).length() < SHORT) {
                found.push(inside);
            }
        }
        found
    }
}

impl Axes {
    fn take(&mut self, joint: &Joint, stance: &Stance) {
        let parent = stance.pose(Some(joint.parent as usize));
        let turn = parent.rotation * joint.before.to_parry().rotation;
        let along = |axis: [f64; 3]| turn * Vector::from_array(axis);
        match joint.kind {
            JointKind::Fixed | JointKind::Locked => {}
            JointKind::Spherical => self.in_space = true,
            JointKind::Revolute { axis, .. } | JointKind::RevoluteMimic { axis, .. } => {
                self.turn(along(axis));
            }
            JointKind::Prismatic { axis, .. } | JointKind::PrismaticMimic { axis, .. } => {
                self.slide(along(axis));
            }
        }
    }

    fn turn(&mut self, axis: Vector) {
        match self.turning {
            None => self.turning = Some(axis),
            Some(known) => self.in_space |= known.cross(axis).length() > PARALLEL,
        }
    }

    fn slide(&mut self, axis: Vector) {
        match self.sliding {
            [None, _] => self.sliding[0] = Some(axis),
            [Some(first), None] if first.cross(axis).length() > PARALLEL => {
                self.sliding[1] = Some(axis);
            }
            [Some(_), None] => {}
            [Some(first), Some(second)] => {
                let normal = first.cross(second).normalize();
                self.in_space |= normal.dot(axis).abs() > PARALLEL;
            }
        }
    }

    fn freedom(&self) -> Freedom {
        if self.in_space {
            return Freedom::Space;
        }
        let slides = self.sliding.iter().flatten();
        match (self.turning, self.sliding) {
            (Some(normal), _) => {
                let in_plane = slides.into_iter().all(|axis| normal.dot(*axis).abs() <= PARALLEL);
                if in_plane { Freedom::Plane(normal) } else { Freedom::Space }
            }
            (None, [Some(first), Some(second)]) => Freedom::Plane(first.cross(second).normalize()),
            (None, [Some(axis), None]) => Freedom::Line(axis),
            (None, [None, _]) => Freedom::Space,
        }
    }
}

/// The joints on the way from a link to another, or to the base where there is no other.
fn joints_between(robot: &Robot, link: usize, other: Option<usize>) -> Vec<&Joint> {
    let to_base = |link: usize| {
        let parent = |link: &usize| {
            let joint = robot.links[*link].joint.as_ref();
            joint.map(|joint| joint.parent as usize)
        };
        std::iter::successors(Some(link), parent).collect::<Vec<usize>>()
    };
    let (own, others) = (to_base(link), other.map_or_else(Vec::new, to_base));
    let one_way = own.iter().filter(|link| !others.contains(link));
    let other_way = others.iter().filter(|link| !own.contains(link));
    one_way.chain(other_way).filter_map(|link| robot.links[*link].joint.as_ref()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Reason;
    use crate::problem::Problem;
    use std::path::Path;

    /// A planar arm whose plane stands upright at 45°, beside a wall that is thin across the plane: the shortest way out of
    /// the wall leads out of the plane, where the arm cannot go.
    const ARM: &str = r#"
[space]
motion = "fixed"
[robot]
base = { turn = { axis = [0, 0, 1], degrees = 45 } }
bodies = [{ shape = { sphere = { radius = 0.05 } } }]
[[robot.links]]
name = "upper"
joint = { kind = { revolute = { axis = [0, 1, 0] } } }
bodies = [{ shape = { capsule = { radius = 0.05, height = 0.8 } }, position = [0, 0, 0.5] }]
[[robot.links]]
name = "lower"
joint = { kind = { KIND }, before = { position = [0, 0, 1] } }
bodies = [{ shape = { capsule = { radius = 0.05, height = 0.8 } }, position = [0, 0, 0.5] }]
[[obstacles]]
shape = { box = { size = [0.6, 0.02, 0.6] } }
position = [0, 0, 1.5]
turn = { axis = [0, 0, 1], degrees = 45 }
"#;

    fn way_out(kind: &str, q: &[f64]) -> Vector {
        let problem = Problem::parse(Path::new("arm.toml"), &ARM.replace("KIND", kind));
        let model =
            problem.unwrap_or_else(|error| panic!("{error}")).model().description().prepare();
        let found = model.reasons(q, true);
        let [Reason::Collision { direction, depth, .. }] = &found[..] else { panic!("{found:?}") };
        assert!(*depth > 0.0);
        Vector::from_array(*direction)
    }

    #[test]
    fn a_planar_arm_has_no_way_out_of_its_plane() {
        let normal = Vector::new(-1.0, 1.0, 0.0).normalize();
        let planar = way_out("revolute = { axis = [0, 2, 0] }", &[0.0, 0.1]);
        assert!(planar.dot(normal).abs() < 1e-9, "{planar:?}");
        assert!((planar.length() - 1.0).abs() < 1e-12);
        // A joint about another axis leads out of the plane, and that is the shortest way.
        let free = way_out("revolute = { axis = [1, 0, 0] }", &[0.0, 0.0]);
        assert!(free.dot(normal).abs() > 0.9, "{free:?}");
        // Slides in the plane stay in it.
        let sliding = way_out("prismatic = { axis = [0, 0, 1], range = [-1, 1] }", &[0.0, 0.1]);
        assert!(sliding.dot(normal).abs() < 1e-9, "{sliding:?}");
    }

    #[test]
    fn joints_span_a_line_a_plane_or_space() {
        let freedom = |turning: &[Vector], sliding: &[Vector]| {
            let mut axes = Axes::default();
            turning.iter().for_each(|axis| axes.turn(*axis));
            sliding.iter().for_each(|axis| axes.slide(*axis));
            axes.freedom()
        };
        let [x, y, z] = [Vector::X, Vector::Y, Vector::Z];
        assert_eq!(freedom(&[], &[]), Freedom::Space);
        assert_eq!(freedom(&[z, -z], &[]), Freedom::Plane(z));
        assert_eq!(freedom(&[z, x], &[]), Freedom::Space);
        assert_eq!(freedom(&[z], &[x, y]), Freedom::Plane(z));
        assert_eq!(freedom(&[z], &[z]), Freedom::Space);
        assert_eq!(freedom(&[], &[x, -x]), Freedom::Line(x));
        assert_eq!(freedom(&[], &[x, y]), Freedom::Plane(z));
        assert_eq!(freedom(&[], &[x, y, z]), Freedom::Space);
        let diagonal = Vector::new(1.0, 0.0, 1.0).normalize();
        assert_eq!(Freedom::Line(x).within(&[z, x, -x, diagonal]), [x, -x]);
        assert_eq!(Freedom::Plane(z).within(&[z, diagonal, y]), [x, y]);
        assert_eq!(Freedom::Space.within(&[diagonal, y]), [diagonal, y]);
    }
}
