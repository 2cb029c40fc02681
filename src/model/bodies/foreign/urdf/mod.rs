//! URDF: a robot without a scene. The file is read by `urdf-rs`; what that library lets pass or cannot
//! place in the file is checked before.

mod lines;
mod uri;

use super::bodies::{Meshes, Named};
use super::error::read_xml;
use super::frames::roll_pitch_yaw;
use super::{ForeignError, Solidity};
use crate::digest::SourceFile;
use crate::model::bodies::robot::{
    Follower, Joint, JointKind, LINKS_MAX, Limits, Link, TURN_MAX, couple,
};
use crate::model::bodies::shapes::{closed_by, found};
use crate::scene::{Body, LENGTH_MAX, MeshOptions, Pose, Shape};
use crate::space::BaseJoint;
use lines::Lines;
use std::collections::BTreeMap;
use std::path::Path;
use urdf_rs::{Geometry, JointType};

/// A robot without a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfRobot {
    /// Its links in the order of a walk from the root, with the shapes that are meant for collision
    /// tests.
    pub links: Vec<Link>,
    /// How the file says that the base moves, by a `floating` or `planar` joint between a root that stands for the world
    /// and the base; [`BaseJoint::Fixed`] of most files, which say nothing of it.
    pub base: BaseJoint,
    /// What the reader decided, for people to read.
    pub notes: Vec<String>,
    /// The files read: the robot's own first.
    pub sources: Vec<SourceFile>,
}

/// Reads a robot. Meshes are solid if they are closed.
///
/// # Errors
/// Names the file and line: no XML, a joint that is not supported, joints that make no tree, limits
/// inside out, a shape without extent, a mesh that cannot be read.
pub fn read_urdf(path: &Path) -> Result<UrdfRobot, ForeignError> {
    let (text, source) = read_xml(path)?;
    let lines = Lines::of(path, &text)?;
    if let Some((line, _)) = lines.links.get(LINKS_MAX) {
        let message = format!("more than {LINKS_MAX} links found");
        return Err(ForeignError::line(path, *line, message));
    }
    let robot = urdf_rs::read_from_string(&lines.text)
        .map_err(|error| ForeignError::whole(path, format!("not a URDF: {error}")))?;
    let mut reader = Reader { path, lines, meshes: Meshes::as_stored(), notes: Vec::new() };
    reader.meshes.sources.push(source);
    let mut walk = reader.walk(&robot)?;
    let base = reader.base(&robot, &mut walk)?;
    let mut links = Vec::new();
    for (link, joint) in &walk {
        let joint = match joint {
            None => None,
            Some((joint, parent)) => Some(reader.joint(&robot.joints[*joint], *joint, *parent)?),
        };
        let bodies = reader.bodies(&robot.links[*link], *link)?;
        links.push(Link { name: robot.links[*link].name.clone(), bodies, joint });
    }
    reader.couple(&robot, &walk, &mut links)?;
    Ok(UrdfRobot { links, base, notes: reader.notes, sources: reader.meshes.sources })
}

/// Indices of a link and, unless it is the root, of the joint that moves it and of its parent in the
/// order of the walk.
type Step = (usize, Option<(usize, usize)>);

struct Reader<'a> {
    path: &'a Path,
    lines: Lines,
    meshes: Meshes,
    notes: Vec<String>,
}

