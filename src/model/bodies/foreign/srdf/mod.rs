//! SRDF, MoveIt's semantic description of a robot, which stands beside a URDF: groups of joints, named states, pairs of
//! links that may touch, how the base moves, end effectors.
//!
//! The format: <https://wiki.ros.org/srdf> and `srdfdom`'s reader, which MoveIt uses. Of joints and links that the robot
//! does not have nothing is read, as MoveIt does: one SRDF often serves several variants of a robot.

mod groups;

use super::ForeignError;
use super::error::read_xml;
use crate::digest::SourceFile;
use roxmltree::{Document, Node};
use std::path::{Path, PathBuf};

/// How deep elements may be nested; the deepest that is read is the third.
const DEPTH_MAX: usize = 64;

/// What an SRDF says.
#[derive(Clone, Debug, PartialEq)]
pub struct Srdf {
    /// The file.
    pub path: PathBuf,
    /// `<group>`: sets of joints.
    pub groups: Vec<Group>,
    /// `<group_state>`: values of joints under a name.
    pub states: Vec<GroupState>,
    /// `<disable_collisions>`: pairs of links that may touch, by their names.
    pub disabled: Vec<[String; 2]>,
    /// `<virtual_joint>`: how the robot's root link moves in the world.
    pub virtual_joints: Vec<VirtualJoint>,
    /// `<end_effector>`: groups that are hands of others.
    pub end_effectors: Vec<EndEffector>,
    /// The file as one of those read.
    pub source: SourceFile,
}

/// A set of joints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Its name.
    pub name: String,
    /// What it consists of, each with its line.
    pub members: Vec<(usize, Member)>,
}

/// A part of a group.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Member {
    /// A joint, by its name.
    Joint(String),
    /// A link, by its name: the joint that moves it.
    Link(String),
    /// All joints between two links, by the links' names.
    Chain {
        /// The link at the chain's beginning, which the chain does not move.
        base: String,
        /// The link at its end.
        tip: String,
    },
    /// All of another group, by its name.
    Group(String),
}

/// Values of joints under a name.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupState {
    /// Its name.
    pub name: String,
    /// The group of which it is a state; empty where the file says none.
    pub group: String,
    /// Names of joints and their values: one of most joints.
    pub joints: Vec<(String, Vec<f64>)>,
}

/// How the robot's root link moves in the world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VirtualJoint {
    /// Its name, by which groups have it.
    pub name: String,
    /// Its kind.
    pub kind: VirtualKind,
    /// The link that it moves.
    pub child: String,
}

/// A kind of virtual joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VirtualKind {
    /// The base stands still.
    Fixed,
    /// The base moves in the plane and turns about z.
    Planar,
    /// The base moves and turns in space.
    Floating,
}

/// A group that is the hand of another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EndEffector {
    /// Its name.
    pub name: String,
    /// The link on which the hand is mounted.
    pub parent_link: String,
    /// The hand's own group.
    pub group: String,
    /// The group that the hand extends, if the file says so.
    pub parent_group: Option<String>,
}

