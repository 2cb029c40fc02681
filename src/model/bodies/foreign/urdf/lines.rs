//! What `urdf-rs` cannot say or lets pass: lines, broken numbers, and what is not supported.

use crate::model::bodies::foreign::ForeignError;
use crate::scene::LENGTH_MAX;
use roxmltree::{Document, Node};
use std::path::Path;

/// How deep elements may be nested; a collision's shape is the fifth.
const DEPTH_MAX: usize = 64;
/// What limits have besides their ends.
const RATES: &str = " effort=\"…\" velocity=\"…\"";

/// Lines of the elements, in the order of the file.
pub(super) struct Lines {
    /// Of each link and of its collisions.
    pub links: Vec<(usize, Vec<usize>)>,
    /// Of each joint.
    pub joints: Vec<usize>,
    /// Of the `<mimic>` of each joint; that of the joint where it has none.
    pub mimics: Vec<usize>,
    /// For each joint whether its `<limit>` names neither a least nor a largest value.
    pub without_ends: Vec<bool>,
    /// The text as `urdf-rs` reads it: blanks in place of elements that say nothing of shapes or joints, such as
    /// materials, in which files leave out what that library requires.
    pub text: String,
}

impl Lines {
    /// Parses the file. Document type definitions are refused, so no entity makes a small file large.
    pub fn of(path: &Path, text: &str) -> Result<Lines, ForeignError> {
        let document = Document::parse(text).map_err(|error| {
            ForeignError::line(path, error.pos().row as usize, format!("not a URDF: {error}"))
        })?;
        // Counted once: `Document::text_pos_at` counts from the beginning of the text at every call.
        let breaks: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
        let line = |node: Node| {
            let start = node.range().start;
            1 + breaks.partition_point(|at| *at < start)
        };
        let root = document.root_element();
        let version = Version::of(root);
        for node in root.descendants().filter(Node::is_element) {
            check(node, version)
                .map_err(|message| ForeignError::line(path, line(node), message))?;
        }
        let named = |parent: Node<'_, '_>, name: &'static str| {
            let children = parent.children().filter(move |node| node.has_tag_name(name));
            children.map(line).collect::<Vec<_>>()
        };
        let mut bytes = text.as_bytes().to_vec();
        for node in root.descendants().filter(says_no_shape) {
            for byte in &mut bytes[node.range()] {
                // Line breaks stay, so that an error of the library would name the right line.
                *byte = if *byte == b'\n' { b'\n' } else { b' ' };
            }
        }
        let shapes = String::from_utf8(bytes).expect("whole elements have become blanks");
        let joints = || root.children().filter(|node| node.has_tag_name("joint"));
        let ends = |joint: Node| {
            let limit = joint.children().find(|node| node.has_tag_name("limit"));
            limit.is_some_and(|limit| {
                ["lower", "upper"].iter().all(|end| limit.attribute(*end).is_none())
            })
        };
        let links = root.children().filter(|node| node.has_tag_name("link"));
        Ok(Lines {
            text: shapes,
            without_ends: joints().map(ends).collect(),
            links: links.map(|link| (line(link), named(link, "collision"))).collect(),
            joints: joints().map(line).collect(),
            mimics: joints()
                .map(|joint| named(joint, "mimic").first().copied().unwrap_or_else(|| line(joint)))
                .collect(),
        })
    }
}

/// Whether an element is about looks, mass or wear and is not read.
fn says_no_shape(node: &Node) -> bool {
    let parent = node.parent_element().map_or("", |parent| parent.tag_name().name());
    matches!(
        (parent, node.tag_name().name()),
        ("robot" | "visual", "material")
            | ("link", "inertial")
            | ("joint", "dynamics" | "calibration" | "safety_controller")
    )
}