impl Reader<'_> {
    fn at_joint(&self, joint: usize, message: impl Into<String>) -> ForeignError {
        ForeignError::line(self.path, self.lines.joints[joint], message)
    }

    fn walk(&self, robot: &urdf_rs::Robot) -> Result<Vec<Step>, ForeignError> {
        let (links, joints) = (&robot.links, &robot.joints);
        let at_link =
            |link: usize, message| ForeignError::line(self.path, self.lines.links[link].0, message);
        let mut index_of = BTreeMap::new();
        for (index, link) in links.iter().enumerate() {
            if index_of.insert(link.name.as_str(), index).is_some() {
                return Err(at_link(index, format!("a second link `{}` found", link.name)));
            }
        }
        // The joint that each link hangs on.
        let mut holder: Vec<Option<usize>> = vec![None; links.len()];
        let mut children: Vec<Vec<(usize, usize)>> = vec![Vec::new(); links.len()];
        for (index, joint) in joints.iter().enumerate() {
            let name = &joint.name;
            let end = |end: &str| {
                index_of.get(end).copied().ok_or_else(|| {
                    self.at_joint(index, format!("joint `{name}`: there is no link `{end}`"))
                })
            };
            let (parent, child) = (end(&joint.parent.link)?, end(&joint.child.link)?);
            if let Some(other) = holder[child] {
                let (link, other) = (&joint.child.link, &joints[other].name);
                let message = format!(
                    "link `{link}` hangs on the joints `{other}` and `{name}`; a tree of links expected"
                );
                return Err(self.at_joint(index, message));
            }
            holder[child] = Some(index);
            children[parent].push((index, child));
        }
        let mut roots = (0..links.len()).filter(|link| holder[*link].is_none());
        let root = match (roots.next(), roots.next()) {
            (Some(root), None) => root,
            (Some(first), Some(second)) => {
                let (first, name) = (&links[first].name, &links[second].name);
                let message =
                    format!("links `{first}` and `{name}` hang on nothing; one root expected");
                return Err(at_link(second, message));
            }
            (None, _) if links.is_empty() => {
                return Err(ForeignError::whole(
                    self.path,
                    "no links found; at least one expected",
                ));
            }
            (None, _) => {
                return Err(self.at_joint(0, "every link hangs on another; a root expected"));
            }
        };
        let mut walk: Vec<Step> = vec![(root, None)];
        let mut reached = 0;
        while let Some((link, _)) = walk.get(reached) {
            let below =
                children[*link].iter().map(|(joint, child)| (*child, Some((*joint, reached))));
            let below: Vec<Step> = below.collect();
            walk.extend(below);
            reached += 1;
        }
        if walk.len() < links.len() {
            let lost = (0..links.len()).find(|link| walk.iter().all(|(other, _)| other != link));
            let lost = lost.expect("one is missing");
            let (name, root) = (&links[lost].name, &links[root].name);
            let message =
                format!("link `{name}` does not hang on the root `{root}`: a closed loop");
            return Err(self.at_joint(holder[lost].expect("it is no root"), message));
        }
        Ok(walk)
    }

    /// Takes the root away where it is no link of the robot but stands for the world: the one joint on it is `floating` or
    /// `planar`, and it has no shapes. Returns how the base moves.
    fn base(
        &mut self,
        robot: &urdf_rs::Robot,
        walk: &mut Vec<Step>,
    ) -> Result<BaseJoint, ForeignError> {
        let root = &robot.links[walk[0].0];
        let mut hang =
            walk.iter().filter_map(|(_, joint)| joint.filter(|(_, parent)| *parent == 0));
        let (Some((joint, _)), None) = (hang.next(), hang.next()) else {
            return Ok(BaseJoint::Fixed);
        };
        let motion = match robot.joints[joint].joint_type {
            JointType::Floating => BaseJoint::Rigid3d,
            JointType::Planar => BaseJoint::Rigid2d,
            _ => return Ok(BaseJoint::Fixed),
        };
        if !root.collision.is_empty() {
            return Ok(BaseJoint::Fixed);
        }
        let (name, child) = (&robot.joints[joint].name, &robot.joints[joint].child.link);
        self.notes.push(format!(
            "joint `{name}` moves the robot in the world: `{child}` is the base, `{}` left out",
            root.name
        ));
        walk.remove(0);
        walk[0].1 = None;
        for (_, joint) in &mut walk[1..] {
            if let Some((_, parent)) = joint {
                *parent -= 1;
            }
        }
        Ok(motion)
    }

    /// Makes the joints with `<mimic>` follow others.
    fn couple(
        &mut self,
        robot: &urdf_rs::Robot,
        walk: &[Step],
        links: &mut [Link],
    ) -> Result<(), ForeignError> {
        let mut followers = Vec::new();
        let mut numbers = Vec::new();
        for (link, (_, joint)) in walk.iter().enumerate() {
            let Some((number, _)) = joint else { continue };
            let joint = &robot.joints[*number];
            let Some(mimic) = &joint.mimic else { continue };
            if joint.joint_type == JointType::Fixed {
                // Tools that reduce a robot leave this behind.
                let name = &joint.name;
                self.notes.push(format!(
                    "joint `{name}` is fixed and follows none, whatever its <mimic> says"
                ));
                continue;
            }
            let is_named = |(_, joint): &Step| {
                joint.is_some_and(|(number, _)| robot.joints[number].name == mimic.joint)
            };
            let Some(followed) = walk.iter().position(is_named) else {
                let message = format!("`{}` found; the name of a joint expected", mimic.joint);
                return Err(self.at_mimic(robot, *number, &message));
            };
            let (multiplier, offset) =
                (mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0));
            followers.push(Follower { link, followed, multiplier, offset });
            numbers.push(*number);
        }
        let notes = couple(links, &followers)
            .map_err(|(index, message)| self.at_mimic(robot, numbers[index], &message))?;
        self.notes.extend(notes);
        Ok(())
    }

    fn at_mimic(&self, robot: &urdf_rs::Robot, joint: usize, message: &str) -> ForeignError {
        let message = format!("joint `{}`: <mimic>: {message}", robot.joints[joint].name);
        ForeignError::line(self.path, self.lines.mimics[joint], message)
    }

    fn joint(
        &mut self,
        joint: &urdf_rs::Joint,
        index: usize,
        parent: usize,
    ) -> Result<Joint, ForeignError> {
        let name = &joint.name;
        let fail = |message: String| self.at_joint(index, format!("joint `{name}`: {message}"));
        let axis = || {
            let [x, y, z] = joint.axis.xyz.0;
            let length = (x * x + y * y + z * z).sqrt();
            if length.is_finite() && length > 1e-100 {
                return Ok([x / length, y / length, z / length]);
            }
            Err(fail(format!("axis {:?} found; a direction expected", joint.axis.xyz.0)))
        };
        let open = self.lines.without_ends[index];
        let limits = |most: f64| {
            if open && joint.mimic.is_some() {
                // What it may be follows from the joint that it follows.
                return Ok(Limits { min: -most, max: most });
            }
            let (min, max) = (joint.limit.lower, joint.limit.upper);
            if -most <= min && min <= max && max <= most {
                return Ok(Limits { min, max });
            }
            let expected = format!("a least and a largest value within ±{most:e} expected");
            Err(fail(format!("limits {min} to {max} found; {expected}")))
        };
        let ends = [joint.limit.lower, joint.limit.upper];
        let endless = ends[0] < -TURN_MAX && TURN_MAX < ends[1];
        let kind = match joint.joint_type.clone() {
            JointType::Fixed => JointKind::Fixed,
            JointType::Continuous => JointKind::Revolute { axis: axis()?, limits: None },
            JointType::Revolute if endless => JointKind::Revolute { axis: axis()?, limits: None },
            JointType::Revolute => {
                JointKind::Revolute { axis: axis()?, limits: Some(limits(TURN_MAX)?) }
            }
            JointType::Prismatic => {
                JointKind::Prismatic { axis: axis()?, limits: limits(LENGTH_MAX)? }
            }
            JointType::Spherical => JointKind::Spherical,
            kind @ (JointType::Floating | JointType::Planar) => {
                let kind = if kind == JointType::Floating { "floating" } else { "planar" };
                return Err(fail(format!(
                    "type `{kind}` found; such a joint expected only on a root without shapes that \
                     has no other joint, and so stands for the world"
                )));
            }
        };
        let limited = matches!(joint.joint_type, JointType::Revolute | JointType::Prismatic);
        if limited && open && joint.mimic.is_none() {
            let what =
                "stays at 0, the format's default, as its <limit> gives neither lower nor upper";
            self.notes.push(format!("joint `{name}` {what}"));
        }
        if endless && joint.joint_type == JointType::Revolute {
            let [min, max] = ends;
            let what = "turns on and on, as it may by more than ten turns either way";
            self.notes.push(format!("joint `{name}` {what}: {min} to {max}"));
        }
        let before = pose(&joint.origin);
        Ok(Joint { name: name.clone(), parent: parent as u32, kind, before, after: Pose::IDENTITY })
    }

    fn bodies(&mut self, link: &urdf_rs::Link, index: usize) -> Result<Vec<Body>, ForeignError> {
        let mut bodies = Vec::new();
        if link.collision.is_empty() && !link.visual.is_empty() {
            let what = "only shapes to be looked at, none for collision tests: it touches nothing";
            self.notes.push(format!("link `{}` has {what}", link.name));
        }
        for (number, collision) in link.collision.iter().enumerate() {
            let line = self.lines.links[index].1[number];
            let pose = pose(&collision.origin);
            let shape = match &collision.geometry {
                Geometry::Mesh { filename, scale } => {
                    let scale = scale.map_or([1.0; 3], |scale| scale.0);
                    let what = format!("link `{}`, collision {number}", link.name);
                    bodies.push(self.mesh(&what, line, filename, scale, pose)?);
                    continue;
                }
                Geometry::Box { size } => Shape::Box { size: size.0 },
                Geometry::Sphere { radius } => Shape::Sphere { radius: *radius },
                Geometry::Cylinder { radius, length } => {
                    Shape::Cylinder { radius: *radius, height: *length }
                }
                Geometry::Capsule { radius, length } => {
                    Shape::Capsule { radius: *radius, height: *length }
                }
            };
            bodies.push(Body { shape, pose, solid: true });
        }
        Ok(bodies)
    }

    fn mesh(
        &mut self,
        what: &str,
        line: usize,
        filename: &str,
        scale: [f64; 3],
        pose: Pose,
    ) -> Result<Body, ForeignError> {
        let file = uri::resolve(self.path, filename)
            .map_err(|m| ForeignError::line(self.path, line, m))?;
        let named = Named { scene: self.path, line, file: &file };
        if scale.contains(&0.0) {
            return Err(named.error("scale = 0 found; another factor expected"));
        }
        let mut options = MeshOptions { scale, ..MeshOptions::default() };
        let (mut body, mut read) = self.meshes.body(&named, &options, pose, Solidity::Auto)?;
        if let Some(metres) = read.unit_metres
            && metres != 1.0
        {
            options.scale = scale.map(|factor| factor * metres);
            (body, read) = self.meshes.body(&named, &options, pose, Solidity::Auto)?;
            self.notes
                .push(format!("{what}: lengths times {metres}, the metres of the file's unit"));
        }
        if let Some(joined) = closed_by(&read) {
            self.notes.push(format!("{what} ({file}): {joined}"));
        }
        let (solid, why) = (body.body.solid, found(read.odd_edges, read.pairs));
        self.notes.push(format!("{what} ({file}): solid = {solid}, as {why}"));
        Ok(body.body)
    }
}

fn pose(origin: &urdf_rs::Pose) -> Pose {
    Pose { translation: origin.xyz.0, rotation: roll_pitch_yaw(origin.rpy.0) }
}