/// Reads an SRDF. Elements other than those of [`Srdf`], such as grippers and rotors of other programs, are passed over.
///
/// # Errors
/// Names the file and line: no XML, no `<robot>`, an element that lacks an attribute, a value that is no number.
pub fn read_srdf(path: &Path) -> Result<Srdf, ForeignError> {
    let (text, source) = read_xml(path)?;
    let document = Document::parse(&text).map_err(|error| {
        ForeignError::line(path, error.pos().row as usize, format!("not an SRDF: {error}"))
    })?;
    let breaks: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    let reader = Reader { path, breaks };
    let root = document.root_element();
    if !root.has_tag_name("robot") {
        let name = root.tag_name().name();
        return Err(reader.error(root, format!("<{name}> found; <robot> expected")));
    }
    let mut srdf = Srdf {
        path: path.to_owned(),
        groups: Vec::new(),
        states: Vec::new(),
        disabled: Vec::new(),
        virtual_joints: Vec::new(),
        end_effectors: Vec::new(),
        source,
    };
    for node in root.descendants().filter(|node| node.is_element()) {
        if node.ancestors().count() > DEPTH_MAX {
            let message = format!("elements nested more than {DEPTH_MAX} deep");
            return Err(reader.error(node, message));
        }
        if node.tag_name().namespace().is_some_and(|space| space.contains("xacro")) {
            let name = node.tag_name().name();
            let message = format!("<xacro:{name}> found; an SRDF that xacro has expanded expected");
            return Err(reader.error(node, message));
        }
    }
    for node in root.children().filter(Node::is_element) {
        match node.tag_name().name() {
            "group" => {
                let group = reader.group(node)?;
                if srdf.groups.iter().any(|other| other.name == group.name) {
                    let message = format!("a second group `{}` found", group.name);
                    return Err(reader.error(node, message));
                }
                srdf.groups.push(group);
            }
            "group_state" => srdf.states.push(reader.state(node)?),
            "disable_collisions" => {
                let [one, other] = ["link1", "link2"].map(|key| reader.text(node, key));
                srdf.disabled.push([one?, other?]);
            }
            "virtual_joint" => srdf.virtual_joints.push(reader.virtual_joint(node)?),
            "end_effector" => srdf.end_effectors.push(EndEffector {
                name: reader.text(node, "name")?,
                parent_link: reader.text(node, "parent_link")?,
                group: reader.text(node, "group")?,
                parent_group: node.attribute("parent_group").map(str::to_owned),
            }),
            _ => {}
        }
    }
    Ok(srdf)
}

struct Reader<'a> {
    path: &'a Path,
    /// Where lines end.
    breaks: Vec<usize>,
}

impl Reader<'_> {
    fn line(&self, node: Node) -> usize {
        let start = node.range().start;
        1 + self.breaks.partition_point(|at| *at < start)
    }

    fn error(&self, node: Node, message: impl Into<String>) -> ForeignError {
        ForeignError::line(self.path, self.line(node), message)
    }

    /// The attribute of an element.
    fn text(&self, node: Node, key: &str) -> Result<String, ForeignError> {
        node.attribute(key).map(str::to_owned).ok_or_else(|| {
            let name = node.tag_name().name();
            self.error(node, format!("<{name}> without `{key}` found; {key}=\"…\" expected"))
        })
    }

    fn group(&self, node: Node) -> Result<Group, ForeignError> {
        let mut members = Vec::new();
        for child in node.children().filter(Node::is_element) {
            let member = match child.tag_name().name() {
                "joint" => Member::Joint(self.text(child, "name")?),
                "link" => Member::Link(self.text(child, "name")?),
                "group" => Member::Group(self.text(child, "name")?),
                "chain" => Member::Chain {
                    base: self.text(child, "base_link")?,
                    tip: self.text(child, "tip_link")?,
                },
                _ => continue,
            };
            members.push((self.line(child), member));
        }
        Ok(Group { name: self.text(node, "name")?, members })
    }

    fn state(&self, node: Node) -> Result<GroupState, ForeignError> {
        let mut joints = Vec::new();
        for child in node.children().filter(|child| child.has_tag_name("joint")) {
            let (name, value) = (self.text(child, "name")?, self.text(child, "value")?);
            let values: Option<Vec<f64>> =
                value.split_whitespace().map(|word| word.parse().ok()).collect();
            let finite = |values: &Vec<f64>| {
                !values.is_empty() && values.iter().all(|value| value.is_finite())
            };
            let values = values.filter(finite).ok_or_else(|| {
                self.error(child, format!("value = `{value}` found; finite numbers expected"))
            })?;
            joints.push((name, values));
        }
        let (name, group) = (self.text(node, "name")?, node.attribute("group").unwrap_or_default());
        let group = group.to_owned();
        Ok(GroupState { name, group, joints })
    }

    fn virtual_joint(&self, node: Node) -> Result<VirtualJoint, ForeignError> {
        let kind = match self.text(node, "type")?.as_str() {
            "fixed" => VirtualKind::Fixed,
            "planar" => VirtualKind::Planar,
            "floating" => VirtualKind::Floating,
            other => {
                let message = format!("type = `{other}` found; fixed, planar or floating expected");
                return Err(self.error(node, message));
            }
        };
        let (name, child) = (self.text(node, "name")?, self.text(node, "child_link")?);
        Ok(VirtualJoint { name, kind, child })
    }
}