fn check(node: Node, version: Version) -> Result<(), String> {
    let name = node.tag_name().name();
    if node.tag_name().namespace().is_some_and(|space| space.contains("xacro")) {
        return Err(format!("<xacro:{name}> found; a URDF that xacro has expanded expected"));
    }
    if node.ancestors().count() > DEPTH_MAX {
        return Err(format!("elements nested more than {DEPTH_MAX} deep"));
    }
    let parent = node.parent_element().map_or("", |parent| parent.tag_name().name());
    match (parent, name) {
        ("", "robot") => {}
        ("", _) => return Err(format!("<{name}> found; <robot> expected")),
        ("robot", "joint") => {
            let kind = node.attribute("type").unwrap_or_default();
            let known =
                ["revolute", "continuous", "prismatic", "fixed", "spherical", "floating", "planar"];
            if !known.contains(&kind) {
                let joint = node.attribute("name").unwrap_or_default();
                let expected = "revolute, continuous, prismatic, spherical, fixed, floating or planar expected";
                return Err(format!("joint `{joint}`: type `{kind}` found; {expected}"));
            }
            let has_limit = node.children().any(|child| child.has_tag_name("limit"));
            if matches!(kind, "revolute" | "prismatic") && !has_limit {
                let joint = node.attribute("name").unwrap_or_default();
                let other = if kind == "revolute" { ", or the type continuous," } else { "" };
                let rates = if version.requires_rates() { RATES } else { "" };
                return Err(format!(
                    "joint `{joint}`: type `{kind}` without <limit> found; <limit lower=\"…\" \
                     upper=\"…\"{rates}/>{other} expected"
                ));
            }
        }
        _ => {}
    }
    if let Some(what) = lacking(node, parent, version) {
        return Err(what);
    }
    for attribute in node.attributes() {
        let (count, positive) = match (name, attribute.name()) {
            ("origin" | "axis", "xyz") | ("origin", "rpy") | ("mesh", "scale") => (3, false),
            ("box", "size") => (3, true),
            ("sphere" | "cylinder" | "capsule", "radius" | "length") => (1, true),
            ("limit", "lower" | "upper") => (1, false),
            ("mimic", "multiplier" | "offset") => (1, false),
            ("origin", "quat_xyzw") => {
                return Err("quat_xyzw found; a rotation as rpy expected".to_owned());
            }
            ("limit", "effort" | "velocity") => {
                let (key, value) = (attribute.name(), attribute.value());
                match numbers(value).as_deref() {
                    Some([_]) => continue,
                    _ => return Err(format!("{key} = `{value}` found; a number expected")),
                }
            }
            _ => continue,
        };
        // Written so that NaN fails it.
        let fits = |x: &f64| x.abs() <= LENGTH_MAX && (!positive || *x > 0.0);
        let numbers = numbers(attribute.value());
        if !numbers.is_some_and(|all| all.len() == count && all.iter().all(fits)) {
            let (key, value) = (attribute.name(), attribute.value());
            let kind = if positive { "positive" } else { "finite" };
            let expected = if count == 1 { "a" } else { "three" };
            let plural = if count == 1 { "" } else { "s" };
            return Err(format!(
                "{key} = `{value}` found; {expected} {kind} number{plural} expected"
            ));
        }
    }
    if name == "limit" {
        let end = |key| node.attribute(key).and_then(|text| text.trim().parse::<f64>().ok());
        if let (Some(lower), Some(upper)) = (end("lower"), end("upper"))
            && lower > upper
        {
            return Err(format!(
                "limits {lower} to {upper} found; a least and a largest value expected"
            ));
        }
    }
    Ok(())
}

/// What an element lacks that is read, and cannot be without: attributes, or other elements.
fn lacking(node: Node, parent: &str, version: Version) -> Option<String> {
    // Within other elements, as what a simulator is told, the same names mean other things.
    let is_read = |top: Node| top.has_tag_name("link") || top.has_tag_name("joint");
    let root = node.document().root_element();
    let top = node.ancestors().find(|above| above.parent_element() == Some(root));
    if !top.is_some_and(is_read) {
        return None;
    }
    let name = node.tag_name().name();
    let (attributes, elements): (&[&str], &[&str]) = match (parent, name) {
        ("robot", "link") => (&["name"], &[]),
        ("robot", "joint") => (&["name", "type"], &["parent", "child"]),
        ("joint", "parent" | "child") => (&["link"], &[]),
        ("joint", "mimic") => (&["joint"], &[]),
        ("joint", "limit") if version.requires_rates() => (&["effort", "velocity"], &[]),
        ("link", "visual" | "collision") => (&[], &["geometry"]),
        ("geometry", "box") => (&["size"], &[]),
        ("geometry", "cylinder" | "capsule") => (&["radius", "length"], &[]),
        ("geometry", "sphere") => (&["radius"], &[]),
        ("geometry", "mesh") => (&["filename"], &[]),
        _ => (&[], &[]),
    };
    if let Some(missing) = attributes.iter().find(|key| node.attribute(**key).is_none()) {
        return Some(format!("<{name}> without `{missing}` found; {missing}=\"…\" expected"));
    }
    let has = |element: &str| node.children().any(|child| child.has_tag_name(element));
    let missing = elements.iter().find(|element| !has(element))?;
    Some(format!("<{name}> without <{missing}> found; <{missing} …/> in it expected"))
}

/// The version of the format that a file is of, as (1, 2).
#[derive(Clone, Copy)]
struct Version(u32, u32);

impl Version {
    /// What the robot says, or 1.0 where it says nothing that can be read, as ROS's own reader takes it.
    fn of(robot: Node) -> Version {
        let version = robot.attribute("version").and_then(|text| {
            let (major, minor) = text.trim().split_once('.')?;
            Some(Version(major.parse().ok()?, minor.parse().ok()?))
        });
        version.unwrap_or(Version(1, 0))
    }

    /// Whether limits have to give the largest effort and velocity. Nothing here uses them, but ROS's own reader refuses
    /// files without.
    fn requires_rates(self) -> bool {
        (self.0, self.1) < (1, 2)
    }
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace().map(|word| word.parse().ok()).collect()
}
